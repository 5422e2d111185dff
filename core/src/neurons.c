#include "neurons.h"

static real below_one(real v) { return v < 1 ? v : REAL_BELOW_ONE; }

/* neurons/sfa.py */
static real adapt(const lobula_sfa_params *p, real raw, real raw_before, real potential, real dt_ms, real clock_ms) {
    if (p->enabled == 0) return raw;
    real share = p->tau_ms / (p->tau_ms + dt_ms), change = raw - raw_before;
    real adapted = share * (change <= p->growth * dt_ms / clock_ms ? potential + change : raw);
    return adapted > (real)0.5 ? adapted : (real)0.5;
}

void lgmd_potential(const lobula_lgmd_params *p, lobula_lgmd_scalars *now, real total, const real patches[2],
                    real pixels, real dt_ms, real clock_ms) {
    real looming = patches[OFF] - p->coarse_on_weight * patches[ON];
    if (looming > 0) total += p->coarse_gain * looming;
    real raw = below_one(1 / (1 + real_exp(-total / (pixels * p->sigmoid_grey))));
    now->potential = adapt(&p->sfa, raw, now->raw, now->potential, dt_ms, clock_ms);
    now->raw = raw;
}

void lptc_potentials(const lobula_lptc_params *p, lobula_scalars *now, real hs, real pixels) {
    real v = below_one(2 / (1 + real_exp(-real_abs(hs) / (pixels * p->sigmoid_grey2))) - 1);
    now->rightward = hs > 0 ? v : 0;
    now->leftward = hs < 0 ? -v : 0;
}

int32_t spike_count(const lobula_spiking_params *p, real potential) {
    real count = real_floor(real_exp(p->gain * (real_abs(potential) - p->threshold)));
    return count < (real)2147483647.0 ? (int32_t)count : 2147483647;
}
