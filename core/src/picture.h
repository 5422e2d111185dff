/* Reading rows of pixels, whatever their type, a vector at a time and never past their end. */
#ifndef LOBULA_PICTURE_H
#define LOBULA_PICTURE_H

#include "sweep.h"
#include "vector.h"

static inline const char *picture_row(const picture *p, int y) { return p->pixels + (ptrdiff_t)y * p->row_bytes; }

static inline vf pixels_at(const char *row, int type, int x) {
    return type == LOBULA_UINT8 ? vf_from_u8((const uint8_t *)row + x) : vf_load((const float *)(const void *)row + x);
}

/* The pixels from x to the row's end, and zeros. */
static inline vf last_pixels(const char *row, int type, int x, int width) {
    if (type == LOBULA_UINT8) {
        uint8_t last[2 * LANES] = {0};
        memcpy(last, row + width - LANES, LANES);
        return vf_from_u8(last + x - (width - LANES));
    }
    float last[2 * LANES] = {0};
    memcpy(last, row + (ptrdiff_t)(width - LANES) * 4, LANES * 4);
    return vf_load(last + x - (width - LANES));
}

#endif
