/* SPDX-License-Identifier: MIT */
/*
 * Conservative advancement (Mirtich, "Impulse-based dynamic simulation of rigid body systems", 1996).
 *
 * At a separation with normal n no contact can come before P is down at the plane that has Q below it. Advancing to
 * that time (query/proof/parting.h) again and again comes as near to contact as the caller asks, and never past it.
 */
#include "query/answer/follow.h"
#include "query/proof/parting.h"

/* The bound on queries that query.h promises. Few motions need more than ten. */
#define MOST_QUERIES 256

/* A quaternion of this rotation whose products neither overflow nor underflow. */
static pir_quat middling(pir_quat r) {
    int e;
    frexp(fmax(fmax(fabs(r.x), fabs(r.y)), fmax(fabs(r.z), fabs(r.w))), &e);
    return (pir_quat){ldexp(r.x, -e), ldexp(r.y, -e), ldexp(r.z, -e), ldexp(r.w, -e)};
}

/*
 * The rotation at a time, where r is that at time 0, by `middling`. Where nothing has turned it is the caller's
 * quaternion, to the bit.
 */
static pir_quat rotation_at(const pir_motion *motion, pir_quat r, pir_vec3 unit_axis, double time) {
    double half = 0.5 * motion->angle * time, s = sin(half), w = cos(half);
    if (half == 0)
        return motion->rotation;
    pir_vec3 a = pir_vec_scale(unit_axis, s), v = {r.x, r.y, r.z};
    pir_vec3 c = pir_vec_cross(a, v);
    return (pir_quat){w * v.x + r.w * a.x + c.x, w * v.y + r.w * a.y + c.y, w * v.z + r.w * a.z + c.z,
                      w * r.w - pir_vec_dot(a, v)};
}

/* The distance of P's farthest vertex from the origin that P turns about, rounded up. */
static double reach_of(const pir_polytope *p) {
    pir_vec3 unit;
    double most = 0, part;
    int exponent;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        if (pir_unit_of(p->vertex[v], &unit, &part, &exponent))
            most = fmax(most, ldexp(part, exponent));
    return most * (1 + 0x1p-48) + 0x1p-1074;
}

static bool is_zero(pir_vec3 v) {
    return v.x == 0 && v.y == 0 && v.z == 0;
}

static pir_status check(pir_query *query, const pir_motion *motion, double tolerance, const void *ret) {
    if (!query || !motion || !ret)
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(motion->start) || !pir_vec_is_finite(motion->motion) || !pir_vec_is_finite(motion->axis) ||
        !isfinite(motion->angle) || !isfinite(tolerance))
        return PIR_ERR_NOT_FINITE;
    bool turns = motion->angle != 0;
    return tolerance > 0 && (!is_zero(motion->axis) || !turns) ? PIR_OK : PIR_ERR_ARGUMENT;
}

static void set_outcome(pir_cast_result *result, const pir_query_result *at, double time, pir_cast_outcome outcome) {
    result->outcome = outcome;
    result->time = time;
    result->normal = at->normal;
    result->point = at->point_q;
    result->witness = at->witness;
}

pir_status pir_query_advance(pir_query *query, const pir_motion *motion, double tolerance,
                             pir_cast_result *ret_result) {
    pir_status status = check(query, motion, tolerance, ret_result);
    if (status != PIR_OK)
        return status;
    double part;
    int exponent;
    pir_quat start = middling(motion->rotation);
    pir_vec3 axis = {0, 0, 0};
    pir_unit_of(motion->axis, &axis, &part, &exponent);
    const pir_polytope *p = pir_sum_pairing(query->sum)->p;
    const pir_parted body = {.point = p->vertex,
                             .count = p->vertex_count,
                             .reach = reach_of(p),
                             .way = motion->motion,
                             .turn = pir_vec_scale(axis, motion->angle)};
    double turning = fabs(motion->angle) * body.reach, time = 0;
    pir_cast_result result = {.outcome = PIR_CAST_STEP_LIMIT};
    pir_query_cache cache = {0};
    for (int i = 0; i < MOST_QUERIES; i++) {
        pir_query_input input = pir_query_input_default();
        pir_query_result at;
        input.translation = pir_vec_add(motion->start, pir_vec_scale(motion->motion, time));
        const pir_pose pose = {rotation_at(motion, start, axis, time), input.translation};
        status = pir_sum_rotate(query->sum, pose.rotation, PIR_METHOD_AUTO);
        if (status == PIR_OK)
            status = pir_query_signed_distance(query, &input, &cache, &at);
        if (status != PIR_OK)
            return status;
        result.steps += at.steps;
        double speed = turning - pir_vec_dot(at.normal, motion->motion);
        if (i == 0 && at.state == PIR_INSIDE) {
            set_outcome(&result, &at, 0, PIR_CAST_START_INSIDE);
            break;
        }
        if (i == 0 && at.state == PIR_BOUNDARY && speed <= 0) {
            set_outcome(&result, &at, 0, PIR_CAST_RECEDING);
            break;
        }
        if (at.distance <= tolerance) {
            set_outcome(&result, &at, time, PIR_CAST_HIT);
            break;
        }
        set_outcome(&result, &at, time, PIR_CAST_STEP_LIMIT);
        if (turning == 0 && is_zero(motion->motion)) {
            set_outcome(&result, &at, 1, PIR_CAST_AT_REST);
            break;
        }
        // advance to part of the tolerance, so that few steps are needed; past the end there is no contact
        const pir_parting plane = {at.normal, at.point_q, 0.75 * tolerance, 0.5 * tolerance};
        time = pir_part_until(&body, &plane, pose, at.distance, time, 1);
        if (!(time <= 1)) {
            set_outcome(&result, &at, 1, PIR_CAST_MISS);
            break;
        }
    }
    *ret_result = result;
    return PIR_OK;
}
