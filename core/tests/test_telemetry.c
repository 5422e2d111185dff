/* The frames of the serial line and the queue before it. The expected bytes are those of docs/telemetry.md, worked out
 * there by other means (tests/telemetry/oracle.py). */
#include "check.h"

#include "../robot/telemetry.h"

static const lobula_telemetry_hello about = {
    99, 72, 0, 30.0f, {0.7f, 0.7f, 0.2f, -0.2f}, "0123456789ab", "default", "0.1.0"};
static const lobula_telemetry_reading usual = {
    1000, 33333, {0.75f, 0.71875f, 0.0f, -0.25f}, {2, 1, 0, 0}, 0, 1, LOBULA_TELEMETRY_STOP, 5120};

static void example_of_a_reading(void) {
    static const uint8_t expected[LOBULA_TELEMETRY_READING_BYTES] = {
        0x00, 0x07, 0x01, 0x01, 0x02, 0x01, 0xe8, 0x03, 0x01, 0x03, 0x35, 0x82, 0x01, 0x01, 0x01, 0x03,
        0x40, 0x3f, 0x01, 0x03, 0x38, 0x3f, 0x01, 0x01, 0x01, 0x01, 0x01, 0x05, 0x80, 0xbe, 0x02, 0x01,
        0x01, 0x01, 0x03, 0x01, 0x01, 0x01, 0x02, 0x14, 0x01, 0x01, 0x90, 0xee, 0x83, 0x00};
    uint8_t out[LOBULA_TELEMETRY_READING_BYTES];
    lobula_telemetry_encode_reading(&usual, 258, out);
    CHECK(memcmp(out, expected, sizeof expected) == 0, "the reading of docs/telemetry.md");
}

static void example_of_a_hello(void) {
    static const uint8_t expected[LOBULA_TELEMETRY_HELLO_BYTES] = {
        0x00, 0x04, 0x01, 0x02, 0x63, 0x02, 0x48, 0x01, 0x01, 0x01, 0x01, 0x26, 0xf0, 0x41, 0x33, 0x33,
        0x33, 0x3f, 0x33, 0x33, 0x33, 0x3f, 0xcd, 0xcc, 0x4c, 0x3e, 0xcd, 0xcc, 0x4c, 0xbe, 0x30, 0x31,
        0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x61, 0x62, 0x64, 0x65, 0x66, 0x61, 0x75, 0x6c,
        0x74, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x06, 0x30, 0x2e, 0x31, 0x2e, 0x30, 0x01,
        0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x99, 0x97, 0x81, 0x00};
    uint8_t out[LOBULA_TELEMETRY_HELLO_BYTES];
    lobula_telemetry_encode_hello(&about, out);
    CHECK(memcmp(out, expected, sizeof expected) == 0, "the hello of docs/telemetry.md");
}

/* Whatever is in it: no zero but the first and the last byte. */
static void no_zero_inside(void) {
    lobula_telemetry_reading r = usual;
    uint8_t out[LOBULA_TELEMETRY_READING_BYTES];
    for (uint32_t k = 0; k < 70000; k++) {
        r.frame = k * 2654435761u;
        r.time_ms = k;
        r.potentials[2] = (float)k;
        lobula_telemetry_encode_reading(&r, (uint16_t)k, out);
        CHECK(out[0] == 0 && out[sizeof out - 1] == 0, "a zero on either side");
        CHECK(memchr(out + 1, 0, sizeof out - 2) == NULL, "none in between");
    }
}

static void counts_that_do_not_fit(void) {
    lobula_telemetry_reading r = usual;
    uint8_t most[LOBULA_TELEMETRY_READING_BYTES], many[LOBULA_TELEMETRY_READING_BYTES];
    r.spikes[0] = 255;
    lobula_telemetry_encode_reading(&r, 0, most);
    r.spikes[0] = 70000;
    lobula_telemetry_encode_reading(&r, 0, many);
    CHECK(memcmp(most, many, sizeof most) == 0, "more than 255 spikes are told as 255");
}

static int drain(lobula_telemetry *line) {
    int count = 0;
    while (lobula_telemetry_next(line) >= 0) count++;
    return count;
}

/* A hello before the first reading and before each 32nd after it. */
static void when_a_hello_comes(void) {
    lobula_telemetry line;
    lobula_telemetry_init(&line, &about);
    CHECK(lobula_telemetry_next(&line) == -1, "nothing waits at first");
    for (int k = 0; k < 100; k++) {
        CHECK(lobula_telemetry_put(&line, &usual) == 1, "an empty line takes a hello and a reading");
        CHECK(drain(&line) == (k % 32 == 0 ? 78 + 46 : 46), "what is sent");
    }
}

/* Nobody empties the line: nothing waits for it, what does not fit is left out, its number is spent. */
static void a_line_that_is_too_slow(void) {
    lobula_telemetry line;
    uint8_t first[LOBULA_TELEMETRY_READING_BYTES], fifth[LOBULA_TELEMETRY_READING_BYTES];
    lobula_telemetry_encode_reading(&usual, 0, first);
    lobula_telemetry_encode_reading(&usual, 4, fifth);
    lobula_telemetry_init(&line, &about);
    CHECK(lobula_telemetry_put(&line, &usual) == 1, "the first");
    for (int k = 0; k < 3; k++) CHECK(lobula_telemetry_put(&line, &usual) == 0, "no room");
    for (int k = 0; k < LOBULA_TELEMETRY_HELLO_BYTES; k++) lobula_telemetry_next(&line);
    CHECK(lobula_telemetry_put(&line, &usual) == 1, "room again");
    for (size_t k = 0; k < sizeof first; k++) CHECK(lobula_telemetry_next(&line) == first[k], "whole frames only");
    for (size_t k = 0; k < sizeof fifth; k++) CHECK(lobula_telemetry_next(&line) == fifth[k], "the next has number 4");
    CHECK(lobula_telemetry_next(&line) == -1, "and no more");
}

/* A line that takes 46 bytes a picture has no room for 78 more while readings fill it up. */
static void a_hello_on_a_full_line(void) {
    lobula_telemetry line;
    int hellos = 0, at = 0;
    lobula_telemetry_init(&line, &about);
    for (int k = 0; k < 200; k++) {
        lobula_telemetry_put(&line, &usual);
        for (int sent = 0; sent < LOBULA_TELEMETRY_READING_BYTES; sent++) {
            int byte = lobula_telemetry_next(&line);
            if (byte < 0) break;
            at = byte == 0 ? 0 : at + 1;
            hellos += at == LOBULA_TELEMETRY_HELLO_BYTES - 2;
        }
    }
    CHECK(hellos >= 6, "one before every 32nd of 200, but for what still waits");
}

static void a_sequence_that_wraps(void) {
    lobula_telemetry line;
    uint8_t expected[LOBULA_TELEMETRY_READING_BYTES];
    lobula_telemetry_init(&line, &about);
    for (long k = 0; k < 65536; k++) {
        lobula_telemetry_put(&line, &usual);
        drain(&line);
    }
    line.until_hello = 1;
    lobula_telemetry_put(&line, &usual);
    lobula_telemetry_encode_reading(&usual, 0, expected);
    for (size_t k = 0; k < sizeof expected; k++) CHECK(lobula_telemetry_next(&line) == expected[k], "0 after 65535");
}

int main(void) {
    example_of_a_reading();
    example_of_a_hello();
    no_zero_inside();
    counts_that_do_not_fit();
    when_a_hello_comes();
    a_line_that_is_too_slow();
    a_hello_on_a_full_line();
    a_sequence_that_wraps();
    puts("telemetry: good");
    return 0;
}
