/* model/network.py: retina, lamina, medulla, neurons, decision, in the paper's order; a few frames at a time. */
#include <math.h>
#include <string.h>

#include "clock.h"
#include "decision.h"
#include "flash.h"
#include "float_mode.h"
#include "neurons.h"
#include "plan.h"
#include "state.h"

/* One call at work. `waiting` frames are planned and have not yet gone through the rows. */
typedef struct {
    lobula_state *s;
    const kernels *k;
    const lobula_net *net;
    extent e;
    int frames, waiting;
    planned_step step[MAX_FRAMES];
} call;

static int warming_up(const lobula_state *s, double time_s) {
    return (time_s - s->now.started_s) * 1000.0 < s->params.decision.warm_up_ms - SLACK_MS;
}

static int after_turn(const lobula_state *s, double time_s) {
    return s->now.has_turned && (time_s - s->now.turned_s) * 1000.0 <= s->params.decision.after_turn_ms + SLACK_MS;
}

static void note_turning(lobula_state *s, double time_s, int turning) {
    if (!turning) return;
    s->now.turned_s = time_s;
    s->now.has_turned = 1;
    s->window_count = 0;
}

static void read_out(const lobula_state *s, double time_s, int turning, const int32_t spikes[4], lobula_reading *r) {
    r->time_s = time_s;
    r->lgmd1 = s->now.lgmd1.potential;
    r->lgmd2 = s->now.lgmd2.potential;
    r->lptc_r = s->now.rightward;
    r->lptc_l = s->now.leftward;
    memcpy(r->spikes, spikes, sizeof r->spikes);
    r->collision = decision_collision(s, time_s);
    r->state = warming_up(s, time_s)                ? LOBULA_STATE_WARMING_UP
               : turning || after_turn(s, time_s)   ? LOBULA_STATE_TURNING
               : s->now.flashing                    ? LOBULA_STATE_FLASH
                                                    : LOBULA_STATE_OK;
}

/* Empty every layer; what the decision remembers stays, so that a gap does not cut off an event. */
static void rest(lobula_state *s) {
    lobula_scalars *now = &s->now;
    lobula_lgmd_scalars quiet = {0.5, 0.5, 0.0};
    memset(state_planes(s), 0, planes_floats(&s->layout) * sizeof(float));
    now->lgmd1 = now->lgmd2 = quiet;
    now->rightward = now->leftward = 0.0;
    now->started_s = 0.0;
    now->flashing = 0;
}

/* After the rows: potentials, spikes, decision. */
static void conclude(lobula_state *s, const planned_step *step) {
    const lobula_params *p = &s->params;
    double pixels = (double)s->layout.width * (double)s->layout.height;
    const double *patches = step->rows.patches;
    lgmd_potential(&p->lgmd1, &s->now.lgmd1, step->rows.total[0], patches, pixels, step->dt_ms, p->clock.period_ms);
    lgmd_potential(&p->lgmd2, &s->now.lgmd2, step->rows.total[1], patches, pixels, step->dt_ms, p->clock.period_ms);
    lptc_potentials(&p->lptc, &s->now, step->rows.hs, pixels);
    s->now.flashing = step->rows.flash;
    note_turning(s, step->time_s, step->turning);
    int32_t spikes[4] = {
        spike_count(&p->lgmd1.spiking, s->now.lgmd1.potential), spike_count(&p->lgmd2.spiking, s->now.lgmd2.potential),
        spike_count(&p->lptc.spiking, s->now.rightward), spike_count(&p->lptc.spiking, s->now.leftward)};
    if (!warming_up(s, step->time_s) && !after_turn(s, step->time_s))
        decision_step(s, step->time_s, spikes, step->ticks);
    read_out(s, step->time_s, step->turning, spikes, step->reading);
}

static void flush(call *c) {
    lobula_state *s = c->s;
    if (!c->waiting) return;
    step_plan rows[MAX_FRAMES];
    for (int i = 0; i < c->waiting; i++) rows[i] = c->step[i].rows;
    c->k->sweep(&s->layout, state_kernel(s), state_planes(s), c->net->workspace, rows, c->waiting);
    for (int i = 0; i < c->waiting; i++) {
        c->step[i].rows = rows[i];
        conclude(s, &c->step[i]);
    }
    c->waiting = 0;
}

/* A frame that does not advance the network. */
static void stand(call *c, double time_s, int turning, lobula_reading *reading, float *const *taps) {
    static const int32_t none[4] = {0, 0, 0, 0};
    read_out(c->s, time_s, turning, none, reading);
    for (int i = 0; taps && i < LOBULA_TAPS; i++)
        if (taps[i]) memset(taps[i], 0, (size_t)c->e.width * (size_t)c->e.height * sizeof(float));
}

static picture luma_of(lobula_state *s) {
    const layout *l = &s->layout;
    picture p = {(const char *)luma_row(l, state_planes(s), 0), (ptrdiff_t)((size_t)l->stride * sizeof(float)),
                 LOBULA_FLOAT32};
    return p;
}

/* Plan a step of `dt_ms`; `about` says how `image` differs from `previous`. */
static planned_step *plan(call *c, picture image, picture previous, const change_summary *about, double dt_ms,
                          float *const *taps) {
    lobula_state *s = c->s;
    planned_step *step = &c->step[c->waiting++];
    step_plan *rows = &step->rows;
    change_of_light light = {1.0, 0.0};
    double ticks = dt_ms / s->params.clock.period_ms, change = about->mean_abs;
    rows->flash = find_flash(c->k, c->e, image, previous, about, &s->params.flash, &light);
    rows->image = image;
    rows->scale = (float)pow(ticks, -s->params.clock.change_exponent);
    rows->gain = (float)light.gain;
    rows->offset = (float)light.offset;
    rows->taps = taps;
    step->dt_ms = dt_ms;
    step->ticks = ticks;
    if (rows->flash) change = c->k->lit_change(c->e, image, previous, rows->gain, rows->offset);
    plan_step(s, step, (double)rows->scale * change);
    return step;
}

static void process(call *c, picture image, double time_s, int turning, lobula_reading *reading, float *const *taps) {
    lobula_state *s = c->s;
    lobula_scalars *now = &s->now;
    switch (clock_beat(&s->params.clock, now, time_s)) {
    case BEAT_START:
        flush(c);
        note_turning(s, time_s, turning);
        rest(s);
        c->k->set_luma(&s->layout, image, state_planes(s));
        now->started_s = time_s;
        s->window_count = 0;
        stand(c, time_s, turning, reading, taps);
        return;
    case BEAT_WAIT:
        flush(c);
        note_turning(s, time_s, turning);
        stand(c, time_s, turning, reading, taps);
        return;
    case BEAT_TICK: break;
    }
    picture previous = c->waiting ? c->step[c->waiting - 1].rows.image : luma_of(s);
    change_summary about = c->k->summarise(c->e, image, previous);
    double largest = about.mean_abs < s->params.clock.repeat_mean_grey ? c->k->largest_change(c->e, image, previous) : 0.0;
    double dt_ms = clock_advances(&s->params.clock, now, time_s, about.mean_abs, largest);
    if (dt_ms < 0.0) {
        flush(c);
        note_turning(s, time_s, turning);
        now->flashing = 0;
        stand(c, time_s, turning, reading, taps);
        return;
    }
    planned_step *step = plan(c, image, previous, &about, dt_ms, taps);
    step->time_s = time_s;
    step->turning = turning;
    step->reading = reading;
    if (c->waiting == c->frames) flush(c);
}

static int enter(call *c, const lobula_net *net, const lobula_images *images, int frames) {
    if (!net || !net->state || !net->workspace || !images || !images->pixels || frames < 1) return LOBULA_BAD_ARGUMENT;
    if (images->type != LOBULA_UINT8 && images->type != LOBULA_FLOAT32) return LOBULA_BAD_ARGUMENT;
    lobula_state *s = net->state;
    if (s->magic != STATE_MAGIC || s->abi != LOBULA_ABI) return LOBULA_BAD_STATE;
    c->s = s;
    c->k = kernels_of(s->isa);
    c->net = net;
    c->e.width = s->layout.width;
    c->e.height = s->layout.height;
    c->frames = frames < MAX_FRAMES ? frames : MAX_FRAMES;
    c->waiting = 0;
    return c->k ? LOBULA_OK : LOBULA_BAD_STATE;
}

int lobula_step(const lobula_net *net, const lobula_images *image, double time_s, int turning, lobula_reading *reading,
                float *const *taps) {
    call c;
    int status = reading ? enter(&c, net, image, 1) : LOBULA_BAD_ARGUMENT;
    if (status != LOBULA_OK) return status;
    float_mode mode = float_mode_enter();
    picture p = {image->pixels, image->row_bytes, image->type};
    process(&c, p, time_s, turning != 0, reading, taps);
    float_mode_leave(mode);
    return status;
}

int lobula_run(const lobula_net *net, const lobula_images *images, const double *times_s, const uint8_t *turning,
               int64_t count, int frames, lobula_reading *readings) {
    call c;
    int status = times_s && readings ? enter(&c, net, images, frames) : LOBULA_BAD_ARGUMENT;
    if (status != LOBULA_OK) return status;
    float_mode mode = float_mode_enter();
    for (int64_t t = 0; t < count; t++) {
        picture p = {(const char *)images->pixels + (ptrdiff_t)t * images->image_bytes, images->row_bytes, images->type};
        process(&c, p, times_s[t], turning && turning[t], &readings[t], NULL);
    }
    flush(&c);
    float_mode_leave(mode);
    return LOBULA_OK;
}

int lobula_in_range(const lobula_images *image, int width, int height) {
    if (!image || !image->pixels) return 0;
    picture p = {image->pixels, image->row_bytes, image->type};
    extent e = {width, height};
    return image->type == LOBULA_UINT8 || kernels_of(lobula_isa_best())->in_range(e, p);
}
