/* model/medulla/grouping.py: S times its 3 x 3 sum, against the strongest one.
 *
 * The normaliser needs the whole picture, so vectors that may still pass the threshold are listed on the way: it only
 * grows, and what lies below the present one never comes back. */
#ifndef LOBULA_GROUPING_H
#define LOBULA_GROUPING_H

#include "scratch.h"

/* The summation S of both channels, and the sum of three rows of it. */
INLINE void sum_row(int n, const lgmd_plan *q, const float *on, const float *off, float *restrict sum,
                    const float *above, const float *middle, float *restrict column, int product) {
    for (int x = 0; x < n; x += LANES) {
        vf a = vf_load(on + x), b = vf_load(off + x);
        vf s = product ? vf_all(q->gain[0]) * a + vf_all(q->gain[1]) * b + vf_all(q->gain[2]) * (a * b) : a + b;
        vf_store(sum + x, s);
        if (column) vf_store(column + x, vf_load(above + x) + vf_load(middle + x) + s);
    }
}

INLINE void column_row(int n, const float *above, const float *middle, const float *below, float *restrict column) {
    for (int x = 0; x < n; x += LANES)
        vf_store(column + x, vf_load(above + x) + vf_load(middle + x) + vf_load(below + x));
}

typedef struct {
    vf strongest;
    float *list; /* its end */
} grouped;

INLINE grouped group_vector(vf sum, vf around, vf least, grouped g) {
    vf product = sum * around;
    g.strongest = vf_max(g.strongest, around);
    vf_store(g.list, product);
    g.list += vm_any(vf_ge(product, least)) ? LANES : 0;
    return g;
}

/* S times the sum of its neighbourhood, nine times too large; `limit` is what passes so far. */
INLINE grouped group_row(int width, int s, const float *sum, const float *column, float limit, grouped g) {
    int whole = width / LANES * LANES;
    vf least = vf_all(limit);
    for (int x = 0; x < whole; x += LANES)
        g = group_vector(vf_load(sum + x), vf_load(column + x - s) + vf_load(column + x) + vf_load(column + x + s),
                         least, g);
    if (whole < width) {
        const float *last = column + whole;
        vf around = vf_load(last - s) + vf_load(last) + vf_load(last + s);
        g = group_vector(vf_load(sum + whole), vf_keep(vm_first(width - whole), around), least, g);
    }
    return g;
}

INLINE vd total_row(int width, const float *sum, vd total) {
    int whole = width / LANES * LANES;
    vf row = vf_all(0.0f);
    for (int x = 0; x < whole; x += LANES) row += vf_load(sum + x);
    if (whole < width) row += vf_keep(vm_first(width - whole), vf_load(sum + whole));
    vd_add(&total, row);
    return total;
}

INLINE double total_of_list(const float *list, const float *end, float least) {
    vd total = {0};
    vf limit = vf_all(least);
    while (list < end) {
        vf part = vf_all(0.0f);
        for (int i = 0; i < 16 && list < end; i++, list += LANES) {
            vf grouped = vf_load(list);
            part += vf_keep(vf_ge(grouped, limit), grouped);
        }
        vd_add(&total, part);
    }
    return vd_total(&total);
}

#endif
