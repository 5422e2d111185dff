/* Turn the settings and one step's length into the numbers its rows need. */
#ifndef LOBULA_PLAN_H
#define LOBULA_PLAN_H

#include "state.h"
#include "sweep.h"

/* What the network knows of a step before its rows: also how long it took and what light it was in. */
typedef struct {
    step_plan rows;
    double time_s;
    real dt_ms, ticks;
    int turning;
    lobula_reading *reading;
} planned_step;

/* `mean_change` is the mean of |P| over the picture; the LGMDs remember it. */
void plan_step(network_state *s, planned_step *step, real mean_change);

#endif
