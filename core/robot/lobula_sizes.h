/* How large a network of lobula_config.h is: the sums of layout.c and scratch.h as constants, checked by lobula_init. */
#ifndef LOBULA_SIZES_H
#define LOBULA_SIZES_H

#include "lobula_config.h"

#define LOBULA_ROUND_8(bytes) (((bytes) + 7) / 8 * 8)
#define LOBULA_LARGER(a, b) ((a) > (b) ? (a) : (b))
#define LOBULA_POWER_OF_2(n) \
    ((n) <= 4 ? 4 : (n) <= 8 ? 8 : (n) <= 16 ? 16 : (n) <= 32 ? 32 : (n) <= 64 ? 64 : (n) <= 128 ? 128 : (n) <= 256 ? 256 : 512)

#define LOBULA_DOG_INNER_PX (LOBULA_LAMINA_DOG_ENABLED ? LOBULA_LAMINA_DOG_RADIUS_PX : 0)
#define LOBULA_DOG_OUTER_PX (LOBULA_DOG_INNER_PX * LOBULA_LAMINA_DOG_SURROUND)
#define LOBULA_SPACING_PX LOBULA_LARGER(LOBULA_LGMD1_NEIGHBOUR_PX, LOBULA_LGMD2_NEIGHBOUR_PX)
#define LOBULA_READS_CHANGE (LOBULA_LGMD1_READS == 0 || LOBULA_LGMD2_READS == 0)
#define LOBULA_READS_LAMINA (LOBULA_LGMD1_READS == 1 || LOBULA_LGMD2_READS == 1)

/* A row with its margins; rows that filters and LGMDs keep. */
#define LOBULA_MARGIN_PX \
    LOBULA_LARGER(LOBULA_LARGER(LOBULA_SPACING_PX, LOBULA_DOG_OUTER_PX), 4 * LOBULA_LPTC_EMD_WIDEST_PX)
#define LOBULA_LONG_ROW (2 * LOBULA_MARGIN_PX + LOBULA_WIDTH + 1)
#define LOBULA_RING_ROWS LOBULA_POWER_OF_2(2 * LOBULA_SPACING_PX + 2)
#define LOBULA_EXCITED_ROWS (4 * LOBULA_RING_ROWS) /* ON and OFF, now and one step ago */

/* Bytes of a cell of all planes together; of the decision's window; of what is remembered. */
#define LOBULA_CELL_BYTES (4 + 2 * LOBULA_LAMINA_FDSR_ENABLED + 4 * LOBULA_READS_CHANGE)
#define LOBULA_WINDOW_STEPS (((int)LOBULA_DECISION_WINDOW_MS + 1) * 10 / ((int)LOBULA_CLOCK_PERIOD_MS * 6) + 3)
#define LOBULA_HEADER_BYTES 768
#define LOBULA_REMEMBERED_BYTES                                                                    \
    (LOBULA_HEADER_BYTES + LOBULA_ROUND_8((LOBULA_DOG_INNER_PX + LOBULA_DOG_OUTER_PX + 2) * 4) +   \
     LOBULA_WINDOW_STEPS * 24 + LOBULA_ROUND_8(LOBULA_WIDTH * LOBULA_HEIGHT) +                     \
     LOBULA_ROUND_8(LOBULA_WIDTH * LOBULA_HEIGHT * LOBULA_CELL_BYTES))

/* Floats of the rows at work, and bytes of the lists of grouped cells. */
#define LOBULA_SHORT_ROWS (2 * LOBULA_DOG_OUTER_PX + 2 + 2 * LOBULA_RING_ROWS)
#define LOBULA_LONG_ROWS                                                                           \
    ((LOBULA_DOG_OUTER_PX > 0 ? 4 : 0) + (LOBULA_LAMINA_FDSR_ENABLED ? 2 : 8) +                    \
     (LOBULA_READS_CHANGE + LOBULA_READS_LAMINA) * LOBULA_EXCITED_ROWS)
#define LOBULA_LIST_BYTES LOBULA_ROUND_8((LOBULA_WIDTH * LOBULA_HEIGHT + 1) * 2)
#define LOBULA_WORKING_BYTES \
    (LOBULA_ROUND_8((LOBULA_SHORT_ROWS * LOBULA_WIDTH + LOBULA_LONG_ROWS * LOBULA_LONG_ROW) * 4) + 2 * LOBULA_LIST_BYTES)

#define LOBULA_MEMORY_BYTES (LOBULA_REMEMBERED_BYTES + LOBULA_WORKING_BYTES)

#endif
