/* SPDX-License-Identifier: MIT */
/*
 * The sum of two coplanar convex polygons, an edge being one of two sides: the sides of both in the order of their
 * directions (de Berg, Cheong, van Kreveld, Overmars, Computational Geometry, 3rd ed., section 13.2). Parallel sides
 * become one, so no corner is straight.
 *
 * Directions count from that of P's first side. Both polygons begin at their vertices farthest to the right of that
 * direction, and there the first sides lie within half a turn. From then on the next sides of the two are less than
 * half a turn apart: of two consecutive sides of one, which turn by half a turn at most, the first is not ahead of the
 * other's next. So the sign of the turn between the next sides tells which comes first.
 */
#include "dymsum/mesh/face_sum.h"

static int turn_between(const pir_posed *posed, uint32_t half, uint32_t h, pir_facet_of facet) {
    pir_edge_pair pair = {half, h, pir_posed_direction(posed, half), posed->q->direction[h]};
    return pir_edges_turn(posed, &pair, facet);
}

/* Whether the direction of halfedge h of Q is less than half a turn ahead of that of `half`, or equal to it. */
static bool is_ahead(const pir_posed *posed, uint32_t half, uint32_t h, pir_facet_of facet) {
    int turn = turn_between(posed, half, h, facet);
    // parallel: doubles tell equal from opposite
    return turn > 0 || (turn == 0 && pir_vec_dot(pir_posed_direction(posed, half), posed->q->direction[h]) > 0);
}

/* The side of Q's face at which the merge begins: the first that is ahead of P's first. */
static uint32_t first_side(const pir_posed *posed, uint32_t half, pir_face_edges of_q, pir_facet_of facet) {
    bool before = is_ahead(posed, half, of_q.half[of_q.count - 1], facet);
    for (uint32_t j = 0; j < of_q.count; j++) {
        bool ahead = is_ahead(posed, half, of_q.half[j], facet);
        if (ahead && !before)
            return j;
        before = ahead;
    }
    PIR_ASSERT(false);
    return 0;
}

uint32_t pir_face_sum(const pir_posed *posed, pir_face_edges of_p, pir_face_edges of_q, pir_facet_of facet,
                      pir_sum_corner *corner) {
    uint32_t count = 0, i = 0, j = 0, start = first_side(posed, of_p.half[0], of_q, facet);
    while (i < of_p.count || j < of_q.count) {
        uint32_t half = of_p.half[i % of_p.count], h = of_q.half[(start + j) % of_q.count];
        corner[count++] = (pir_sum_corner){posed->p->origin[half], posed->q->origin[h]};
        int turn = i == of_p.count ? -1 : j == of_q.count ? 1 : turn_between(posed, half, h, facet);
        i += turn >= 0;
        j += turn <= 0;
    }
    return count;
}
