/* SPDX-License-Identifier: MIT */
/*
 * The whole-structure check of a sum: its invariants (pairing/pairing.h, pairing/tracked.h), every sign by exact
 * arithmetic, without the filter and the certificates; and that what a region needs is there (region/region.c).
 */
#include "dymsum/pairing/predicates.h"
#include "dymsum/sum.h"

/* s of a vector of P and one of Q at the perturbed rotation. */
static int sign_of(pir_sum *sum, pir_int3 a, pir_int3 b) {
    return pir_sign_perturbed(&sum->tracked.pairing.signs, &a, &b);
}

/* Whether the region certainly has a direction, beyond rounding: then its pair must be there. */
static bool is_needed(const pir_sum *sum, pir_vec3 n) {
    const pir_cone *cone = &sum->region.cone;
    return !cone->set || pir_vec_dot(cone->axis, n) > cone->cosine + 0x1p-30;
}

/* Whether the arc along halfedge `half` of P certainly enters the region. */
static bool is_arc_needed(const pir_sum *sum, uint32_t half) {
    pir_vec3 from = pir_rotated_normal(&sum->tracked.pairing, sum->tracked.pairing.p->left[half]),
             to = pir_rotated_normal(&sum->tracked.pairing, pir_right(sum->tracked.pairing.p, half));
    if (is_needed(sum, from) || is_needed(sum, to))
        return true;
    // else the point of its circle that is nearest to the axis, if it is on the arc
    pir_vec3 e = pir_rotated_direction(&sum->tracked.pairing, half), axis = sum->region.cone.axis;
    pir_vec3 nearest = pir_vec_sub(axis, pir_vec_scale(e, pir_vec_dot(e, axis)));
    double length = sqrt(pir_vec_dot(nearest, nearest));
    return length > 0x1p-20 && pir_vec_dot(pir_vec_cross(from, nearest), e) > 0 &&
           pir_vec_dot(pir_vec_cross(nearest, to), e) > 0 && is_needed(sum, pir_vec_scale(nearest, 1 / length));
}

static bool fv_is_valid(pir_sum *sum) {
    const pir_polytope *p = sum->tracked.pairing.p, *q = sum->tracked.pairing.q;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        uint32_t v = sum->tracked.pairing.fv[f];
        if (v == PIR_NO_PAIR && !is_needed(sum, pir_rotated_normal(&sum->tracked.pairing, f)))
            continue;
        if (v >= q->vertex_count)
            return false;
        for (uint32_t h = q->ring_start[v]; h < q->ring_start[v + 1]; h++)
            if (sign_of(sum, pir_normal_exact(p, f), pir_half_exact(q, h)) > 0)
                return false;
    }
    return true;
}

static bool vf_is_valid(pir_sum *sum) {
    const pir_polytope *p = sum->tracked.pairing.p, *q = sum->tracked.pairing.q;
    for (uint32_t g = 0; g < q->facet_count; g++) {
        uint32_t v = sum->tracked.pairing.vf[g];
        if (v == PIR_NO_PAIR && !is_needed(sum, q->normal[g]))
            continue;
        if (v >= p->vertex_count)
            return false;
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++)
            if (sign_of(sum, pir_half_exact(p, h), pir_normal_exact(q, g)) > 0)
                return false;
    }
    return true;
}

/* Whether halfedge h of Q, from one cell to the next, is crossed by the arc of halfedge `half` of P. */
static bool crosses(pir_sum *sum, uint32_t half, uint32_t h) {
    const pir_polytope *p = sum->tracked.pairing.p, *q = sum->tracked.pairing.q;
    pir_int3 e = pir_half_exact(p, half), d = pir_half_exact(q, h);
    return sign_of(sum, e, pir_normal_exact(q, pir_right(q, h))) < 0 &&
           sign_of(sum, e, pir_normal_exact(q, q->left[h])) > 0 &&
           sign_of(sum, pir_normal_exact(p, p->left[half]), d) < 0 &&
           sign_of(sum, pir_normal_exact(p, pir_right(p, half)), d) > 0;
}

static bool crossings_are_valid(pir_sum *sum) {
    const pir_polytope *p = sum->tracked.pairing.p, *q = sum->tracked.pairing.q;
    const pir_crossings *c = &sum->tracked.pairing.crossings;
    uint32_t count = 0;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t half = p->edge_half[e], v = sum->tracked.pairing.fv[p->left[half]];
        if (sum->tracked.touched[e] == PIR_INACTIVE) {
            if (sum->tracked.pairing.crossings.first[e] != PIR_NO_CROSSING || is_arc_needed(sum, half))
                return false;
            continue;
        }
        if (v == PIR_NO_PAIR)
            return false;
        for (uint32_t slot = sum->tracked.pairing.crossings.first[e]; slot != PIR_NO_CROSSING;
             slot = c->at[slot].next) {
            if (slot >= c->used || c->at[slot].edge != e || ++count > sum->tracked.pairing.crossings.count)
                return false;
            uint32_t h = c->at[slot].half;
            if (q->origin[h] != v || !crosses(sum, half, h))
                return false;
            v = q->target[h];
        }
        if (v != sum->tracked.pairing.fv[pir_right(p, half)])
            return false;
    }
    // the other slots are free
    for (uint32_t slot = c->free; slot != PIR_NO_CROSSING; slot = c->at[slot].next)
        if (slot >= c->used || c->at[slot].edge != PIR_NO_CROSSING || ++count > c->used)
            return false;
    return count == c->used;
}

bool pir_sum_is_valid(pir_sum *sum) {
    return fv_is_valid(sum) && vf_is_valid(sum) && crossings_are_valid(sum);
}
