/* SPDX-License-Identifier: MIT */
/* The rotations of equal turns about one axis. */
#ifndef PIR_CSPACE_GRID_TURNS_H
#define PIR_CSPACE_GRID_TURNS_H

#include <pirouette/base.h>

#include "cspace/grid/near.h"

typedef struct pir_turns {
    pir_vec3 unit; /* the axis, of length 1 */
    uint64_t count;
} pir_turns;

pir_quat pir_turns_rotation(const pir_turns *turns, uint64_t number);

/* Fills `near`, which is empty, for a unit quaternion. */
void pir_turns_nearest(const pir_turns *turns, pir_quat unit, pir_near *near);

#endif
