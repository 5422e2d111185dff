/* Compiled once for each instruction set, see isa.h. */
#include "eye_sensor.h"

#include <stddef.h>
#include <string.h>

#ifndef LOBULA_ISA
#define LOBULA_ISA base
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

static void noisy(const float *restrict grey, int count, eye_noise n, uint8_t *restrict bytes) {
    for (int i = 0; i < count; i++) {
        uint32_t x = bits_of((uint32_t)i, n);
        uint32_t pairs = (x & 0x00ff00ffu) + ((x >> 8) & 0x00ff00ffu);
        int32_t noise = (int32_t)((pairs & 0xffffu) + (pairs >> 16)) - 510;
        noise = (noise * n.scale + (1 << (EYE_SCALE_BITS - 1))) >> EYE_SCALE_BITS;
        int32_t level = ((int32_t)(grey[i] * EYE_GREY + 0.5f) + noise + EYE_GREY / 2) >> 7;
        bytes[i] = (uint8_t)(level < 0 ? 0 : level > 255 ? 255 : level);
    }
}

static void rounded(const float *restrict grey, int count, uint8_t *restrict bytes) {
    for (int i = 0; i < count; i++) {
        int32_t level = ((int32_t)(grey[i] * EYE_GREY + 0.5f) + EYE_GREY / 2) >> 7;
        bytes[i] = (uint8_t)(level > 255 ? 255 : level);
    }
}

/* Exchange the bits of `b` under `mask` with those of `a` `shift` above. */
#define SWAP(a, b, shift, mask)                      \
    do {                                             \
        uint64_t t = (((a) >> (shift)) ^ (b)) & (mask); \
        (b) ^= t;                                    \
        (a) ^= t << (shift);                         \
    } while (0)

/* Eight columns of eight bytes become eight rows. */
static inline void transpose8(uint64_t w[8]) {
    const uint64_t ones = 0x00ff00ff00ff00ffu, twos = 0x0000ffff0000ffffu, fours = 0x00000000ffffffffu;
    for (int i = 0; i < 8; i += 2) SWAP(w[i], w[i + 1], 8, ones);
    for (int i = 0; i < 8; i += 1 + 2 * (i & 1)) SWAP(w[i], w[i + 2], 16, twos);
    for (int i = 0; i < 4; i++) SWAP(w[i], w[i + 4], 32, fours);
}

static void to_rows(const uint8_t *bytes, int width, int height, uint8_t *rows) {
    for (int y = 0; y < height; y += 8)
        for (int x = 0; x < width; x += 8) {
            int tall = height - y < 8 ? height - y : 8, wide = width - x < 8 ? width - x : 8;
            uint64_t w[8] = {0};
            for (int i = 0; i < wide; i++) memcpy(&w[i], bytes + (ptrdiff_t)(x + i) * height + y, 8);
            transpose8(w);
            uint8_t *to = rows + (ptrdiff_t)y * width + x;
            if (wide == 8)
                for (int i = 0; i < tall; i++) memcpy(to + (ptrdiff_t)i * width, &w[i], 8);
            else
                for (int i = 0; i < tall; i++) memcpy(to + (ptrdiff_t)i * width, &w[i], (size_t)wide);
        }
}

static void sense(const float *columns, int width, int height, eye_noise noise, uint8_t *bytes, uint8_t *rows) {
    if (noise.scale)
        noisy(columns, width * height, noise, bytes);
    else
        rounded(columns, width * height, bytes);
    to_rows(bytes, width, height, rows);
}

const eye_kernels JOIN(eye_kernels_, LOBULA_ISA) = {sense};
