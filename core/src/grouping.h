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

/* Sum of the neighbourhood times S, nine times too large; `limit` is what passes so far. */
INLINE float *group_row(int width, int s, const float *sum, const float *column, float limit, vf *strongest,
                        float *list) {
    int whole = width / LANES * LANES;
    vf highest = *strongest, least = vf_all(limit);
    for (int x = 0; x < whole; x += LANES) {
        vf around = vf_load(column + x - s) + vf_load(column + x) + vf_load(column + x + s);
        vf grouped = vf_load(sum + x) * around;
        highest = vf_max(highest, around);
        vf_store(list, grouped);
        list += vm_any(vf_ge(grouped, least)) ? LANES : 0;
    }
    if (whole < width) {
        vm inside = vm_first(width - whole);
        vf around = vf_keep(inside, vf_load(column + whole - s) + vf_load(column + whole) + vf_load(column + whole + s));
        vf grouped = vf_load(sum + whole) * around;
        highest = vf_max(highest, around);
        vf_store(list, grouped);
        list += vm_any(vf_ge(grouped, least)) ? LANES : 0;
    }
    *strongest = highest;
    return list;
}

INLINE void total_row(int width, const float *sum, vd *total) {
    int whole = width / LANES * LANES;
    vf row = vf_all(0.0f);
    for (int x = 0; x < whole; x += LANES) row += vf_load(sum + x);
    if (whole < width) row += vf_keep(vm_first(width - whole), vf_load(sum + whole));
    vd_add(total, row);
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
