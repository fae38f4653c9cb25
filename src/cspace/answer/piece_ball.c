/* SPDX-License-Identifier: MIT */
/*
 * A ball around a piece: its centre begins at the mean of the vertices and moves towards the farthest vertex by ever
 * smaller parts of the way (Badoiu and Clarkson, Smaller core-sets for balls, SODA 2003); the best place is kept. A
 * vertex is rounded to the nearest double, so it is off by up to u of its length; radius and reach are rounded up by
 * more than that and what sums and roots are off by.
 */
#include "cspace/answer/piece_ball.h"

#define MOVES 48

double pir_scaled_length(pir_vec3 v) {
    double most = fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z));
    if (!(most > 0) || !isfinite(most))
        return most;
    v = (pir_vec3){v.x / most, v.y / most, v.z / most};
    return most * sqrt(pir_vec_dot(v, v));
}

static pir_vec3 mean_vertex(const pir_polytope *polytope) {
    const uint32_t count = pir_polytope_vertex_count(polytope);
    pir_vec3 mean = {0, 0, 0};
    for (uint32_t v = 0; v < count; v++)
        mean = pir_vec_add(mean, pir_vec_scale(pir_polytope_vertex(polytope, v), 1.0 / count));
    return mean;
}

/* The farthest vertex from a point, and how far it is. */
static double farthest(const pir_polytope *polytope, pir_vec3 from, pir_vec3 *ret_vertex) {
    double most = -1;
    *ret_vertex = from;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++) {
        pir_vec3 at = pir_polytope_vertex(polytope, v);
        double away = pir_safe_length(pir_vec_sub(at, from));
        if (away > most) {
            most = away;
            *ret_vertex = at;
        }
    }
    return most;
}

pir_piece_ball pir_piece_ball_of(const pir_polytope *polytope) {
    pir_vec3 at = mean_vertex(polytope), best = at, vertex;
    double least = farthest(polytope, at, &vertex);
    for (int move = 1; move <= MOVES; move++) {
        at = pir_vec_add(at, pir_vec_scale(pir_vec_sub(vertex, at), 1.0 / (move + 1)));
        double radius = farthest(polytope, at, &vertex);
        best = radius < least ? at : best;
        least = fmin(least, radius);
    }
    double reach = farthest(polytope, (pir_vec3){0, 0, 0}, &vertex) * (1 + 8 * PIR_ROUNDING);
    return (pir_piece_ball){polytope, best, least * (1 + 8 * PIR_ROUNDING) + 4 * PIR_ROUNDING * reach, reach};
}
