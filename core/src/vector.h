/* A row of floats, LANES at a time: AVX-512, AVX2, SSE2 or NEON, and one at a time in plain C elsewhere.
 *
 * vf is a vector of floats, vm a mask of its lanes, vd a sum of floats kept in double, or on a robot in two floats. + - * work on vf as written
 * (compiler vector extensions); a * b + c becomes one fused instruction where there is one.
 */
#ifndef LOBULA_VECTOR_H
#define LOBULA_VECTOR_H

#include <stdint.h>
#include <string.h>

#include "real.h"

#if defined(LOBULA_PLAIN) || !defined(LOBULA_LAPTOP)
#define LANES 1
#elif defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512BW__) && defined(__AVX512DQ__)
#define LANES 16
#elif defined(__AVX2__)
#define LANES 8
#elif defined(__SSE2__) || (defined(__aarch64__) && defined(__ARM_NEON))
#define LANES 4
#else
#define LANES 1
#endif

#if LANES > 1 && (defined(__x86_64__) || defined(__i386__))
#include <immintrin.h>
#elif LANES > 1
#include <arm_neon.h>
#endif

#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline))
#define UNROLL _Pragma("GCC unroll 8")
#else
#define INLINE static inline
#define UNROLL
#endif

#if LANES == 16

typedef __m512 vf;
typedef __mmask16 vm;
typedef struct { __m512d low, high; } vd;

INLINE vf vf_all(float x) { return _mm512_set1_ps(x); }
INLINE vf vf_max(vf a, vf b) { return _mm512_max_ps(a, b); }
INLINE vf vf_min(vf a, vf b) { return _mm512_min_ps(a, b); }
INLINE vf vf_abs(vf a) { return _mm512_abs_ps(a); }
INLINE vf vf_xor(vf a, vf b) { return _mm512_xor_ps(a, b); }
INLINE vf vf_sign(vf a) { return _mm512_and_ps(a, _mm512_set1_ps(-0.0f)); }
INLINE vm vf_ge(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_GE_OQ); }
INLINE vm vf_gt(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ); }
INLINE vm vm_and(vm a, vm b) { return (vm)(a & b); }
INLINE vf vf_keep(vm m, vf a) { return _mm512_maskz_mov_ps(m, a); }
INLINE int vm_any(vm m) { return m != 0; }
INLINE vm vm_first(int n) { return (vm)((1u << n) - 1u); }
INLINE vf vf_from_bytes(__m128i bytes) { return _mm512_cvtepi32_ps(_mm512_cvtepu8_epi32(bytes)); }
INLINE vf vf_from_u8(const uint8_t *p) {
    return vf_from_bytes(_mm_loadu_si128((const __m128i *)(const void *)p));
}
INLINE vf vf_load_first(const float *p, int n) { return _mm512_maskz_loadu_ps(vm_first(n), p); }
INLINE float vf_highest(vf a) { return _mm512_reduce_max_ps(a); }
INLINE void vd_add(vd *sum, vf a) {
    sum->low += _mm512_cvtps_pd(_mm512_castps512_ps256(a));
    sum->high += _mm512_cvtps_pd(_mm512_extractf32x8_ps(a, 1));
}

#elif LANES == 8

typedef __m256 vf;
typedef __m256 vm;
typedef struct { __m256d low, high; } vd;

INLINE vf vf_all(float x) { return _mm256_set1_ps(x); }
INLINE vf vf_max(vf a, vf b) { return _mm256_max_ps(a, b); }
INLINE vf vf_min(vf a, vf b) { return _mm256_min_ps(a, b); }
INLINE vf vf_abs(vf a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
INLINE vf vf_xor(vf a, vf b) { return _mm256_xor_ps(a, b); }
INLINE vf vf_sign(vf a) { return _mm256_and_ps(a, _mm256_set1_ps(-0.0f)); }
INLINE vm vf_ge(vf a, vf b) { return _mm256_cmp_ps(a, b, _CMP_GE_OQ); }
INLINE vm vf_gt(vf a, vf b) { return _mm256_cmp_ps(a, b, _CMP_GT_OQ); }
INLINE vm vm_and(vm a, vm b) { return _mm256_and_ps(a, b); }
INLINE vf vf_keep(vm m, vf a) { return _mm256_and_ps(m, a); }
INLINE int vm_any(vm m) { return _mm256_movemask_ps(m) != 0; }
INLINE vm vm_first(int n) {
    return _mm256_castsi256_ps(_mm256_cmpgt_epi32(_mm256_set1_epi32(n), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7)));
}
INLINE vf vf_from_bytes(__m128i bytes) { return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(bytes)); }
INLINE vf vf_from_u8(const uint8_t *p) {
    return vf_from_bytes(_mm_loadl_epi64((const __m128i *)(const void *)p));
}
INLINE vf vf_load_first(const float *p, int n) { return _mm256_maskload_ps(p, _mm256_castps_si256(vm_first(n))); }
INLINE float vf_highest(vf a) {
    __m128 m = _mm_max_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    m = _mm_max_ps(m, _mm_movehl_ps(m, m));
    return _mm_cvtss_f32(_mm_max_ss(m, _mm_shuffle_ps(m, m, 1)));
}
INLINE void vd_add(vd *sum, vf a) {
    sum->low += _mm256_cvtps_pd(_mm256_castps256_ps128(a));
    sum->high += _mm256_cvtps_pd(_mm256_extractf128_ps(a, 1));
}

#elif LANES == 4 && defined(__SSE2__)

typedef __m128 vf;
typedef __m128 vm;
typedef struct { __m128d low, high; } vd;

INLINE vf vf_all(float x) { return _mm_set1_ps(x); }
INLINE vf vf_max(vf a, vf b) { return _mm_max_ps(a, b); }
INLINE vf vf_min(vf a, vf b) { return _mm_min_ps(a, b); }
INLINE vf vf_abs(vf a) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
INLINE vf vf_xor(vf a, vf b) { return _mm_xor_ps(a, b); }
INLINE vf vf_sign(vf a) { return _mm_and_ps(a, _mm_set1_ps(-0.0f)); }
INLINE vm vf_ge(vf a, vf b) { return _mm_cmpge_ps(a, b); }
INLINE vm vf_gt(vf a, vf b) { return _mm_cmpgt_ps(a, b); }
INLINE vm vm_and(vm a, vm b) { return _mm_and_ps(a, b); }
INLINE vf vf_keep(vm m, vf a) { return _mm_and_ps(m, a); }
INLINE int vm_any(vm m) { return _mm_movemask_ps(m) != 0; }
INLINE vm vm_first(int n) {
    return _mm_castsi128_ps(_mm_cmpgt_epi32(_mm_set1_epi32(n), _mm_setr_epi32(0, 1, 2, 3)));
}
INLINE vf vf_from_bytes(uint32_t bytes) {
    __m128i zero = _mm_setzero_si128(), pairs = _mm_unpacklo_epi8(_mm_cvtsi32_si128((int32_t)bytes), zero);
    return _mm_cvtepi32_ps(_mm_unpacklo_epi16(pairs, zero));
}
INLINE vf vf_from_u8(const uint8_t *p) {
    uint32_t four;
    memcpy(&four, p, 4);
    return vf_from_bytes(four);
}
INLINE vf vf_load_first(const float *p, int n) {
    return _mm_setr_ps(p[0], n > 1 ? p[1] : 0.0f, n > 2 ? p[2] : 0.0f, n > 3 ? p[3] : 0.0f);
}
INLINE float vf_highest(vf a) {
    __m128 m = _mm_max_ps(a, _mm_movehl_ps(a, a));
    return _mm_cvtss_f32(_mm_max_ss(m, _mm_shuffle_ps(m, m, 1)));
}
INLINE void vd_add(vd *sum, vf a) {
    sum->low += _mm_cvtps_pd(a);
    sum->high += _mm_cvtps_pd(_mm_movehl_ps(a, a));
}

#elif LANES == 4

typedef float32x4_t vf;
typedef uint32x4_t vm;
typedef struct { float64x2_t low, high; } vd;

INLINE vf vf_all(float x) { return vdupq_n_f32(x); }
INLINE vf vf_max(vf a, vf b) { return vmaxq_f32(a, b); }
INLINE vf vf_min(vf a, vf b) { return vminq_f32(a, b); }
INLINE vf vf_abs(vf a) { return vabsq_f32(a); }
INLINE vf vf_xor(vf a, vf b) {
    return vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
}
INLINE vf vf_sign(vf a) {
    return vreinterpretq_f32_u32(vandq_u32(vreinterpretq_u32_f32(a), vdupq_n_u32(0x80000000u)));
}
INLINE vm vf_ge(vf a, vf b) { return vcgeq_f32(a, b); }
INLINE vm vf_gt(vf a, vf b) { return vcgtq_f32(a, b); }
INLINE vm vm_and(vm a, vm b) { return vandq_u32(a, b); }
INLINE vf vf_keep(vm m, vf a) { return vreinterpretq_f32_u32(vandq_u32(m, vreinterpretq_u32_f32(a))); }
INLINE int vm_any(vm m) { return vmaxvq_u32(m) != 0; }
INLINE vm vm_first(int n) {
    static const int32_t lanes[4] = {0, 1, 2, 3};
    return vcltq_s32(vld1q_s32(lanes), vdupq_n_s32(n));
}
INLINE vf vf_from_bytes(uint32_t bytes) {
    return vcvtq_f32_u32(vmovl_u16(vget_low_u16(vmovl_u8(vcreate_u8(bytes)))));
}
INLINE vf vf_from_u8(const uint8_t *p) {
    uint32_t four;
    memcpy(&four, p, 4);
    return vf_from_bytes(four);
}
INLINE vf vf_load_first(const float *p, int n) {
    vf a = vsetq_lane_f32(p[0], vdupq_n_f32(0.0f), 0);
    a = n > 1 ? vsetq_lane_f32(p[1], a, 1) : a;
    return n > 2 ? vsetq_lane_f32(p[2], a, 2) : a;
}
INLINE float vf_highest(vf a) { return vmaxvq_f32(a); }
INLINE void vd_add(vd *sum, vf a) {
    sum->low += vcvt_f64_f32(vget_low_f32(a));
    sum->high += vcvt_high_f64_f32(a);
}

#else

typedef float vf;
typedef int vm;
#if defined(LOBULA_LAPTOP)
typedef struct { double low; } vd;
#else
typedef struct { float sum, rest; } vd;
#endif

INLINE vf vf_all(float x) { return x; }
INLINE vf vf_max(vf a, vf b) { return a > b ? a : b; }
INLINE vf vf_min(vf a, vf b) { return a < b ? a : b; }
INLINE vf vf_abs(vf a) { return fabsf(a); }
INLINE vf vf_xor(vf a, vf sign) {
    uint32_t bits, other;
    memcpy(&bits, &a, sizeof bits);
    memcpy(&other, &sign, sizeof other);
    bits ^= other;
    memcpy(&a, &bits, sizeof a);
    return a;
}
INLINE vf vf_sign(vf a) {
    uint32_t bits;
    memcpy(&bits, &a, sizeof bits);
    bits &= 0x80000000u;
    memcpy(&a, &bits, sizeof a);
    return a;
}
INLINE vm vf_ge(vf a, vf b) { return a >= b; }
INLINE vm vf_gt(vf a, vf b) { return a > b; }
INLINE vm vm_and(vm a, vm b) { return a & b; }
INLINE vf vf_keep(vm m, vf a) { return m ? a : 0.0f; }
INLINE int vm_any(vm m) { return m; }
INLINE vm vm_first(int n) { return n > 0; }
INLINE vf vf_from_u8(const uint8_t *p) { return (float)*p; }
INLINE vf vf_load_first(const float *p, int n) { return n > 0 ? *p : 0.0f; }
INLINE float vf_highest(vf a) { return a; }
#if defined(LOBULA_LAPTOP)
INLINE void vd_add(vd *sum, vf a) { sum->low += (double)a; }
#else
/* What the sum loses to rounding is kept beside it (Knuth's two-sum). */
INLINE void vd_add(vd *s, vf a) {
    float sum = s->sum + a, part = sum - s->sum;
    s->rest += (s->sum - (sum - part)) + (a - part);
    s->sum = sum;
}
#endif

#endif

#if LANES == 1

INLINE vf vf_load(const float *p) { return *p; }
INLINE void vf_store(float *p, vf a) { *p = a; }

/* Without branches and without the floating point unit, where comparing takes four instructions. */
INLINE vf vf_above_zero(vf a) {
    uint32_t bits;
    memcpy(&bits, &a, sizeof bits);
    /* cppcheck-suppress shiftTooManyBitsSigned ; every compiler there is fills up with the sign */
    bits &= ~(uint32_t)((int32_t)bits >> 31);
    memcpy(&a, &bits, sizeof a);
    return a;
}

#else

INLINE vf vf_load(const float *p) {
    vf a;
    memcpy(&a, p, sizeof a);
    return a;
}

INLINE void vf_store(float *p, vf a) { memcpy(p, &a, sizeof a); }

INLINE vf vf_above_zero(vf a) { return vf_max(a, vf_all(0.0f)); }

#endif

#if defined(LOBULA_LAPTOP)
INLINE double vd_total(const vd *sum) {
    double lanes[sizeof(vd) / sizeof(double)], total = 0.0;
    memcpy(lanes, sum, sizeof lanes);
    for (size_t i = 0; i < sizeof(vd) / sizeof(double); i++) total += lanes[i];
    return total;
}
#else
INLINE float vd_total(const vd *s) { return s->sum + s->rest; }
#endif

/* Number of vectors that hold a row of `width`. */
INLINE int padded(int width) { return (width + LANES - 1) / LANES * LANES; }

#endif
