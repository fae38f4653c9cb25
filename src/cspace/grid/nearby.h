/* SPDX-License-Identifier: MIT */
/* The nearest rotation of a grid, with that rotation. */
#ifndef PIR_CSPACE_GRID_NEARBY_H
#define PIR_CSPACE_GRID_NEARBY_H

#include <pirouette/grid.h>

typedef struct pir_grid_nearby {
    uint64_t number;
    pir_quat unit; /* of length 1, off by 8u */
} pir_grid_nearby;

/* As pir_grid_nearest has it, for a rotation that is `unit` with its length brought to 1, off by 8u. */
pir_grid_nearby pir_grid_nearest_to(const pir_grid *grid, pir_quat rotation, pir_quat unit);

#endif
