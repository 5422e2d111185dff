/* model/neurons: from a sum over the picture to a membrane potential and its spikes. */
#ifndef LOBULA_NEURONS_H
#define LOBULA_NEURONS_H

#include "layout.h"
#include "real.h"

/* neurons/lgmd.py: sigmoid and adaptation of the grouped cells' sum and of what the patches say, ON and OFF. */
void lgmd_potential(const lobula_lgmd_params *p, lobula_lgmd_scalars *now, real total, const real patches[2],
                    real pixels, real dt_ms, real clock_ms);

/* neurons/lptc.py: one net sum, whose sign says which of the two speaks. */
void lptc_potentials(const lobula_lptc_params *p, lobula_scalars *now, real hs, real pixels);

/* neurons/spiking.py */
int32_t spike_count(const lobula_spiking_params *p, real potential);

#endif
