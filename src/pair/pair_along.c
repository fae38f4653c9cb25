/* SPDX-License-Identifier: MIT */
/*
 * Questions of a pair on its whole difference: along a direction, how far it reaches, all ways out of an overlap. The
 * answers are those of query/answer, in Q's frame, brought to the world. The time of impact alone takes less
 * (flight.c).
 */
#include "dymsum/view.h"
#include "pair/flight.h"
#include "pair/pair.h"
#include "polytope/polytope.h"
#include "query/answer/along.h"
#include "query/answer/extent.h"
#include "query/proof/parting.h"

/* Begins a call: the placement in the workspace's query on the whole difference. */
static pir_status begin(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                        pir_placement *ret_placement) {
    if (!pair || !workspace || !input)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_pair_begin(pair, workspace, input);
    if (status == PIR_OK && !pir_pair_allows(pair, PIR_LEVEL_WHOLE))
        status = PIR_ERR_LIMIT;
    if (status == PIR_OK)
        status = pir_pair_place_whole(pair, workspace, input, ret_placement);
    if (status != PIR_OK)
        return status;
    pair->statistics.queries++;
    pair->statistics.by_whole++;
    pair->level = PIR_LEVEL_WHOLE;
    return PIR_OK;
}

/* The line from a placement along a direction of the world. */
static pir_status make_line(const pir_workspace *workspace, const pir_placement *placement, pir_vec3 direction,
                            pir_line *ret_line) {
    pir_status status = pir_line_make(placement, direction, ret_line);
    if (status == PIR_OK && workspace->posed)
        ret_line->u = pir_mat_apply_transposed(&workspace->rotation_q.r, ret_line->u);
    return status;
}

/* Brings a result whose points are one, where it has any, to the world. */
static void arrive_in_world(const pir_workspace *workspace, pir_query_result *result) {
    if (!workspace->posed)
        return;
    pir_pair_to_world(workspace, result);
    result->point_p = result->point_q;
}

static pir_status look_along(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, pir_vec3 direction,
                             void (*look)(pir_query *, const pir_line *, pir_query_result *),
                             pir_query_result *ret_result) {
    pir_placement placement;
    pir_line line;
    pir_status status = ret_result ? begin(pair, workspace, input, &placement) : PIR_ERR_ARGUMENT;
    if (status == PIR_OK)
        status = make_line(workspace, &placement, direction, &line);
    if (status != PIR_OK)
        return status;
    pir_query_result result = {0};
    look(workspace->query, &line, &result);
    arrive_in_world(workspace, &result);
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_pair_directional_depth(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                      pir_vec3 direction, pir_query_result *ret_result) {
    return look_along(pair, workspace, input, direction, pir_query_depth_along, ret_result);
}

pir_status pir_pair_directional_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                         pir_vec3 direction, pir_query_result *ret_result) {
    return look_along(pair, workspace, input, direction, pir_query_distance_along, ret_result);
}

static pir_query_input radii_of(const pir_pair_input *input) {
    return (pir_query_input){.radius_p = input->radius_p, .radius_q = input->radius_q, .cutoff = HUGE_VAL};
}

pir_status pir_pair_largest_distance(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                     pir_query_result *ret_result) {
    pir_placement placement;
    pir_query_result result;
    pir_status status = ret_result ? begin(pair, workspace, input, &placement) : PIR_ERR_ARGUMENT;
    if (status != PIR_OK)
        return status;
    const pir_query_input radii = radii_of(input);
    status = pir_query_farthest(workspace->query, &placement, &radii, &result);
    if (status != PIR_OK)
        return status;
    if (workspace->posed)
        pir_pair_to_world(workspace, &result);
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_pair_escapes(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, double slack,
                            size_t capacity, pir_escape *ret_escapes, size_t *ret_count) {
    pir_placement placement;
    pir_query_result least;
    if ((!ret_escapes && capacity > 0) || !ret_count || !(slack >= 0))
        return PIR_ERR_ARGUMENT;
    pir_status status = begin(pair, workspace, input, &placement);
    if (status != PIR_OK)
        return status;
    const pir_query_input radii = radii_of(input);
    pir_query_answer(workspace->query, &placement, &radii, PIR_WANT_DEPTH, NULL, &least);
    const pir_escapes_ask ask = {&least, input->radius_p + input->radius_q, slack, capacity};
    const size_t count = pir_query_ways_out(workspace->query, &placement, &ask, ret_escapes);
    for (size_t i = 0; i < count && i < capacity && workspace->posed; i++)
        ret_escapes[i].normal = pir_mat_apply(&workspace->rotation_q.r, ret_escapes[i].normal);
    *ret_count = count;
    return PIR_OK;
}

pir_status pir_pair_cast(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, pir_vec3 way,
                         pir_impact *ret_impact) {
    pir_placement placement;
    pir_line line;
    pir_query_result start;
    pir_status status = ret_impact ? begin(pair, workspace, input, &placement) : PIR_ERR_ARGUMENT;
    const pir_status moving = status == PIR_OK ? make_line(workspace, &placement, way, &line) : status;
    if (moving == PIR_ERR_NOT_FINITE)
        status = moving;
    if (status != PIR_OK)
        return status;
    const pir_query_input radii = radii_of(input);
    pir_query_answer(workspace->query, &placement, &radii, PIR_WANT_SEPARATION | PIR_WANT_DEPTH, NULL, &start);
    pir_impact impact = {0};
    pir_query_cast_along(workspace->query, &line, moving == PIR_OK, &start, &impact);
    if (workspace->posed && impact.outcome != PIR_CAST_MISS) {
        impact.normal = pir_mat_apply(&workspace->rotation_q.r, impact.normal);
        impact.point = pir_pair_point_to_world(workspace, impact.point);
    }
    *ret_impact = impact;
    return PIR_OK;
}

/* --- times of impact --- */

pir_status pir_pair_time_of_impact(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                   const pir_motion *motion, double tolerance, pir_impact *ret_impact) {
    if (!pair || !workspace || !input || !motion || !ret_impact)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_motion_check(motion, tolerance);
    if (status == PIR_OK)
        status = pir_pair_check(input);
    if (status != PIR_OK)
        return status;
    const pir_polytope *p = pair->p, *q = pair->q;
    const pir_vec3 origin = {0, 0, 0};
    pir_pair_input at = *input;
    pir_flight_end end;
    pir_flight flight = {.p = p, .from = input->pose_p, .motion = motion, .tolerance = tolerance};
    flight.reach = pir_parted_reach(p->vertex, p->vertex_count, origin);
    flight.size = flight.reach + pir_parted_reach(q->vertex, q->vertex_count, origin) + input->radius_p +
                  input->radius_q + pir_vec_length(input->pose_p.translation) +
                  pir_vec_length(input->pose_q.translation) + pir_vec_length(motion->way);
    status = pir_pair_fly(pair, workspace, &at, &flight, 1, &end);
    if (status != PIR_OK)
        return status;
    pir_impact impact = {.outcome = end.outcome, .time = end.outcome == PIR_CAST_MISS ? 1 : end.time};
    if (end.outcome != PIR_CAST_MISS) {
        impact.normal = end.answer.normal;
        impact.point = end.answer.point_q;
        impact.witness = end.answer.witness;
    }
    *ret_impact = impact;
    return PIR_OK;
}
