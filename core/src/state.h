/* What a network remembers from frame to frame: this header, then kernels, decision window and planes. */
#ifndef LOBULA_STATE_H
#define LOBULA_STATE_H

#include "layout.h"

#define STATE_MAGIC 0x6c6f6275u

typedef struct {
    uint32_t magic, abi;
    int32_t isa, storage;
    int32_t window_count, reserved;
    layout layout;
    lobula_params params;
    lobula_scalars now;
} network_state;

static inline char *state_planes(network_state *s) { return (char *)s + s->layout.planes_at; }
static inline float *state_kernel(network_state *s) { return (float *)(void *)((char *)s + s->layout.kernel_at); }
static inline lobula_decision_entry *state_window(network_state *s) {
    return (lobula_decision_entry *)((char *)s + s->layout.window_at);
}

static inline size_t planes_bytes(const layout *l) {
    return l->luma_bytes + (size_t)l->height * l->record * l->cell_bytes;
}

/* One row of the luma, and of one of the other planes. */
static inline void *luma_row(const layout *l, char *planes, int y) {
    return planes + (size_t)y * (size_t)l->stride * l->pixel_bytes;
}

static inline void *state_row(const layout *l, char *planes, int plane, int y) {
    return planes + l->luma_bytes + ((size_t)y * l->record + (size_t)plane * (size_t)l->stride) * l->cell_bytes;
}

#endif
