/* model/retina.py: the change of the picture, a row at a time, and what one look at all of it tells. */
#ifndef LOBULA_RETINA_H
#define LOBULA_RETINA_H

#include "picture.h"
#include "scratch.h"
#include "storage.h"

/* A row of the retina: the luma and the channels of the change in the state, this step's over the one before; the
 * change; what excites the LGMDs, where they read it; and the sums down the columns of the patches. */
typedef struct {
    stored_luma *luma;
    stored *kept[2];
    float *change, *excitation[E_ROWS], *columns;
} retina_rows;

/* What a vector needs of the plan, as vectors. */
typedef struct {
    vf scale, gain, offset, residual, limit;
} retina_constants;

INLINE void excite(int x, vf signal, vf residual, stored *kept, float *now_row, float *before_row) {
    vf before = stored_load(kept + x), now = signal + residual * before;
    stored_store(kept + x, now);
    vf_store(now_row + x, now);
    vf_store(before_row + x, before);
}

/* What a row is made with, known when it is compiled: the old light is another one; the LGMDs read the change; patches
 * are heard and the change saturates. */
enum { FLASH = 1, EXCITES = 2, COARSE = 4 };

/* model.retina.frame_difference and saturate, and where the LGMDs read it its ON and OFF channels
 * (model.lamina.on_off) */
INLINE void retina_vector(int x, vf now, const retina_constants *c, const retina_rows *r, int what) {
    vf luma = luma_load(r->luma + x), zero = vf_all(0.0f);
    if (what & FLASH) luma = c->gain * luma + c->offset;
    vf change = (now - luma) * c->scale;
    if (what & COARSE) {
        vf_store(r->columns + x, vf_load(r->columns + x) + change);
        change = vf_max(zero - c->limit, vf_min(change, c->limit));
    }
    luma_store(r->luma + x, now);
    vf_store(r->change + x, change);
    if (what & EXCITES) {
        excite(x, vf_above_zero(change), c->residual, r->kept[ON], r->excitation[E_ON], r->excitation[E_ON_BEFORE]);
        excite(x, vf_above_zero(zero - change), c->residual, r->kept[OFF], r->excitation[E_OFF],
               r->excitation[E_OFF_BEFORE]);
    }
}

INLINE void retina_row_as(int width, const step_plan *p, const char *image, int type, const retina_rows *rows, int what) {
    int whole = width / LANES * LANES;
    retina_rows r = *rows;
    retina_constants c = {vf_all(p->scale), vf_all(p->gain), vf_all(p->offset), vf_all(p->residual), vf_all(p->limit)};
    for (int x = 0; x < whole; x += LANES) retina_vector(x, pixels_at(image, type, x), &c, &r, what);
    if (whole < width) retina_vector(whole, last_pixels(image, type, whole, width), &c, &r, what);
}

INLINE void retina_row_of(int width, const step_plan *p, const char *image, const retina_rows *r, int what) {
    if (p->flash)
        retina_row_as(width, p, image, kind_of(&p->image), r, what | FLASH);
    else if (kind_of(&p->image) == LOBULA_UINT8)
        retina_row_as(width, p, image, LOBULA_UINT8, r, what);
    else
        retina_row_as(width, p, image, LOBULA_FLOAT32, r, what);
}

static void retina_row_excites(int width, const step_plan *p, const char *image, const retina_rows *r) {
    retina_row_of(width, p, image, r, EXCITES);
}

static void retina_row_alone(int width, const step_plan *p, const char *image, const retina_rows *r) {
    retina_row_of(width, p, image, r, 0);
}

static void retina_row_coarse(int width, const step_plan *p, const char *image, const retina_rows *r, int excites) {
    if (excites)
        retina_row_of(width, p, image, r, EXCITES | COARSE);
    else
        retina_row_of(width, p, image, r, COARSE);
}

/* model/medulla/coarse.py: the patches that are complete, from their sums down the columns. */
static void hear_patches(int width, const step_plan *p, const float *columns, real patches[2]) {
    int side = p->patch;
    float pixels = (float)(side * side), floor = p->patch_floor * pixels;
    for (int left = 0; left + side <= width; left += side) {
        float sum = 0.0f;
        for (int x = left; x < left + side; x++) sum += columns[x];
        if (sum > floor) patches[ON] += (real)(sum - floor);
        if (-sum > floor) patches[OFF] += (real)(-sum - floor);
    }
}

typedef struct {
    vf sum, magnitude;
} row_change;

INLINE void add_change(row_change *r, vf change) {
    r->sum += change;
    r->magnitude += vf_abs(change);
}

enum { EXACT_SUM = 256 }; /* changes that are added up in float before they join a double */

/* model.retina.change_statistics, what every step needs of it */
INLINE change_summary summarise_as(extent e, picture image, int type, picture previous, int type_before) {
    const row_change nothing = {vf_all(0.0f), vf_all(0.0f)};
    vd sum = {0}, magnitude = {0};
    row_change r = nothing;
    int whole = e.width / LANES * LANES, added = 0;
    for (int y = 0; y < e.height; y++) {
        const char *now = picture_row(&image, y), *before = picture_row(&previous, y);
        for (int x = 0; x < whole; x += LANES) add_change(&r, pixels_at(now, type, x) - pixels_at(before, type_before, x));
        if (whole < e.width)
            add_change(&r, last_pixels(now, type, whole, e.width) - last_pixels(before, type_before, whole, e.width));
        added += e.width;
        if (added > EXACT_SUM * LANES - e.width || y == e.height - 1) {
            vd_add(&sum, r.sum);
            vd_add(&magnitude, r.magnitude);
            r = nothing;
            added = 0;
        }
    }
    real pixels = (real)e.width * (real)e.height;
    change_summary s = {vd_total(&sum) / pixels, vd_total(&magnitude) / pixels};
    return s;
}

/* The same of bytes, in whole numbers. */
static change_summary summarise_bytes(extent e, picture image, picture previous) {
    int64_t sum = 0, magnitude = 0;
    for (int y = 0; y < e.height; y++) {
        const uint8_t *now = bytes_at(&image, y), *before = bytes_at(&previous, y);
        int32_t row_sum = 0, row_magnitude = 0;
        for (int x = 0; x < e.width; x++) {
            int32_t change = now[x] - before[x];
            row_sum += change;
            row_magnitude += change < 0 ? -change : change;
        }
        sum += row_sum;
        magnitude += row_magnitude;
    }
    real pixels = (real)e.width * (real)e.height;
    change_summary s = {real_of(sum) / pixels, real_of(magnitude) / pixels};
    return s;
}

static change_summary summarise(extent e, picture image, picture previous) {
    int bytes = kind_of(&image) == LOBULA_UINT8 && kind_of(&previous) == LOBULA_UINT8;
    if (bytes && LANES == 1) return summarise_bytes(e, image, previous);
    if (bytes)
        return summarise_as(e, image, LOBULA_UINT8, previous, LOBULA_UINT8);
    if (kind_of(&image) == LOBULA_UINT8) return summarise_as(e, image, LOBULA_UINT8, previous, LOBULA_FLOAT32);
    return summarise_as(e, image, LOBULA_FLOAT32, previous, LOBULA_FLOAT32);
}

INLINE real pixel(const picture *p, int y, int x) {
    const char *row = picture_row(p, y);
    return kind_of(p) == LOBULA_UINT8 ? (real)((const uint8_t *)row)[x] : (real)((const float *)(const void *)row)[x];
}

/* The largest magnitude; asked for only where the mean says that the picture could be a repeat. */
static real largest_change(extent e, picture image, picture previous) {
    vf highest = vf_all(0.0f);
    int whole = e.width / LANES * LANES, now_type = kind_of(&image), before_type = kind_of(&previous);
    for (int y = 0; y < e.height; y++) {
        const char *now = picture_row(&image, y), *before = picture_row(&previous, y);
        for (int x = 0; x < whole; x += LANES)
            highest = vf_max(highest, vf_abs(pixels_at(now, now_type, x) - pixels_at(before, before_type, x)));
        if (whole < e.width)
            highest = vf_max(highest, vf_abs(last_pixels(now, now_type, whole, e.width) -
                                             last_pixels(before, before_type, whole, e.width)));
    }
    return (real)vf_highest(highest);
}

typedef struct {
    vf brighter, darker;
} row_count;

INLINE void count_change(row_count *c, vf change) {
    vf half = vf_all(0.5f), one = vf_all(1.0f);
    c->brighter += vf_keep(vf_gt(change, half), one);
    c->darker += vf_keep(vf_gt(vf_all(0.0f) - change, half), one);
}

/* The rest of model.retina.change_statistics; asked for only where the mean change could be a flash. */
static void coverage(extent e, picture image, picture previous, int32_t *brighter, int32_t *darker) {
    vd brighter_sum = {0}, darker_sum = {0};
    int whole = e.width / LANES * LANES, now_type = kind_of(&image), before_type = kind_of(&previous);
    for (int y = 0; y < e.height; y++) {
        const char *now = picture_row(&image, y), *before = picture_row(&previous, y);
        row_count c = {vf_all(0.0f), vf_all(0.0f)};
        for (int x = 0; x < whole; x += LANES)
            count_change(&c, pixels_at(now, now_type, x) - pixels_at(before, before_type, x));
        if (whole < e.width)
            count_change(&c, last_pixels(now, now_type, whole, e.width) - last_pixels(before, before_type, whole, e.width));
        vd_add(&brighter_sum, c.brighter);
        vd_add(&darker_sum, c.darker);
    }
    *brighter = (int32_t)vd_total(&brighter_sum);
    *darker = (int32_t)vd_total(&darker_sum);
}

/* The sums behind the least squares of model.retina.find_flash, of bytes. */
static light_sums light_of_bytes(extent e, picture image, picture previous, real limit) {
    int64_t count = 0, new_sum = 0, old_sum = 0, old_old = 0, new_old = 0, change_change = 0;
    int32_t most = limit < (real)255 ? (int32_t)limit : 255;
    for (int y = 0; y < e.height; y++) {
        const uint8_t *now = bytes_at(&image, y), *before = bytes_at(&previous, y);
        for (int x = 0; x < e.width; x++) {
            int32_t new_ = now[x], old = before[x], change = new_ - old;
            if (change > most || change < -most) continue;
            count++;
            new_sum += new_;
            old_sum += old;
            old_old += old * old;
            new_old += new_ * old;
            change_change += change * change;
        }
    }
    light_sums s = {real_of(count), real_of(new_sum), real_of(old_sum), real_of(old_old), real_of(new_old),
                    real_of(change_change)};
    return s;
}

static light_sums light(extent e, picture image, picture previous, real limit) {
    if (kind_of(&image) == LOBULA_UINT8 && kind_of(&previous) == LOBULA_UINT8)
        return light_of_bytes(e, image, previous, limit);
    light_sums s = {0};
    for (int y = 0; y < e.height; y++)
        for (int x = 0; x < e.width; x++) {
            real new_ = pixel(&image, y, x), old = pixel(&previous, y, x), change = new_ - old;
            if (real_abs(change) > limit) continue;
            s.count += 1;
            s.new_sum += new_;
            s.old_sum += old;
            s.old_old += old * old;
            s.new_old += new_ * old;
            s.change_change += change * change;
        }
    return s;
}

static real light_rest(extent e, picture image, picture previous, real limit, real gain, real offset) {
    real rest = 0;
    for (int y = 0; y < e.height; y++)
        for (int x = 0; x < e.width; x++) {
            real new_ = pixel(&image, y, x), old = pixel(&previous, y, x);
            real error = new_ - gain * old - offset;
            if (real_abs(new_ - old) <= limit) rest += error * error;
        }
    return rest;
}

static real lit_change(extent e, picture image, picture previous, float gain, float offset) {
    real sum = 0;
    for (int y = 0; y < e.height; y++)
        for (int x = 0; x < e.width; x++)
            sum += real_abs((real)((float)pixel(&image, y, x) - (gain * (float)pixel(&previous, y, x) + offset)));
    return sum / ((real)e.width * (real)e.height);
}

static void set_luma(const layout *l, picture image, char *planes) {
    for (int y = 0; y < l->height; y++) {
        stored_luma *luma = luma_row(l, planes, y);
        for (int x = 0; x < l->width; x++) luma[x] = (stored_luma)pixel(&image, y, x);
    }
}

#if defined(LOBULA_LAPTOP) && !defined(LOBULA_COMPACT_PLANES)
/* Floats in 0..255 are, as integers, at most 255.0f; NaN, infinity and negatives are more. -0 counts as outside. */
static int in_range(extent e, picture image) {
    uint32_t most = 0;
    for (int y = 0; y < e.height; y++) {
        const char *row = picture_row(&image, y);
        for (int x = 0; x < e.width; x++) {
            uint32_t bits;
            memcpy(&bits, row + (ptrdiff_t)x * 4, 4);
            most = bits > most ? bits : most;
        }
    }
    return most <= 0x437f0000u;
}
#endif

#endif
