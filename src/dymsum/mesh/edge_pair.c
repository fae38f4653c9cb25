/* SPDX-License-Identifier: MIT */
/*
 * Exact signs of d × e for an edge e of P, rotated, and an edge d of Q.
 *
 * Doubles decide first. With unit vectors as in exact/sign.h a component of d × e errs by less than 2^-46, and so does
 * its product with a unit normal, summed up: three vectors that err by at most 51u each, and less than 10u of rounding,
 * below 2^-45, u = 2^-53 (tests/proofs/parallel.g).
 */
#include "dymsum/mesh/edge_pair.h"

#define PARALLEL_BOUND 0x1p-45

pir_status pir_posed_init(pir_posed *posed, const pir_allocator *allocator, const pir_polytope *p,
                          const pir_polytope *q, pir_signs *signs) {
    *posed = (pir_posed){p, q, signs, PIR_NEW(allocator, pir_vec3, p->facet_count)};
    if (!posed->normal)
        return PIR_ERR_MEMORY;
    for (uint32_t f = 0; f < p->facet_count; f++)
        posed->normal[f] = pir_mat_apply(&signs->rotation.r, p->normal[f]);
    return PIR_OK;
}

void pir_posed_finish(pir_posed *posed, const pir_allocator *allocator) {
    PIR_FREE(allocator, posed->normal, posed->p->facet_count);
}

/* d × M·e exactly, into scratch that the caller gives back. */
static pir_int3 exact_normal(const pir_posed *posed, const pir_edge_pair *pair) {
    pir_limbs *scratch = posed->signs->scratch;
    pir_int3 e = pir_half_exact(posed->p, pair->half), d = pir_half_exact(posed->q, pair->h);
    uint32_t le = pir_int3_length(&e) + PIR_MATRIX_LIMBS + 1, ld = pir_int3_length(&d);
    pir_rotation_make_exact(&posed->signs->rotation);
    pir_int3 rotated = pir_int3_take(scratch, le), n = pir_int3_take(scratch, le + ld + 1);
    pir_rotation_apply(&posed->signs->rotation, &rotated, &e, scratch);
    pir_int3_cross(&n, &d, &rotated, scratch);
    return n;
}

bool pir_edges_are_parallel(const pir_posed *posed, const pir_edge_pair *pair) {
    pir_vec3 n = pir_vec_cross(pair->d, pair->e);
    if (fabs(n.x) > PARALLEL_BOUND || fabs(n.y) > PARALLEL_BOUND || fabs(n.z) > PARALLEL_BOUND)
        return false;
    uint32_t mark = posed->signs->scratch->used;
    pir_int3 exact = exact_normal(posed, pair);
    posed->signs->scratch->used = mark;
    return pir_int3_is_zero(&exact);
}

/* 1 where d × e points along the normal of the facet, −1 where against it, 0 where it is zero; exactly. */
static int exact_side(const pir_posed *posed, const pir_edge_pair *pair, pir_facet_of facet) {
    pir_limbs *scratch = posed->signs->scratch;
    uint32_t mark = scratch->used;
    pir_int3 n = exact_normal(posed, pair);
    pir_int3 m = facet.of_p ? pir_normal_exact(posed->p, facet.facet) : pir_normal_exact(posed->q, facet.facet);
    if (facet.of_p) {
        pir_int3 own = m;
        m = pir_int3_take(scratch, pir_int3_length(&own) + PIR_MATRIX_LIMBS + 1);
        pir_rotation_apply(&posed->signs->rotation, &m, &own, scratch);
    }
    // parallel vectors have components that are equal in sign, or opposite in sign, wherever neither is zero
    int side = 0;
    for (int k = 0; k < 3 && side == 0; k++)
        side = pir_int_sign(&n.c[k]) * pir_int_sign(&m.c[k]);
    scratch->used = mark;
    return side;
}

/* The side by doubles where they are certain, else exactly. */
static int side_of(const pir_posed *posed, const pir_edge_pair *pair, pir_facet_of facet) {
    pir_vec3 normal = facet.of_p ? posed->normal[facet.facet] : posed->q->normal[facet.facet];
    double value = pir_vec_dot(pir_vec_cross(pair->d, pair->e), normal);
    return value > PARALLEL_BOUND ? 1 : value < -PARALLEL_BOUND ? -1 : exact_side(posed, pair, facet);
}

bool pir_edges_point_along(const pir_posed *posed, const pir_edge_pair *pair, pir_facet_of facet) {
    return side_of(posed, pair, facet) > 0;
}

int pir_edges_turn(const pir_posed *posed, const pir_edge_pair *pair, pir_facet_of facet) {
    return -side_of(posed, pair, facet);
}
