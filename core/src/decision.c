#include "decision.h"

#include <string.h>

#include "clock.h"

/* A sum that loses nothing to rounding on the way (Knuth's two-sum): half a spike is where decisions turn. */
typedef struct {
    real sum, rest;
} exact;

static void exact_add(exact *a, real x) {
    real sum = a->sum + x, part = sum - a->sum;
    a->rest += (a->sum - (sum - part)) + (x - part);
    a->sum = sum;
}

static real whole_spikes(const exact *a) { return real_floor(a->sum + a->rest + (real)0.5); }

static void forget_old(network_state *s, double time_s) {
    lobula_decision_entry *window = state_window(s);
    int old = 0;
    while (old < s->window_count && (time_s - window[old].time_s) * 1000.0 > (double)s->params.decision.window_ms - SLACK_MS) old++;
    if (old) memmove(window, window + old, (size_t)(s->window_count - old) * sizeof *window);
    s->window_count -= old;
}

/* One step is never enough: see model/decision.py. */
static int holds(const network_state *s, const lobula_decision_entry *window) {
    const lobula_decision_params *p = &s->params.decision;
    enum { ALL, LGMDS, LGMD2 } neurons = (int)p->neurons;
    exact lgmd1 = {0, 0}, lgmd2 = {0, 0}, lptc = {0, 0};
    int steps = 0;
    for (int i = 0; i < s->window_count; i++) {
        steps += window[i].lgmd2 > 0 && (window[i].lgmd1 > 0 || neurons == LGMD2);
        exact_add(&lgmd1, window[i].lgmd1);
        exact_add(&lgmd2, window[i].lgmd2);
        exact_add(&lptc, window[i].lptc);
    }
    real a = whole_spikes(&lgmd2), b = whole_spikes(&lptc), other = whole_spikes(&lgmd1);
    if (neurons != LGMD2 && other < a) a = other;
    return steps >= 2 && a >= p->collision_spikes && (neurons != ALL || a > p->lptc_weight * b);
}

void decision_step(network_state *s, double time_s, const int32_t spikes[4], real weight) {
    lobula_decision_entry *window = state_window(s);
    weight = whole_quarters(weight);
    int lptc = spikes[2] > spikes[3] ? spikes[2] : spikes[3];
    lobula_decision_entry entry = {time_s, weight * (real)spikes[0], weight * (real)spikes[1], weight * (real)lptc};
    forget_old(s, time_s);
    if (s->window_count == s->layout.window_capacity) { /* only after a state was loaded with closer entries */
        memmove(window, window + 1, (size_t)(s->window_count - 1) * sizeof *window);
        s->window_count--;
    }
    window[s->window_count++] = entry;
    if (holds(s, window)) {
        s->now.held_s = time_s;
        s->now.has_held = 1;
    }
}

int decision_collision(const network_state *s, double time_s) {
    double end_ms = (double)s->params.decision.end_ms - SLACK_MS;
    return s->now.has_held && (time_s - s->now.held_s) * 1000.0 <= (end_ms > 0.0 ? end_ms : 0.0);
}
