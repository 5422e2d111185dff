#include "plan.h"

#include <math.h>
#include <string.h>

#include "clock.h"

/* model.filters */
static double low_pass_share(double clock_ms, double tau_ms) { return clock_ms / (clock_ms + tau_ms); }

/* Kernel W of Eq. (1) split into what meets E now and what meets it one step ago: centre, nearest, diagonal. */
typedef struct {
    double now[3], then[3];
} rings;

static rings rings_of(const lobula_inhibition_params *p, double clock_ms) {
    double weight[3] = {p->centre_weight, p->nearest_weight, p->diagonal_weight};
    double tau_ms[3] = {p->centre_ms, p->nearest_ms, p->diagonal_ms};
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
static int silenced(const rings *r, double bias) { return bias * r->now[0] >= 1.0001; }

static void plan_lgmd(const lobula_state *s, step_plan *p, int j, double arousal) {
    const lobula_lgmd_params *q = j ? &s->params.lgmd2 : &s->params.lgmd1;
    const lobula_inhibition_params *inhibition[2] = {&q->on, &q->off};
    const double gain[2] = {q->on_gain, q->off_gain};
    lgmd_plan *lgmd = &p->lgmd[j];
    inhibition_set set[2];
    int speaks[2];
    for (int c = 0; c < 2; c++) {
        rings r = rings_of(inhibition[c], s->params.clock.period_ms);
        double bias = inhibition[c]->bias > arousal ? inhibition[c]->bias : arousal;
        set[c] = weigh(&r);
        set[c].source = s->layout.reads[j];
        set[c].channel = c;
        set[c].spacing = s->layout.spacing[j];
        speaks[c] = !silenced(&r, bias);
        lgmd->bias[c] = (float)bias;
        lgmd->gain[c] = (float)gain[c];
    }
    int product = speaks[ON] && speaks[OFF] && q->product_gain != 0.0;
    int on = speaks[ON] && (product || gain[ON] != 0.0), off = speaks[OFF] && (product || gain[OFF] != 0.0);
    lgmd->kind = product ? SUM_PRODUCT : on && off ? SUM_BOTH : on ? SUM_ON : off ? SUM_OFF : SUM_NONE;
    for (int c = 0; c < 2; c++) {
        int tapped = p->taps && p->taps[LOBULA_TAP_LGMD1_INHIBITION_ON + 4 * j + c];
        lgmd->set[c] = (c == ON ? on : off) || tapped ? find_or_add(p, set[c]) : NO_SET;
    }
    lgmd->product_gain = (float)q->product_gain;
    lgmd->grouping = q->grouping.enabled != 0.0;
    lgmd->omega_floor = 9.0 * q->grouping.floor_grey;
    lgmd->omega_share = 1.0 / q->grouping.divisor;
    lgmd->threshold_grey = q->grouping.threshold_grey;
}

static double arousal(const lobula_lgmd_params *p, lobula_lgmd_scalars *now, double mean_change, double clock_ms) {
    double share = low_pass_share(clock_ms, p->change_ms);
    double smooth = share * mean_change + (1.0 - share) * now->change_before;
    now->change_before = mean_change;
    return smooth / p->change_scale_grey;
}

/* model/medulla/emd.py: in a long step things go further. */
static int stretched(int span_px, double ticks) {
    int far = (int)floor(span_px * whole_quarters(ticks < MAX_STRETCH ? ticks : MAX_STRETCH) + 0.5);
    return far < 1 ? 1 : far;
}

void plan_step(lobula_state *s, planned_step *step, double mean_change) {
    const lobula_params *q = &s->params;
    const lobula_emd_params *emd = &q->lptc.emd;
    step_plan *p = &step->rows;
    double clock_ms = q->clock.period_ms;
    p->residual = (float)pow(q->lamina.on_off.residual, step->ticks);
    p->fdsr_share = (float)(1.0 - low_pass_share(clock_ms, q->lamina.fdsr.rise_ms));
    p->dead_zone = (float)q->lamina.dog.dead_zone_grey;
    p->spans = (int)emd->spans;
    double uncounted = pow(step->ticks, q->clock.change_exponent); /* once of the change's square: model/medulla/emd.py */
    for (int i = 0; i < p->spans; i++) {
        p->span[i] = stretched((int)emd->spans_px[i], step->ticks);
        p->span_share[i] = (float)((1.0 - low_pass_share(clock_ms, emd->delays_ms[i])) * uncounted);
    }
    p->coarse = q->saturation.enabled != 0.0 || q->lgmd1.coarse_gain != 0.0 || q->lgmd2.coarse_gain != 0.0;
    p->patch = (int)q->coarse.patch_px;
    p->patch_floor = (float)q->coarse.floor_grey;
    p->limit = q->saturation.enabled != 0.0 ? (float)q->saturation.limit_grey : 1e30f;
    p->patches[ON] = p->patches[OFF] = 0.0;
    p->sets = 0;
    plan_lgmd(s, p, 0, arousal(&q->lgmd1, &s->now.lgmd1, mean_change, clock_ms));
    plan_lgmd(s, p, 1, arousal(&q->lgmd2, &s->now.lgmd2, mean_change, clock_ms));
}
