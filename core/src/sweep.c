/* The whole step, row by row: each row goes through every layer while it is in the cache.
 *
 * Compiled once for each instruction set, with its own flags and LOBULA_ISA; see isa.h. Layers follow each other at a
 * fixed number of rows, so several frames can go through together: every row is finished by one frame before the next
 * frame reads it. */
#include "sweep.h"

#include "emd.h"
#include "grouping.h"
#include "isa.h"
#include "known.h"
#include "lamina.h"
#include "retina.h"
#include "scratch.h"
#include "storage.h"

#if defined(LOBULA_LAPTOP)
#include "lateral_inhibition.h"
#include "usual.h"
#else
#include "sparse.h"
#endif

#if defined(LOBULA_LAPTOP) && !defined(LOBULA_COMPACT_PLANES)
#include "area_average.h"
#endif

/* What stays the same for all rows of all frames of a sweep. */
typedef struct {
    const layout *l;
    int n; /* width in whole vectors */
    int lgmds_read_change, lgmds_read_lamina, fdsr;
    int reach[SOURCES]; /* farthest neighbour among the LGMDs that read it */
    const float *inner, *outer; /* weights of the DoG */
    char *planes;
} constants;

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

static void zero_margins(const ring *r, int margin) {
    for (unsigned i = 0; i < r->rows; i++)
        for (int x = 0; x < margin; x += LANES) vf_store(r->first + (size_t)i * (size_t)r->stride - x - LANES, vf_all(0.0f));
}

static float *tap_row(const step_plan *p, int tap, const layout *l, int y) {
#if !defined(LOBULA_LAPTOP)
    return NULL; /* no room for maps */
#endif
    return p->taps && p->taps[tap] ? p->taps[tap] + (size_t)y * (size_t)l->width : NULL;
}

static void copy_to_tap(const step_plan *p, int tap, const layout *l, int y, const float *row) {
    float *map = tap_row(p, tap, l, y);
    if (map) memcpy(map, row, (size_t)l->width * sizeof(float));
}

static void retina_row(const constants *c, scratch *k, step_plan *p, int y) {
    const layout *l = c->l;
    const char *image = picture_row(&p->image, y);
    stored_luma *luma = luma_row(l, c->planes, y);
    float *change = k->change.first + (size_t)((unsigned)y % k->change.rows) * (size_t)k->change.stride;
    retina_rows r = {luma, {NULL}, change, {NULL}, k->columns};
    if (HAS_COARSE(p) && y % p->patch == 0) memset(k->columns, 0, (size_t)l->stride * sizeof(float));
    if (READ_CHANGE(c)) {
        r.kept[ON] = state_row(l, c->planes, l->planes.change, y);
        r.kept[OFF] = r.kept[ON] + l->stride;
        for (int i = 0; i < E_ROWS; i++) r.excitation[i] = row_of(&k->excitation[CHANGE][i], y);
    }
    if (HAS_COARSE(p))
        retina_row_coarse(l->width, p, image, &r, READ_CHANGE(c));
    else if (READ_CHANGE(c))
        retina_row_excites(l->width, p, image, &r);
    else
        retina_row_alone(l->width, p, image, &r);
    luma_keep(luma, image, l->width);
    for (int i = 0; i < E_ROWS && READ_CHANGE(c); i++) replicate_margins(r.excitation[i], l->width, c->reach[CHANGE]);
    if (HAS_COARSE(p) && y % p->patch == p->patch - 1) hear_patches(l->width, p, k->columns, p->patches);
    copy_to_tap(p, LOBULA_TAP_CHANGE, l, y, change);
}

static void blur_row(const constants *c, scratch *k, int y) {
    const layout *l = c->l;
    float *rows[2 * MAX_RADIUS + 1], *e = row_of(&k->inner, y), *i = row_of(&k->outer, y);
    window_of(&k->change, y, DOG_OUTER(l), l->height, rows);
    if (KNOWN(l->inner_radius == 2 && l->outer_radius == 4, 0))
        blur_down(rows, c->n, c->inner, 2, c->outer, 4, e, i);
    else
        blur_down(rows, c->n, c->inner, DOG_INNER(l), c->outer, DOG_OUTER(l), e, i);
    replicate_margins(e, l->width, DOG_INNER(l));
    replicate_margins(i, l->width, DOG_OUTER(l));
}

static void lamina_row(const constants *c, scratch *k, const step_plan *p, int y) {
    const layout *l = c->l;
    const float *e = row_of(&k->inner, y), *i = row_of(&k->outer, y), *change = k->change.first;
    lamina_rows rows = {.kept = {state_row(l, c->planes, l->planes.on, y), state_row(l, c->planes, l->planes.off, y)}};
    if (HAS_FDSR(c))
        rows.adapted = row_of(&k->adapted, y);
    for (int ch = 0; ch < 2 && !HAS_FDSR(c); ch++) {
        rows.apart[ch] = row_of(&k->apart[ch], y);
        rows.before[ch] = row_of(&k->before[ch], y);
    }
    if (!DOG_OUTER(l))
        lamina_row_unfiltered(c->n, change, p, &rows, HAS_FDSR(c));
    else if (KNOWN(l->inner_radius == 2 && l->outer_radius == 4 && c->fdsr, 0))
        lamina_row_as(c->n, e, i, c->inner, 2, c->outer, 4, p, &rows, 1);
    else
        lamina_row_as(c->n, e, i, c->inner, DOG_INNER(l), c->outer, DOG_OUTER(l), p, &rows, HAS_FDSR(c));
    if (HAS_FDSR(c))
        zero_right(rows.adapted, l->width, l->margin);
    for (int ch = 0; ch < 2 && !HAS_FDSR(c); ch++) {
        zero_right(rows.apart[ch], l->width, l->margin);
        zero_right(rows.before[ch], l->width, 0);
    }
    for (int ch = 0; ch < 2; ch++) {
        float *map = tap_row(p, LOBULA_TAP_ADAPTED_ON + ch, l, y);
        for (int x = 0; map && x < l->width; x++)
            map[x] = HAS_FDSR(c) ? part_of(rows.adapted[x], ch == ON ? 1.0f : -1.0f) : rows.apart[ch][x];
    }
    float *map = tap_row(p, LOBULA_TAP_LAMINA, l, y);
    if (map && DOG_OUTER(l))
        edges_map(l->width, e, i, c->inner, DOG_INNER(l), c->outer, DOG_OUTER(l), p->dead_zone, map);
    else
        copy_to_tap(p, LOBULA_TAP_LAMINA, l, y, change);
}

#if defined(LOBULA_LAPTOP)
static void motion_tap(const constants *c, scratch *k, const step_plan *p, int y, const stored *kept) {
    float *map = tap_row(p, LOBULA_TAP_MOTION, c->l, y);
    if (!map) return;
    memset(map, 0, (size_t)c->l->width * sizeof(float));
    const float *before = kept ? stored_row(kept, k->inhibition[0], c->n) : NULL; /* free until the LGMDs come */
    for (int ch = 0; ch < 2; ch++) {
        if (kept)
            emd_map(c->l->width, row_of(&k->adapted, y), before, ch == ON ? 1.0f : -1.0f, p, map);
        else
            emd_map(c->l->width, row_of(&k->apart[ch], y), row_of(&k->before[ch], y), 1.0f, p, map);
    }
}

#endif

static void motion_row(const constants *c, scratch *k, const step_plan *p, int y) {
    const layout *l = c->l;
    stored *kept = HAS_FDSR(c) ? state_row(l, c->planes, l->planes.adapted, y) : NULL;
    float *excitation[E_ROWS] = {NULL};
    for (int i = 0; i < E_ROWS && READ_LAMINA(c); i++) excitation[i] = row_of(&k->excitation[ADAPTED][i], y);
#if defined(LOBULA_LAPTOP)
    motion_tap(c, k, p, y, kept);
#endif
    if (HAS_FDSR(c))
        k->hs = emd_row(c->n, row_of(&k->adapted, y), kept, excitation, p, READ_LAMINA(c), k->hs);
    for (int ch = 0; ch < 2 && !HAS_FDSR(c); ch++) {
        const float *now = row_of(&k->apart[ch], y), *before = row_of(&k->before[ch], y);
        k->hs = emd_row_apart(c->n, now, before, p, k->hs);
        if (!READ_LAMINA(c)) continue;
        memcpy(excitation[ch], now, (size_t)l->width * sizeof(float));
        memcpy(excitation[E_ON_BEFORE + ch], before, (size_t)l->width * sizeof(float));
    }
    for (int i = 0; i < E_ROWS && READ_LAMINA(c); i++)
        replicate_margins(excitation[i], l->width, c->reach[ADAPTED]);
}

static float *excitation_of(const scratch *k, int source, int channel, int before, int y) {
    return row_of(&k->excitation[source][before ? E_ON_BEFORE + channel : channel], y);
}

static float *sums_of(const scratch *k, int j, int y) { return row_of(&k->sums, y) + j * LANES; }

static void sums_map(const constants *c, const step_plan *p, int tap, int y, const float *sums) {
    float *map = tap_row(p, tap, c->l, y);
    for (int x = 0; map && x < c->l->width; x++) map[x] = sums[x / LANES * LANES * SUMS + x % LANES];
}

#if defined(LOBULA_LAPTOP)

static float *weighed_of(const scratch *k, int set, int y) {
    return row_of(&k->weighed[set / 2], y) + set % 2 * LANES;
}

/* One set: weigh row y; the inhibition of row y - spacing is then complete. Past the lower border there is nothing
 * left to weigh. */
static void set_row(const constants *c, scratch *k, const step_plan *p, int set, int y) {
    const inhibition_set *q = &p->set[set];
    int s = q->spacing, mid = y - s, height = c->l->height;
    if (y < height)
        weigh_row(c->n, q, excitation_of(k, q->source, q->channel, 0, y),
                  excitation_of(k, q->source, q->channel, 1, y), weighed_of(k, set, y));
    if (mid < 0) return;
    inhibition_row(c->n, weighed_of(k, set, mid), weighed_of(k, set, clamp(mid - s, height)),
                   weighed_of(k, set, clamp(y, height)), k->inhibition[set]);
    for (int j = 0; j < 2; j++)
        if (p->lgmd[j].set[q->channel] == set)
            copy_to_tap(p, LOBULA_TAP_LGMD1_INHIBITION_ON + 4 * j + q->channel, c->l, mid, k->inhibition[set]);
}

/* Row y of the summation of one LGMD. */
static void add_up(const constants *c, scratch *k, const step_plan *p, int j, int y) {
    const lgmd_plan *q = &p->lgmd[j];
    channel_rows channels[2];
    for (int ch = 0; ch < 2; ch++) {
        channels[ch].excitation = excitation_of(k, c->l->reads[j], ch, 0, y);
        channels[ch].inhibition = q->set[ch] == NO_SET ? NULL : k->inhibition[q->set[ch]];
    }
    sum_row(c->n, q, channels, sums_of(k, j, y));
}

#else

static int alike(const step_plan *p, int channel) {
    int a = p->lgmd[0].set[channel], b = p->lgmd[1].set[channel];
    return a == b || a == NO_SET || b == NO_SET;
}

/* The same of both at once where they read the same rows with the same weights. */
static void add_up(const constants *c, scratch *k, const step_plan *p, int j, int y) {
    const layout *l = c->l;
    int s = l->spacing[j], both = l->reads[0] == l->reads[1] && l->spacing[0] == l->spacing[1] && alike(p, ON) &&
                                  alike(p, OFF) && p->lgmd[0].kind != SUM_NONE && p->lgmd[1].kind != SUM_NONE;
    three_rows rows[2];
    if (both && j == 1) return;
    for (int ch = 0; ch < 2; ch++)
        for (int i = 0; i < 3; i++) {
            int row = clamp(y + (i - 1) * s, l->height);
            rows[ch].now[i] = excitation_of(k, l->reads[j], ch, 0, row);
            rows[ch].before[i] = excitation_of(k, l->reads[j], ch, 1, row);
        }
    sparse_row(c->n, rows, p, j, both ? 1 : j, s, row_of(&k->sums, y));
}

#endif

static real omega(const lgmd_plan *q, float strongest) {
    return q->omega_floor + q->omega_share * (real)strongest;
}

static float threshold(const lgmd_plan *q, float strongest) {
    return (float)(q->threshold_grey * omega(q, strongest));
}

/* What a cell of row y must reach to be listed. It grows with the strongest sum; now and then is often enough. It stays a
 * little below, so that rounding on the way to the final threshold loses nothing. */
static float limit_of(scratch *k, const lgmd_plan *q, int j, int y) {
    if (y % 8 == 1) k->limit[j] = 0.999999f * threshold(q, vf_highest(k->grouped[j].strongest));
    return k->limit[j];
}

/* Row y of the summation, and the column sums it completes (row y - spacing), which on a robot are grouped at once. */
static void summation_row(const constants *c, scratch *k, const step_plan *p, int j, int y) {
    const layout *l = c->l;
    const lgmd_plan *q = &p->lgmd[j];
    int s = l->spacing[j], mid = y - s;
    if (y < l->height) {
        float *sums = sums_of(k, j, y);
        add_up(c, k, p, j, y);
        if (!q->grouping) k->total[j] = total_row(l->width, sums, k->total[j]);
        sums_map(c, p, LOBULA_TAP_LGMD1_SUMMATION + 4 * j, y, sums);
        if (!q->grouping) sums_map(c, p, LOBULA_TAP_LGMD1_GROUPED + 4 * j, y, sums);
    }
    if (!q->grouping || mid < 0) return;
#if defined(LOBULA_LAPTOP)
    float *column = row_of(&k->column[j], mid);
    column_row(c->n, sums_of(k, j, clamp(mid - s, l->height)), sums_of(k, j, mid), sums_of(k, j, clamp(y, l->height)),
               column);
    replicate_margins(column, l->width, s);
#else
    const float *rows[3] = {sums_of(k, j, clamp(mid - s, l->height)), sums_of(k, j, mid),
                            sums_of(k, j, clamp(y, l->height))};
    k->grouped[j] = sparse_group(c->n, rows, s, limit_of(k, q, j, mid), q->list_scale, k->grouped[j]);
#endif
}

#if defined(LOBULA_LAPTOP)

/* All of the above at once, for the usual LGMDs away from the borders: LGMD-1 adds up both channels, LGMD-2 hears OFF
 * only, and OFF is the same for both. */
static void usual_row(const constants *c, scratch *k, const step_plan *p, int y) {
    const inhibition_set *on = &p->set[0], *off = &p->set[1];
    int s = on->spacing, mid = y - s, top = mid - s;
    usual_rows r = {
        .on = {excitation_of(k, on->source, ON, 0, y), excitation_of(k, on->source, ON, 1, y)},
        .off = {excitation_of(k, on->source, OFF, 0, y), excitation_of(k, on->source, OFF, 1, y)},
        .on_middle = excitation_of(k, on->source, ON, 0, mid),
        .off_middle = excitation_of(k, on->source, OFF, 0, mid),
        .weighed = row_of(k->weighed, y),
        .middle = row_of(k->weighed, mid),
        .above = row_of(k->weighed, top),
        .sums = row_of(&k->sums, mid),
        .sums_middle = row_of(&k->sums, top),
        .sums_above = row_of(&k->sums, top - s),
        .column = {row_of(&k->column[0], top), row_of(&k->column[1], top)},
    };
    switch (k->usual) {
    case PLAIN_SAME: usual_row_as(c->n, s, on, on, p->lgmd, &r, 1, 1); break;
    case PLAIN: usual_row_as(c->n, s, on, on, p->lgmd, &r, 1, 0); break;
    default: usual_row_as(c->n, s, on, off, p->lgmd, &r, 0, 0); break;
    }
    for (int j = 0; j < 2; j++) replicate_margins(r.column[j], c->l->width, s);
}

/* Whether usual_row can do it, and how much of it is as plain as in the presets. */
static how_usual usual(const constants *c, const step_plan *p) {
    const lgmd_plan *a = &p->lgmd[0], *b = &p->lgmd[1];
    const inhibition_set *on = &p->set[0], *off = &p->set[1];
    int can = !p->taps && p->sets == 2 && a->kind == SUM_BOTH && b->kind == SUM_OFF && a->set[ON] == 0 &&
              a->set[OFF] == 1 && b->set[OFF] == 1 && a->grouping && b->grouping && c->l->spacing[0] == c->l->spacing[1];
    if (!can) return UNUSUAL;
    int alike = memcmp(on->own, off->own, sizeof on->own) == 0 && memcmp(on->across, off->across, sizeof on->across) == 0;
    if (!alike || a->gain[ON] != 1.0f || a->gain[OFF] != 1.0f || b->gain[OFF] != 1.0f) return USUAL;
    return a->bias[OFF] == b->bias[OFF] ? PLAIN_SAME : PLAIN;
}

#endif

#if defined(LOBULA_LAPTOP)

static grouping_rows rows_to_group(const constants *c, scratch *k, const step_plan *p, int j, int y) {
    float limit = limit_of(k, &p->lgmd[j], j, y);
    grouping_rows r = {sums_of(k, j, y), row_of(&k->column[j], y), c->l->spacing[j], vf_all(limit),
                       vf_all(p->lgmd[j].list_scale)};
    return r;
}

static void grouped_tap(const constants *c, const step_plan *p, int j, int y, const grouping_rows *r) {
    float *map = tap_row(p, LOBULA_TAP_LGMD1_GROUPED + 4 * j, c->l, y);
    for (int x = 0; map && x < c->l->width; x++)
        map[x] = r->sum[x / LANES * LANES * SUMS + x % LANES] *
                 (r->column[x - r->spacing] + r->column[x] + r->column[x + r->spacing]);
}

static void grouping_row(const constants *c, scratch *k, const step_plan *p, int j, int y) {
    grouping_rows r = rows_to_group(c, k, p, j, y);
    k->grouped[j] = group_row(c->l->width, &r, k->grouped[j]);
    grouped_tap(c, p, j, y, &r);
}

static void grouping_row_of_both(const constants *c, scratch *k, const step_plan *p, int y) {
    grouping_rows r[2] = {rows_to_group(c, k, p, 0, y), rows_to_group(c, k, p, 1, y)};
    group_row_of_both(c->l->width, r, k->grouped);
}
#endif

/* Row y of what the LGMDs read is there. */
static void source_row(const constants *c, scratch *k, const step_plan *p, int source, int y) {
    const layout *l = c->l;
    if (y < 0) return;
#if defined(LOBULA_LAPTOP)
    for (int j = 0; j < 2; j++) {
        int row = y - 2 * l->spacing[j] - SETTLE;
        if (l->reads[j] != source || p->lgmd[j].kind == SUM_NONE || !p->lgmd[j].grouping || row < 0 || row >= l->height)
            continue;
        if (k->usual != UNUSUAL && j == 0)
            grouping_row_of_both(c, k, p, row);
        else if (k->usual == UNUSUAL)
            grouping_row(c, k, p, j, row);
    }
    if (k->usual != UNUSUAL && y >= 3 * l->spacing[0] && y < l->height) {
        usual_row(c, k, p, y);
        return;
    }
    for (int i = 0; i < p->sets; i++)
        if (p->set[i].source == source && y < l->height + p->set[i].spacing) set_row(c, k, p, i, y);
#endif
    for (int j = 0; j < 2; j++) {
        int summed = y - l->spacing[j];
        if (l->reads[j] == source && p->lgmd[j].kind != SUM_NONE && summed >= 0 && summed < l->height + l->spacing[j])
            summation_row(c, k, p, j, summed);
    }
}

/* Row y enters; every later layer works on the row that has become possible. What looks along a row comes one push
 * after what wrote it, see SETTLE. */
static void push_row(const constants *c, scratch *k, step_plan *p, int y) {
    const layout *l = c->l;
    int height = l->height, blurred = y - DOG_OUTER(l), laminated = blurred - (DOG_OUTER(l) ? SETTLE : 0);
    int moved = laminated - SETTLE;
    if (READ_LAMINA(c)) source_row(c, k, p, ADAPTED, moved - SETTLE);
    if (READ_CHANGE(c)) source_row(c, k, p, CHANGE, y - SETTLE);
    if (moved >= 0 && moved < height) motion_row(c, k, p, moved);
    if (DOG_OUTER(l) && laminated >= 0 && laminated < height) lamina_row(c, k, p, laminated);
    if (y < height) retina_row(c, k, p, y);
    if (DOG_OUTER(l) && blurred >= 0 && blurred < height) blur_row(c, k, blurred);
    if (!DOG_OUTER(l) && y < height) lamina_row(c, k, p, y);
}

static void begin(const constants *c, scratch *k, const step_plan *p) {
    vd none = {0};
#if defined(LOBULA_LAPTOP)
    k->usual = usual(c, p);
#else
    (void)p;
#endif
    zero_margins(&k->adapted, c->l->margin);
    for (int ch = 0; ch < 2; ch++) zero_margins(&k->apart[ch], c->l->margin);
    k->hs = none;
    for (int j = 0; j < 2; j++) {
        k->total[j] = none;
        k->grouped[j].strongest = vf_all(0.0f);
        k->grouped[j].list = k->list[j];
        k->limit[j] = 0.0f;
    }
}

static void finish(const constants *c, scratch *k, step_plan *p) {
    size_t pixels = (size_t)c->l->width * (size_t)c->l->height;
    p->hs = vd_total(&k->hs);
    for (int j = 0; j < 2; j++) {
        const lgmd_plan *q = &p->lgmd[j];
        float strongest = vf_highest(k->grouped[j].strongest), least = threshold(q, strongest);
        real nine_omega = omega(q, strongest);
        p->total[j] = q->grouping ? total_of_list(k->list[j], k->grouped[j].list, least, q->list_scale) / nine_omega
                                  : vd_total(&k->total[j]);
        float *sum = tap_row(p, LOBULA_TAP_LGMD1_SUMMATION + 4 * j, c->l, 0);
        float *map = tap_row(p, LOBULA_TAP_LGMD1_GROUPED + 4 * j, c->l, 0);
        if (q->kind == SUM_NONE) {
            if (sum) memset(sum, 0, pixels * sizeof(float));
            if (map) memset(map, 0, pixels * sizeof(float));
        } else if (map && q->grouping) {
            for (size_t i = 0; i < pixels; i++) map[i] = map[i] >= least ? map[i] / (float)nine_omega : 0.0f;
        }
    }
}

static constants constants_of(const layout *l, const float *kernel, char *planes) {
    constants c = {.l = l, .n = padded(l->width), .fdsr = l->planes.adapted >= 0, .inner = kernel,
                   .outer = kernel + l->inner_radius + 1, .planes = planes};
    for (int j = 0; j < 2; j++) {
        int source = l->reads[j];
        if (source == CHANGE) c.lgmds_read_change = 1;
        if (source == ADAPTED) c.lgmds_read_lamina = 1;
        if (l->spacing[j] > c.reach[source]) c.reach[source] = l->spacing[j];
    }
    return c;
}

static void sweep(const layout *l, const float *kernel, char *planes, char *workspace, step_plan *plans, int n) {
    scratch k[MAX_FRAMES];
    constants c = constants_of(l, kernel, planes);
    memory m = {workspace, 0};
    int spacing = l->spacing[0] > l->spacing[1] ? l->spacing[0] : l->spacing[1];
    int lag = l->outer_radius + 2 * spacing + 4 * SETTLE;
    for (int t = 0; t < n; t++) {
        scratch_layout(l, &m, &k[t]);
        begin(&c, &k[t], &plans[t]);
    }
    for (int y = 0; y < l->height + lag; y++)
        for (int t = 0; t < n; t++) push_row(&c, &k[t], &plans[t], y);
    for (int t = 0; t < n; t++) finish(&c, &k[t], &plans[t]);
}

static size_t scratch_bytes(const layout *l) {
    scratch k;
    memory m = {NULL, 0};
    scratch_layout(l, &m, &k);
    return m.used;
}

static size_t row_bytes(const layout *l) { return scratch_bytes(l) - 2 * list_bytes(l); }

const kernels KERNELS = {
    ISA_NAME, isa_runs,   scratch_bytes, row_bytes, summarise, largest_change, coverage,
    light,    light_rest, lit_change,    set_luma,  sweep,
#if defined(LOBULA_LAPTOP) && !defined(LOBULA_COMPACT_PLANES)
    in_range, area_average,
#else
    NULL,     NULL,
#endif
};
