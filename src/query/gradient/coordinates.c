/* SPDX-License-Identifier: MIT */
/* Derivatives in other coordinates, and to the vertices of a feature. All are linear in the first ones. */
#include <pirouette/gradient.h>

#include <math.h>

#include "base/vec.h"
#include "polytope/polytope.h"

double pir_wrench_along(pir_wrench wrench, pir_vec3 velocity, pir_vec3 angular_velocity) {
    return pir_vec_dot(wrench.force, velocity) + pir_vec_dot(wrench.torque, angular_velocity);
}

pir_wrench pir_wrench_in_body(pir_wrench wrench, pir_pose pose) {
    return (pir_wrench){pir_pose_rotate_inverse(pose, wrench.force), pir_pose_rotate_inverse(pose, wrench.torque)};
}

pir_wrench pir_wrench_in_space(pir_wrench wrench, pir_pose pose) {
    return (pir_wrench){wrench.force, pir_vec_add(wrench.torque, pir_vec_cross(pose.translation, wrench.force))};
}

/* A change dq turns by w = 2 vec(dq · q⁻¹): hence 2/|q|² (w τ + τ × v, −τ·v) for q = (v, w). */
pir_quat pir_wrench_by_quat(pir_wrench wrench, pir_quat q) {
    const pir_vec3 v = {q.x, q.y, q.z}, torque = wrench.torque;
    // of a quaternion of any length: by its greatest component first
    const double most = fmax(fmax(fabs(q.x), fabs(q.y)), fmax(fabs(q.z), fabs(q.w)));
    const pir_vec3 u = pir_vec_scale(v, 1 / most);
    const double w = q.w / most, s = 2 / (pir_vec_dot(u, u) + w * w) / most;
    const pir_vec3 by_v = pir_vec_scale(pir_vec_add(pir_vec_scale(torque, w), pir_vec_cross(torque, u)), s);
    return (pir_quat){by_v.x, by_v.y, by_v.z, -s * pir_vec_dot(torque, u)};
}

/* --- second derivatives --- */

/* Turns the four triples of a row of twelve into the axes of the bodies. */
static void turn_row(double row[12], pir_pose pose_p, pir_pose pose_q) {
    for (int at = 0; at < 12; at += 3) {
        const pir_vec3 v =
            pir_pose_rotate_inverse(at < 6 ? pose_p : pose_q, (pir_vec3){row[at], row[at + 1], row[at + 2]});
        row[at] = v.x;
        row[at + 1] = v.y;
        row[at + 2] = v.z;
    }
}

static void transpose(double m[12][12]) {
    for (int i = 0; i < 12; i++)
        for (int j = 0; j < i; j++) {
            const double c = m[i][j];
            m[i][j] = m[j][i];
            m[j][i] = c;
        }
}

pir_curvature pir_curvature_in_body(const pir_curvature *curvature, pir_pose pose_p, pir_pose pose_q) {
    pir_curvature turned = *curvature;
    for (int i = 0; i < 3; i++)
        turn_row(turned.normal[i], pose_p, pose_q);
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < 12; i++)
            turn_row(turned.hessian[i], pose_p, pose_q);
        transpose(turned.hessian);
    }
    // rows were turned before columns, which rounds otherwise
    for (int i = 0; i < 12; i++)
        for (int j = 0; j < i; j++)
            turned.hessian[i][j] = turned.hessian[j][i] = 0.5 * (turned.hessian[i][j] + turned.hessian[j][i]);
    return turned;
}

/* --- vertices --- */

/* The weights of three corners at a point of their plane; what is below 0 is rounding or beside, and becomes 0. */
static void weigh_corners(const pir_vec3 at[3], pir_vec3 point, double weights[3]) {
    const pir_vec3 n = pir_vec_cross(pir_vec_sub(at[1], at[0]), pir_vec_sub(at[2], at[0]));
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const pir_vec3 a = pir_vec_sub(at[(k + 1) % 3], point), b = pir_vec_sub(at[(k + 2) % 3], point);
        weights[k] = fmax(0, pir_vec_dot(pir_vec_cross(a, b), n));
        sum += weights[k];
    }
    for (int k = 0; k < 3; k++)
        weights[k] = sum > 0 ? weights[k] / sum : 1.0 / 3;
}

/* How far a point is outside of the triangle, at most 0 within. */
static double outside_of(const pir_vec3 at[3], pir_vec3 point) {
    const pir_vec3 n = pir_vec_cross(pir_vec_sub(at[1], at[0]), pir_vec_sub(at[2], at[0]));
    double most = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const pir_vec3 a = pir_vec_sub(at[(k + 1) % 3], point), b = pir_vec_sub(at[(k + 2) % 3], point);
        most = fmax(most, -pir_vec_dot(pir_vec_cross(a, b), n) / pir_vec_dot(n, n));
    }
    return most;
}

static size_t weigh_facet(const pir_polytope *p, uint32_t facet, pir_vec3 point, uint32_t *ret_vertices,
                          double *ret_weights) {
    const uint32_t start = p->loop_start[facet], end = p->loop_start[facet + 1];
    double least = HUGE_VAL;
    pir_vec3 best[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (uint32_t i = start + 1; i + 1 < end; i++) {
        const uint32_t v[3] = {p->origin[p->loop[start]], p->origin[p->loop[i]], p->origin[p->loop[i + 1]]};
        const pir_vec3 at[3] = {p->vertex[v[0]], p->vertex[v[1]], p->vertex[v[2]]};
        const double outside = outside_of(at, point);
        if (i > start + 1 && !(outside < least))
            continue;
        least = outside;
        for (int k = 0; k < 3; k++) {
            ret_vertices[k] = v[k];
            best[k] = at[k];
        }
    }
    weigh_corners(best, point, ret_weights);
    return 3;
}

static size_t weigh_edge(const pir_polytope *p, uint32_t edge, pir_vec3 point, uint32_t *ret_vertices,
                         double *ret_weights) {
    const uint32_t half = p->edge_half[edge], a = p->origin[half], b = p->target[half];
    const pir_vec3 e = pir_vec_sub(p->vertex[b], p->vertex[a]);
    const double part = pir_vec_dot(pir_vec_sub(point, p->vertex[a]), e) / pir_vec_dot(e, e);
    ret_vertices[0] = a;
    ret_vertices[1] = b;
    ret_weights[1] = part > 0 ? fmin(part, 1) : 0;
    ret_weights[0] = 1 - ret_weights[1];
    return 2;
}

size_t pir_feature_weights(const pir_polytope *polytope, pir_feature feature, pir_vec3 point, uint32_t *ret_vertices,
                           double *ret_weights) {
    switch (feature.kind) {
    case PIR_FEATURE_VERTEX:
        if (feature.index >= polytope->vertex_count)
            return 0;
        ret_vertices[0] = feature.index;
        ret_weights[0] = 1;
        return 1;
    case PIR_FEATURE_EDGE:
        if (feature.index >= pir_polytope_edge_count(polytope))
            return 0;
        return weigh_edge(polytope, feature.index, point, ret_vertices, ret_weights);
    case PIR_FEATURE_FACET:
        if (feature.index >= pir_polytope_facet_count(polytope))
            return 0;
        return weigh_facet(polytope, feature.index, point, ret_vertices, ret_weights);
    default:
        return 0;
    }
}
