/* Sizes, and a network's life outside its steps: made, emptied, saved, loaded. */
#include "lobula.h"

#include <math.h>
#include <string.h>

#include "state.h"
#include "sweep.h"

int lobula_abi(void) { return LOBULA_ABI; }

size_t lobula_params_size(void) { return sizeof(lobula_params); }

size_t lobula_state_size(const lobula_params *p, int width, int height) {
    layout l;
    return p && layout_init(&l, p, width, height) == LOBULA_OK ? l.state_bytes : 0;
}

size_t lobula_workspace_size(const lobula_params *p, int width, int height, int frames) {
    layout l;
    if (!p || frames < 1 || layout_init(&l, p, width, height) != LOBULA_OK) return 0;
    const kernels *k = kernels_of(0); /* all of them lay it out alike */
    return k->scratch_bytes(&l) * (size_t)(frames < MAX_FRAMES ? frames : MAX_FRAMES);
}

int lobula_block_frames(const lobula_params *p, int width, int height) {
    /* A processor's own cache, not the one it shares: the state should not need to leave it, or else the rows at work
     * of all frames should fit it beside the state's present ones. */
    const size_t cache = (size_t)2 << 20;
    layout l;
    if (!p || layout_init(&l, p, width, height) != LOBULA_OK || l.state_bytes <= cache) return 1;
    size_t frames = cache / 2 / kernels_of(0)->row_bytes(&l);
    return frames < 1 ? 1 : frames > 8 ? 8 : (int)frames;
}

/* model.lamina.dog.gaussian_kernel, from the centre outwards */
static void gaussian_kernel(int radius, double sigma, float *weights) {
    double total = 1.0;
    for (int i = 1; i <= radius; i++) total += 2.0 * exp(-0.5 * (i / sigma) * (i / sigma));
    for (int i = 0; i <= radius; i++) weights[i] = (float)(exp(-0.5 * (i / sigma) * (i / sigma)) / total);
}

int lobula_init(void *state, const lobula_params *p, int width, int height, int isa) {
    lobula_state *s = state;
    if (!state || !p) return LOBULA_BAD_ARGUMENT;
    if (isa == LOBULA_ISA_AUTO) isa = lobula_isa_best();
    layout l;
    if (!lobula_isa_runs(isa) || layout_init(&l, p, width, height) != LOBULA_OK) return LOBULA_BAD_ARGUMENT;
    memset(s, 0, sizeof *s);
    s->magic = STATE_MAGIC;
    s->abi = LOBULA_ABI;
    s->isa = isa;
    s->layout = l;
    s->params = *p;
    float *kernel = (float *)(void *)((char *)state + l.kernel_at);
    double sigma = p->lamina.dog.sigma_px;
    gaussian_kernel(l.inner_radius, sigma, kernel);
    gaussian_kernel(l.outer_radius, sigma * p->lamina.dog.surround, kernel + l.inner_radius + 1);
    return lobula_reset(state);
}

static lobula_state *checked(const void *state) {
    lobula_state *s = (lobula_state *)state;
    return s && s->magic == STATE_MAGIC && s->abi == LOBULA_ABI ? s : NULL;
}

int lobula_reset(void *state) {
    lobula_state *s = checked(state);
    if (!s) return LOBULA_BAD_STATE;
    lobula_scalars none = {0};
    none.lgmd1.raw = none.lgmd1.potential = none.lgmd2.raw = none.lgmd2.potential = 0.5;
    s->now = none;
    s->window_count = 0;
    memset(state_planes(s), 0, planes_floats(&s->layout) * sizeof(float));
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

static float *row_in(lobula_state *s, place p, int y) {
    return p.plane == LUMA ? luma_row(&s->layout, state_planes(s), y)
                           : state_row(&s->layout, state_planes(s), p.plane, y);
}

int lobula_get_plane(const void *state, int plane, float *out) {
    lobula_state *s = checked(state);
    if (!s) return LOBULA_BAD_STATE;
    if (plane < 0 || plane >= LOBULA_PLANES || !out) return LOBULA_BAD_ARGUMENT;
    const layout *l = &s->layout;
    place p = place_of(l, plane);
    for (int y = 0; y < l->height; y++, out += l->width) {
        const float *row = p.plane == NOT_KEPT ? NULL : row_in(s, p, y);
        for (int x = 0; x < l->width; x++) {
            float value = row ? row[x] : 0.0f;
            out[x] = p.sign == 0.0f ? value : p.sign * value > 0.0f ? p.sign * value : 0.0f;
        }
    }
    return LOBULA_OK;
}

int lobula_set_plane(void *state, int plane, const float *in) {
    lobula_state *s = checked(state);
    if (!s) return LOBULA_BAD_STATE;
    if (plane < 0 || plane >= LOBULA_PLANES || !in) return LOBULA_BAD_ARGUMENT;
    const layout *l = &s->layout;
    place p = place_of(l, plane);
    if (p.plane == NOT_KEPT) return LOBULA_OK;
    if (l->planes.adapted < 0 && (plane == LOBULA_PLANE_ADAPTED_ON || plane == LOBULA_PLANE_ADAPTED_OFF))
        return LOBULA_OK; /* without adaptation they are the channels themselves */
    for (int y = 0; y < l->height; y++, in += l->width) {
        float *row = row_in(s, p, y);
        for (int x = 0; x < l->width; x++) {
            /* ON and OFF share a plane: each replaces only its own sign */
            if (p.sign == 0.0f)
                row[x] = in[x];
            else if (in[x] != 0.0f || p.sign * row[x] > 0.0f)
                row[x] = p.sign * in[x];
        }
    }
    return LOBULA_OK;
}

int lobula_get_scalars(const void *state, lobula_scalars *out) {
    lobula_state *s = checked(state);
    if (!s || !out) return s ? LOBULA_BAD_ARGUMENT : LOBULA_BAD_STATE;
    *out = s->now;
    return LOBULA_OK;
}

int lobula_set_scalars(void *state, const lobula_scalars *in) {
    lobula_state *s = checked(state);
    if (!s || !in) return s ? LOBULA_BAD_ARGUMENT : LOBULA_BAD_STATE;
    s->now = *in;
    return LOBULA_OK;
}

int lobula_window_capacity(const void *state) { return checked(state) ? checked(state)->layout.window_capacity : 0; }

int lobula_window_count(const void *state) { return checked(state) ? checked(state)->window_count : 0; }

int lobula_get_window(const void *state, lobula_decision_entry *out) {
    lobula_state *s = checked(state);
    if (!s || !out) return s ? LOBULA_BAD_ARGUMENT : LOBULA_BAD_STATE;
    memcpy(out, state_window(s), (size_t)s->window_count * sizeof *out);
    return LOBULA_OK;
}

int lobula_set_window(void *state, const lobula_decision_entry *in, int count) {
    lobula_state *s = checked(state);
    if (!s) return LOBULA_BAD_STATE;
    if (count < 0 || count > s->layout.window_capacity || (count && !in)) return LOBULA_BAD_ARGUMENT;
    if (count) memcpy(state_window(s), in, (size_t)count * sizeof *in);
    s->window_count = count;
    return LOBULA_OK;
}
