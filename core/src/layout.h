/* Where everything lies in the caller's memory. */
#ifndef LOBULA_LAYOUT_H
#define LOBULA_LAYOUT_H

#include <stddef.h>

#include "real.h"

#if defined(LOBULA_LAPTOP)
#define ROW_FLOATS 16 /* rows start on multiples of this, whatever the instruction set: states are exchangeable */
#else
#define ROW_FLOATS 1
#endif

enum { CHANGE, ADAPTED, SOURCES }; /* what an LGMD can read */
enum { ON, OFF };

#if defined(LOBULA_LAPTOP)
#define MAX_RADIUS (32 * 4) /* of the DoG's outer field */
#else
#include "lobula_config.h"
#define MAX_RADIUS (LOBULA_LAMINA_DOG_RADIUS_PX * LOBULA_LAMINA_DOG_SURROUND)
#endif

#define MAX_STRETCH 4 /* of the EMDs' spans, in long steps */

/* Planes of the state but the luma, in the order a row of each is stored; -1 where the settings need none. All their
 * rows at one y lie side by side, so that the step walks through one stream of memory. The luma, which is looked at
 * once more before each step, lies by itself in front of them. */
typedef struct {
    int on, off, adapted, change;
    int count;
} plane_numbers;

/* Everything that follows from the settings and the size alone. Sizes in floats unless they say bytes. */
typedef struct {
    int width, height;
    int stride;   /* of a row without margins */
    int margin;   /* left and right of a row that a filter looks along */
    int long_row; /* such a row with its margins */
    plane_numbers planes;
    int inner_radius, outer_radius; /* of the DoG; 0 where it is off */
    int spacing[2];                 /* neighbour_px of each LGMD */
    int reads[2];                   /* source of each LGMD */
    int ring;                       /* rows that inhibition and grouping keep, a power of two */
    int excited, excited_before;    /* rows of what excites the LGMDs that are kept, powers of two */
    int window_capacity;
    size_t record;          /* cells of one row of every plane but the luma */
    size_t cell_bytes, pixel_bytes; /* of a plane's cell, and of the luma's */
    size_t luma_bytes;      /* the whole luma */
    size_t planes_at;       /* offset of the luma in the state, bytes; the others follow */
    size_t kernel_at;       /* offset of the DoG weights, bytes */
    size_t window_at;       /* offset of the decision's entries, bytes */
    size_t state_bytes;
} layout;

/* Fill `l`, or say that the size or a setting cannot be. */
int layout_init(layout *l, const lobula_params *p, int width, int height, int storage);

#endif
