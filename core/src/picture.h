/* Reading rows of pixels, whatever their type, a vector at a time and never past their end. */
#ifndef LOBULA_PICTURE_H
#define LOBULA_PICTURE_H

#include "sweep.h"
#include "vector.h"

static inline const char *picture_row(const picture *p, int y) { return p->pixels + (ptrdiff_t)y * p->row_bytes; }

/* What its pixels are: known beforehand where the planes are compact. */
static inline int kind_of(const picture *p) {
#if defined(LOBULA_LAPTOP) && !defined(LOBULA_COMPACT_PLANES)
    return p->type;
#else
    (void)p;
    return LOBULA_UINT8;
#endif
}

static inline const uint8_t *bytes_at(const picture *p, int y) { return (const uint8_t *)picture_row(p, y); }

static inline vf pixels_at(const char *row, int type, int x) {
    return type == LOBULA_UINT8 ? vf_from_u8((const uint8_t *)row + x) : vf_load((const float *)(const void *)row + x);
}

/* The pixels from x to the row's end, fewer than a vector, and zeros. Bytes that lie behind the row are not read; those
 * before x are, and shifted out: a detour through memory would wait for all stores on the way. */
INLINE vf last_bytes(const uint8_t *row, int x, int width) {
    const uint8_t *last = row + width - LANES;
    int surplus = x - (width - LANES);
#if LANES == 16
    static const uint8_t moves[32] = {0,   1,   2,   3,   4,   5,   6,   7,   8,   9,   10,  11,  12,  13,  14,  15,
                                      128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128, 128};
    __m128i move = _mm_loadu_si128((const __m128i *)(const void *)(moves + surplus));
    return vf_from_bytes(_mm_shuffle_epi8(_mm_loadu_si128((const __m128i *)(const void *)last), move));
#elif LANES == 8
    uint64_t bytes;
    memcpy(&bytes, last, sizeof bytes);
    return vf_from_bytes(_mm_cvtsi64_si128((int64_t)(bytes >> 8 * surplus)));
#elif LANES == 4
    uint32_t bytes;
    memcpy(&bytes, last, sizeof bytes);
    return vf_from_bytes(bytes >> 8 * surplus);
#else
    return (float)last[surplus];
#endif
}

static inline vf last_pixels(const char *row, int type, int x, int width) {
    return type == LOBULA_UINT8 ? last_bytes((const uint8_t *)row, x, width)
                                : vf_load_first((const float *)(const void *)row + x, width - x);
}

#endif
