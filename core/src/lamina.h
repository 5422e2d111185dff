/* model/lamina: edges, ON and OFF channels, adaptation. */
#ifndef LOBULA_LAMINA_H
#define LOBULA_LAMINA_H

#include <float.h>

#include "scratch.h"
#include "storage.h"

/* Weights as vectors: read once a row, since for all the compiler knows a store into a row may change them. */
INLINE void spread(const float *weights, int R, vf *vectors) {
    UNROLL for (int k = 0; k <= R; k++) vectors[k] = vf_all(weights[k]);
}

/* model.lamina.dog.gaussian_blur down the columns, both fields at once: the kernels are symmetric, so pairs of pixels
 * are added up first and serve both. `rows` are those around the present one, which is rows[R]; weights go from the
 * centre outwards. Adding rows first and columns second, or the other way round, is the same but for rounding. */
INLINE void blur_down(float *const *rows, int n, const float *inner, int r, const float *outer, int R,
                      float *restrict e, float *restrict i) {
    vf a_weight[MAX_RADIUS + 1], b_weight[MAX_RADIUS + 1];
    spread(inner, r, a_weight);
    spread(outer, R, b_weight);
    for (int x = 0; x < n; x += LANES) {
        vf middle = vf_load(rows[R] + x);
        vf a = a_weight[0] * middle, b = b_weight[0] * middle;
        UNROLL for (int k = 1; k <= R; k++) {
            vf pair = vf_load(rows[R - k] + x) + vf_load(rows[R + k] + x);
            if (k <= r) a += a_weight[k] * pair;
            b += b_weight[k] * pair;
        }
        vf_store(e + x, a);
        vf_store(i + x, b);
    }
}

/* The same along a row, which has margins. */
INLINE vf blur_along(const float *row, const vf *weights, int R) {
    vf sum = weights[0] * vf_load(row);
    UNROLL for (int k = 1; k <= R; k++) sum += weights[k] * (vf_load(row - k) + vf_load(row + k));
    return sum;
}

typedef struct {
    vf on, off;
} on_off;

/* model.lamina.dog.difference_of_gaussians, its positive and its negative part; `below` is -dead_zone, or less than
 * any number but zero where there is none, since e = 0 belongs to ON */
INLINE on_off edges(vf e, vf i, vf dead_zone, vf below) {
#if LANES == 1
    on_off none = {0.0f, 0.0f};
    if (e >= dead_zone)
        none.on = i >= 0.0f ? fabsf(e - i) : 0.0f;
    else if (below >= e)
        none.off = i < 0.0f ? fabsf(e - i) : 0.0f;
    return none;
#else
    vf size = vf_abs(e - i), zero = vf_all(0.0f);
    on_off x = {vf_keep(vm_and(vf_ge(e, dead_zone), vf_ge(i, zero)), size),
                vf_keep(vm_and(vf_ge(below, e), vf_gt(zero, i)), size)};
    return x;
#endif
}

INLINE vf below_zone(float dead_zone) { return vf_all(dead_zone > FLT_MIN ? -dead_zone : -FLT_MIN); }

INLINE on_off halves(vf change) {
    vf zero = vf_all(0.0f);
    on_off x = {vf_max(change, zero), vf_max(zero - change, zero)};
    return x;
}

/* The rows of both channels: `kept` in the state, this step's over the one before; and what goes on. With adaptation
 * that is one row, ON less OFF, since only one of them rises; without, both channels and what they were before. */
typedef struct {
    stored *kept[2];
    float *adapted, *apart[2], *before[2];
} lamina_rows;

/* A channel now and one step ago. */
typedef struct {
    vf now, before;
} two_steps;

/* model.lamina.on_off of one channel */
INLINE two_steps remember(vf signal, vf residual, stored *kept) {
    two_steps x = {signal, stored_load(kept)};
    x.now += residual * x.before;
    stored_store(kept, x.now);
    return x;
}

/* model.lamina.fdsr of one channel */
INLINE vf adapt(two_steps x, vf share) { return vf_above_zero(share * (x.now - x.before)); }

INLINE void lamina_vector(int x, on_off signal, vf residual, vf share, const lamina_rows *r, int fdsr) {
    two_steps on = remember(signal.on, residual, r->kept[0] + x), off = remember(signal.off, residual, r->kept[1] + x);
    if (fdsr) {
        vf_store(r->adapted + x, adapt(on, share) - adapt(off, share));
    } else {
        vf_store(r->apart[0] + x, on.now);
        vf_store(r->apart[1] + x, off.now);
        vf_store(r->before[0] + x, on.before);
        vf_store(r->before[1] + x, off.before);
    }
}

/* `e` and `i` are blurred down the columns and have margins. */
INLINE void lamina_row_as(int n, const float *e, const float *i, const float *inner, int r, const float *outer, int R,
                          const step_plan *p, const lamina_rows *rows, int fdsr) {
    lamina_rows q = *rows;
    vf a_weight[MAX_RADIUS + 1], b_weight[MAX_RADIUS + 1];
    spread(inner, r, a_weight);
    spread(outer, R, b_weight);
    vf dead_zone = vf_all(p->dead_zone), below = below_zone(p->dead_zone);
    vf residual = vf_all(p->residual), share = vf_all(p->fdsr_share);
    for (int x = 0; x < n; x += LANES) {
        on_off edge = edges(blur_along(e + x, a_weight, r), blur_along(i + x, b_weight, R), dead_zone, below);
        lamina_vector(x, edge, residual, share, &q, fdsr);
    }
}

/* Where the DoG is off, the change goes on as it is. */
static void lamina_row_unfiltered(int n, const float *change, const step_plan *p, const lamina_rows *rows, int fdsr) {
    lamina_rows q = *rows;
    vf residual = vf_all(p->residual), share = vf_all(p->fdsr_share);
    for (int x = 0; x < n; x += LANES) lamina_vector(x, halves(vf_load(change + x)), residual, share, &q, fdsr);
}

/* The signed edges themselves, only for a tap. */
static void edges_map(int width, const float *e, const float *i, const float *inner, int r, const float *outer, int R,
                      float dead_zone, float *map) {
    vf a_weight[MAX_RADIUS + 1], b_weight[MAX_RADIUS + 1];
    spread(inner, r, a_weight);
    spread(outer, R, b_weight);
    for (int x = 0; x < width; x += LANES) {
        float row[LANES];
        on_off edge = edges(blur_along(e + x, a_weight, r), blur_along(i + x, b_weight, R), vf_all(dead_zone),
                            below_zone(dead_zone));
        vf_store(row, edge.on - edge.off);
        for (int lane = 0; lane < LANES && x + lane < width; lane++) map[x + lane] = row[lane];
    }
}

#endif
