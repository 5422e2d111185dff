/* model/medulla/grouping.py: S times its 3 x 3 sum, against the strongest one.
 *
 * The normaliser needs the whole picture, so vectors that may still pass the threshold are listed on the way: it only
 * grows, and what lies below the present one never comes back. */
#ifndef LOBULA_GROUPING_H
#define LOBULA_GROUPING_H

#include "scratch.h"
#include "storage.h"

/* The summations of both LGMDs lie side by side, vector by vector. */
enum { SUMS = 2 };

/* As it is listed. */
INLINE vf in_list(vf product, vf scale) {
    if (STORED_NARROW) product *= scale;
    return product;
}

#if defined(LOBULA_LAPTOP)

static void column_row(int n, const float *above, const float *middle, const float *below, float *restrict column) {
    for (int x = 0; x < n; x += LANES)
        vf_store(column + x, vf_load(above + x * SUMS) + vf_load(middle + x * SUMS) + vf_load(below + x * SUMS));
}

/* One LGMD's row: S, sums of three cells of a column, and what passes so far. */
typedef struct {
    const float *sum, *column;
    int spacing;
    vf least, scale;
} grouping_rows;

/* S times the sum of its neighbourhood, nine times too large, for the cells `inside` the picture. */
INLINE grouped group_vector(const grouping_rows *r, int x, vm inside, int partial, grouped g) {
    const float *column = r->column + x;
    vf around = vf_load(column - r->spacing) + vf_load(column) + vf_load(column + r->spacing);
    if (partial) around = vf_keep(inside, around);
    vf product = vf_load(r->sum + x * SUMS) * around;
    g.strongest = vf_max(g.strongest, around);
    stored_store(g.list, in_list(product, r->scale));
    g.list += (unsigned)vm_any(vf_ge(product, r->least)) * LANES;
    return g;
}

static grouped group_row(int width, const grouping_rows *rows, grouped g) {
    grouping_rows r = *rows;
    int whole = width / LANES * LANES;
    vm inside = vm_first(width - whole);
    for (int x = 0; x < whole; x += LANES) g = group_vector(&r, x, inside, 0, g);
    return whole < width ? group_vector(&r, whole, inside, 1, g) : g;
}

static void group_row_of_both(int width, const grouping_rows *rows, grouped *both) {
    grouping_rows r = rows[0], q = rows[1];
    grouped g = both[0], h = both[1];
    int whole = width / LANES * LANES;
    vm inside = vm_first(width - whole);
    for (int x = 0; x < whole; x += LANES) {
        g = group_vector(&r, x, inside, 0, g);
        h = group_vector(&q, x, inside, 0, h);
    }
    both[0] = whole < width ? group_vector(&r, whole, inside, 1, g) : g;
    both[1] = whole < width ? group_vector(&q, whole, inside, 1, h) : h;
}

#endif

INLINE vd total_row(int width, const float *sum, vd total) {
    int whole = width / LANES * LANES;
    vf row = vf_all(0.0f);
    for (int x = 0; x < whole; x += LANES) row += vf_load(sum + x * SUMS);
    if (whole < width) row += vf_keep(vm_first(width - whole), vf_load(sum + whole * SUMS));
    vd_add(&total, row);
    return total;
}

/* What is listed and at least `least`; the list holds it times `scale`. */
INLINE real total_of_list(const stored *list, const stored *end, float least, float scale) {
    vd total = {0};
    vf limit = in_list(vf_all(least), vf_all(scale));
    while (list < end) {
        vf part = vf_all(0.0f);
        for (int i = 0; i < 16 && list < end; i++, list += LANES) {
            vf listed = stored_load(list);
            part += vf_keep(vf_ge(listed, limit), listed);
        }
        vd_add(&total, part);
    }
    return STORED_NARROW ? vd_total(&total) / (real)scale : vd_total(&total);
}

#endif
