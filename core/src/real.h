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

#endif
