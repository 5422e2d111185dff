#include "neurons.h"

#include <math.h>

static double below_one(double v) { return v < 1.0 ? v : 1.0 - 0x1p-53; }

/* neurons/sfa.py */
static double adapt(const lobula_sfa_params *p, double raw, double raw_before, double potential, double dt_ms,
                    double clock_ms) {
    if (p->enabled == 0.0) return raw;
    double share = p->tau_ms / (p->tau_ms + dt_ms), change = raw - raw_before;
    double adapted = share * (change <= p->growth * dt_ms / clock_ms ? potential + change : raw);
    return adapted > 0.5 ? adapted : 0.5;
}

void lgmd_potential(const lobula_lgmd_params *p, lobula_lgmd_scalars *now, double total, const double patches[2],
                    double pixels, double dt_ms, double clock_ms) {
    double looming = patches[OFF] - p->coarse_on_weight * patches[ON];
    if (looming > 0.0) total += p->coarse_gain * looming;
    double raw = below_one(1.0 / (1.0 + exp(-total / (pixels * p->sigmoid_grey))));
    now->potential = adapt(&p->sfa, raw, now->raw, now->potential, dt_ms, clock_ms);
    now->raw = raw;
}

void lptc_potentials(const lobula_lptc_params *p, lobula_scalars *now, double hs, double pixels) {
    double v = below_one(2.0 / (1.0 + exp(-fabs(hs) / (pixels * p->sigmoid_grey2))) - 1.0);
    now->rightward = hs > 0.0 ? v : 0.0;
    now->leftward = hs < 0.0 ? -v : 0.0;
}

int32_t spike_count(const lobula_spiking_params *p, double potential) {
    double count = floor(exp(p->gain * (fabs(potential) - p->threshold)));
    return count < 2147483647.0 ? (int32_t)count : 2147483647;
}
