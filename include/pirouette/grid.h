/* SPDX-License-Identifier: MIT */
/**
 * Grids of rotations, in the order in which slices of a configuration space are made.
 *
 * Rotations are numbered 0, 1, … in the order of visiting, a path of small turns through the grid.
 *
 * Threads may read one grid at the same time.
 */
#ifndef PIROUETTE_GRID_H
#define PIROUETTE_GRID_H

#include <pirouette/base.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_grid pir_grid;

/** Which rotations a grid has. */
typedef enum pir_grid_kind {
    PIR_GRID_AXIS = 0, /**< `steps` equal turns about one axis, beginning with no turn */
    PIR_GRID_HOPF,     /**< the incremental grid of SO(3) at `level`: 72·8^level rotations */
    PIR_GRID_LIST,     /**< rotations that the caller gave, in the order given */
} pir_grid_kind;

/** What a grid was made of. */
typedef struct pir_grid_info {
    pir_grid_kind kind;
    uint64_t count; /**< rotations */
    pir_vec3 axis;  /**< PIR_GRID_AXIS: as given */
    uint32_t level; /**< PIR_GRID_HOPF */
} pir_grid_info;

#ifdef __cplusplus
}
#endif

#endif
