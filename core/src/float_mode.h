/* Tiny numbers count as zero while a call lasts: a scene that comes to rest would otherwise leave denormals behind,
 * which are slow. The caller's own mode is put back. */
#ifndef LOBULA_FLOAT_MODE_H
#define LOBULA_FLOAT_MODE_H

#include <stdint.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
typedef unsigned int float_mode;
static inline float_mode float_mode_enter(void) {
    float_mode before = _mm_getcsr();
    _mm_setcsr(before | 0x8040u); /* flush to zero, denormals are zero */
    return before;
}
static inline void float_mode_leave(float_mode before) { _mm_setcsr((_mm_getcsr() & ~0x8040u) | (before & 0x8040u)); }
#elif defined(__aarch64__)
typedef uint64_t float_mode;
static inline float_mode float_mode_enter(void) {
    float_mode before;
    __asm__ volatile("mrs %0, fpcr" : "=r"(before));
    __asm__ volatile("msr fpcr, %0" : : "r"(before | (UINT64_C(1) << 24)));
    return before;
}
static inline void float_mode_leave(float_mode before) { __asm__ volatile("msr fpcr, %0" : : "r"(before)); }
#else
typedef int float_mode;
static inline float_mode float_mode_enter(void) { return 0; }
static inline void float_mode_leave(float_mode before) { (void)before; }
#endif

#endif
