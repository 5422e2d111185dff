/* model/neurons: from a sum over the picture to a membrane potential and its spikes. */
#ifndef LOBULA_NEURONS_H
#define LOBULA_NEURONS_H

#include "layout.h"

/* neurons/lgmd.py: sigmoid and adaptation of the grouped cells' sum and of what the patches say, ON and OFF. */
void lgmd_potential(const lobula_lgmd_params *p, lobula_lgmd_scalars *now, double total, const double patches[2],
                    double pixels, double dt_ms, double clock_ms);

/* neurons/lptc.py: one net sum, whose sign says which of the two speaks. */
void lptc_potentials(const lobula_lptc_params *p, lobula_scalars *now, double hs, double pixels);

/* neurons/spiking.py */
int32_t spike_count(const lobula_spiking_params *p, double potential);

#endif
