/* Sixteen bits: every half there is, the roundings between them, and a network that keeps its planes in them. */
#include "check.h"

#include <math.h>

#include "storage.h"

static float float_with(uint32_t bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* The value of a half by its definition. */
static double defined(uint32_t h) {
    int exponent = (int)(h >> 10 & 31), fraction = (int)(h & 1023);
    double size = exponent ? ldexp(1024 + fraction, exponent - 25) : ldexp(fraction, -24);
    return h & 0x8000u ? -size : size;
}

static void every_half(void) {
    for (uint32_t h = 0; h < 0x10000u; h++) {
        if ((h & 0x7c00u) == 0x7c00u) continue; /* infinite, or no number */
        CHECK((double)float_of((half16)h) == defined(h), "the value of a half");
        CHECK(half_of(float_of((half16)h)) == h, "there and back");
    }
    CHECK(float_of(0x7c00u) == HUGE_VALF && half_of(65520.0f) == 0x7c00u && half_of(65519.0f) == 0x7bffu, "the end");
}

/* Between two halves lies a border: below it goes down, above it up, on it to the even one. */
static void every_rounding(void) {
    for (uint32_t h = 0; h < 0x7bffu; h++) {
        float border = (float)((defined(h) + defined(h + 1)) / 2.0);
        uint32_t bits;
        memcpy(&bits, &border, sizeof bits);
        CHECK(half_of(float_with(bits - 1)) == h && half_of(float_with(bits + 1)) == h + 1, "the nearest");
        CHECK(half_of(border) == (h & 1 ? h + 1 : h), "the even one");
        CHECK(half_of(-border) == (0x8000u | (h & 1 ? h + 1 : h)), "as far below zero");
    }
    CHECK(half_of(0.0f) == 0 && half_of(-0.0f) == 0x8000u && half_of(1e-30f) == 0, "zero");
}

enum { WIDTH = 50, HEIGHT = 33, FRAMES = 20 };

static void draw(uint8_t *pixels, int t) {
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            int near = abs(x - 20) < 3 + t && abs(y - 15) < 2 + t / 2;
            *pixels++ = (uint8_t)(near ? 30 : 120 + 40 * ((x + 2 * t) / 5 % 2) + y);
        }
}

static void as_with_floats(void) {
    static uint8_t pixels[WIDTH * HEIGHT];
    static float plane[WIDTH * HEIGHT];
    lobula_params p = published();
    lobula_net small = network_in(LOBULA_COMPACT, &p, WIDTH, HEIGHT, 1), large = network(&p, WIDTH, HEIGHT, 1);
    CHECK(2 * lobula_state_size(&p, WIDTH, HEIGHT, LOBULA_COMPACT) < lobula_state_size(&p, WIDTH, HEIGHT, LOBULA_FLOAT) + 8192,
          "half the memory");
    for (int t = 0; t < FRAMES; t++) {
        lobula_reading a, b;
        lobula_images image = bytes_of(pixels, WIDTH, HEIGHT);
        draw(pixels, t);
        lobula_step(&small, &image, t / 30.0, 0, &a, NULL);
        lobula_step(&large, &image, t / 30.0, 0, &b, NULL);
        CHECK(fabs(a.lgmd1 - b.lgmd1) < 1e-3 && fabs(a.lgmd2 - b.lgmd2) < 1e-3, "the LGMDs");
        CHECK(fabs(a.lptc_r - b.lptc_r) < 1e-3 && fabs(a.lptc_l - b.lptc_l) < 1e-3, "the LPTCs");
    }
    lobula_images floats = {plane, WIDTH * (ptrdiff_t)sizeof(float), sizeof plane, LOBULA_FLOAT32, 0};
    lobula_reading r;
    CHECK(lobula_step(&small, &floats, 1.0, 0, &r, NULL) == LOBULA_BAD_ARGUMENT, "it takes bytes only");
    for (int i = 0; i < LOBULA_PLANES; i++) {
        CHECK(lobula_get_plane(small.state, i, plane) == LOBULA_OK, "a plane");
        CHECK(lobula_set_plane(small.state, i, plane) == LOBULA_OK, "and back");
    }
    release(&small);
    release(&large);
}

int main(void) {
    every_half();
    every_rounding();
    as_with_floats();
    puts("compact: good");
    return 0;
}
