/* Which instruction set a file is compiled for: LOBULA_ISA is base, v3 or v4; base where nothing is said. */
#ifndef LOBULA_ISA_H
#define LOBULA_ISA_H

#define LOBULA_ISA_base 0
#define LOBULA_ISA_v3 3
#define LOBULA_ISA_v4 4

#ifndef LOBULA_ISA
#define LOBULA_ISA base
#endif

#define ISA_JOIN_(a, b) a##b
#define ISA_JOIN(a, b) ISA_JOIN_(a, b)
#define ISA_TEXT_(a) #a
#define ISA_TEXT(a) ISA_TEXT_(a)
#define ISA_LEVEL ISA_JOIN(LOBULA_ISA_, LOBULA_ISA)
#if defined(LOBULA_COMPACT_PLANES)
#define KERNELS ISA_JOIN(kernels_compact_, LOBULA_ISA)
#else
#define KERNELS ISA_JOIN(kernels_, LOBULA_ISA)
#endif

#if ISA_LEVEL == 4
#define ISA_NAME "x86-64-v4"
static int isa_runs(void) {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("fma");
}
#elif ISA_LEVEL == 3
#define ISA_NAME "x86-64-v3"
#include <cpuid.h>
static int isa_runs(void) {
    unsigned a, b, c, d; /* the builtin does not know f16c in older compilers */
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __get_cpuid(1, &a, &b, &c, &d) && (c & bit_F16C);
}
#else
#if defined(__x86_64__)
#define ISA_NAME "x86-64"
#elif defined(__aarch64__)
#define ISA_NAME "aarch64"
#else
#define ISA_NAME "plain"
#endif
static int isa_runs(void) { return 1; }
#endif

#endif
