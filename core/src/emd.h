/* model/medulla/emd.py: the net motion of a row.
 *
 * Summed over a row, R_d = b_d (M'(x) M(x+d) - M(x) M'(x+d)) is M'(x) b_d (M(x+d) - M(x-d)), with nothing outside the
 * picture: one product a cell for all spans. The sum is kept in double: it is a small difference of large numbers. */
#ifndef LOBULA_EMD_H
#define LOBULA_EMD_H

#include "scratch.h"

INLINE vf pull(const float *adapted, const int *span, const float *share, int spans) {
    vf sum = vf_all(0.0f);
    UNROLL for (int i = 0; i < spans; i++)
        sum += vf_all(share[i]) * (vf_load(adapted + span[i]) - vf_load(adapted - span[i]));
    return sum;
}

/* `adapted` rows have zero margins. `kept` is the state's row: ON - OFF, since a cell is never both, read as the step
 * before and written as this one. */
INLINE void emd_row_as(int n, const float *on, const float *off, float *restrict kept, const int *span,
                       const float *share, int spans, vd *hs) {
    vf zero = vf_all(0.0f);
    vd sum = *hs;
    for (int x = 0; x < n; x += LANES) {
        vf before = vf_load(kept + x);
        vf_store(kept + x, vf_load(on + x) - vf_load(off + x));
        vd_add(&sum, vf_max(before, zero) * pull(on + x, span, share, spans) -
                         vf_min(before, zero) * pull(off + x, span, share, spans));
    }
    *hs = sum;
}

static void emd_row(int n, const float *on, const float *off, float *kept, const step_plan *p, vd *hs) {
    static const int usual[4] = {1, 2, 3, 4};
    if (p->spans == 4 && memcmp(p->span, usual, sizeof usual) == 0)
        emd_row_as(n, on, off, kept, usual, p->span_share, 4, hs);
    else
        emd_row_as(n, on, off, kept, p->span, p->span_share, p->spans, hs);
}

/* Where adaptation is off the channels overlap: the step before comes in rows of its own. */
static void emd_row_apart(int n, const float *on, const float *off, const float *on_before, const float *off_before,
                          const step_plan *p, vd *hs) {
    for (int x = 0; x < n; x += LANES)
        vd_add(hs, vf_load(on_before + x) * pull(on + x, p->span, p->span_share, p->spans) +
                       vf_load(off_before + x) * pull(off + x, p->span, p->span_share, p->spans));
}

static float part_of(float kept, float sign) { return sign * kept > 0.0f ? sign * kept : 0.0f; }

/* The map itself, only for a tap: each pair booked at its left cell. `before` holds the channel times `sign`. */
static void emd_map(int width, const float *now, const float *before, float sign, const step_plan *p, float *map) {
    for (int i = 0; i < p->spans; i++)
        for (int x = 0, far = p->span[i]; far < width; x++, far++)
            map[x] += p->span_share[i] * (part_of(before[x], sign) * now[far] - now[x] * part_of(before[far], sign));
}

#endif
