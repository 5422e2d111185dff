/* How the planes of the state and the lists of grouped cells are kept: as floats, or in 16 bits with the luma in bytes.
 *
 * 16 bits are a half: 5 bits of exponent, 10 of fraction. What the planes hold spans many magnitudes: a change is up to
 * 255 grey levels, its adapted edges matter from 0.001 on, and both scale with settings. A half keeps each to 1 part in
 * 2048 whatever its size and needs no range beforehand; fixed point of the same width would keep large values better,
 * but lose the faint edges of which the LPTCs hear thousands. And processors convert it in one instruction: Cortex-M4F,
 * x86-64-v3, aarch64. All arithmetic is on floats; a value is rounded, to the nearest, only where it is stored. The
 * luma needs no rounding: a compact network takes bytes. */
#ifndef LOBULA_STORAGE_H
#define LOBULA_STORAGE_H

#include "vector.h"

typedef uint16_t half16;

#if LANES == 1 && defined(__GNUC__) && defined(__ARM_FP) && defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'M'
/* Every Cortex-M with a floating point unit converts, though not every compiler says so in __ARM_FP. */

INLINE float float_of(half16 h) {
    float x = 0.0f;
    uint32_t bits = h;
    memcpy(&x, &bits, sizeof x);
    __asm__("vcvtb.f32.f16 %0, %1" : "=t"(x) : "t"(x));
    return x;
}

INLINE half16 half_of(float x) {
    uint32_t bits;
    __asm__("vcvtb.f16.f32 %0, %1" : "=t"(x) : "t"(x));
    memcpy(&bits, &x, sizeof bits);
    return (half16)bits;
}

#else

static inline float float_of(half16 h) {
    uint32_t sign = (uint32_t)(h & 0x8000u) << 16, size = h & 0x7fffu;
    uint32_t bits = size >= 0x7c00u ? (size << 13) + (224u << 23) : (size << 13) + (112u << 23);
    float x;
    if (size < 0x0400u) { /* a multiple of 2^-24 */
        x = (float)size * 0x1p-24f;
        memcpy(&bits, &x, sizeof bits);
    }
    bits |= sign;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline half16 half_of(float x) {
    uint32_t bits, sign;
    memcpy(&bits, &x, sizeof bits);
    sign = bits >> 16 & 0x8000u;
    bits &= 0x7fffffffu;
    if (bits >= 0x477ff000u) return (half16)(sign | 0x7c00u); /* what would round to 65536 and more */
    if (bits < 0x38800000u) {                               /* to a multiple of 2^-24, the step of floats next to 0.5 */
        memcpy(&x, &bits, sizeof x);
        x += 0.5f;
        memcpy(&bits, &x, sizeof bits);
        return (half16)(sign | (bits - 0x3f000000u));
    }
    bits += 0x0fffu + (bits >> 13 & 1u);
    return (half16)(sign | ((bits >> 13) - (112u << 10)));
}

#endif

#if defined(LOBULA_LAPTOP) && !defined(LOBULA_COMPACT_PLANES)

enum { STORED_NARROW = 0 };
typedef float stored;
typedef float stored_luma;

INLINE vf stored_load(const stored *p) { return vf_load(p); }
INLINE void stored_store(stored *p, vf a) { vf_store(p, a); }
INLINE const float *stored_row(const stored *row, float *room, int n) {
    (void)room, (void)n;
    return row;
}
INLINE vf luma_load(const stored_luma *p) { return vf_load(p); }
INLINE void luma_store(stored_luma *p, vf a) { vf_store(p, a); }
INLINE void luma_keep(stored_luma *luma, const char *image, int width) {
    (void)luma, (void)image, (void)width; /* stored on the way */
}

#else

enum { STORED_NARROW = 1 }; /* what may be too large or too small is scaled before it is stored */
typedef half16 stored;
typedef uint8_t stored_luma;

INLINE vf luma_load(const stored_luma *p) { return vf_from_u8(p); }
INLINE void luma_store(stored_luma *p, vf a) { (void)p, (void)a; /* the row is copied as it is, after its last use */ }
INLINE void luma_keep(stored_luma *luma, const char *image, int width) { memcpy(luma, image, (size_t)width); }

#if LANES == 16
INLINE vf stored_load(const stored *p) { return _mm512_cvtph_ps(_mm256_loadu_si256((const __m256i *)(const void *)p)); }
INLINE void stored_store(stored *p, vf a) {
    _mm256_storeu_si256((__m256i *)(void *)p, _mm512_cvtps_ph(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC));
}
#elif LANES == 8
INLINE vf stored_load(const stored *p) { return _mm256_cvtph_ps(_mm_loadu_si128((const __m128i *)(const void *)p)); }
INLINE void stored_store(stored *p, vf a) {
    _mm_storeu_si128((__m128i *)(void *)p, _mm256_cvtps_ph(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC));
}
#elif LANES == 4 && defined(__aarch64__)
INLINE vf stored_load(const stored *p) { return vcvt_f32_f16(vreinterpret_f16_u16(vld1_u16(p))); }
INLINE void stored_store(stored *p, vf a) { vst1_u16(p, vreinterpret_u16_f16(vcvt_f16_f32(a))); }
#else
INLINE vf stored_load(const stored *p) {
    float lanes[LANES];
    vf a;
    for (int i = 0; i < LANES; i++) lanes[i] = float_of(p[i]);
    memcpy(&a, lanes, sizeof a);
    return a;
}
INLINE void stored_store(stored *p, vf a) {
    float lanes[LANES];
    memcpy(lanes, &a, sizeof lanes);
    for (int i = 0; i < LANES; i++) p[i] = half_of(lanes[i]);
}
#endif

/* A row as floats, in `room` if they are not there already. */
INLINE const float *stored_row(const stored *row, float *room, int n) {
    for (int x = 0; x < n; x += LANES) vf_store(room + x, stored_load(row + x));
    return room;
}

#endif

#endif
