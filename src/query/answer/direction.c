/* SPDX-License-Identifier: MIT */
/*
 * Queries along a line: the directional depth and distance, and the linear cast. decide/line.h has where lines cross
 * facets.
 */
#include "query/answer/along.h"
#include "query/decide/flat.h"
#include "query/decide/placed.h"
#include "query/depth/depth.h"

/* Clips the line by every facet of D. */
static pir_clip clip_line(pir_query *query, const pir_line *line, uint32_t *steps) {
    pir_clip clip = PIR_CLIP_NONE;
    for (uint32_t g = 0; g < query->search.groups.count; g++) {
        pir_group_make(&query->search.groups, g);
        const pir_group *group = &query->search.groups.at[g];
        for (uint32_t i = group->start; i < group->start + group->count; i++)
            pir_clip_bound(query->search.groups.planes, line, &clip, i);
    }
    for (uint32_t g = 0; g < query->search.groups.count; g++) {
        const pir_group *group = &query->search.groups.at[g];
        for (uint32_t i = group->start; i < group->start + group->count && !clip.misses; i++)
            pir_clip_take(&query->exact, query->search.groups.planes, line, &clip, i);
    }
    ++*steps;
    return clip;
}

/* Where P first touches Q along a line from outside. False where it never does. */
static bool first_touch(pir_query *query, const pir_line *line, pir_arrival *ret_arrival, uint32_t *steps) {
    if (pir_flat_is(&query->exact))
        return pir_flat_enter(&query->exact, line, ret_arrival);
    pir_clip clip = clip_line(query, line, steps);
    if (clip.misses || !clip.enter.found || pir_facet_side(&query->exact, line->placement, &clip.enter.facet) >= 0)
        return false;
    if (clip.leave.found && pir_line_compare(&query->exact, line, &clip.enter.facet, &clip.leave.facet) > 0)
        return false;
    return pir_line_arrive(&query->exact, line, &clip.enter.facet, ret_arrival);
}

/* Answers with an arrival. The distance has the given sign. */
static void set_arrival(const pir_query *query, const pir_arrival *arrival, double sign, pir_query_result *result) {
    result->normal = arrival->normal;
    result->point_p = result->point_q = pir_frame_world(&query->frame, arrival->touch.point_q);
    result->witness = arrival->touch.witness;
    result->distance = sign * pir_frame_length(&query->frame, arrival->at);
}

/* Answers with the exit from the half-spaces of the facets in the region. */
static void exit_region(pir_query *query, const pir_line *line, pir_query_result *result) {
    pir_least least;
    pir_arrival arrival;
    result->state =
        pir_regional_find(&query->regional, &query->search.groups, line->placement, NULL, &least, &result->steps);
    result->outcome = PIR_NO_HIT;
    if (result->state != PIR_INSIDE ||
        !pir_regional_exit(&query->regional, &query->search.groups, line, &arrival, &result->steps))
        return;
    result->outcome = PIR_NOT_SEPARATED;
    set_arrival(query, &arrival, -1, result);
}

void pir_query_depth_along(pir_query *query, const pir_line *line, pir_query_result *result) {
    pir_piece separating;
    pir_least touching;
    result->state = pir_state_find(&query->search, line->placement, NULL, &separating, &touching, &result->steps);
    result->outcome = PIR_NO_HIT;
    if (result->state != PIR_INSIDE)
        return;
    pir_clip clip = clip_line(query, line, &result->steps);
    pir_arrival arrival;
    // D is bounded and x inside, so the line leaves D through a facet, and on it
    bool leaves = clip.leave.found && pir_line_arrive(&query->exact, line, &clip.leave.facet, &arrival);
    result->outcome = leaves ? PIR_OVERLAPPING : PIR_STEP_LIMIT;
    if (leaves)
        set_arrival(query, &arrival, -1, result);
}

void pir_query_distance_along(pir_query *query, const pir_line *line, pir_query_result *result) {
    pir_piece separating;
    pir_least touching;
    pir_arrival arrival;
    result->state = pir_state_find(&query->search, line->placement, NULL, &separating, &touching, &result->steps);
    result->outcome = result->state == PIR_INSIDE ? PIR_OVERLAPPING : PIR_TOUCHING;
    if (result->state != PIR_OUTSIDE)
        return;
    result->outcome = PIR_NO_HIT;
    if (first_touch(query, line, &arrival, &result->steps)) {
        result->outcome = PIR_SEPARATED;
        set_arrival(query, &arrival, 1, result);
    }
}

pir_status pir_query_directional_depth(pir_query *query, const pir_query_input *input, pir_vec3 direction,
                                       pir_query_result *ret_result) {
    pir_placement placement;
    pir_line line;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_place(query, input, &placement);
    if (status == PIR_OK)
        status = pir_line_make(&placement, direction, &line);
    bool in_region = status == PIR_OK && pir_sum_cone(query->sum)->set;
    if (in_region)
        status = pir_query_need_regional(query);
    if (status != PIR_OK)
        return status;
    pir_query_result result = {0};
    if (in_region)
        exit_region(query, &line, &result);
    else
        pir_query_depth_along(query, &line, &result);
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_query_directional_distance(pir_query *query, const pir_query_input *input, pir_vec3 direction,
                                          pir_query_result *ret_result) {
    pir_placement placement;
    pir_line line;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_begin(query, input, &placement);
    if (status == PIR_OK)
        status = pir_line_make(&placement, direction, &line);
    if (status != PIR_OK)
        return status;
    pir_query_result result = {0};
    pir_query_distance_along(query, &line, &result);
    *ret_result = result;
    return PIR_OK;
}

/* --- the cast --- */

/*
 * Whether P, which touches Q, moves into Q along the line: it does where every facet that touches lets it in.
 * *ret_facet is the one that it meets at the steepest angle.
 */
static bool moves_in(pir_query *query, const pir_line *line, pir_facet *ret_facet) {
    const pir_planes *planes = query->search.groups.planes;
    const pir_placement *placement = line->placement;
    double most = HUGE_VAL;
    bool found = false;
    for (uint32_t g = 0; g < query->search.groups.count; g++) {
        pir_group_make(&query->search.groups, g);
        const pir_group *group = &query->search.groups.at[g];
        for (uint32_t i = group->start; i < group->start + group->count; i++) {
            pir_facet facet;
            if (fabs(pir_planes_slack(planes, i, placement->x)) > placement->error * planes->err[i] ||
                pir_side_exact(&query->exact, planes->piece[i], placement->translation) != 0)
                continue;
            if (pir_line_rate(&query->exact, line, planes->piece[i]) >= 0)
                return false;
            if (!pir_facet_of(&query->exact, planes->piece[i], &facet))
                continue;
            double rate = pir_vec_dot(facet.n, line->u);
            if (!found || rate < most || (rate == most && pir_facet_before(&facet, ret_facet))) {
                *ret_facet = facet;
                most = rate;
            }
            found = true;
        }
    }
    return found;
}

static void cast_from_outside(pir_query *query, const pir_line *line, pir_impact *result) {
    pir_arrival arrival;
    result->outcome = PIR_CAST_MISS;
    result->time = 1;
    if (!first_touch(query, line, &arrival, &result->steps) || !arrival.within)
        return;
    result->outcome = PIR_CAST_HIT;
    result->time = fmin(1, ldexp(arrival.at / line->part, query->frame.exponent - line->exponent));
    result->normal = arrival.normal;
    result->point = pir_frame_world(&query->frame, arrival.touch.point_q);
    result->witness = arrival.touch.witness;
}

void pir_query_cast_along(pir_query *query, const pir_line *line, bool moves, const pir_query_result *start,
                          pir_impact *impact) {
    pir_facet facet;
    impact->steps = start->steps;
    impact->normal = start->normal;
    impact->point = start->point_q;
    impact->witness = start->witness;
    if (start->state == PIR_INSIDE) {
        impact->outcome = PIR_CAST_START_INSIDE;
    } else if (start->state == PIR_BOUNDARY) {
        impact->outcome = PIR_CAST_RECEDING;
        if (moves && moves_in(query, line, &facet)) {
            impact->outcome = PIR_CAST_HIT;
            impact->normal = facet.n;
        }
    } else if (!moves) {
        impact->outcome = PIR_CAST_AT_REST;
        impact->time = 1;
    } else {
        cast_from_outside(query, line, impact);
    }
}

pir_status pir_query_cast(pir_query *query, const pir_query_input *input, pir_vec3 way, pir_impact *ret_impact) {
    pir_placement placement;
    pir_line line;
    if (!ret_impact)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_begin(query, input, &placement);
    const pir_status moving = status == PIR_OK ? pir_line_make(&placement, way, &line) : status;
    if (moving == PIR_ERR_NOT_FINITE)
        status = moving;
    pir_query_result start;
    if (status == PIR_OK)
        status = pir_query_signed_distance(query, input, NULL, &start);
    if (status != PIR_OK)
        return status;
    pir_impact impact = {0};
    pir_query_cast_along(query, &line, moving == PIR_OK, &start, &impact);
    *ret_impact = impact;
    return PIR_OK;
}
