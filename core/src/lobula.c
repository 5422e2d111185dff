/* Sizes, and a network's life outside its steps: made, emptied, saved, loaded. */
#include "lobula.h"

#include <string.h>

#include "network.h"
#include "state.h"
#include "storage.h"
#include "sweep.h"

int lobula_abi(void) { return LOBULA_ABI; }

size_t lobula_params_size(void) { return sizeof(lobula_params); }

size_t lobula_state_size(const lobula_params *p, int width, int height, int storage) {
    layout l;
    return p && layout_init(&l, p, width, height, storage) == LOBULA_OK ? l.state_bytes : 0;
}

size_t lobula_workspace_size(const lobula_params *p, int width, int height, int storage, int frames) {
    layout l;
    if (!p || frames < 1 || layout_init(&l, p, width, height, storage) != LOBULA_OK) return 0;
    const kernels *k = kernels_of(0, storage); /* all of them lay it out alike */
    return k->scratch_bytes(&l) * (size_t)(frames < MAX_FRAMES ? frames : MAX_FRAMES);
}

int lobula_block_frames(const lobula_params *p, int width, int height, int storage) {
    /* A processor's own cache, not the one it shares: the state should not need to leave it, or else the rows at work
     * of all frames should fit it beside the state's present ones. */
    const size_t cache = (size_t)2 << 20;
    layout l;
    if (!p || layout_init(&l, p, width, height, storage) != LOBULA_OK || l.state_bytes <= cache) return 1;
    size_t frames = cache / 2 / kernels_of(0, storage)->row_bytes(&l);
    return frames < 1 ? 1 : frames > 8 ? 8 : (int)frames;
}

int lobula_init(void *state, const lobula_params *p, int width, int height, int storage, int isa) {
    if (!state || !p) return LOBULA_BAD_ARGUMENT;
    if (isa == LOBULA_ISA_AUTO) isa = lobula_isa_best();
    layout l;
    if (!lobula_isa_runs(isa) || layout_init(&l, p, width, height, storage) != LOBULA_OK) return LOBULA_BAD_ARGUMENT;
    network_init(state, p, &l, isa, storage);
    return LOBULA_OK;
}

static network_state *checked(const void *state) {
    network_state *s = (network_state *)state;
    return s && s->magic == STATE_MAGIC && s->abi == LOBULA_ABI ? s : NULL;
}

int lobula_reset(void *state) {
    network_state *s = checked(state);
    if (!s) return LOBULA_BAD_STATE;
    network_reset(s);
    return LOBULA_OK;
}

enum { NOT_KEPT = -1, LUMA = -2 };

/* Where a public plane is kept: in which one of the state, and which sign of it. */
typedef struct {
    int plane;
    float sign; /* 0: as it is */
} place;

static place place_of(const layout *l, int plane) {
    place none = {NOT_KEPT, 0.0f}, p = none;
    switch (plane) {
    case LOBULA_PLANE_LUMA: p.plane = LUMA; break;
    case LOBULA_PLANE_ON: p.plane = l->planes.on; break;
    case LOBULA_PLANE_OFF: p.plane = l->planes.off; break;
    case LOBULA_PLANE_ADAPTED_ON:
    case LOBULA_PLANE_ADAPTED_OFF: {
        int on = plane == LOBULA_PLANE_ADAPTED_ON;
        if (l->planes.adapted < 0) return place_of(l, on ? LOBULA_PLANE_ON : LOBULA_PLANE_OFF);
        p.plane = l->planes.adapted;
        p.sign = on ? 1.0f : -1.0f;
        break;
    }
    case LOBULA_PLANE_CHANGE_ON: p.plane = l->planes.change; break;
    case LOBULA_PLANE_CHANGE_OFF: p.plane = l->planes.change < 0 ? NOT_KEPT : l->planes.change + 1; break;
    default: break;
    }
    return p;
}

static char *row_in(network_state *s, place p, int y) {
    return p.plane == LUMA ? luma_row(&s->layout, state_planes(s), y)
                           : state_row(&s->layout, state_planes(s), p.plane, y);
}

/* Cell `x` of such a row. */
static float cell_of(const char *row, size_t bytes, int x) {
    return bytes == sizeof(float)  ? ((const float *)(const void *)row)[x]
           : bytes == sizeof(half16) ? float_of(((const half16 *)(const void *)row)[x])
                                   : (float)((const uint8_t *)row)[x];
}

static void set_cell(char *row, size_t bytes, int x, float value) {
    if (bytes == sizeof(float))
        ((float *)(void *)row)[x] = value;
    else if (bytes == sizeof(half16))
        ((half16 *)(void *)row)[x] = half_of(value);
    else
        ((uint8_t *)row)[x] = (uint8_t)(value + 0.5f);
}

static size_t bytes_in(const layout *l, place p) { return p.plane == LUMA ? l->pixel_bytes : l->cell_bytes; }

int lobula_get_plane(const void *state, int plane, float *out) {
    network_state *s = checked(state);
    if (!s) return LOBULA_BAD_STATE;
    if (plane < 0 || plane >= LOBULA_PLANES || !out) return LOBULA_BAD_ARGUMENT;
    const layout *l = &s->layout;
    place p = place_of(l, plane);
    for (int y = 0; y < l->height; y++, out += l->width) {
        const char *row = p.plane == NOT_KEPT ? NULL : row_in(s, p, y);
        for (int x = 0; x < l->width; x++) {
            float value = row ? cell_of(row, bytes_in(l, p), x) : 0.0f;
            out[x] = p.sign == 0.0f ? value : p.sign * value > 0.0f ? p.sign * value : 0.0f;
        }
    }
    return LOBULA_OK;
}

int lobula_set_plane(void *state, int plane, const float *in) {
    network_state *s = checked(state);
    if (!s) return LOBULA_BAD_STATE;
    if (plane < 0 || plane >= LOBULA_PLANES || !in) return LOBULA_BAD_ARGUMENT;
    const layout *l = &s->layout;
    place p = place_of(l, plane);
    if (p.plane == NOT_KEPT) return LOBULA_OK;
    if (l->planes.adapted < 0 && (plane == LOBULA_PLANE_ADAPTED_ON || plane == LOBULA_PLANE_ADAPTED_OFF))
        return LOBULA_OK; /* without adaptation they are the channels themselves */
    for (int y = 0; y < l->height; y++, in += l->width) {
        char *row = row_in(s, p, y);
        size_t bytes = bytes_in(l, p);
        for (int x = 0; x < l->width; x++) {
            /* ON and OFF share a plane: each replaces only its own sign */
            if (p.sign == 0.0f)
                set_cell(row, bytes, x, in[x]);
            else if (in[x] != 0.0f || p.sign * cell_of(row, bytes, x) > 0.0f)
                set_cell(row, bytes, x, p.sign * in[x]);
        }
    }
    return LOBULA_OK;
}

int lobula_get_scalars(const void *state, lobula_scalars *out) {
    network_state *s = checked(state);
    if (!s || !out) return s ? LOBULA_BAD_ARGUMENT : LOBULA_BAD_STATE;
    *out = s->now;
    return LOBULA_OK;
}

int lobula_set_scalars(void *state, const lobula_scalars *in) {
    network_state *s = checked(state);
    if (!s || !in) return s ? LOBULA_BAD_ARGUMENT : LOBULA_BAD_STATE;
    s->now = *in;
    return LOBULA_OK;
}

int lobula_window_capacity(const void *state) { return checked(state) ? checked(state)->layout.window_capacity : 0; }

int lobula_window_count(const void *state) { return checked(state) ? checked(state)->window_count : 0; }

int lobula_get_window(const void *state, lobula_decision_entry *out) {
    network_state *s = checked(state);
    if (!s || !out) return s ? LOBULA_BAD_ARGUMENT : LOBULA_BAD_STATE;
    memcpy(out, state_window(s), (size_t)s->window_count * sizeof *out);
    return LOBULA_OK;
}

int lobula_set_window(void *state, const lobula_decision_entry *in, int count) {
    network_state *s = checked(state);
    if (!s) return LOBULA_BAD_STATE;
    if (count < 0 || count > s->layout.window_capacity || (count && !in)) return LOBULA_BAD_ARGUMENT;
    if (count) memcpy(state_window(s), in, (size_t)count * sizeof *in);
    s->window_count = count;
    return LOBULA_OK;
}
