#include "telemetry.h"

#include <string.h>

enum { READING = 1, HELLO = 2 };
enum { READING_PAYLOAD = LOBULA_TELEMETRY_READING_BYTES - 6, HELLO_PAYLOAD = LOBULA_TELEMETRY_HELLO_BYTES - 6 };
enum { HASH_BYTES = 12, TEXT_BYTES = 16 };

static uint8_t *put_u8(uint8_t *at, uint32_t value) {
    *at = (uint8_t)(value & 0xffu);
    return at + 1;
}

static uint8_t *put_u16(uint8_t *at, uint32_t value) { return put_u8(put_u8(at, value), value >> 8); }

static uint8_t *put_u32(uint8_t *at, uint32_t value) { return put_u16(put_u16(at, value), value >> 16); }

static uint8_t *put_float(uint8_t *at, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return put_u32(at, bits);
}

/* Four numbers, one for each neuron. */
static uint8_t *put_floats(uint8_t *at, const float values[4]) {
    for (int i = 0; i < 4; i++) at = put_float(at, values[i]);
    return at;
}

static uint8_t *put_text(uint8_t *at, const char *text, int bytes) {
    for (int i = 0; i < bytes; i++) {
        *at++ = (uint8_t)*text;
        if (*text != '\0') text++;
    }
    return at;
}

static uint32_t within_byte(int32_t value) { return value < 0 ? 0u : value > 255 ? 255u : (uint32_t)value; }

/* CRC-16/IBM-SDLC: the frame check of HDLC and PPP. Its bits go in the order in which a serial line sends them. */
static uint16_t checksum(const uint8_t *bytes, int count) {
    uint16_t crc = 0xffffu;
    for (int i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = (uint16_t)((crc & 1u) ? (crc >> 1) ^ 0x8408u : crc >> 1);
    }
    return (uint16_t)(crc ^ 0xffffu);
}

/* Between two zeros: the payload without zeros (COBS, for fewer than 254 bytes), then the checksum of that. */
static void frame(const uint8_t *payload, int bytes, uint8_t *out) {
    uint8_t *code = out + 1;
    out[0] = 0;
    *code = 1;
    for (int i = 0; i < bytes; i++) {
        out[2 + i] = payload[i];
        if (payload[i] == 0) {
            code = out + 2 + i;
            *code = 1;
        } else {
            (*code)++;
        }
    }
    const uint16_t crc = checksum(out + 1, bytes + 1);
    uint8_t *at = out + 2 + bytes; /* in three bytes, the top bits set so that none of them is zero */
    at = put_u8(at, 0x80u | crc);
    at = put_u8(at, 0x80u | (uint32_t)(crc >> 7));
    at = put_u8(at, 0x80u | (uint32_t)(crc >> 14));
    *at = 0;
}

void lobula_telemetry_encode_reading(const lobula_telemetry_reading *reading, uint16_t sequence,
                                     uint8_t out[LOBULA_TELEMETRY_READING_BYTES]) {
    uint8_t payload[READING_PAYLOAD], *at = payload;
    at = put_u8(at, LOBULA_TELEMETRY_VERSION);
    at = put_u8(at, READING);
    at = put_u16(at, sequence);
    at = put_u32(at, reading->frame);
    at = put_u32(at, reading->time_ms);
    at = put_floats(at, reading->potentials);
    for (int i = 0; i < 4; i++) at = put_u8(at, within_byte(reading->spikes[i]));
    at = put_u8(at, within_byte(reading->state));
    at = put_u8(at, reading->collision ? 1u : 0u);
    at = put_u8(at, within_byte(reading->action));
    at = put_u8(at, 0u);
    put_u32(at, reading->step_us);
    frame(payload, READING_PAYLOAD, out);
}

void lobula_telemetry_encode_hello(const lobula_telemetry_hello *hello, uint8_t out[LOBULA_TELEMETRY_HELLO_BYTES]) {
    uint8_t payload[HELLO_PAYLOAD], *at = payload;
    at = put_u8(at, LOBULA_TELEMETRY_VERSION);
    at = put_u8(at, HELLO);
    at = put_u16(at, hello->width);
    at = put_u16(at, hello->height);
    at = put_u8(at, hello->neurons);
    at = put_u8(at, 0u);
    at = put_float(at, hello->rate_hz);
    at = put_floats(at, hello->thresholds);
    at = put_text(at, hello->settings_hash, HASH_BYTES);
    at = put_text(at, hello->preset, TEXT_BYTES);
    put_text(at, hello->version, TEXT_BYTES);
    frame(payload, HELLO_PAYLOAD, out);
}

static uint8_t next_place(uint8_t place) { return (uint8_t)((place + 1u) % LOBULA_TELEMETRY_ROOM); }

/* One byte stays free, or full would look like empty. */
static int room(const lobula_telemetry *line) {
    return (int)((line->begin + 2u * LOBULA_TELEMETRY_ROOM - line->end - 1u) % LOBULA_TELEMETRY_ROOM);
}

static int wait_to_be_sent(lobula_telemetry *line, const uint8_t *bytes, int count) {
    if (room(line) < count) return 0;
    uint8_t end = line->end;
    for (int i = 0; i < count; i++) {
        line->waiting[end] = bytes[i];
        end = next_place(end);
    }
    line->end = end; /* last: an interrupt sees the whole frame or none of it */
    return 1;
}

void lobula_telemetry_init(lobula_telemetry *line, const lobula_telemetry_hello *hello) {
    line->hello = hello;
    line->sequence = 0;
    line->until_hello = 0;
    line->begin = line->end = 0;
}

int lobula_telemetry_put(lobula_telemetry *line, const lobula_telemetry_reading *reading) {
    uint8_t bytes[LOBULA_TELEMETRY_HELLO_BYTES];
    const uint16_t sequence = line->sequence++;
    if (line->until_hello == 0) {
        lobula_telemetry_encode_hello(line->hello, bytes);
        if (!wait_to_be_sent(line, bytes, LOBULA_TELEMETRY_HELLO_BYTES)) return 0; /* readings could keep it out for ever */
        line->until_hello = LOBULA_TELEMETRY_HELLO_EVERY;
    }
    line->until_hello--;
    lobula_telemetry_encode_reading(reading, sequence, bytes);
    return wait_to_be_sent(line, bytes, LOBULA_TELEMETRY_READING_BYTES);
}

int lobula_telemetry_next(lobula_telemetry *line) {
    const uint8_t begin = line->begin;
    if (begin == line->end) return -1;
    const int byte = line->waiting[begin];
    line->begin = next_place(begin);
    return byte;
}
