/* SPDX-License-Identifier: MIT */
/* On which side of a facet's plane a translation lies, exactly: the sign of n·W (exact.h) for a corner of the facet. */
#include "query/query.h"

bool pir_side_normal(pir_query *query, pir_piece piece, pir_vec3 *ret_normal) {
    pir_rotation_make_exact(pir_sum_exact_rotation(query->sum));
    uint32_t mark = query->scratch.used;
    pir_int3 n = pir_exact_normal(query, piece);
    bool is_normal = !pir_int3_is_zero(&n);
    if (is_normal)
        *ret_normal = pir_int3_unit(&n);
    query->scratch.used = mark;
    return is_normal;
}

void pir_piece_corner(const pir_query *query, pir_piece piece, uint32_t *ret_a, uint32_t *ret_b) {
    const pir_polytope *p = query->p, *q = query->q;
    if (piece.kind == PIR_FACET_FV) {
        *ret_a = p->origin[p->loop[p->loop_start[piece.first]]];
        *ret_b = pir_sum_pairing(query->sum)->fv[piece.first];
    } else if (piece.kind == PIR_FACET_VF) {
        *ret_a = pir_sum_pairing(query->sum)->vf[piece.second];
        *ret_b = q->origin[q->loop[q->loop_start[piece.second]]];
    } else {
        *ret_a = p->origin[p->edge_half[piece.first]];
        *ret_b = q->origin[piece.second];
    }
}

int pir_side_exact(pir_query *query, pir_piece piece, pir_vec3 translation) {
    pir_exact_begin(query, translation);
    uint32_t mark = query->scratch.used, a, b;
    pir_piece_corner(query, piece, &a, &b);
    pir_int3 n = pir_exact_normal(query, piece), corner = pir_exact_corner(query, a, b);
    int sign = pir_exact_dot_sign(query, &n, &corner);
    query->scratch.used = mark;
    return sign;
}
