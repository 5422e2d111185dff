/* model/medulla/lateral_inhibition.py: Eqs. (1) and (2) of the paper.
 *
 * I is linear in E now and one step ago, so each row needs its own weighted sum (`own`) and the one it hands to the
 * rows above and below (`across`). */
#ifndef LOBULA_LATERAL_INHIBITION_H
#define LOBULA_LATERAL_INHIBITION_H

#include "scratch.h"

/* The two sums of two channels lie side by side, vector by vector, so that one pointer serves all four. */
enum { OWN = 0, ACROSS = 2, WEIGHED = 4 };

typedef struct {
    vf own[4], across[4];
} ring_weights;

typedef struct {
    vf own, across;
} weighed;

INLINE ring_weights weights_of(const inhibition_set *q) {
    ring_weights w;
    UNROLL for (int i = 0; i < 4; i++) {
        w.own[i] = vf_all(q->own[i]);
        w.across[i] = vf_all(q->across[i]);
    }
    return w;
}

INLINE weighed weigh(const ring_weights *w, const float *now, const float *before, int s) {
    vf e = vf_load(now), sides = vf_load(now - s) + vf_load(now + s);
    vf b = vf_load(before), sides_before = vf_load(before - s) + vf_load(before + s);
    weighed r = {w->own[0] * e + w->own[1] * sides + w->own[2] * b + w->own[3] * sides_before,
                 w->across[0] * e + w->across[1] * sides + w->across[2] * b + w->across[3] * sides_before};
    return r;
}

/* Weigh one channel of a row; `out` points at its place among the four. */
static void weigh_row(int n, const inhibition_set *q, const float *now, const float *before, float *restrict out) {
    ring_weights w = weights_of(q);
    for (int x = 0; x < n; x += LANES, out += WEIGHED * LANES) {
        weighed r = weigh(&w, now + x, before + x, q->spacing);
        vf_store(out + OWN * LANES, r.own);
        vf_store(out + ACROSS * LANES, r.across);
    }
}

/* I of one channel, from the weighed rows around. */
static void inhibition_row(int n, const float *middle, const float *above, const float *below,
                           float *restrict inhibition) {
    for (int x = 0; x < n; x += LANES) {
        int at = x * WEIGHED;
        vf_store(inhibition + x, vf_load(middle + at + OWN * LANES) + vf_load(above + at + ACROSS * LANES) +
                                     vf_load(below + at + ACROSS * LANES));
    }
}

/* model.medulla.lateral_inhibition.compete */
INLINE vf compete(vf excitation, vf inhibition, vf bias) {
    return vf_max(excitation - bias * inhibition, vf_all(0.0f));
}

/* model/medulla: the summation S. One channel: what excites it and what inhibits it. */
typedef struct {
    const float *excitation, *inhibition;
} channel_rows;

INLINE vf channel_at(const channel_rows *c, int x, vf bias) {
    return compete(vf_load(c->excitation + x), vf_load(c->inhibition + x), bias);
}

/* The summation S of one LGMD from its channels; `out` points at its place among the two. */
INLINE void sum_row_as(int n, const lgmd_plan *q, const channel_rows *c, float *restrict out, int kind) {
    vf bias_on = vf_all(q->bias[ON]), bias_off = vf_all(q->bias[OFF]), product_gain = vf_all(q->product_gain);
    vf gain_on = vf_all(q->gain[ON]), gain_off = vf_all(q->gain[OFF]);
    channel_rows on = c[ON], off = c[OFF];
    for (int x = 0; x < n; x += LANES) {
        vf sum = vf_all(0.0f), a = sum, b = sum;
        if (kind != SUM_OFF) sum += gain_on * (a = channel_at(&on, x, bias_on));
        if (kind != SUM_ON) sum += gain_off * (b = channel_at(&off, x, bias_off));
        if (kind == SUM_PRODUCT) sum += product_gain * (a * b);
        vf_store(out + x * SUMS, sum);
    }
}

static void sum_row(int n, const lgmd_plan *q, const channel_rows *c, float *out) {
    switch (q->kind) {
    case SUM_ON: sum_row_as(n, q, c, out, SUM_ON); break;
    case SUM_OFF: sum_row_as(n, q, c, out, SUM_OFF); break;
    case SUM_BOTH: sum_row_as(n, q, c, out, SUM_BOTH); break;
    case SUM_PRODUCT: sum_row_as(n, q, c, out, SUM_PRODUCT); break;
    default: break;
    }
}

#endif
