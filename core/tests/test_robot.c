/* The robot's front on this machine: the preset of robot/lobula_config.h, whole frames and lines, and what goes wrong. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check_macro.h"
#include "lobula.h"

static const float TICK_MS = 1000.0f / 30.0f;

static void draw(uint8_t *pixels, int t) {
    for (int y = 0; y < LOBULA_HEIGHT; y++)
        for (int x = 0; x < LOBULA_WIDTH; x++) {
            int grown = 4 + t * t / 24, near = abs(x - 45) < grown && abs(y - 36) < grown;
            *pixels++ = (uint8_t)(near ? 25 + 3 * ((x + y) % 3) : 150 + 30 * ((x + 7 * y) / 6 % 2));
        }
}

/* Step by frames or by lines; lines are cut short after `lines`. */
static int step(lobula_state *s, const uint8_t *pixels, int lines, lobula_reading *r) {
    if (lines < 0) return lobula_step(s, pixels, TICK_MS, r);
    for (int y = 0; y < lines; y++) {
        uint8_t *line = malloc(LOBULA_WIDTH); /* exactly as long as it must be, and gone afterwards */
        if (!line) abort();
        memcpy(line, pixels + (y < LOBULA_HEIGHT ? y : 0) * LOBULA_WIDTH, LOBULA_WIDTH);
        CHECK(lobula_push_row(s, line) == (y < LOBULA_HEIGHT ? y + 1 : LOBULA_HEIGHT), "the lines so far");
        free(line);
    }
    return lobula_end_frame(s, TICK_MS, r);
}

static void frames_and_lines(void) {
    static lobula_state whole, lines;
    static uint8_t pixels[LOBULA_WIDTH * LOBULA_HEIGHT];
    int alarms = 0;
    CHECK(lobula_init(&whole) == LOBULA_OK && lobula_init(&lines) == LOBULA_OK, "the settings fit the sizes");
    for (int t = 0; t < 34; t++) {
        lobula_reading a, b;
        draw(pixels, t);
        alarms += step(&whole, pixels, -1, &a);
        CHECK(step(&lines, pixels, LOBULA_HEIGHT + t % 2, &b) == a.collision, "the same decision, a line too many or not");
        CHECK(memcmp(&a, &b, sizeof a) == 0, "the same reading");
        CHECK(a.lgmd1 >= 0.5f && a.lgmd1 < 1.0f && a.lptc_l <= 0.0f && a.lptc_l > -1.0f, "potentials in their ranges");
        CHECK(fabs(a.time_s - t / 30.0) < 1e-5, "the time");
    }
    CHECK(alarms > 0, "something comes near");
}

static void missing_lines(void) {
    static lobula_state cut, still;
    static uint8_t pixels[LOBULA_WIDTH * LOBULA_HEIGHT], mixed[LOBULA_WIDTH * LOBULA_HEIGHT];
    lobula_reading a, b;
    const int there = 40;
    lobula_init(&cut);
    lobula_init(&still);
    draw(pixels, 8);
    memcpy(mixed, pixels, sizeof mixed);
    step(&cut, pixels, LOBULA_HEIGHT, &a);
    step(&still, pixels, -1, &b);
    draw(pixels, 20);
    memcpy(mixed, pixels, (size_t)there * LOBULA_WIDTH);
    step(&cut, pixels, there, &a);
    step(&still, mixed, -1, &b);
    CHECK(memcmp(&a, &b, sizeof a) == 0, "missing lines stay as they were");
}

static void broken_off(void) {
    static lobula_state cut, plain;
    static uint8_t pixels[LOBULA_WIDTH * LOBULA_HEIGHT];
    lobula_reading a, b;
    lobula_init(&cut);
    lobula_init(&plain);
    for (int t = 0; t < 34; t++) {
        draw(pixels, t);
        for (int y = 0; y < t; y++) lobula_push_row(&cut, pixels); /* then the camera begins anew */
        lobula_begin_frame(&cut);
        step(&cut, pixels, LOBULA_HEIGHT, &a);
        step(&plain, pixels, -1, &b);
        CHECK(memcmp(&a, &b, sizeof a) == 0, "a frame that was broken off leaves nothing behind");
    }
}

/* Memory that was never made a state, as that of a variable on the stack. */
static void not_a_state(void) {
    static lobula_state s;
    static uint8_t pixels[LOBULA_WIDTH * LOBULA_HEIGHT];
    lobula_reading r;
    memset(&s, 0xa5, sizeof s);
    CHECK(lobula_push_row(&s, pixels) == LOBULA_BAD_STATE, "a line");
    CHECK(lobula_end_frame(&s, TICK_MS, &r) == LOBULA_BAD_STATE, "the end of a frame");
    CHECK(lobula_step(&s, pixels, TICK_MS, &r) == LOBULA_BAD_STATE, "a frame");
    lobula_init(&s);
    CHECK(lobula_push_row(&s, NULL) == LOBULA_BAD_ARGUMENT, "no line");
    CHECK(lobula_step(&s, NULL, TICK_MS, &r) == LOBULA_BAD_ARGUMENT, "no picture");
    CHECK(lobula_step(&s, pixels, TICK_MS, NULL) == LOBULA_BAD_ARGUMENT, "nowhere to write");
}

/* A timer that once says nonsense: refused, or a gap; the network then does what a fresh one does. */
static void time_out_of_order(void) {
    const float gaps[] = {INFINITY, 1e30f, 2e9f, 1e9f, 4294967.0f};
    static lobula_state s, fresh;
    static uint8_t pixels[LOBULA_WIDTH * LOBULA_HEIGHT];
    lobula_reading a = {0}, b = {0};
    for (int i = 0; i < 5; i++) {
        lobula_init(&s);
        lobula_init(&fresh);
        draw(pixels, 0);
        lobula_step(&s, pixels, TICK_MS, &a);
        int answer = lobula_step(&s, pixels, gaps[i], &a);
        CHECK(answer == (gaps[i] > 1e9f ? LOBULA_BAD_ARGUMENT : 0), "more than 1e9 ms cannot be");
        int alarms = 0, expected = 0;
        lobula_step(&fresh, pixels, TICK_MS, &b);
        for (int t = 1; t < 34; t++) {
            draw(pixels, t);
            alarms += lobula_step(&s, pixels, TICK_MS, &a);
            expected += lobula_step(&fresh, pixels, TICK_MS, &b);
        }
        CHECK(expected > 0 && alarms == expected, "as if nothing had been");
        CHECK(fabsf(a.lgmd1 - b.lgmd1) < 1e-3f && fabsf(a.lptc_r - b.lptc_r) < 1e-3f, "the same potentials");
    }
}

static void turns_and_mistakes(void) {
    static lobula_state s;
    static uint8_t pixels[LOBULA_WIDTH * LOBULA_HEIGHT];
    lobula_reading r = {0};
    CHECK(lobula_step(&s, pixels, TICK_MS, &r) == LOBULA_BAD_STATE, "not made yet");
    lobula_init(&s);
    lobula_set_turning(&s, 7);
    CHECK(lobula_step(&s, pixels, 0.0f, &r) == 0 && r.state == LOBULA_STATE_WARMING_UP, "the first dt is not looked at");
    CHECK(lobula_step(&s, pixels, 0.0f, &r) == LOBULA_BAD_ARGUMENT, "no time has gone by");
    CHECK(lobula_step(&s, pixels, -1.0f, &r) == LOBULA_BAD_ARGUMENT, "time runs backwards");
    CHECK(lobula_step(&s, pixels, (float)NAN, &r) == LOBULA_BAD_ARGUMENT, "no number");
    for (int t = 0; t < 12; t++) {
        draw(pixels, t);
        lobula_step(&s, pixels, TICK_MS, &r);
    }
    CHECK(r.state == LOBULA_STATE_TURNING, "it turns");
    lobula_set_turning(&s, 0);
    for (int t = 0; t < 4; t++) lobula_step(&s, pixels, TICK_MS, &r);
    CHECK(r.state == LOBULA_STATE_OK, "and no longer");
    lobula_step(&s, pixels, 2000.0f, &r);
    CHECK(r.state == LOBULA_STATE_WARMING_UP, "a long silence starts afresh");
}

int main(void) {
    frames_and_lines();
    missing_lines();
    broken_off();
    not_a_state();
    time_out_of_order();
    turns_and_mistakes();
    puts("robot: good");
    return 0;
}
