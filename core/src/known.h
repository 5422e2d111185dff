/* What a robot's compiler knows of the settings: roads that are never taken take no memory. */
#ifndef LOBULA_KNOWN_H
#define LOBULA_KNOWN_H

#if defined(LOBULA_LAPTOP)
#define KNOWN(here, there) (here)
#else
#include "lobula_sizes.h"
#define KNOWN(here, there) ((void)(here), (there))
#endif

#define DOG_INNER(l) KNOWN((l)->inner_radius, LOBULA_DOG_INNER_PX)
#define DOG_OUTER(l) KNOWN((l)->outer_radius, LOBULA_DOG_OUTER_PX)
#define HAS_FDSR(c) KNOWN((c)->fdsr, LOBULA_LAMINA_FDSR_ENABLED)
#define READ_CHANGE(c) KNOWN((c)->lgmds_read_change, LOBULA_READS_CHANGE)
#define READ_LAMINA(c) KNOWN((c)->lgmds_read_lamina, LOBULA_READS_LAMINA)
#define HAS_COARSE(p) \
    KNOWN((p)->coarse, LOBULA_SATURATION_ENABLED || LOBULA_LGMD1_COARSE_GAIN > 0.0f || LOBULA_LGMD2_COARSE_GAIN > 0.0f)
/* The spacing of an LGMD's neighbours. */
#define SPACING(s) KNOWN(s, LOBULA_LGMD1_NEIGHBOUR_PX == LOBULA_LGMD2_NEIGHBOUR_PX ? LOBULA_SPACING_PX : (s))
#define MULTIPLIES(q) \
    KNOWN((q)->kind == SUM_PRODUCT, \
          (q)->kind == SUM_PRODUCT && (LOBULA_LGMD1_PRODUCT_GAIN > 0.0f || LOBULA_LGMD2_PRODUCT_GAIN > 0.0f))

#endif
