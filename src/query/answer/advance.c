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

/* The rotation at a time, where `start` was that at time 0, and r the same by `middling`. */
static pir_quat rotation_at(pir_quat start, pir_quat r, pir_vec3 unit_axis, double angle, double time) {
    double half = 0.5 * angle * time, s = sin(half), w = cos(half);
    if (half == 0)
        return start;
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

static void set_outcome(pir_impact *impact, const pir_query_result *at, double time, pir_cast_outcome outcome) {
    impact->outcome = outcome;
    impact->time = time;
    impact->normal = at->normal;
    impact->point = at->point_q;
    impact->witness = at->witness;
}

/* An advance: P's motion, where it began, and how near it has come. */
struct advance {
    pir_query *query;
    pir_query_input input; /* its translation is that of the time at hand */
    const pir_motion *motion;
    pir_quat start, middling;
    pir_vec3 from, axis;
    double angle;
    pir_parted body;
    double tolerance, near; /* how near counts as met, once that is known */
    pir_query_cache cache;
};

/* Whether what was found at time 0 ends the search. */
static bool ends_at_once(struct advance *advance, const pir_query_result *at, pir_impact *impact) {
    const pir_motion *motion = advance->motion;
    const double speed = advance->angle * advance->body.reach - pir_vec_dot(at->normal, motion->way);
    const bool shares = at->state != PIR_OUTSIDE;
    if (motion->held > 0 && shares)
        set_outcome(impact, at, 1, PIR_CAST_MISS);
    else if (at->state == PIR_INSIDE)
        set_outcome(impact, at, 0, PIR_CAST_START_INSIDE);
    else if (at->state == PIR_BOUNDARY && speed <= 0)
        set_outcome(impact, at, 0, PIR_CAST_RECEDING);
    else if (at->distance > advance->tolerance && advance->angle == 0 && is_zero(motion->way))
        set_outcome(impact, at, 1, PIR_CAST_AT_REST);
    else if ((advance->near = pir_motion_near(motion, advance->tolerance, at->distance, 0)) == 0)
        set_outcome(impact, at, 1, PIR_CAST_MISS);
    else
        return false;
    return true;
}

/* One step from `impact->time` on. Where the outcome is PIR_CAST_STEP_LIMIT the search goes on. */
static pir_status step(struct advance *advance, int number, pir_impact *impact) {
    const double time = impact->time;
    pir_query_result at;
    advance->input.translation = pir_vec_add(advance->from, pir_vec_scale(advance->motion->way, time));
    const pir_pose pose = {rotation_at(advance->start, advance->middling, advance->axis, advance->angle, time),
                           advance->input.translation};
    pir_status status = pir_sum_rotate(advance->query->sum, pose.rotation, PIR_METHOD_AUTO);
    if (status == PIR_OK)
        status = pir_query_signed_distance(advance->query, &advance->input, &advance->cache, &at);
    if (status != PIR_OK)
        return status;
    impact->steps += at.steps;
    if (number == 0 && ends_at_once(advance, &at, impact))
        return PIR_OK;
    set_outcome(impact, &at, time, at.distance <= advance->near ? PIR_CAST_HIT : PIR_CAST_STEP_LIMIT);
    if (impact->outcome == PIR_CAST_HIT)
        return PIR_OK;
    // advance to part of what counts as met, so that few steps are needed; past the end there is no contact
    const pir_parting plane = {at.normal, at.point_q, 0.75 * advance->near, 0.5 * advance->near};
    impact->time = pir_part_until(&advance->body, &plane, pose, at.distance, time, 1);
    if (!(impact->time <= 1))
        set_outcome(impact, &at, 1, PIR_CAST_MISS);
    return PIR_OK;
}

pir_status pir_query_time_of_impact(pir_query *query, const pir_query_input *input, const pir_motion *motion,
                                    double tolerance, pir_impact *ret_impact) {
    pir_placement placement;
    if (!query || !input || !motion || !ret_impact)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_motion_check(motion, tolerance);
    if (status == PIR_OK)
        status = pir_query_begin(query, input, &placement);
    if (status != PIR_OK)
        return status;
    struct advance advance = {.query = query, .input = *input, .motion = motion, .tolerance = tolerance};
    double part;
    int exponent;
    advance.input.cutoff = HUGE_VAL;
    advance.from = input->translation;
    advance.start = pir_sum_rotation(query->sum);
    advance.middling = middling(advance.start);
    if (pir_unit_of(motion->turn, &advance.axis, &part, &exponent))
        advance.angle = ldexp(part, exponent);
    // the sum holds −P, which keeps P
    pir_polytope *p;
    status = pir_polytope_reflect(query->p, &p);
    if (status != PIR_OK)
        return status;
    advance.body = (pir_parted){.point = p->vertex,
                                .count = p->vertex_count,
                                .radius = input->radius_p,
                                .reach = reach_of(p),
                                .way = motion->way,
                                .turn = motion->turn};
    pir_impact impact = {.outcome = PIR_CAST_STEP_LIMIT};
    for (int i = 0; i < MOST_QUERIES && impact.outcome == PIR_CAST_STEP_LIMIT && status == PIR_OK; i++)
        status = step(&advance, i, &impact);
    pir_polytope_release(p);
    if (status != PIR_OK)
        return status;
    *ret_impact = impact;
    return PIR_OK;
}
