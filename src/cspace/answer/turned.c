/* SPDX-License-Identifier: MIT */
/*
 * Poses beside slices. With u = 2^-53: matrices are within 31u of the exact ones in Frobenius norm (exact/rotation.h),
 * their difference so within 62u and, its entries rounded, 66u; vertices are within u of their length. Errors below are
 * some 100u of the lengths that enter; 512u holds them.
 */
#include "cspace/answer/turned.h"

#include <math.h>

#define ERROR (512 * PIR_ROUNDING)

pir_turned pir_turned_of(const pir_rotation *pose, pir_vec3 translation, const pir_rotation *slice) {
    pir_turned turned = {.a = pose->r, .t = translation};
    for (int k = 0; k < 9; k++)
        turned.between.m[k / 3][k % 3] = pose->r.m[k / 3][k % 3] - slice->r.m[k / 3][k % 3];
    turned.turn = pir_rotation_angle_bound(pose->unit, slice->unit);
    return turned;
}

pir_vec3 pir_turned_shift(const pir_turned *turned, const pir_piece_ball *p) {
    return pir_mat_apply(&turned->between, p->centre);
}

double pir_turned_error(const pir_turned *turned, const pir_piece_ball *p, const pir_piece_ball *q) {
    return ERROR * (p->reach + q->reach + pir_safe_length(turned->t));
}

double pir_turned_by_ball(const pir_turned *turned, const pir_piece_ball *p) {
    // no point moves by more than twice the radius
    return fmin(turned->turn, 2) * p->radius * (1 + ERROR);
}

double pir_turned_by_vertices(const pir_turned *turned, const pir_piece_ball *p) {
    double most = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p->polytope); v++) {
        pir_vec3 moved = pir_mat_apply(&turned->between, pir_vec_sub(pir_polytope_vertex(p->polytope, v), p->centre));
        most = fmax(most, pir_vec_dot(moved, moved));
    }
    return sqrt(most) * (1 + ERROR) + ERROR * p->reach;
}
