/* model/medulla/emd.py: the net motion of a row.
 *
 * Summed over a row, R_d = b_d (M'(x) M(x+d) - M(x) M'(x+d)) is M'(x) b_d (M(x+d) - M(x-d)), with nothing outside the
 * picture: one product a cell for all spans. The sum is kept in double: it is a small difference of large numbers. */
#ifndef LOBULA_EMD_H
#define LOBULA_EMD_H

#include "scratch.h"

INLINE vf pull(const float *adapted, const int *span, const vf *share, int spans) {
    vf sum = share[0] * (vf_load(adapted + span[0]) - vf_load(adapted - span[0]));
    UNROLL for (int i = 1; i < spans; i++)
        sum += share[i] * (vf_load(adapted + span[i]) - vf_load(adapted - span[i]));
    return sum;
}

/* `adapted` rows have zero margins. `kept` is the state's row: ON - OFF, since a cell is never both, read as the step
 * before and written as this one; the halves of the step before go to `before` where the LGMDs read them. */
INLINE vd emd_row_as(int n, const float *on, const float *off, float *restrict kept, float *restrict on_before,
                     float *restrict off_before, const int *span, const float *span_share, int spans, int lgmds,
                     vd sum) {
    vf share[LOBULA_MAX_SPANS], zero = vf_all(0.0f);
    for (int i = 0; i < spans; i++) share[i] = vf_all(span_share[i]);
    for (int x = 0; x < n; x += LANES) {
        vf before = vf_load(kept + x), rising = vf_max(before, zero), falling = vf_max(zero - before, zero);
        vf_store(kept + x, vf_load(on + x) - vf_load(off + x));
        if (lgmds) {
            vf_store(on_before + x, rising);
            vf_store(off_before + x, falling);
        }
        vd_add(&sum, rising * pull(on + x, span, share, spans) + falling * pull(off + x, span, share, spans));
    }
    return sum;
}

/* Where adaptation is off the channels overlap: the step before came in rows of its own. */
static vd emd_row_apart(int n, const float *on, const float *off, const float *on_before, const float *off_before,
                        const step_plan *p, vd sum) {
    vf share[LOBULA_MAX_SPANS];
    for (int i = 0; i < LOBULA_MAX_SPANS; i++) share[i] = vf_all(p->span_share[i]);
    for (int x = 0; x < n; x += LANES)
        vd_add(&sum, vf_load(on_before + x) * pull(on + x, p->span, share, p->spans) +
                         vf_load(off_before + x) * pull(off + x, p->span, share, p->spans));
    return sum;
}

static vd emd_row(int n, const float *on, const float *off, float *kept, float *const *before, const step_plan *p,
                  int lgmds, vd sum) {
    static const int usual[4] = {1, 2, 3, 4};
    if (p->spans != 4 || memcmp(p->span, usual, sizeof usual) != 0)
        return emd_row_as(n, on, off, kept, before[ON], before[OFF], p->span, p->span_share, p->spans, lgmds, sum);
    return lgmds ? emd_row_as(n, on, off, kept, before[ON], before[OFF], usual, p->span_share, 4, 1, sum)
                 : emd_row_as(n, on, off, kept, NULL, NULL, usual, p->span_share, 4, 0, sum);
}

static float part_of(float kept, float sign) { return sign * kept > 0.0f ? sign * kept : 0.0f; }

/* The map itself, only for a tap: each pair booked at its left cell. `before` holds the channel times `sign`. */
static void emd_map(int width, const float *now, const float *before, float sign, const step_plan *p, float *map) {
    for (int i = 0; i < p->spans; i++)
        for (int x = 0, far = p->span[i]; far < width; x++, far++)
            map[x] += p->span_share[i] * (part_of(before[x], sign) * now[far] - now[x] * part_of(before[far], sign));
}

#endif
