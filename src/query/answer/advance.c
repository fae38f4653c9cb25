/* SPDX-License-Identifier: MIT */
/* When P, moving, comes near Q: the advance of query/proof/parting.h by the distances of a sum. */
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

/* An advance on a query, and where P's motion begins. */
struct query_advance {
    pir_advance advance; /* first: what the loop knows */
    pir_query *query;
    pir_query_input input; /* its translation is that of the time at hand */
    pir_quat start, middling;
    pir_vec3 from, axis;
    double angle;
    pir_query_cache cache;
    uint32_t steps;
};

/* The outcome of what was found at time 0; PIR_CAST_STEP_LIMIT where the search goes on. */
static pir_cast_outcome outcome_at_once(const struct query_advance *on) {
    const pir_motion *motion = on->advance.motion;
    const pir_query_result *at = &on->advance.answer;
    const double speed = on->angle * on->advance.body.reach - pir_vec_dot(at->normal, motion->way);
    if (motion->held > 0 && at->state != PIR_OUTSIDE)
        return PIR_CAST_MISS;
    if (at->state == PIR_INSIDE)
        return PIR_CAST_START_INSIDE;
    if (at->state == PIR_BOUNDARY && speed <= 0)
        return PIR_CAST_RECEDING;
    bool rests = at->distance > on->advance.tolerance && on->angle == 0 && is_zero(motion->way);
    return rests ? PIR_CAST_AT_REST : PIR_CAST_STEP_LIMIT;
}

static pir_status ask(pir_advance *advance, pir_pose *ret_pose) {
    struct query_advance *on = (struct query_advance *)advance;
    const double time = advance->time;
    on->input.translation = pir_vec_add(on->from, pir_vec_scale(advance->motion->way, time));
    *ret_pose = (pir_pose){rotation_at(on->start, on->middling, on->axis, on->angle, time), on->input.translation};
    pir_status status = pir_sum_rotate(on->query->sum, ret_pose->rotation, PIR_METHOD_AUTO);
    if (status == PIR_OK)
        status = pir_query_signed_distance(on->query, &on->input, &on->cache, &advance->answer);
    if (status != PIR_OK)
        return status;
    on->steps += advance->answer.steps;
    if (time == 0)
        advance->outcome = outcome_at_once(on);
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
    // the sum holds −P, which keeps P
    pir_polytope *p;
    if (status == PIR_OK)
        status = pir_polytope_reflect(query->p, &p);
    if (status != PIR_OK)
        return status;
    struct query_advance on = {.query = query, .input = *input, .from = input->translation};
    double part;
    int exponent;
    on.input.cutoff = HUGE_VAL;
    on.start = pir_sum_rotation(query->sum);
    on.middling = middling(on.start);
    if (pir_unit_of(motion->turn, &on.axis, &part, &exponent))
        on.angle = ldexp(part, exponent);
    on.advance = (pir_advance){.body = {.point = p->vertex,
                                        .count = p->vertex_count,
                                        .radius = input->radius_p,
                                        .reach = reach_of(p),
                                        .way = motion->way,
                                        .turn = motion->turn},
                               .motion = motion,
                               .tolerance = tolerance,
                               .until = 1,
                               .steps = MOST_QUERIES,
                               .ask = ask};
    status = pir_advance_run(&on.advance);
    pir_polytope_release(p);
    if (status != PIR_OK)
        return status;
    const pir_query_result *at = &on.advance.answer;
    const pir_cast_outcome outcome = on.advance.outcome;
    const bool is_over = outcome == PIR_CAST_MISS || outcome == PIR_CAST_AT_REST;
    *ret_impact = (pir_impact){.outcome = outcome,
                               .time = is_over ? 1 : on.advance.time,
                               .normal = at->normal,
                               .point = at->point_q,
                               .witness = at->witness,
                               .steps = on.steps};
    return PIR_OK;
}
