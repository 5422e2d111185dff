/* The medulla for a processor that takes one cell at a time: model/medulla/lateral_inhibition.py and grouping.py.
 *
 * Inhibition matters only where there is excitation to take it from, and grouping only where something is left; most
 * cells have neither. So both are added up cell by cell, where lateral_inhibition.h, usual.h and grouping.h keep sums of
 * whole rows. */
#ifndef LOBULA_SPARSE_H
#define LOBULA_SPARSE_H

#include "grouping.h"

/* One channel: its rows above, at and below the present one, edges repeated. */
typedef struct {
    const float *now[3], *before[3];
} three_rows;

/* W of Eq. (1), of the cell itself, the nearest and the diagonal ones, now and one step ago; w and the gain of each LGMD
 * that hears the channel, the others having no gain. */
typedef struct {
    float own, nearest, diagonal, own_before, nearest_before, diagonal_before;
    float bias[2], gain[2], least_bias;
} channel_plan;

/* `first` to `last` are the LGMDs that are looked at; they have the same weights. */
static channel_plan channel_of(const step_plan *p, int c, int first, int last) {
    channel_plan q = {0};
    q.least_bias = 1e30f;
    for (int j = first; j <= last; j++) {
        const lgmd_plan *lgmd = &p->lgmd[j];
        if (lgmd->set[c] == NO_SET) continue;
        const inhibition_set *set = &p->set[lgmd->set[c]];
        q.own = set->own[0];
        q.nearest = set->own[1];
        q.diagonal = set->across[1];
        q.own_before = set->own[2];
        q.nearest_before = set->own[3];
        q.diagonal_before = set->across[3];
        q.bias[j] = lgmd->bias[c];
        q.gain[j] = lgmd->gain[c];
        if (lgmd->bias[c] < q.least_bias) q.least_bias = lgmd->bias[c];
    }
    return q;
}

/* S_c of Eq. (2) of an excited cell. Where a part of I already silences it, the rest is not looked at. */
INLINE void excited_cell(const three_rows *r, const channel_plan *q, int first, int last, float excitation, int x, int s,
                         float part[2]) {
    const float *above = r->now[0] + x, *middle = r->now[1] + x, *below = r->now[2] + x;
    float inhibition = q->own * excitation + q->nearest * (middle[-s] + middle[s] + (above[0] + below[0]));
    if (q->least_bias * inhibition >= excitation) return;
    inhibition += q->diagonal * (above[-s] + above[s] + (below[-s] + below[s]));
    above = r->before[0] + x;
    middle = r->before[1] + x;
    below = r->before[2] + x;
    inhibition += q->own_before * middle[0] + q->nearest_before * (middle[-s] + middle[s] + (above[0] + below[0]));
    inhibition += q->diagonal_before * (above[-s] + above[s] + (below[-s] + below[s]));
    UNROLL for (int j = first; j <= last; j++) part[j] = vf_above_zero(excitation - q->bias[j] * inhibition);
}

/* The summation S of the LGMDs `first` to `last`, which are side by side in `sums`. */
INLINE void sparse_row_as(int n, const three_rows *rows, const step_plan *p, int first, int last, int s,
                          float *restrict sums) {
    const channel_plan on_plan = channel_of(p, ON, first, last), off_plan = channel_of(p, OFF, first, last);
    const three_rows on_rows = rows[ON], off_rows = rows[OFF];
    float product[2] = {0.0f, 0.0f};
    for (int j = first; j <= last; j++)
        if (MULTIPLIES(&p->lgmd[j])) product[j] = p->lgmd[j].product_gain;
    for (int x = 0; x < n; x++, sums += SUMS) {
        float on = on_rows.now[1][x], off = off_rows.now[1][x], a[2] = {0.0f, 0.0f}, b[2] = {0.0f, 0.0f};
        if (on > 0.0f) excited_cell(&on_rows, &on_plan, first, last, on, x, s, a);
        if (off > 0.0f) excited_cell(&off_rows, &off_plan, first, last, off, x, s, b);
        UNROLL for (int j = first; j <= last; j++) {
            float sum = on_plan.gain[j] * a[j] + off_plan.gain[j] * b[j];
            if (product[j] != 0.0f) sum += product[j] * (a[j] * b[j]);
            sums[j] = sum;
        }
    }
}

static void sparse_row(int n, const three_rows *rows, const step_plan *p, int first, int last, int s, float *sums) {
    if (first < last)
        sparse_row_as(n, rows, p, 0, 1, SPACING(s), sums);
    else
        sparse_row_as(n, rows, p, first, first, SPACING(s), sums);
}

INLINE float column_at(const float *const *sums, int x) {
    return sums[0][x * SUMS] + sums[1][x * SUMS] + sums[2][x * SUMS];
}

INLINE grouped group_cell(float sum, float around, float least, float scale, grouped g) {
    if (around > g.strongest) g.strongest = around;
    if (sum > 0.0f) {
        float product = sum * around;
        if (product >= least) stored_store(g.list++, in_list(product, scale));
    }
    return g;
}

/* One LGMD's row of grouping.h, from its sums in the rows above, at and below. */
static grouped sparse_group(int n, const float *const *rows, int s, float least, float scale, grouped g) {
    const float *const sums[3] = {rows[0], rows[1], rows[2]};
    if (SPACING(s) == 1) {
        float left = column_at(sums, 0), here = left;
        for (int x = 0; x < n - 1; x++) {
            float right = column_at(sums, x + 1);
            g = group_cell(sums[1][x * SUMS], left + here + right, least, scale, g);
            left = here;
            here = right;
        }
        return group_cell(sums[1][(n - 1) * SUMS], left + here + here, least, scale, g);
    }
    for (int x = 0; x < n; x++) {
        float around = column_at(sums, clamp(x - s, n)) + column_at(sums, x) + column_at(sums, clamp(x + s, n));
        g = group_cell(sums[1][x * SUMS], around, least, scale, g);
    }
    return g;
}

#endif
