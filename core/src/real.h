/* The numbers of which a step has a few: see lobula_types.h. */
#ifndef LOBULA_REAL_H
#define LOBULA_REAL_H

#include <math.h>

#include "lobula_types.h"

typedef lobula_real real;

#if defined(LOBULA_LAPTOP)
#define real_exp exp
#define real_pow pow
#define real_floor floor
#define real_abs fabs
#define REAL_BELOW_ONE (1.0 - 0x1p-53)
#else
#define real_exp expf
#define real_pow powf
#define real_floor floorf
#define real_abs fabsf
#define REAL_BELOW_ONE (1.0f - 0x1p-24f)
#endif

/* A sum of whole numbers; a robot's conversion of 64 bits would take a kilobyte. */
static inline real real_of(int64_t sum) {
#if defined(LOBULA_LAPTOP)
    return (real)sum;
#else
    return (real)(int32_t)(sum >> 16) * 65536 + (real)(uint16_t)sum;
#endif
}

#endif
