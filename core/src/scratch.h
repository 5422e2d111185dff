/* The rows at work: rings of a few rows each, so that a step never leaves the cache. */
#ifndef LOBULA_SCRATCH_H
#define LOBULA_SCRATCH_H

#include "state.h"
#include "sweep.h"
#include "storage.h"
#include "vector.h"

/* Rows that were just written are read at unaligned places by the filters; reading them one row later lets the
 * stores settle. */
#define SETTLE 1

/* `rows` rows of `stride` floats, a power of two; row y is kept until row y + rows comes. */
typedef struct {
    float *first;
    unsigned rows;
    int stride;
} ring;

enum { E_ON, E_OFF, E_ON_BEFORE, E_OFF_BEFORE, E_ROWS };

/* The grouping of one LGMD so far: the largest 3 x 3 sums, and the end of its list. */
typedef struct {
    vf strongest;
    stored *list;
} grouped;

/* What usual.h can do: nothing; the LGMDs of the presets; those with plain gains; those with one bias besides. */
typedef enum { UNUSUAL, USUAL, PLAIN, PLAIN_SAME } how_usual;

typedef struct {
    ring change; /* as many rows as the DoG looks at, not a power of two; see window_of */
    float *columns; /* the change, added up down the columns of the patches at work */
    ring inner, outer; /* blurred down the columns */
    ring adapted; /* ON less OFF; zero margins */
    ring apart[2], before[2]; /* where adaptation is off: both channels, and one step ago */
    ring excitation[SOURCES][E_ROWS]; /* what the LGMDs read, edges repeated outwards */
#if defined(LOBULA_LAPTOP)
    ring weighed[MAX_SETS / 2]; /* two sets in each, see lateral_inhibition.h */
    float *inhibition[MAX_SETS]; /* one row of I of each set */
#endif
    ring sums; /* of both LGMDs, see grouping.h */
#if defined(LOBULA_LAPTOP)
    ring column[2]; /* three rows of the summation, added up */
#endif
    stored *list[2]; /* vectors of grouped cells that may reach the threshold */
    grouped grouped[2];
    float limit[2]; /* what such a cell must reach, as far as is known */
    how_usual usual;
    vd hs;
    vd total[2];
} scratch;

static inline float *row_of(const ring *r, int y) {
    return r->first + (size_t)((unsigned)y & (r->rows - 1u)) * (size_t)r->stride;
}

static inline int clamp(int y, int height) { return y < 0 ? 0 : y >= height ? height - 1 : y; }

/* The rows y - R to y + R of a ring of 2 R + 1, those outside the picture being its first or last one. */
static inline void window_of(const ring *r, int y, int R, int height, float **rows) {
    int from = clamp(y - R, height);
    float *row = r->first + (size_t)((unsigned)from % r->rows) * (size_t)r->stride;
    const float *end = r->first + (size_t)r->rows * (size_t)r->stride;
    for (int i = -R; i <= R; i++) {
        *rows++ = row;
        if (y + i < 0 || y + i >= height - 1) continue;
        row += r->stride;
        if (row == end) row = r->first;
    }
}

/* The workspace as it is dealt out; without a base it is only measured. */
typedef struct {
    char *base;
    size_t used;
} memory;

static inline float *take(memory *m, size_t floats) {
    float *at = m->base ? (float *)(void *)(m->base + m->used) : NULL;
    m->used += floats * sizeof(float);
    return at;
}

static inline ring take_ring(memory *m, int rows, int stride, int margin) {
    float *first = take(m, (size_t)rows * (size_t)stride);
    ring r = {first ? first + margin : NULL, (unsigned)rows, stride};
    return r;
}

static inline ring take_long(memory *m, const layout *l, int rows) { return take_ring(m, rows, l->long_row, l->margin); }

static inline ring take_short(memory *m, const layout *l, int rows) { return take_ring(m, rows, l->stride, 0); }

static inline size_t list_bytes(const layout *l) {
    size_t bytes = ((size_t)l->height * (size_t)l->stride + ROW_FLOATS) * sizeof(stored);
    return (bytes + 7) / 8 * 8; /* floats may follow */
}

static inline stored *take_list(memory *m, const layout *l) {
    stored *at = m->base ? (stored *)(void *)(m->base + m->used) : NULL;
    m->used += list_bytes(l);
    return at;
}

/* The rows of one frame at work. */
static inline void scratch_layout(const layout *l, memory *m, scratch *s) {
    int fdsr = l->planes.adapted >= 0;
    s->change = take_short(m, l, 2 * l->outer_radius + 1);
    s->columns = take(m, (size_t)l->stride);
    s->inner = take_long(m, l, l->outer_radius ? 2 : 0);
    s->outer = take_long(m, l, l->outer_radius ? 2 : 0);
    s->adapted = take_long(m, l, fdsr ? 2 : 0);
    for (int c = 0; c < 2; c++) {
        s->apart[c] = take_long(m, l, fdsr ? 0 : 2);
        s->before[c] = take_long(m, l, fdsr ? 0 : 2);
    }
    for (int source = 0; source < SOURCES; source++)
        for (int k = 0; k < E_ROWS; k++) {
            int read = l->reads[0] == source || l->reads[1] == source;
            s->excitation[source][k] = take_long(m, l, !read ? 0 : k < E_ON_BEFORE ? l->excited : l->excited_before);
        }
#if defined(LOBULA_LAPTOP)
    for (int k = 0; k < MAX_SETS / 2; k++) s->weighed[k] = take_ring(m, l->ring, 4 * l->stride, 0);
    for (int k = 0; k < MAX_SETS; k++) s->inhibition[k] = take(m, (size_t)l->stride);
#endif
    s->sums = take_ring(m, l->ring, 2 * l->stride, 0);
#if defined(LOBULA_LAPTOP)
    for (int j = 0; j < 2; j++) s->column[j] = take_long(m, l, 2);
#endif
    m->used = (m->used + 7) / 8 * 8;
    for (int j = 0; j < 2; j++) s->list[j] = take_list(m, l); /* last: see robot/lobula.c */
}

#endif
