#include "clock.h"

real whole_quarters(real ticks) { return real_floor(4 * ticks + (real)0.6) / 4; }

beat clock_beat(const lobula_clock_params *p, lobula_scalars *now, double time_s) {
    int first = !now->has_frame;
    double before = now->frame_s;
    now->frame_s = time_s;
    now->has_frame = 1;
    if (first || (time_s - before) * 1000.0 > (double)p->max_gap_ms + SLACK_MS) {
        now->tick_s = now->step_s = time_s;
        now->still = 0;
        return BEAT_START;
    }
    double interval_ms = (time_s - before) * 1000.0, elapsed_ms = (time_s - now->tick_s) * 1000.0;
    if (elapsed_ms + 0.5 * interval_ms < NEAREST * (double)p->period_ms) return BEAT_WAIT;
    now->tick_s = time_s;
    return BEAT_TICK;
}

double clock_advances(const lobula_clock_params *p, lobula_scalars *now, double time_s, real mean_abs, real max_abs) {
    double elapsed_ms = (time_s - now->step_s) * 1000.0;
    int repeats = p->repeats != 0 && mean_abs < p->repeat_mean_grey && max_abs < p->repeat_max_grey;
    if (repeats && !now->still && elapsed_ms <= (double)p->repeat_hold_ms + SLACK_MS) return -1.0;
    now->still = repeats;
    now->step_s = time_s;
    return elapsed_ms;
}
