/* SPDX-License-Identifier: MIT */
/*
 * Exact points of the sum. With P on the scale n/d, Q on the scale m/c and R = M/N,
 *
 *     R·p·(n/d) + q·(m/c) = (n c · M p + N m d · q) / (N d c),
 *
 * so all of them are integers over one denominator.
 */
#include "dymsum/mesh/placing.h"

pir_status pir_placing_init(pir_placing *placing, const pir_allocator *allocator, const pir_polytope *p,
                            const pir_polytope *q, pir_rotation *rotation) {
    pir_rotation_make_exact(rotation);
    const pir_scale *sp = &p->scale, *sq = &q->scale;
    uint32_t np = pir_int_length(&sp->num), dp = pir_int_length(&sp->den), nq = pir_int_length(&sq->num),
             dq = pir_int_length(&sq->den), norm = pir_int_length(&rotation->integers->norm), m = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            m = pir_int_length(&rotation->integers->m[i][j]) > m ? pir_int_length(&rotation->integers->m[i][j]) : m;
    /*
     * A product has as many limbs as its factors together; a sum of three products, all of one length at most, has one
     * more. So a component of M·p has m + stride + 1. pir_placing_set takes most of the scratch: one such component
     * (at most `stride`) and a product of it with p_factor, or of q_factor with q (at most `stride` either). What is
     * made here first, N·d and its product with m or c, fits beside.
     */
    uint32_t p_limbs = np + dq, q_limbs = norm + nq + dp, den_limbs = norm + dp + dq;
    uint32_t from_p = p_limbs + m + 1 + p->exact_vertex.stride, from_q = q_limbs + q->exact_vertex.stride;
    uint32_t stride = (from_p > from_q ? from_p : from_q) + 1, work = 2 * stride + den_limbs + q_limbs;
    uint32_t count = p_limbs + q_limbs + den_limbs + work;
    mp_limb_t *limbs = PIR_NEW(allocator, mp_limb_t, count);
    if (!limbs)
        return PIR_ERR_MEMORY;
    *placing = (pir_placing){
        .p = p, .q = q, .rotation = rotation, .stride = stride, .limbs = limbs, .limb_count = count, .one = 1};
    pir_limbs room = {limbs, 0, count};
    placing->p_factor = pir_limbs_take(&room, p_limbs);
    placing->q_factor = pir_limbs_take(&room, q_limbs);
    placing->scale.num = (pir_int){&placing->one, 1, 0};
    placing->scale.den = pir_limbs_take(&room, den_limbs);
    placing->scratch = (pir_limbs){limbs + room.used, 0, work};
    // the products at the head of this file
    pir_int_mul(&placing->p_factor, &sp->num, &sq->den);
    pir_int part = pir_limbs_take(&placing->scratch, den_limbs + q_limbs);
    pir_int_mul(&part, &rotation->integers->norm, &sp->den);
    pir_int_mul(&placing->q_factor, &part, &sq->num);
    pir_int_mul(&placing->scale.den, &part, &sq->den);
    placing->scratch.used = 0;
    return PIR_OK;
}

void pir_placing_finish(pir_placing *placing, const pir_allocator *allocator) {
    PIR_FREE(allocator, placing->limbs, placing->limb_count);
    placing->limbs = NULL;
}

void pir_placing_set(pir_placing *placing, uint32_t p, uint32_t q, pir_vectors *points, uint32_t index) {
    pir_limbs *scratch = &placing->scratch;
    pir_int3 x = pir_vertex_exact(placing->p, p), y = pir_vertex_exact(placing->q, q);
    pir_int3 to = pir_vectors_at(points, index);
    uint32_t mark = scratch->used;
    pir_int rotated = pir_limbs_take(scratch, placing->stride);
    for (int i = 0; i < 3; i++) {
        rotated.size = 0;
        for (int j = 0; j < 3; j++)
            pir_int_add_mul(&rotated, &placing->rotation->integers->m[i][j], &x.c[j], scratch);
        pir_int_mul(&to.c[i], &rotated, &placing->p_factor);
        pir_int_add_mul(&to.c[i], &y.c[i], &placing->q_factor, scratch);
    }
    scratch->used = mark;
    pir_vectors_put(points, index, &to);
}

bool pir_placing_fill(pir_placing *placing, pir_mesh *mesh) {
    if (!pir_vectors_init(&mesh->where, &mesh->allocator, mesh->vertex_count, placing->stride) ||
        !pir_scale_copy(&mesh->scale, &mesh->allocator, &placing->scale))
        return false;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        pir_placing_set(placing, mesh->pair[v][0], mesh->pair[v][1], &mesh->where, v);
    mesh->exact = true;
    return true;
}
