/* model/medulla/emd.py: the net motion of a row.
 *
 * Summed over a row, R_d = b_d (M'(x) M(x+d) - M(x) M'(x+d)) is M'(x) b_d (M(x+d) - M(x-d)), with nothing outside the
 * picture: one product a cell for all spans. The sum is kept in double: it is a small difference of large numbers. */
#ifndef LOBULA_EMD_H
#define LOBULA_EMD_H

#include "known.h"
#include "scratch.h"
#include "storage.h"

/* What one channel of the cells around pulls: those of the sign `side`, as magnitudes. */
INLINE vf pull(const float *adapted, vf side, const int *span, const vf *share, int spans) {
    vf sum = vf_all(0.0f);
    UNROLL for (int i = 0; i < spans; i++) {
        vf right = vf_above_zero(vf_xor(vf_load(adapted + span[i]), side));
        vf left = vf_above_zero(vf_xor(vf_load(adapted - span[i]), side));
        sum += share[i] * (right - left);
    }
    return sum;
}

/* `adapted`, ON less OFF, has zero margins: a cell is never both, so the sign of the step before (in `kept`, the state's
 * row) says which channel the cells around are to be read from. What the LGMDs read of both goes to `excitation`. */
INLINE vd emd_row_as(int n, const float *adapted, stored *restrict kept, float *const *excitation, const int *span,
                     const float *span_share, int spans, int lgmds, vd sum) {
    vf share[LOBULA_MAX_SPANS], zero = vf_all(0.0f);
    for (int i = 0; i < spans; i++) share[i] = vf_all(span_share[i]);
    float *on = lgmds ? excitation[E_ON] : NULL, *off = lgmds ? excitation[E_OFF] : NULL;
    float *on_before = lgmds ? excitation[E_ON_BEFORE] : NULL, *off_before = lgmds ? excitation[E_OFF_BEFORE] : NULL;
    for (int x = 0; x < n; x += LANES) {
        vf before = stored_load(kept + x), now = vf_load(adapted + x), side = vf_sign(before);
        stored_store(kept + x, now);
        if (lgmds) {
            vf_store(on + x, vf_above_zero(now));
            vf_store(off + x, vf_above_zero(zero - now));
            vf_store(on_before + x, vf_above_zero(before));
            vf_store(off_before + x, vf_above_zero(zero - before));
        }
#if LANES == 1
        if (before == 0.0f) continue; /* as is most of a still scene */
#endif
        vd_add(&sum, vf_xor(before, side) * pull(adapted + x, side, span, share, spans));
    }
    return sum;
}

static vd emd_row(int n, const float *adapted, stored *kept, float *const *excitation, const step_plan *p, int lgmds,
                  vd sum) {
    static const int usual[4] = {1, 2, 3, 4};
    const int heard = KNOWN(lgmds, LOBULA_READS_LAMINA);
    if (p->spans != 4 || memcmp(p->span, usual, sizeof usual) != 0)
        return emd_row_as(n, adapted, kept, excitation, p->span, p->span_share, p->spans, heard, sum);
    return heard ? emd_row_as(n, adapted, kept, excitation, usual, p->span_share, 4, 1, sum)
                 : emd_row_as(n, adapted, kept, NULL, usual, p->span_share, 4, 0, sum);
}

/* Where adaptation is off the channels overlap: one of them, and what it was before. */
static vd emd_row_apart(int n, const float *now, const float *before, const step_plan *p, vd sum) {
    vf share[LOBULA_MAX_SPANS];
    for (int i = 0; i < LOBULA_MAX_SPANS; i++) share[i] = vf_all(p->span_share[i]);
    for (int x = 0; x < n; x += LANES)
        vd_add(&sum, vf_load(before + x) * pull(now + x, vf_all(0.0f), p->span, share, p->spans));
    return sum;
}

static float part_of(float kept, float sign) { return sign * kept > 0.0f ? sign * kept : 0.0f; }

#if defined(LOBULA_LAPTOP)
/* The map itself, only for a tap: each pair booked at its left cell. Both rows hold the channel times `sign`. */
static void emd_map(int width, const float *now, const float *before, float sign, const step_plan *p, float *map) {
    for (int i = 0; i < p->spans; i++)
        for (int x = 0, far = p->span[i]; far < width; x++, far++)
            map[x] += p->span_share[i] * (part_of(before[x], sign) * part_of(now[far], sign) -
                                          part_of(now[x], sign) * part_of(before[far], sign));
}
#endif

#endif
