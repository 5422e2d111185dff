/* One pass over the picture: what a step is told before it starts, and what it leaves behind. */
#ifndef LOBULA_SWEEP_H
#define LOBULA_SWEEP_H

#include <stddef.h>
#include <stdint.h>

#include "layout.h"
#include "real.h"

#define MAX_SETS 4     /* both channels of both LGMDs */
#define NO_SET (-1)
#if defined(LOBULA_LAPTOP)
#define MAX_FRAMES 16 /* at once */
#else
#define MAX_FRAMES 1
#endif

/* Where a picture lies. */
typedef struct {
    const char *pixels;
    ptrdiff_t row_bytes;
    int type;
} picture;

/* The inhibition I of one channel, as two rows of weights on (E, sides of E, E', sides of E'), E' being one step ago
 * and "sides" the sum of the neighbours to the left and right: what a row gives to its own cells, and what it takes
 * from the cells above and below. */
typedef struct {
    int source, channel, spacing;
    float own[4], across[4];
} inhibition_set;

/* Which channels of an LGMD can speak at all, and how they are added up. */
enum { SUM_NONE, SUM_ON, SUM_OFF, SUM_BOTH, SUM_PRODUCT };

/* One LGMD: the set, bias and gain of both channels, how they are added up, and how it groups. */
typedef struct {
    int kind;
    int set[2]; /* NO_SET where a channel is silent and nobody looks at its inhibition */
    float bias[2], gain[2], product_gain;
    int grouping;
    float list_scale; /* a power of two that brings what is listed into the range of its storage */
    /* With m the largest sum of 3 x 3 cells: nine times omega, and what nine times S Ce must reach. */
    real omega_floor, omega_share, threshold_grey;
} lgmd_plan;

/* Everything known about one step before its rows are looked at. */
typedef struct {
    picture image;
    float scale, gain, offset; /* P = scale (image - (gain luma + offset)) */
    int flash;
    int coarse;  /* patches are heard; then the change is also kept within `limit` */
    int patch;   /* side of one, px */
    float patch_floor, limit;
    float residual, fdsr_share, dead_zone;
    int spans, span[LOBULA_MAX_SPANS];
    float span_share[LOBULA_MAX_SPANS];
    int sets;
    inhibition_set set[MAX_SETS];
    lgmd_plan lgmd[2];
    float *const *taps; /* NULL: none */
    /* Left behind: the net motion, the sum of each LGMD's grouped cells, and what the patches say, ON and OFF. */
    real hs, total[2], patches[2];
} step_plan;

typedef struct {
    real mean, mean_abs;
} change_summary;

typedef struct {
    int width, height;
} extent;

/* Sums over the pixels whose change is at most `limit`. */
typedef struct {
    real count, new_sum, old_sum, old_old, new_old, change_change;
} light_sums;

struct resize_plan;

/* The loops over pixels, once for each instruction set and each storage of the planes. A picture `previous` may be the
 * luma plane. */
typedef struct {
    const char *name;
    int (*runs)(void);
    size_t (*scratch_bytes)(const layout *l); /* of one frame at work, */
    size_t (*row_bytes)(const layout *l);     /* and without the lists, which are seldom long */
    /* mean and mean magnitude of image - previous; its largest magnitude */
    change_summary (*summarise)(extent e, picture image, picture previous);
    real (*largest_change)(extent e, picture image, picture previous);
    /* pixels brighter, and darker, by more than half a grey level */
    void (*coverage)(extent e, picture image, picture previous, int32_t *brighter, int32_t *darker);
    light_sums (*light)(extent e, picture image, picture previous, real limit);
    real (*light_rest)(extent e, picture image, picture previous, real limit, real gain, real offset);
    /* mean |image - (gain previous + offset)| */
    real (*lit_change)(extent e, picture image, picture previous, float gain, float offset);
    void (*set_luma)(const layout *l, picture image, char *planes);
    /* Take `n` frames through all rows together. */
    void (*sweep)(const layout *l, const float *kernel, char *planes, char *workspace, step_plan *plans, int n);
    /* Of the floats' table only: `out` is the area average of the cropped picture; `plan` is a resize_plan */
    int (*in_range)(extent e, picture image);
    void (*area_average)(struct resize_plan *plan, picture crop, float *out);
} kernels;

/* The table of instruction set `isa` and of a storage, or NULL. */
const kernels *kernels_of(int isa, int storage);

#endif
