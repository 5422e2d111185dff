/* What one core of this machine can do at most: vector operations a second, and bytes a second through a float array
 * that is read, changed and written in place. Compiled by roofline.py for the instruction set the core uses.
 *
 *     peaks ROUNDS BYTES...     prints "fma|add|mix RATE" in vector operations a second, then "rmw BYTES RATE"
 *
 * Best of ROUNDS, time of the thread: a limit is what was possible once. */
#define _POSIX_C_SOURCE 200809L
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#ifndef VECTOR_BYTES
#define VECTOR_BYTES 16
#endif
#if defined(__AVX512F__)
#define REGISTER "v"
#elif defined(__x86_64__)
#define REGISTER "x"
#elif defined(__aarch64__)
#define REGISTER "w"
#else
#define REGISTER "m"
#endif

typedef float vf __attribute__((vector_size(VECTOR_BYTES)));
typedef int32_t vi __attribute__((vector_size(VECTOR_BYTES)));

/* The compiler must believe that x was changed here. */
#define OPAQUE(x) __asm__ volatile("" : "+" REGISTER(x))

enum { CHAINS = 12, TURNS = 100000 };

static double now_s(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Twelve chains, independent of one another, hide the latency; one variable each, so that all stay in registers. */
#define MULTIPLY_ADD(x) x = x * factor + term; OPAQUE(x);
#define ADD(x) x = x + term; OPAQUE(x);
#define AND(x) x = (vf)((vi)x & mask); OPAQUE(x);
#define OPERATIONS(NAME, A, B, C)                                                             \
    static double NAME(void) {                                                                \
        vf factor = (vf){0} + 0.999f, term = (vf){0} + 0.001f;                                \
        vi mask = (vi){0} - 1;                                                                \
        vf x0 = term, x1 = term, x2 = term, x3 = term, x4 = term, x5 = term, x6 = term, x7 = term, x8 = term, x9 = term, \
           xa = term, xb = term;                                                              \
        OPAQUE(factor);                                                                       \
        OPAQUE(term);                                                                         \
        OPAQUE(mask);                                                                         \
        double start = now_s();                                                               \
        for (int turn = 0; turn < TURNS; turn++) {                                            \
            A(x0) B(x1) C(x2) A(x3) B(x4) C(x5) A(x6) B(x7) C(x8) A(x9) B(xa) C(xb)           \
        }                                                                                     \
        return (double)TURNS * CHAINS / (now_s() - start);                                    \
    }
OPERATIONS(multiply_adds, MULTIPLY_ADD, MULTIPLY_ADD, MULTIPLY_ADD)
OPERATIONS(adds, ADD, ADD, ADD)
OPERATIONS(mixed, MULTIPLY_ADD, ADD, AND)

static double read_modify_write(float *data, size_t bytes) {
    vf *v = (vf *)data, factor = (vf){0} + 0.999f, term = (vf){0} + 0.001f;
    size_t count = bytes / sizeof(vf) / 8 * 8, passes = 1 + (size_t)(64 << 20) / (bytes + 1);
    OPAQUE(factor);
    OPAQUE(term);
    double start = now_s();
    for (size_t pass = 0; pass < passes; pass++)
        for (size_t i = 0; i < count; i += 8)
#pragma GCC unroll 8
            for (size_t k = 0; k < 8; k++) v[i + k] = v[i + k] * factor + term;
    return 2.0 * (double)(count * sizeof(vf)) * (double)passes / (now_s() - start);
}

int main(int argc, char **argv) {
    static const struct { const char *name; double (*rate)(void); } kinds[] = {
        {"fma", multiply_adds}, {"add", adds}, {"mix", mixed}};
    int rounds = argc > 1 ? atoi(argv[1]) : 9;
    for (int kind = 0; kind < 3; kind++) {
        double best = 0.0;
        for (int round = 0; round < rounds; round++) {
            double rate = kinds[kind].rate();
            if (rate > best) best = rate;
        }
        printf("%s %.6g\n", kinds[kind].name, best);
    }
    for (int a = 2; a < argc; a++) {
        size_t bytes = (size_t)strtoull(argv[a], NULL, 10), room = (bytes + 4095) / 4096 * 4096;
        float *data = aligned_alloc(4096, room);
        if (!data) return 1;
        for (size_t i = 0; i < room / sizeof(float); i++) data[i] = 1.0f;
        double best = 0.0;
        for (int round = 0; round < rounds; round++) {
            double rate = read_modify_write(data, bytes);
            if (rate > best) best = rate;
        }
        printf("rmw %zu %.6g\n", bytes, best);
        free(data);
    }
    return 0;
}
