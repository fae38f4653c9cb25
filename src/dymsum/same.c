/* SPDX-License-Identifier: MIT */
/*
 * Are two pairings the same? Where regions are, so far as both cones reach: what a sum keeps beyond its own depends on how it came there.
 */
#include "dymsum/pairing/pairing.h"

/* Whether both sums are to have what has this normal. */
static bool both_have(const pir_sum *a, const pir_sum *b, pir_vec3 n) {
    return pir_cone_has(&a->region.cone, n) && pir_cone_has(&b->region.cone, n);
}

static bool same_cells(const pir_sum *a, const pir_sum *b) {
    const pir_polytope *p = a->p, *q = a->q;
    for (uint32_t f = 0; f < p->facet_count; f++)
        if (a->fv[f] != b->fv[f] && both_have(a, b, pir_rotated_normal(a, f)))
            return false;
    for (uint32_t g = 0; g < q->facet_count; g++)
        if (a->vf[g] != b->vf[g] && both_have(a, b, q->normal[g]))
            return false;
    return true;
}

/* Edges nearer to parallel than this, by the sine, cross nowhere in particular: their pieces have next to no area. */
#define NEARLY_PARALLEL 0x1p-30

/* The first crossing of edge e from `slot` on that both are to have. */
static uint32_t next_crossing(const pir_sum *a, const pir_sum *b, const pir_sum *of, uint32_t e, uint32_t slot) {
    if (!a->region.cone.set && !b->region.cone.set)
        return slot;
    pir_vec3 direction = pir_rotated_direction(of, of->p->edge_half[e]);
    for (; slot != PIR_NO_CROSSING; slot = of->crossings.next[slot]) {
        pir_vec3 n = pir_vec_cross(of->q->direction[of->crossings.half[slot]], direction);
        if (pir_vec_dot(n, n) >= NEARLY_PARALLEL * NEARLY_PARALLEL && both_have(a, b, n))
            break;
    }
    return slot;
}

static bool same_crossings(const pir_sum *a, const pir_sum *b, uint32_t e) {
    uint32_t i = next_crossing(a, b, a, e, a->first[e]), j = next_crossing(a, b, b, e, b->first[e]);
    while (i != PIR_NO_CROSSING && j != PIR_NO_CROSSING && a->crossings.half[i] == b->crossings.half[j]) {
        i = next_crossing(a, b, a, e, a->crossings.next[i]);
        j = next_crossing(a, b, b, e, b->crossings.next[j]);
    }
    return i == PIR_NO_CROSSING && j == PIR_NO_CROSSING;
}

int pir_sum_same_pairing(const pir_sum *a, const pir_sum *b) {
    const pir_polytope *p = a->p, *q = a->q;
    if (p->facet_count != b->p->facet_count || q->facet_count != b->q->facet_count || p->edge_count != b->p->edge_count)
        return 0;
    if (!same_cells(a, b))
        return 0;
    for (uint32_t e = 0; e < p->edge_count; e++)
        if (!same_crossings(a, b, e))
            return 0;
    return 1;
}
