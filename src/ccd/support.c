/* SPDX-License-Identifier: MIT */
/* Supports by hill climbing in the form that libccd calls. */
#include <pirouette/ccd.h>
#include <pirouette/query.h>

#include "dymsum/view.h"
#include "query/frame/climb.h"

/* The matrix of a quaternion of any length, or the identity where the quaternion is no rotation. */
static pir_mat3 matrix_of(pir_quat q) {
    pir_rotation rotation;
    return pir_rotation_set(&rotation, q) == PIR_OK ? rotation.r : (pir_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

/* `direction` as a unit vector, or any unit vector where it has no direction. */
static pir_vec3 unit_direction(const double *direction) {
    double most = fmax(fabs(direction[0]), fmax(fabs(direction[1]), fabs(direction[2])));
    if (!(most > 0 && most < HUGE_VAL))
        return (pir_vec3){1, 0, 0};
    pir_vec3 d = {direction[0] / most, direction[1] / most, direction[2] / most};
    return pir_vec_scale(d, 1 / sqrt(pir_vec_dot(d, d)));
}

static void put_point(pir_vec3 p, double *ret_point) {
    ret_point[0] = p.x;
    ret_point[1] = p.y;
    ret_point[2] = p.z;
}

void pir_support_body_ccd(const void *object, const double *direction, double *ret_point) {
    // libccd's form says const, but the last vertex is a hint that the caller owns
    pir_support_body *body = (pir_support_body *)object;
    const pir_polytope *p = body->polytope;
    pir_mat3 r = matrix_of(body->rotation);
    pir_vec3 d = pir_mat_apply_transposed(&r, unit_direction(direction));
    body->last = pir_climb(p, d, body->last < p->vertex_count ? body->last : 0);
    put_point(pir_vec_add(pir_mat_apply(&r, p->vertex[body->last]), body->translation), ret_point);
}

void pir_support_sum_ccd(const void *object, const double *direction, double *ret_point) {
    const pir_sum *sum = object;
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_polytope *p = pairing->p, *q = pairing->q;
    const pir_mat3 *r = &pairing->signs.rotation.r;
    pir_vec3 d = unit_direction(direction);
    uint32_t a = pir_climb(p, pir_mat_apply_transposed(r, d), 0), b = pir_climb(q, d, 0);
    put_point(pir_vec_add(pir_mat_apply(r, p->vertex[a]), q->vertex[b]), ret_point);
}
