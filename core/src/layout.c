#include "layout.h"

#include "real.h"
#include "state.h"

static int larger(int a, int b) { return a > b ? a : b; }

static int round_up(int n, int multiple) { return (n + multiple - 1) / multiple * multiple; }

static int power_of_two(int at_least) {
    int n = 1;
    while (n < at_least) n *= 2;
    return n;
}

static size_t aligned(size_t bytes) { return (bytes + LOBULA_ALIGN - 1) / LOBULA_ALIGN * LOBULA_ALIGN; }

static int between(real value, real low, real high) { return value >= low && value <= high; } /* false on NaN */

static int possible(const lobula_params *p) {
    const lobula_lgmd_params *lgmds[2] = {&p->lgmd1, &p->lgmd2};
    int ok = between(p->clock.period_ms, 1, 10000) && between(p->decision.window_ms, 0, 10000) &&
             between(p->lamina.dog.radius_px, 1, 32) && between(p->lamina.dog.surround, 1, 4) &&
             between(p->lamina.dog.sigma_px, (real)1e-3, 1000) && between(p->lptc.emd.spans, 1, LOBULA_MAX_SPANS) &&
             between(p->coarse.patch_px, 1, LOBULA_MAX_SIDE);
    for (int i = 0; ok && i < (int)p->lptc.emd.spans; i++) ok = between(p->lptc.emd.spans_px[i], 1, 256);
    for (int j = 0; ok && j < 2; j++) ok = between(lgmds[j]->neighbour_px, 1, 256) && between(lgmds[j]->reads, 0, 1);
    return ok;
}

static int widest_span(const lobula_emd_params *p) {
    int widest = 1;
    for (int i = 0; i < (int)p->spans; i++) widest = larger(widest, (int)p->spans_px[i]);
    return widest;
}

int layout_init(layout *l, const lobula_params *p, int width, int height, int storage) {
    if (width < LOBULA_MIN_WIDTH || height < LOBULA_MIN_HEIGHT || width > LOBULA_MAX_SIDE ||
        height > LOBULA_MAX_SIDE || storage < 0 || storage >= LOBULA_STORAGES || !possible(p))
        return LOBULA_BAD_ARGUMENT;
    const lobula_dog_params *dog = &p->lamina.dog;
    l->width = width;
    l->height = height;
    l->stride = round_up(width, ROW_FLOATS);
    l->inner_radius = dog->enabled != 0 ? (int)dog->radius_px : 0;
    l->outer_radius = dog->enabled != 0 ? (int)dog->radius_px * (int)dog->surround : 0;
    l->spacing[0] = (int)p->lgmd1.neighbour_px;
    l->spacing[1] = (int)p->lgmd2.neighbour_px;
    l->reads[0] = (int)p->lgmd1.reads;
    l->reads[1] = (int)p->lgmd2.reads;

    int n = 0;
    l->planes.on = n++;
    l->planes.off = n++;
    l->planes.adapted = p->lamina.fdsr.enabled != 0 ? n++ : -1;
    l->planes.change = l->reads[0] == CHANGE || l->reads[1] == CHANGE ? (n += 2) - 2 : -1;
    l->planes.count = n;
    l->record = (size_t)n * (size_t)l->stride;

    int reach = larger(larger(l->spacing[0], l->spacing[1]), larger(l->outer_radius, MAX_STRETCH * widest_span(&p->lptc.emd)));
    l->margin = round_up(reach, ROW_FLOATS);
    /* A vector may start at the last margin pixel and run on. */
    l->long_row = l->margin + l->stride + l->margin + ROW_FLOATS;
    l->ring = power_of_two(2 * larger(l->spacing[0], l->spacing[1]) + 2);
#if defined(LOBULA_LAPTOP)
    l->excited = power_of_two(larger(l->spacing[0], l->spacing[1]) + 2);
    l->excited_before = 2;
#else
    l->excited = l->excited_before = l->ring; /* inhibition is added up from them: sparse.h */
#endif

    /* Steps are at least two thirds of a tick apart (clock.c), and older spikes leave as new ones come. */
    l->window_capacity = -(int)real_floor(-p->decision.window_ms / ((real)0.6 * p->clock.period_ms)) + 2;

    size_t at = aligned(sizeof(network_state));
    l->kernel_at = at;
    at += aligned((size_t)(l->inner_radius + 1 + l->outer_radius + 1) * sizeof(float));
    l->window_at = at;
    at += aligned((size_t)l->window_capacity * sizeof(lobula_decision_entry));
    l->cell_bytes = storage == LOBULA_COMPACT ? 2 : sizeof(float);
    l->pixel_bytes = storage == LOBULA_COMPACT ? 1 : sizeof(float);
    l->luma_bytes = aligned((size_t)height * (size_t)l->stride * l->pixel_bytes);
    l->planes_at = at;
    l->state_bytes = at + aligned(planes_bytes(l));
    return LOBULA_OK;
}
