/* Lateral inhibition, competition, summation and column sums of both LGMDs in one loop, for the settings of the presets:
 * what lateral_inhibition.h and grouping.h do row by row, without going through memory in between. */
#ifndef LOBULA_USUAL_H
#define LOBULA_USUAL_H

#include "grouping.h"
#include "lateral_inhibition.h"

typedef struct {
    const float *on[2], *off[2]; /* excitation of row y, now and one step ago */
    const float *on_middle, *off_middle; /* of row y - spacing, now */
    float *weighed; /* row y; then rows y - spacing and y - 2 spacing */
    const float *middle, *above;
    float *sums; /* row y - spacing; then the two above, spacing apart */
    const float *sums_middle, *sums_above;
    float *column[2]; /* row y - 2 spacing */
} usual_rows;

/* Weigh one channel; return the inhibition that this completes, of row y - spacing. */
INLINE vf usual_channel(const ring_weights *w, const float *now, const float *before, int s, float *out,
                        const float *middle, const float *above) {
    weighed r = weigh(w, now, before, s);
    vf_store(out + OWN * LANES, r.own);
    vf_store(out + ACROSS * LANES, r.across);
    return vf_load(middle + OWN * LANES) + vf_load(above + ACROSS * LANES) + r.across;
}

/* With `plain` gains of 1, and where `same` both LGMDs hear OFF with one bias, there is less to do. */
INLINE void usual_row_as(int n, int s, const inhibition_set *on, const inhibition_set *off, const lgmd_plan *lgmd,
                         const usual_rows *rows, int plain, int same) {
    usual_rows q = *rows;
    ring_weights on_weights = weights_of(on), off_weights = weights_of(off);
    vf bias_on = vf_all(lgmd[0].bias[ON]), bias_off = vf_all(lgmd[0].bias[OFF]), bias2 = vf_all(lgmd[1].bias[OFF]);
    vf gain_on = vf_all(lgmd[0].gain[ON]), gain_off = vf_all(lgmd[0].gain[OFF]), gain2 = vf_all(lgmd[1].gain[OFF]);
    for (int x = 0; x < n; x += LANES) {
        int at = x * WEIGHED, sums_at = x * SUMS;
        vf a = usual_channel(&on_weights, q.on[0] + x, q.on[1] + x, s, q.weighed + at, q.middle + at, q.above + at);
        vf b = usual_channel(&off_weights, q.off[0] + x, q.off[1] + x, s, q.weighed + at + LANES, q.middle + at + LANES,
                             q.above + at + LANES);
        vf e_on = vf_load(q.on_middle + x), e_off = vf_load(q.off_middle + x);
        vf on_wins = compete(e_on, a, bias_on), off_wins = compete(e_off, b, bias_off);
        vf one = on_wins + off_wins, two = off_wins;
        if (!plain) one = gain_on * on_wins + gain_off * off_wins;
        if (!same) two = compete(e_off, b, bias2);
        if (!plain) two = gain2 * two;
        vf_store(q.sums + sums_at, one);
        vf_store(q.sums + sums_at + LANES, two);
        vf_store(q.column[0] + x, vf_load(q.sums_above + sums_at) + vf_load(q.sums_middle + sums_at) + one);
        vf_store(q.column[1] + x,
                 vf_load(q.sums_above + sums_at + LANES) + vf_load(q.sums_middle + sums_at + LANES) + two);
    }
}

#endif
