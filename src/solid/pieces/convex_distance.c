/* SPDX-License-Identifier: MIT */
/* See convex_distance.h. */
#include "solid/pieces/convex_distance.h"

#include <math.h>
#include <stdbool.h>

/* From a point to a side, both relative to where the side begins. */
static double from_side(pir_vec3 point, pir_vec3 side) {
    const double along = pir_vec_dot(point, side), whole = pir_vec_dot(side, side);
    const double share = whole > 0 ? fmin(1, fmax(0, along / whole)) : 0;
    return pir_vec_length(pir_vec_sub(point, pir_vec_scale(side, share)));
}

/* From a point to facet f, which it is `above` its plane. `margin` is what rounding may do to such a height. */
static double from_facet(const pir_polytope *p, uint32_t f, pir_vec3 point, double above, double margin) {
    double least = HUGE_VAL;
    bool inside = true;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        const pir_vec3 a = p->vertex[p->origin[p->loop[i]]], b = p->vertex[p->target[p->loop[i]]];
        const pir_vec3 way = pir_vec_sub(point, a), side = pir_vec_sub(b, a);
        inside = inside && pir_vec_dot(pir_vec_cross(p->normal[f], side), way) > margin * pir_vec_length(side);
        least = fmin(least, from_side(way, side));
    }
    return inside ? fabs(above) : least;
}

double pir_convex_distance(const pir_polytope *p, pir_vec3 point, double reach) {
    const double margin = 0x1p-47 * reach;
    double least = HUGE_VAL;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        const double above =
            pir_vec_dot(p->normal[f], pir_vec_sub(point, p->vertex[p->origin[p->loop[p->loop_start[f]]]]));
        if (above > -margin && fabs(above) < least)
            least = fmin(least, from_facet(p, f, point, above, margin));
    }
    return least < HUGE_VAL ? least : 0;
}
