/* model/lamina: edges, ON and OFF channels, adaptation. */
#ifndef LOBULA_LAMINA_H
#define LOBULA_LAMINA_H

#include <float.h>

#include "scratch.h"

/* model.lamina.dog.gaussian_blur along a row, both fields at once: the kernels are symmetric, so pairs of pixels are
 * added up first and serve both. `change` has margins. Weights from the centre outwards. */
INLINE void blur_along(const float *restrict change, int n, const float *inner, int r, const float *outer, int R,
                       float *restrict e, float *restrict i) {
    for (int x = 0; x < n; x += LANES) {
        vf middle = vf_load(change + x);
        vf a = vf_all(inner[0]) * middle, b = vf_all(outer[0]) * middle;
        UNROLL for (int k = 1; k <= r; k++) {
            vf pair = vf_load(change + x - k) + vf_load(change + x + k);
            a += vf_all(inner[k]) * pair;
            b += vf_all(outer[k]) * pair;
        }
        UNROLL for (int k = r + 1; k <= R; k++) b += vf_all(outer[k]) * (vf_load(change + x - k) + vf_load(change + x + k));
        vf_store(e + x, a);
        vf_store(i + x, b);
    }
}

/* The same down a column, x onwards; rows[R] is the middle one. */
INLINE vf blur_down(float *const *rows, int x, const float *weights, int R) {
    vf sum = vf_all(weights[0]) * vf_load(rows[R] + x);
    UNROLL for (int k = 1; k <= R; k++) sum += vf_all(weights[k]) * (vf_load(rows[R - k] + x) + vf_load(rows[R + k] + x));
    return sum;
}

typedef struct {
    vf on, off;
} on_off;

/* model.lamina.dog.difference_of_gaussians, its positive and its negative part */
INLINE on_off edges(vf e, vf i, float dead_zone) {
    vf size = vf_abs(e - i), zero = vf_all(0.0f);
    float below = dead_zone > FLT_MIN ? dead_zone : FLT_MIN; /* without a dead zone, e = 0 belongs to ON */
    on_off x = {vf_keep(vm_and(vf_ge(e, vf_all(dead_zone)), vf_ge(i, zero)), size),
                vf_keep(vm_and(vf_ge(vf_all(-below), e), vf_gt(zero, i)), size)};
    return x;
}

INLINE on_off halves(vf change) {
    vf zero = vf_all(0.0f);
    on_off x = {vf_max(change, zero), vf_max(zero - change, zero)};
    return x;
}

/* model.lamina.on_off and model.lamina.fdsr for one row: `on` and `off` hold the channels of the step before and
 * receive those of this one. */
INLINE void adapt_channels(int x, on_off signal, const step_plan *p, float *on, float *off, float *adapted_on,
                           float *adapted_off, float *before_on, float *before_off, int fdsr) {
    vf on_before = vf_load(on + x), off_before = vf_load(off + x), zero = vf_all(0.0f);
    vf on_now = signal.on + vf_all(p->residual) * on_before, off_now = signal.off + vf_all(p->residual) * off_before;
    vf_store(on + x, on_now);
    vf_store(off + x, off_now);
    if (fdsr) {
        vf share = vf_all(p->fdsr_share);
        vf_store(adapted_on + x, vf_max(share * (on_now - on_before), zero));
        vf_store(adapted_off + x, vf_max(share * (off_now - off_before), zero));
    } else {
        vf_store(adapted_on + x, on_now);
        vf_store(adapted_off + x, off_now);
        vf_store(before_on + x, on_before);
        vf_store(before_off + x, off_before);
    }
}

#endif
