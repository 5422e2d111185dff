/* Compiled once for each instruction set, see isa.h. */
#include "eye_sensor.h"

#include <stddef.h>
#include <string.h>

#ifndef LOBULA_ISA
#define LOBULA_ISA base
#endif
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
#define WORDS_START_LOW 1
#else
#define WORDS_START_LOW 0
#endif

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)

/* Well mixed bits of pixel `i`; each half of the key enters at a place of its own, so no two keys share a sequence. */
static inline uint32_t bits_of(uint32_t i, eye_noise n) {
    uint32_t x = i * 0x9e3779b9u + n.first;
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= (x >> 15) ^ n.second;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

static inline uint8_t byte_of(int32_t level) {
    level >>= EYE_GREY_BITS;
    level = level > 0 ? level : 0;
    return (uint8_t)(level < 255 ? level : 255);
}

static void noisy(const float *restrict grey, int count, eye_noise n, uint8_t *restrict bytes) {
    int32_t offset = (1 << (EYE_SCALE_BITS - 1)) - EYE_BYTES_MEAN * n.scale; /* rounds, and takes off the mean */
    for (int i = 0; i < count; i++) {
        uint32_t x = bits_of((uint32_t)i, n);
        uint32_t pairs = (x & 0x00ff00ffu) + ((x >> 8) & 0x00ff00ffu);
        int32_t sum = (int32_t)((pairs + (pairs >> 16)) & 0xffffu);
        int32_t noise = (sum * n.scale + offset) >> EYE_SCALE_BITS;
        bytes[i] = byte_of((int32_t)(grey[i] * EYE_GREY + 0.5f) + (noise + EYE_GREY / 2));
    }
}

static void rounded(const float *restrict grey, int count, uint8_t *restrict bytes) {
    for (int i = 0; i < count; i++) bytes[i] = byte_of((int32_t)(grey[i] * EYE_GREY + 0.5f) + EYE_GREY / 2);
}

/* Exchange the bits of `b` under `mask` with those of `a` `shift` above. */
static inline void swap_bits(uint64_t *a, uint64_t *b, int shift, uint64_t mask) {
    uint64_t t = ((*a >> shift) ^ *b) & mask;
    *b ^= t;
    *a ^= t << shift;
}

static inline uint64_t eight(const uint8_t *p) {
    uint64_t x;
    memcpy(&x, p, sizeof x);
    return x;
}

/* Eight columns of eight bytes, each in one word, the upper row in its lowest byte, become eight rows. */
static inline void block(const uint8_t *columns, ptrdiff_t height, uint8_t *rows, ptrdiff_t width) {
    const uint64_t ones = UINT64_C(0x00ff00ff00ff00ff), twos = UINT64_C(0x0000ffff0000ffff), fours = 0xffffffffu;
    uint64_t a = eight(columns), b = eight(columns + height), c = eight(columns + 2 * height),
             d = eight(columns + 3 * height), e = eight(columns + 4 * height), f = eight(columns + 5 * height),
             g = eight(columns + 6 * height), h = eight(columns + 7 * height);
    swap_bits(&a, &b, 8, ones), swap_bits(&c, &d, 8, ones), swap_bits(&e, &f, 8, ones), swap_bits(&g, &h, 8, ones);
    swap_bits(&a, &c, 16, twos), swap_bits(&b, &d, 16, twos), swap_bits(&e, &g, 16, twos), swap_bits(&f, &h, 16, twos);
    swap_bits(&a, &e, 32, fours), swap_bits(&b, &f, 32, fours), swap_bits(&c, &g, 32, fours), swap_bits(&d, &h, 32, fours);
    memcpy(rows, &a, 8), memcpy(rows + width, &b, 8), memcpy(rows + 2 * width, &c, 8), memcpy(rows + 3 * width, &d, 8);
    memcpy(rows + 4 * width, &e, 8), memcpy(rows + 5 * width, &f, 8), memcpy(rows + 6 * width, &g, 8);
    memcpy(rows + 7 * width, &h, 8);
}

static void to_rows(const uint8_t *bytes, ptrdiff_t width, ptrdiff_t height, uint8_t *rows) {
    ptrdiff_t wide = WORDS_START_LOW ? width / 8 * 8 : 0, tall = height / 8 * 8;
    for (ptrdiff_t y = 0; y < tall; y += 8)
        for (ptrdiff_t x = 0; x < wide; x += 8) block(bytes + x * height + y, height, rows + y * width + x, width);
    for (ptrdiff_t y = 0; y < height; y++)
        for (ptrdiff_t x = y < tall ? wide : 0; x < width; x++) rows[y * width + x] = bytes[x * height + y];
}

static void sense(const float *columns, int width, int height, eye_noise noise, uint8_t *bytes, uint8_t *rows) {
    if (noise.scale)
        noisy(columns, width * height, noise, bytes);
    else
        rounded(columns, width * height, bytes);
    to_rows(bytes, width, height, rows);
}

const eye_kernels JOIN(eye_kernels_, LOBULA_ISA) = {sense};
