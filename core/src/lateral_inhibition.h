/* model/medulla/lateral_inhibition.py: Eqs. (1) and (2) of the paper for one channel, [g (E - w I)]+.
 *
 * I is linear in E now and one step ago, so each row needs its own weighted sum (`own`, with E itself) and the one it
 * hands to the rows above and below (`across`); w and g are in the weights. */
#ifndef LOBULA_LATERAL_INHIBITION_H
#define LOBULA_LATERAL_INHIBITION_H

#include "scratch.h"

enum { WEIGH_ONLY, WEIGH_AND_COMPETE };

/* Weigh row y of the excitation, and where asked compete in row y - spacing, whose neighbours are now complete. */
INLINE void inhibition_row(int n, const inhibition_set *q, int s, const float *now, const float *before,
                           float *restrict own, float *restrict across, const float *own_above,
                           const float *across_above, float *restrict part, int mode) {
    vf w0 = vf_all(q->own[0]), w1 = vf_all(q->own[1]), w2 = vf_all(q->own[2]), w3 = vf_all(q->own[3]);
    vf a0 = vf_all(q->across[0]), a1 = vf_all(q->across[1]), a2 = vf_all(q->across[2]), a3 = vf_all(q->across[3]);
    for (int x = 0; x < n; x += LANES) {
        vf e = vf_load(now + x), sides = vf_load(now + x - s) + vf_load(now + x + s);
        vf b = vf_load(before + x), sides_before = vf_load(before + x - s) + vf_load(before + x + s);
        vf below = a0 * e + a1 * sides + (a2 * b + a3 * sides_before);
        vf_store(across + x, below);
        vf mine = w0 * e + w1 * sides + (w2 * b + w3 * sides_before);
        vf_store(own + x, mine);
        if (mode == WEIGH_AND_COMPETE)
            vf_store(part + x, vf_max(vf_load(own_above + x) - vf_load(across_above + x) - below, vf_all(0.0f)));
    }
}

/* Compete where the row below is long since weighed: at the picture's lower border. */
INLINE void compete_row(int n, const float *own, const float *above, const float *below, float *restrict part) {
    for (int x = 0; x < n; x += LANES)
        vf_store(part + x, vf_max(vf_load(own + x) - vf_load(above + x) - vf_load(below + x), vf_all(0.0f)));
}

#endif
