/* frames/resize.py: the area average. The plan is the same for every instruction set; the loops are not. */
#ifndef LOBULA_RESIZE_H
#define LOBULA_RESIZE_H

#include "lobula.h"
#include "sweep.h"

/* The source pixels under one output pixel, along one axis: `first` and `last` count by their share, all between in
 * full. */
typedef struct {
    int32_t first, last;
    float first_share, last_share;
} span;

typedef struct resize_plan {
    uint32_t magic;
    int32_t isa;
    lobula_resize_spec spec;
    size_t rows_at, columns_at, sums_at, whole_at, bytes; /* offsets from the plan */
} resize_plan;

#endif
