#include "plan.h"

#include <string.h>

#include "clock.h"

/* model.filters */
static real low_pass_share(real clock_ms, real tau_ms) { return clock_ms / (clock_ms + tau_ms); }

/* Kernel W of Eq. (1) split into what meets E now and what meets it one step ago: centre, nearest, diagonal. */
typedef struct {
    real now[3], then[3];
} rings;

static rings rings_of(const lobula_inhibition_params *p, real clock_ms) {
    real weight[3] = {p->centre_weight, p->nearest_weight, p->diagonal_weight};
    real tau_ms[3] = {p->centre_ms, p->nearest_ms, p->diagonal_ms};
    rings r;
    for (int k = 0; k < 3; k++) {
        r.now[k] = weight[k] * low_pass_share(clock_ms, tau_ms[k]);
        r.then[k] = weight[k] - r.now[k];
    }
    return r;
}

static inhibition_set weigh(const rings *r) {
    inhibition_set q = {
        .own = {(float)r->now[0], (float)r->now[1], (float)r->then[0], (float)r->then[1]},
        .across = {(float)r->now[1], (float)r->now[2], (float)r->then[1], (float)r->then[2]},
    };
    return q;
}

/* Channels of both LGMDs that are computed alike are computed once. */
static int find_or_add(step_plan *p, inhibition_set q) {
    for (int i = 0; i < p->sets; i++) {
        const inhibition_set *known = &p->set[i];
        if (known->source == q.source && known->channel == q.channel && known->spacing == q.spacing &&
            memcmp(known->own, q.own, sizeof q.own) == 0 && memcmp(known->across, q.across, sizeof q.across) == 0)
            return i;
    }
    p->set[p->sets] = q;
    return p->sets++;
}

/* A cell whose own inhibition alone is as large as its excitation never speaks, whatever the picture. */
static int silenced(const rings *r, real bias) { return bias * r->now[0] >= (real)1.0001; }

/* What an LGMD lists is at most 9 S^2 (grouping.h); a power of two brings that below the largest 16-bit float. A bound
 * that is some times too large costs nothing. */
static float list_scale(const network_state *s, int j, int kind) {
    const lobula_params *p = &s->params;
    if (s->layout.cell_bytes == sizeof(float)) return 1.0f;
    const lobula_lgmd_params *q = j ? &p->lgmd2 : &p->lgmd1;
    real cell = p->saturation.enabled != 0 ? p->saturation.limit_grey : 255;
    cell *= 3 / (1 - p->lamina.on_off.residual); /* a short step's change counts more, and what is left of those before */
    if (s->layout.reads[j] == ADAPTED && s->layout.planes.adapted >= 0)
        cell *= 1 - low_pass_share(p->clock.period_ms, p->lamina.fdsr.rise_ms);
    real sum = kind == SUM_ON ? q->on_gain * cell : kind == SUM_OFF ? q->off_gain * cell : (q->on_gain + q->off_gain) * cell;
    if (kind == SUM_PRODUCT) sum += q->product_gain * cell * cell;
    real bound = 9 * sum * sum;
    float scale = 1.0f;
    while (bound * (real)scale > 32768 && scale > 0x1p-100f) scale /= 2.0f;
    while (bound * (real)scale < 16384 && scale < 0x1p20f) scale *= 2.0f;
    return scale;
}

static void plan_lgmd(const network_state *s, step_plan *p, int j, real arousal) {
    const lobula_lgmd_params *q = j ? &s->params.lgmd2 : &s->params.lgmd1;
    const lobula_inhibition_params *inhibition[2] = {&q->on, &q->off};
    const real gain[2] = {q->on_gain, q->off_gain};
    lgmd_plan *lgmd = &p->lgmd[j];
    inhibition_set set[2];
    int speaks[2];
    for (int c = 0; c < 2; c++) {
        rings r = rings_of(inhibition[c], s->params.clock.period_ms);
        real bias = inhibition[c]->bias > arousal ? inhibition[c]->bias : arousal;
        set[c] = weigh(&r);
        set[c].source = s->layout.reads[j];
        set[c].channel = c;
        set[c].spacing = s->layout.spacing[j];
        speaks[c] = !silenced(&r, bias);
        lgmd->bias[c] = (float)bias;
        lgmd->gain[c] = (float)gain[c];
    }
    int product = speaks[ON] && speaks[OFF] && q->product_gain != 0;
    int on = speaks[ON] && (product || gain[ON] != 0), off = speaks[OFF] && (product || gain[OFF] != 0);
    lgmd->kind = product ? SUM_PRODUCT : on && off ? SUM_BOTH : on ? SUM_ON : off ? SUM_OFF : SUM_NONE;
    for (int c = 0; c < 2; c++) {
        int tapped = p->taps && p->taps[LOBULA_TAP_LGMD1_INHIBITION_ON + 4 * j + c];
        lgmd->set[c] = (c == ON ? on : off) || tapped ? find_or_add(p, set[c]) : NO_SET;
    }
    lgmd->product_gain = (float)q->product_gain;
    lgmd->list_scale = list_scale(s, j, lgmd->kind);
    lgmd->grouping = q->grouping.enabled != 0;
    lgmd->omega_floor = 9 * q->grouping.floor_grey;
    lgmd->omega_share = 1 / q->grouping.divisor;
    lgmd->threshold_grey = q->grouping.threshold_grey;
}

static real arousal(const lobula_lgmd_params *p, lobula_lgmd_scalars *now, real mean_change, real clock_ms) {
    real share = low_pass_share(clock_ms, p->change_ms);
    real smooth = share * mean_change + (1 - share) * now->change_before;
    now->change_before = mean_change;
    return smooth / p->change_scale_grey;
}

/* model/medulla/emd.py: in a long step things go further. */
static int stretched(int span_px, real ticks) {
    int far = (int)real_floor((real)span_px * whole_quarters(ticks < MAX_STRETCH ? ticks : MAX_STRETCH) + (real)0.5);
    return far < 1 ? 1 : far;
}

void plan_step(network_state *s, planned_step *step, real mean_change) {
    const lobula_params *q = &s->params;
    const lobula_emd_params *emd = &q->lptc.emd;
    step_plan *p = &step->rows;
    real clock_ms = q->clock.period_ms;
    p->residual = (float)real_pow(q->lamina.on_off.residual, step->ticks);
    p->fdsr_share = (float)(1 - low_pass_share(clock_ms, q->lamina.fdsr.rise_ms));
    p->dead_zone = (float)q->lamina.dog.dead_zone_grey;
    p->spans = (int)emd->spans;
    real uncounted = real_pow(step->ticks, q->clock.change_exponent); /* once of the change's square: model/medulla/emd.py */
    for (int i = 0; i < p->spans; i++) {
        p->span[i] = stretched((int)emd->spans_px[i], step->ticks);
        p->span_share[i] = (float)((1 - low_pass_share(clock_ms, emd->delays_ms[i])) * uncounted);
    }
    p->coarse = q->saturation.enabled != 0 || q->lgmd1.coarse_gain != 0 || q->lgmd2.coarse_gain != 0;
    p->patch = (int)q->coarse.patch_px;
    p->patch_floor = (float)q->coarse.floor_grey;
    p->limit = q->saturation.enabled != 0 ? (float)q->saturation.limit_grey : 1e30f;
    p->patches[ON] = p->patches[OFF] = 0;
    p->sets = 0;
    plan_lgmd(s, p, 0, arousal(&q->lgmd1, &s->now.lgmd1, mean_change, clock_ms));
    plan_lgmd(s, p, 1, arousal(&q->lgmd2, &s->now.lgmd2, mean_change, clock_ms));
}
