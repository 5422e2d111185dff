/* The loops of frames/resize.py: rows are added up first, whole ones as integers, then the sums along the row. */
#ifndef LOBULA_AREA_AVERAGE_H
#define LOBULA_AREA_AVERAGE_H

#include "picture.h"
#include "resize.h"

/* sums = share * row, or added to it. */
INLINE void add_row(const picture *p, int y, float share, float *restrict sums, int n, int fresh) {
    const char *row = picture_row(p, y);
    if (p->type == LOBULA_UINT8) {
        const uint8_t *bytes = (const uint8_t *)row;
        for (int x = 0; x < n; x++) sums[x] = (fresh ? 0.0f : sums[x]) + share * (float)bytes[x];
    } else {
        const float *floats = (const float *)(const void *)row;
        for (int x = 0; x < n; x++) sums[x] = (fresh ? 0.0f : sums[x]) + share * floats[x];
    }
}

/* Rows from y to end, at most 256 of them, each in full. */
static void add_whole_rows(const picture *p, int y, int end, uint16_t *restrict whole, float *restrict sums, int n) {
    memset(whole, 0, (size_t)n * sizeof *whole);
    for (; y + 4 <= end; y += 4) {
        const uint8_t *a = bytes_at(p, y), *b = bytes_at(p, y + 1), *c = bytes_at(p, y + 2), *d = bytes_at(p, y + 3);
        for (int x = 0; x < n; x++) whole[x] = (uint16_t)(whole[x] + a[x] + b[x] + c[x] + d[x]);
    }
    for (; y < end; y++) {
        const uint8_t *a = bytes_at(p, y);
        for (int x = 0; x < n; x++) whole[x] = (uint16_t)(whole[x] + a[x]);
    }
    for (int x = 0; x < n; x++) sums[x] += (float)whole[x];
}

static void add_rows(const picture *p, const span *rows, uint16_t *whole, float *sums, int n) {
    add_row(p, rows->first, rows->first_share, sums, n, 1);
    if (rows->last > rows->first) add_row(p, rows->last, rows->last_share, sums, n, 0);
    if (p->type == LOBULA_UINT8) {
        for (int y = rows->first + 1; y < rows->last; y += 256)
            add_whole_rows(p, y, y + 256 < rows->last ? y + 256 : rows->last, whole, sums, n);
    } else {
        for (int y = rows->first + 1; y < rows->last; y++) add_row(p, y, 1.0f, sums, n, 0);
    }
}

static void area_average(resize_plan *r, picture crop, float *out) {
    const lobula_resize_spec *s = &r->spec;
    const span *rows = (const span *)(const void *)((char *)r + r->rows_at);
    const span *columns = (const span *)(const void *)((char *)r + r->columns_at);
    float *sums = (float *)(void *)((char *)r + r->sums_at);
    uint16_t *whole = (uint16_t *)(void *)((char *)r + r->whole_at);
    float scale = (float)(s->gain * s->out_width / s->crop_width * s->out_height / s->crop_height);
    float offset = (float)s->offset;
    for (int y = 0; y < s->out_height; y++, out += s->out_width) {
        add_rows(&crop, &rows[y], whole, sums, s->crop_width);
        for (int x = 0; x < s->out_width; x++) {
            const span *c = &columns[x];
            float sum = c->first_share * sums[c->first] + c->last_share * sums[c->last];
            for (int i = c->first + 1; i < c->last; i++) sum += sums[i];
            float mean = scale * sum + offset;
            out[x] = mean < 0.0f ? 0.0f : mean > 255.0f ? 255.0f : mean;
        }
    }
}

#endif
