/* SPDX-License-Identifier: MIT */
/* Points that are farthest from a body, and not next to each other. */
#ifndef PIR_SIMPLIFY_FARTHEST_H
#define PIR_SIMPLIFY_FARTHEST_H

#include "base/vec.h"

typedef struct pir_far_point {
    pir_vec3 at;
    double distance;
    uint32_t index;
} pir_far_point;

/*
 * Moves up to `most` of the points to the front, the farthest first, each at least as far from those before it as half
 * the greatest distance, and none less than half as far from the body as the first. Returns how many.
 */
uint32_t pir_farthest_first(pir_far_point *points, uint32_t count, uint32_t most);

#endif
