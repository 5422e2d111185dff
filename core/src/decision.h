/* model/decision.py: the LGMDs must agree, the LPTCs must not win. */
#ifndef LOBULA_DECISION_H
#define LOBULA_DECISION_H

#include "state.h"

/* Add one step's spikes, weight = dt / clock in whole quarters, and note whether the rule holds. */
void decision_step(network_state *s, double time_s, const int32_t spikes[4], real weight);

int decision_collision(const network_state *s, double time_s);

#endif
