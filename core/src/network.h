/* model/network.py: a network from its first frame on, whoever calls it. */
#ifndef LOBULA_NETWORK_H
#define LOBULA_NETWORK_H

#include "plan.h"
#include "state.h"
#include "sweep.h"

/* One call at work. `waiting` frames are planned and have not yet gone through the rows. */
typedef struct {
    network_state *s;
    const kernels *k;
    char *workspace;
    extent e;
    int frames, waiting;
    planned_step step[MAX_FRAMES];
} call;

/* Make the network that `l` describes; `s` has room for l->state_bytes. */
void network_init(network_state *s, const lobula_params *p, const layout *l, int isa, int storage);

/* Forget everything. */
void network_reset(network_state *s);

/* Take in one frame; its reading is there at the latest after network_flush. */
void network_frame(call *c, picture image, double time_s, int turning, lobula_reading *reading, float *const *taps);
void network_flush(call *c);

#endif
