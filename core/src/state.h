/* What a network remembers from frame to frame: this header, then kernels, decision window and planes. */
#ifndef LOBULA_STATE_H
#define LOBULA_STATE_H

#include "layout.h"

#define STATE_MAGIC 0x6c6f6275u

typedef struct {
    uint32_t magic, abi;
    int32_t isa;
    int32_t window_count;
    layout layout;
    lobula_params params;
    lobula_scalars now;
} lobula_state;

static inline float *state_planes(lobula_state *s) { return (float *)((char *)s + s->layout.planes_at); }
static inline const float *state_kernel(const lobula_state *s) {
    return (const float *)((const char *)s + s->layout.kernel_at);
}
static inline lobula_decision_entry *state_window(lobula_state *s) {
    return (lobula_decision_entry *)((char *)s + s->layout.window_at);
}

static inline size_t planes_floats(const layout *l) { return l->luma + (size_t)l->height * l->record; }

/* One row of the luma, and of one of the other planes. */
static inline float *luma_row(const layout *l, float *planes, int y) { return planes + (size_t)y * (size_t)l->stride; }

static inline float *state_row(const layout *l, float *planes, int plane, int y) {
    return planes + l->luma + (size_t)y * l->record + (size_t)plane * (size_t)l->stride;
}

#endif
