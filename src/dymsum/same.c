/* SPDX-License-Identifier: MIT */
/*
 * Whether two pairings are the same. Where regions are set, they are compared within both cones: what a sum keeps
 * beyond its own cone depends on its history.
 */
#include "dymsum/pairing/predicates.h"
#include "dymsum/view.h"

/* One of the two sums. */
struct compared_sum {
    const pir_pairing *pairing;
    const pir_cone *cone;
};

/* Whether both sums must have what has this normal. */
static bool both_have(const struct compared_sum *a, const struct compared_sum *b, pir_vec3 n) {
    return pir_cone_has(a->cone, n) && pir_cone_has(b->cone, n);
}

static bool same_cells(const struct compared_sum *a, const struct compared_sum *b) {
    const pir_polytope *p = a->pairing->p, *q = a->pairing->q;
    for (uint32_t f = 0; f < p->facet_count; f++)
        if (a->pairing->fv[f] != b->pairing->fv[f] && both_have(a, b, pir_rotated_normal(a->pairing, f)))
            return false;
    for (uint32_t g = 0; g < q->facet_count; g++)
        if (a->pairing->vf[g] != b->pairing->vf[g] && both_have(a, b, q->normal[g]))
            return false;
    return true;
}

/*
 * The normal of a crossing of edges whose sine is below this is mostly rounding, and its piece has next to no area.
 * Whether it is in a cone is not told by doubles.
 */
#define NEARLY_PARALLEL 0x1p-30

/* The first crossing of edge e from `at` on that both sums must have. */
static uint32_t next_crossing(const struct compared_sum *a, const struct compared_sum *b, const struct compared_sum *of,
                              uint32_t e, uint32_t at) {
    if (!a->cone->set && !b->cone->set)
        return at;
    pir_vec3 direction = pir_rotated_direction(of->pairing, of->pairing->p->edge_half[e]);
    for (; at != PIR_NO_CROSSING; at = pir_crossing_next(of->pairing, at)) {
        pir_vec3 n = pir_vec_cross(of->pairing->q->direction[pir_crossing_half(of->pairing, at)], direction);
        if (pir_vec_dot(n, n) >= NEARLY_PARALLEL * NEARLY_PARALLEL && both_have(a, b, n))
            break;
    }
    return at;
}

static bool same_crossings(const struct compared_sum *a, const struct compared_sum *b, uint32_t e) {
    uint32_t i = next_crossing(a, b, a, e, pir_crossing_first(a->pairing, e)),
             j = next_crossing(a, b, b, e, pir_crossing_first(b->pairing, e));
    while (i != PIR_NO_CROSSING && j != PIR_NO_CROSSING &&
           pir_crossing_half(a->pairing, i) == pir_crossing_half(b->pairing, j)) {
        i = next_crossing(a, b, a, e, pir_crossing_next(a->pairing, i));
        j = next_crossing(a, b, b, e, pir_crossing_next(b->pairing, j));
    }
    return i == PIR_NO_CROSSING && j == PIR_NO_CROSSING;
}

bool pir_sum_same_pairing(const pir_sum *one, const pir_sum *other) {
    const struct compared_sum a = {pir_sum_pairing(one), pir_sum_cone(one)},
                              b = {pir_sum_pairing(other), pir_sum_cone(other)};
    const pir_polytope *p = a.pairing->p, *q = a.pairing->q, *p_of_b = b.pairing->p, *q_of_b = b.pairing->q;
    if (p->facet_count != p_of_b->facet_count || q->facet_count != q_of_b->facet_count ||
        p->edge_count != p_of_b->edge_count)
        return false;
    if (!same_cells(&a, &b))
        return false;
    for (uint32_t e = 0; e < p->edge_count; e++)
        if (!same_crossings(&a, &b, e))
            return false;
    return true;
}
