/* SPDX-License-Identifier: MIT */
/* Support vertices by hill climbing: see climb.h. */
#include "query/frame/climb.h"

uint32_t pir_climb(const pir_polytope *polytope, pir_vec3 n, uint32_t from) {
    return pir_climb_above(polytope, n, PIR_LEAST_SLOPE, from);
}

void pir_landmarks_set(const pir_polytope *polytope, uint32_t landmarks[PIR_LANDMARKS]) {
    // near the middle of the directions that have this landmark, to two digits: a climb that starts beside it is as
    // right
    const double most = 0.82, less = 0.4;
    for (uint32_t i = 0, from = 0; i < PIR_LANDMARKS; i++) {
        pir_vec3 n = {i / 8 == 0 ? most : less, i / 8 == 1 ? most : less, i / 8 == 2 ? most : less};
        n = (pir_vec3){i & 4 ? -n.x : n.x, i & 2 ? -n.y : n.y, i & 1 ? -n.z : n.z};
        landmarks[i] = from = pir_climb(polytope, n, from);
    }
}
