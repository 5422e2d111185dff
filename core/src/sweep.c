/* The whole step, row by row: each row goes through every layer while it is in the cache.
 *
 * Compiled once for each instruction set, with its own flags and LOBULA_ISA; see isa.h. Layers follow each other at a
 * fixed number of rows, so several frames can go through together: every row is finished by one frame before the next
 * frame reads it. */
#include "sweep.h"

#include "area_average.h"
#include "emd.h"
#include "grouping.h"
#include "isa.h"
#include "lamina.h"
#include "lateral_inhibition.h"
#include "retina.h"
#include "scratch.h"

typedef struct {
    const layout *l;
    const float *inner_kernel, *outer_kernel;
    float *planes;
} picture_state;

static void replicate_margins(float *row, int width, int margin) {
    vf first = vf_all(row[0]), last = vf_all(row[width - 1]);
    for (int x = 0; x < margin; x += LANES) {
        vf_store(row - x - LANES, first);
        vf_store(row + width + x, last);
    }
}

static void zero_right(float *row, int width, int margin) {
    for (int x = 0; x < margin + LANES; x += LANES) vf_store(row + width + x, vf_all(0.0f));
}

static void copy_row(float *const *taps, int tap, const layout *l, int y, const float *row) {
    if (taps && taps[tap]) memcpy(taps[tap] + (size_t)y * (size_t)l->width, row, (size_t)l->width * sizeof(float));
}

static int uses(const layout *l, int source) { return l->reads[0] == source || l->reads[1] == source; }

static int reach_of(const layout *l, int source) {
    int reach = 0;
    for (int j = 0; j < 2; j++)
        if (l->reads[j] == source && l->spacing[j] > reach) reach = l->spacing[j];
    return reach;
}

INLINE void retina_vector(int x, vf now, const step_plan *p, float *luma, float *change, float *on, float *off,
                          float *const *excitation, int lgmds_read_change) {
    vf c = frame_difference(now, vf_load(luma + x), p);
    vf_store(luma + x, now);
    vf_store(change + x, c);
    if (lgmds_read_change) {
        on_off signal = halves(c);
        vf on_before = vf_load(on + x), off_before = vf_load(off + x);
        vf on_now = signal.on + vf_all(p->residual) * on_before, off_now = signal.off + vf_all(p->residual) * off_before;
        vf_store(on + x, on_now);
        vf_store(off + x, off_now);
        vf_store(excitation[E_ON] + x, on_now);
        vf_store(excitation[E_OFF] + x, off_now);
        vf_store(excitation[E_ON_BEFORE] + x, on_before);
        vf_store(excitation[E_OFF_BEFORE] + x, off_before);
    }
}

INLINE void retina_row_as(const layout *l, const step_plan *p, const char *image, int type, float *luma, float *change,
                          float *on, float *off, float *const *excitation, int lgmds_read_change) {
    int whole = l->width / LANES * LANES;
    for (int x = 0; x < whole; x += LANES)
        retina_vector(x, pixels_at(image, type, x), p, luma, change, on, off, excitation, lgmds_read_change);
    if (whole < l->width)
        retina_vector(whole, last_pixels(image, type, whole, l->width), p, luma, change, on, off, excitation,
                      lgmds_read_change);
}

static void retina_row(const picture_state *s, scratch *k, const step_plan *p, int y) {
    const layout *l = s->l;
    const char *image = picture_row(&p->image, y);
    int change_read = uses(l, CHANGE);
    float *luma = state_row(l, s->planes, l->planes.luma, y), *change = row_of(&k->change, y), *excitation[E_ROWS];
    float *on = change_read ? state_row(l, s->planes, l->planes.change, y) : NULL;
    float *off = change_read ? on + l->stride : NULL;
    for (int i = 0; i < E_ROWS; i++) excitation[i] = change_read ? row_of(&k->excitation[CHANGE][i], y) : NULL;
    if (p->image.type == LOBULA_UINT8) {
        if (change_read)
            retina_row_as(l, p, image, LOBULA_UINT8, luma, change, on, off, excitation, 1);
        else
            retina_row_as(l, p, image, LOBULA_UINT8, luma, change, on, off, excitation, 0);
    } else {
        retina_row_as(l, p, image, LOBULA_FLOAT32, luma, change, on, off, excitation, change_read);
    }
    if (change_read)
        for (int i = 0; i < E_ROWS; i++) replicate_margins(excitation[i], l->width, reach_of(l, CHANGE));
    if (l->outer_radius) replicate_margins(change, l->width, l->outer_radius);
    copy_row(p->taps, LOBULA_TAP_CHANGE, l, y, change);
}

static void blur_row(const picture_state *s, scratch *k, int y) {
    const layout *l = s->l;
    float *change = row_of(&k->change, y), *e = row_of(&k->inner, y), *i = row_of(&k->outer, y);
    int n = padded(l->width);
    if (l->inner_radius == 2 && l->outer_radius == 4)
        blur_along(change, n, s->inner_kernel, 2, s->outer_kernel, 4, e, i);
    else
        blur_along(change, n, s->inner_kernel, l->inner_radius, s->outer_kernel, l->outer_radius, e, i);
}

INLINE void lamina_row_as(const picture_state *s, const step_plan *p, float *const *inner, int r, float *const *outer,
                          int R, float *on, float *off, float *const *adapted, float *const *before, int fdsr) {
    int n = padded(s->l->width);
    for (int x = 0; x < n; x += LANES) {
        vf e = blur_down(inner, x, s->inner_kernel, r), i = blur_down(outer, x, s->outer_kernel, R);
        adapt_channels(x, edges(e, i, p->dead_zone), p, on, off, adapted[ON], adapted[OFF], before[ON], before[OFF],
                       fdsr);
    }
}

static void lamina_row_unfiltered(const picture_state *s, const step_plan *p, const float *change, float *on,
                                  float *off, float *const *adapted, float *const *before, int fdsr) {
    int n = padded(s->l->width);
    for (int x = 0; x < n; x += LANES)
        adapt_channels(x, halves(vf_load(change + x)), p, on, off, adapted[ON], adapted[OFF], before[ON], before[OFF],
                       fdsr);
}

static void edges_tap(const picture_state *s, const step_plan *p, float *const *inner, float *const *outer,
                      const float *change, int y) {
    const layout *l = s->l;
    if (!l->outer_radius) {
        copy_row(p->taps, LOBULA_TAP_LAMINA, l, y, change);
        return;
    }
    float *map = p->taps[LOBULA_TAP_LAMINA] + (size_t)y * (size_t)l->width;
    int n = padded(l->width);
    for (int x = 0; x < n; x += LANES) {
        float row[LANES];
        on_off edge = edges(blur_down(inner, x, s->inner_kernel, l->inner_radius),
                            blur_down(outer, x, s->outer_kernel, l->outer_radius), p->dead_zone);
        vf_store(row, edge.on - edge.off);
        for (int i = 0; i < LANES && x + i < l->width; i++) map[x + i] = row[i];
    }
}

static void lamina_row(const picture_state *s, scratch *k, const step_plan *p, int y) {
    const layout *l = s->l;
    float *inner[2 * 32 + 1], *outer[2 * 32 * 4 + 1];
    float *on = state_row(l, s->planes, l->planes.on, y), *off = state_row(l, s->planes, l->planes.off, y);
    float *adapted[2], *before[2];
    int fdsr = l->planes.adapted >= 0, r = l->inner_radius, R = l->outer_radius;
    for (int c = 0; c < 2; c++) {
        adapted[c] = row_of(&k->adapted[c], y);
        before[c] = fdsr ? NULL : row_of(&k->before[c], y);
    }
    if (R) {
        for (int i = -r; i <= r; i++) inner[r + i] = row_of(&k->inner, clamp(y + i, l->height));
        for (int i = -R; i <= R; i++) outer[R + i] = row_of(&k->outer, clamp(y + i, l->height));
    }
    if (!R)
        lamina_row_unfiltered(s, p, row_of(&k->change, y), on, off, adapted, before, fdsr);
    else if (r == 2 && R == 4 && fdsr)
        lamina_row_as(s, p, inner, 2, outer, 4, on, off, adapted, before, 1);
    else
        lamina_row_as(s, p, inner, r, outer, R, on, off, adapted, before, fdsr);
    for (int c = 0; c < 2; c++) {
        zero_right(adapted[c], l->width, l->margin);
        if (!fdsr) zero_right(before[c], l->width, 0);
        copy_row(p->taps, LOBULA_TAP_ADAPTED_ON + c, l, y, adapted[c]);
    }
    if (p->taps && p->taps[LOBULA_TAP_LAMINA]) edges_tap(s, p, inner, outer, row_of(&k->change, y), y);
}

/* What the LGMDs read where they read the lamina: both channels now and one step ago, edges repeated outwards. */
static void excite_row(const layout *l, scratch *k, const float *on, const float *off, const float *kept,
                       const float *on_before, const float *off_before, int y) {
    float *rows[E_ROWS];
    int n = padded(l->width);
    for (int i = 0; i < E_ROWS; i++) rows[i] = row_of(&k->excitation[ADAPTED][i], y);
    for (int x = 0; x < n; x += LANES) {
        on_off before = kept ? halves(vf_load(kept + x)) : (on_off){vf_load(on_before + x), vf_load(off_before + x)};
        vf_store(rows[E_ON] + x, vf_load(on + x));
        vf_store(rows[E_OFF] + x, vf_load(off + x));
        vf_store(rows[E_ON_BEFORE] + x, before.on);
        vf_store(rows[E_OFF_BEFORE] + x, before.off);
    }
    for (int i = 0; i < E_ROWS; i++) replicate_margins(rows[i], l->width, reach_of(l, ADAPTED));
}

static void motion_tap(const layout *l, const step_plan *p, const float *on, const float *off, const float *kept,
                       const float *on_before, const float *off_before, int y) {
    float *map = p->taps[LOBULA_TAP_MOTION] + (size_t)y * (size_t)l->width;
    memset(map, 0, (size_t)l->width * sizeof(float));
    emd_map(l->width, on, kept ? kept : on_before, 1.0f, p, map);
    emd_map(l->width, off, kept ? kept : off_before, kept ? -1.0f : 1.0f, p, map);
}

static void motion_row(const picture_state *s, scratch *k, const step_plan *p, int y) {
    const layout *l = s->l;
    int fdsr = l->planes.adapted >= 0;
    float *on = row_of(&k->adapted[ON], y), *off = row_of(&k->adapted[OFF], y);
    float *on_before = fdsr ? NULL : row_of(&k->before[ON], y), *off_before = fdsr ? NULL : row_of(&k->before[OFF], y);
    float *kept = fdsr ? state_row(l, s->planes, l->planes.adapted, y) : NULL;
    if (uses(l, ADAPTED)) excite_row(l, k, on, off, kept, on_before, off_before, y);
    if (p->taps && p->taps[LOBULA_TAP_MOTION]) motion_tap(l, p, on, off, kept, on_before, off_before, y);
    if (fdsr)
        emd_row(padded(l->width), on, off, kept, p, &k->hs);
    else
        emd_row_apart(padded(l->width), on, off, on_before, off_before, p, &k->hs);
}

/* One set: weigh row y, compete in row y - spacing. Past the lower border there is nothing left to weigh. */
static void set_row(const layout *l, scratch *k, const inhibition_set *q, const ring *own, const ring *across,
                    const ring *part, int y) {
    int s = q->spacing, n = padded(l->width), mid = y - s, competes = mid >= 0;
    float *above = competes ? row_of(across, clamp(mid - s, l->height)) : NULL;
    float *middle = competes ? row_of(own, mid) : NULL, *out = competes ? row_of(part, mid) : NULL;
    if (y < l->height) {
        const float *now = row_of(&k->excitation[q->source][q->channel], y);
        const float *before = row_of(&k->excitation[q->source][E_ON_BEFORE + q->channel], y);
        float *mine = row_of(own, y), *hands_on = row_of(across, y);
        if (competes && mid - s >= 0)
            inhibition_row(n, q, s, now, before, mine, hands_on, middle, above, out, WEIGH_AND_COMPETE);
        else
            inhibition_row(n, q, s, now, before, mine, hands_on, NULL, NULL, NULL, WEIGH_ONLY);
        if (competes && mid - s < 0) compete_row(n, middle, above, hands_on, out);
    } else if (competes) {
        compete_row(n, middle, above, row_of(across, l->height - 1), out);
    }
}

/* Inhibition as such, for a tap: a set without E and without a floor, so what competes is -I. */
static void tap_row(const layout *l, scratch *k, const step_plan *p, int i, int y) {
    const inhibition_set *q = &p->tap_set[i];
    int s = q->spacing, mid = y - s;
    if (y < l->height)
        inhibition_row(padded(l->width), q, s, row_of(&k->excitation[q->source][q->channel], y),
                       row_of(&k->excitation[q->source][E_ON_BEFORE + q->channel], y), row_of(&k->tap_own[i], y),
                       row_of(&k->tap_across[i], y), NULL, NULL, NULL, WEIGH_ONLY);
    if (mid < 0) return;
    const float *own = row_of(&k->tap_own[i], mid), *above = row_of(&k->tap_across[i], clamp(mid - s, l->height));
    const float *below = row_of(&k->tap_across[i], clamp(y, l->height));
    float *out = p->tap_set_out[i] + (size_t)mid * (size_t)l->width;
    for (int x = 0; x < l->width; x++) out[x] = above[x] + below[x] - own[x];
}

static const ring *summation_of(const scratch *k, const lgmd_plan *q, int j) {
    if (q->kind != SUM_ONE) return &k->summation[j];
    return &k->part[q->set[q->set[ON] == NO_SET]];
}

/* Row y of the summation, and the column sums it completes (row y - spacing). */
static void summation_row(const layout *l, scratch *k, const step_plan *p, int j, int y) {
    const lgmd_plan *q = &p->lgmd[j];
    const ring *sum = summation_of(k, q, j);
    int s = l->spacing[j], n = padded(l->width), mid = y - s, columns = q->grouping && mid >= 0;
    float *column = columns ? row_of(&k->column[j], mid) : NULL;
    float *above = columns ? row_of(sum, clamp(mid - s, l->height)) : NULL;
    float *middle = columns ? row_of(sum, mid) : NULL;
    if (y < l->height) {
        float *now = row_of(sum, y);
        const float *on = q->kind == SUM_ONE ? NULL : row_of(&k->part[q->set[ON]], y);
        const float *off = q->kind == SUM_ONE ? NULL : row_of(&k->part[q->set[OFF]], y);
        int fused = columns && mid - s >= 0;
        if (q->kind == SUM_PRODUCT)
            sum_row(n, q, on, off, now, above, middle, fused ? column : NULL, 1);
        else if (q->kind == SUM_BOTH)
            sum_row(n, q, on, off, now, above, middle, fused ? column : NULL, 0);
        if (columns && !(fused && q->kind != SUM_ONE)) column_row(n, above, middle, now, column);
        if (!q->grouping) total_row(l->width, now, &k->total[j]);
        copy_row(p->taps, LOBULA_TAP_LGMD1_SUMMATION + 4 * j, l, y, now);
        if (!q->grouping) copy_row(p->taps, LOBULA_TAP_LGMD1_GROUPED + 4 * j, l, y, now);
    } else if (columns) {
        column_row(n, above, middle, row_of(sum, l->height - 1), column);
    }
    if (columns) replicate_margins(column, l->width, s);
}

static float threshold(const lgmd_plan *q, float strongest) {
    return (float)(9.0 * q->threshold_grey * (q->floor_grey + (double)strongest / (9.0 * q->divisor)));
}

static void grouping_row(const layout *l, scratch *k, const step_plan *p, int j, int y) {
    const lgmd_plan *q = &p->lgmd[j];
    vf strongest = vf_all(k->strongest[j]);
    const float *sum = row_of(summation_of(k, q, j), y), *column = row_of(&k->column[j], y);
    /* a little below, so that rounding on the way to the final threshold loses nothing */
    float limit = 0.999999f * threshold(q, k->strongest[j]);
    float *from = k->list[j] + k->listed[j];
    float *to = group_row(l->width, l->spacing[j], sum, column, limit, &strongest, from);
    k->listed[j] += (size_t)(to - from);
    k->strongest[j] = vf_highest(strongest);
    if (p->taps && p->taps[LOBULA_TAP_LGMD1_GROUPED + 4 * j]) {
        float *map = p->taps[LOBULA_TAP_LGMD1_GROUPED + 4 * j] + (size_t)y * (size_t)l->width;
        int s = l->spacing[j];
        for (int x = 0; x < l->width; x++) map[x] = sum[x] * (column[x - s] + column[x] + column[x + s]);
    }
}

static void lgmd_row(const layout *l, scratch *k, const step_plan *p, int j, int y) {
    int s = l->spacing[j], summed = y - s, grouped = summed - s - SETTLE;
    if (p->lgmd[j].kind == SUM_NONE) return;
    if (p->lgmd[j].grouping && grouped >= 0 && grouped < l->height) grouping_row(l, k, p, j, grouped);
    if (summed >= 0 && summed < l->height + s) summation_row(l, k, p, j, summed);
}

static void source_row(const layout *l, scratch *k, const step_plan *p, int source, int y) {
    if (y < 0) return;
    for (int i = 0; i < p->sets; i++)
        if (p->set[i].source == source && y < l->height + p->set[i].spacing)
            set_row(l, k, &p->set[i], &k->own[i], &k->across[i], &k->part[i], y);
    for (int i = 0; i < p->tap_sets; i++)
        if (p->tap_set[i].source == source && y < l->height + p->tap_set[i].spacing) tap_row(l, k, p, i, y);
    for (int j = 0; j < 2; j++)
        if (l->reads[j] == source) lgmd_row(l, k, p, j, y);
}

/* Row y enters; every later layer works on the row that has become possible. */
static void push_row(const picture_state *s, scratch *k, const step_plan *p, int y) {
    const layout *l = s->l;
    int height = l->height, settled = y - SETTLE, laminated = settled - l->outer_radius, moved = laminated - SETTLE;
    if (uses(l, ADAPTED)) source_row(l, k, p, ADAPTED, moved - SETTLE);
    if (moved >= 0 && moved < height) motion_row(s, k, p, moved);
    if (l->outer_radius && settled >= 0 && settled < height) blur_row(s, k, settled);
    if (laminated >= 0 && laminated < height) lamina_row(s, k, p, laminated);
    if (uses(l, CHANGE)) source_row(l, k, p, CHANGE, settled);
    if (y < height) retina_row(s, k, p, y);
}

static void begin(const layout *l, scratch *k) {
    vd none = {0};
    for (int c = 0; c < 2; c++)
        for (unsigned i = 0; i < k->adapted[c].rows; i++)
            for (int x = 0; x < l->margin; x += LANES)
                vf_store(k->adapted[c].first + (size_t)i * (size_t)k->adapted[c].stride - x - LANES, vf_all(0.0f));
    k->hs = none;
    for (int j = 0; j < 2; j++) {
        k->total[j] = none;
        k->listed[j] = 0;
        k->strongest[j] = 0.0f;
    }
}

static void finish(const layout *l, scratch *k, step_plan *p) {
    p->hs = vd_total(&k->hs);
    for (int j = 0; j < 2; j++) {
        const lgmd_plan *q = &p->lgmd[j];
        float least = threshold(q, k->strongest[j]);
        double omega = q->floor_grey + (double)k->strongest[j] / (9.0 * q->divisor);
        p->total[j] = q->grouping ? total_of_list(k->list[j], k->list[j] + k->listed[j], least) / (9.0 * omega)
                                  : vd_total(&k->total[j]);
        float *map = p->taps ? p->taps[LOBULA_TAP_LGMD1_GROUPED + 4 * j] : NULL;
        if (p->taps && q->kind == SUM_NONE)
            for (int i = LOBULA_TAP_LGMD1_SUMMATION + 4 * j; i <= LOBULA_TAP_LGMD1_GROUPED + 4 * j; i++)
                if (p->taps[i]) memset(p->taps[i], 0, (size_t)l->width * (size_t)l->height * sizeof(float));
        if (map && q->grouping && q->kind != SUM_NONE)
            for (size_t i = 0; i < (size_t)l->width * (size_t)l->height; i++)
                map[i] = map[i] >= least ? map[i] / (float)(9.0 * omega) : 0.0f;
    }
}

static void sweep(const layout *l, const float *kernel, float *planes, char *workspace, step_plan *plans, int n) {
    scratch k[MAX_FRAMES];
    picture_state s = {l, kernel, kernel + l->inner_radius + 1, planes};
    memory m = {workspace, 0};
    int spacing = l->spacing[0] > l->spacing[1] ? l->spacing[0] : l->spacing[1];
    int lag = l->outer_radius + 2 * spacing + 4 * SETTLE;
    for (int t = 0; t < n; t++) {
        scratch_layout(l, &m, &k[t]);
        begin(l, &k[t]);
    }
    if (plans[0].tap_sets) scratch_taps(l, &m, &k[0]);
    for (int y = 0; y < l->height + lag; y++)
        for (int t = 0; t < n; t++) push_row(&s, &k[t], &plans[t], y);
    for (int t = 0; t < n; t++) finish(l, &k[t], &plans[t]);
}

static size_t scratch_bytes(const layout *l) {
    scratch k;
    memory m = {NULL, 0};
    scratch_layout(l, &m, &k);
    return m.used;
}

static size_t tap_bytes(const layout *l) {
    scratch k;
    memory m = {NULL, 0};
    scratch_taps(l, &m, &k);
    return m.used;
}

const kernels KERNELS = {
    ISA_NAME,   isa_runs,   scratch_bytes, tap_bytes, summarise, coverage, light,
    light_rest, lit_change, set_luma,      sweep,     in_range,
    area_average,
};
