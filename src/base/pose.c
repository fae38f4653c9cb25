/* SPDX-License-Identifier: MIT */
/*
 * Poses in doubles. A quaternion is first divided by the power of two of its largest component, so that neither its
 * square nor a product of two overflows; that changes no rotation and rounds nothing.
 */
#include <pirouette/pose.h>

#include "base/vec.h"

/* The quaternion with its largest component in [0.5, 1). */
static pir_quat scaled(pir_quat q) {
    double most = fmax(fmax(fabs(q.x), fabs(q.y)), fmax(fabs(q.z), fabs(q.w)));
    int exponent;
    (void)frexp(most, &exponent);
    return (pir_quat){ldexp(q.x, -exponent), ldexp(q.y, -exponent), ldexp(q.z, -exponent), ldexp(q.w, -exponent)};
}

static pir_quat conjugate(pir_quat q) {
    return (pir_quat){-q.x, -q.y, -q.z, q.w};
}

static pir_quat multiply(pir_quat a, pir_quat b) {
    return (pir_quat){a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

static double norm(pir_quat q) {
    return q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
}

/* v turned by q: v + 2 u × (u × v + w v) / |q|². */
static pir_vec3 turn(pir_quat given, pir_vec3 v) {
    pir_quat q = scaled(given);
    pir_vec3 u = {q.x, q.y, q.z};
    pir_vec3 inner = pir_vec_add(pir_vec_cross(u, v), pir_vec_scale(v, q.w));
    return pir_vec_add(v, pir_vec_scale(pir_vec_cross(u, inner), 2 / norm(q)));
}

pir_pose pir_pose_identity(void) {
    return (pir_pose){{0, 0, 0, 1}, {0, 0, 0}};
}

pir_pose pir_pose_compose(pir_pose outer, pir_pose inner) {
    return (pir_pose){multiply(scaled(outer.rotation), scaled(inner.rotation)),
                      pir_pose_apply(outer, inner.translation)};
}

pir_pose pir_pose_invert(pir_pose pose) {
    pir_quat back = conjugate(pose.rotation);
    return (pir_pose){back, turn(back, pir_vec_scale(pose.translation, -1))};
}

pir_vec3 pir_pose_apply(pir_pose pose, pir_vec3 point) {
    return pir_vec_add(turn(pose.rotation, point), pose.translation);
}

pir_vec3 pir_pose_apply_inverse(pir_pose pose, pir_vec3 point) {
    return turn(conjugate(pose.rotation), pir_vec_sub(point, pose.translation));
}

pir_vec3 pir_pose_rotate(pir_pose pose, pir_vec3 direction) {
    return turn(pose.rotation, direction);
}

pir_vec3 pir_pose_rotate_inverse(pir_pose pose, pir_vec3 direction) {
    return turn(conjugate(pose.rotation), direction);
}

/*
 * The quaternion of a turn by the vector: along its axis, through its length. Series of sine over angle and of cosine
 * at a half-angle below 1/4, where terms beyond the eighth are below 2^-53, then as many squarings as it was halved by.
 */
static pir_quat turn_by(pir_vec3 vector) {
    pir_vec3 half = pir_vec_scale(vector, 0.5);
    int halvings = 0;
    while (pir_vec_dot(half, half) > 0.0625 && halvings < 20) {
        half = pir_vec_scale(half, 0.5);
        halvings++;
    }
    double square = pir_vec_dot(half, half), sine = 1, cosine = 1;
    for (int k = 8; k > 0; k--) {
        sine = 1 - square / (2 * k * (2 * k + 1)) * sine;
        cosine = 1 - square / (2 * k * (2 * k - 1)) * cosine;
    }
    pir_quat q = {half.x * sine, half.y * sine, half.z * sine, cosine};
    for (int i = 0; i < halvings; i++)
        q = multiply(q, q);
    return q;
}

pir_pose pir_pose_integrate(pir_pose pose, pir_vec3 velocity, pir_vec3 angular_velocity, double time) {
    pir_quat q = multiply(turn_by(pir_vec_scale(angular_velocity, time)), scaled(pose.rotation));
    double length = sqrt(norm(q));
    return (pir_pose){{q.x / length, q.y / length, q.z / length, q.w / length},
                      pir_vec_add(pose.translation, pir_vec_scale(velocity, time))};
}
