/* model/retina.py, find_flash: a change of light that explains the change of the picture. */
#ifndef LOBULA_FLASH_H
#define LOBULA_FLASH_H

#include "sweep.h"

typedef struct {
    real gain, offset;
} change_of_light;

/* Whether there was one, and which. */
int find_flash(const kernels *k, extent e, picture image, picture previous, const change_summary *about,
               const lobula_flash_params *p, change_of_light *light);

#endif
