/* SPDX-License-Identifier: MIT */
/* Results of queries: see result.h. */
#include "query/answer/result.h"

#include "query/decide/flat.h"
#include "query/decide/touch.h"

/* The end of P's normal: point_p = point_q + distance · normal. */
static void set_points(pir_query_result *result, pir_vec3 point_q) {
    result->point_q = point_q;
    result->point_p = pir_vec_add(point_q, pir_vec_scale(result->normal, result->distance));
}

/* The faces of a body as a whole, where D is a point or in a line. */
static pir_feature whole_of(const pir_polytope *p) {
    return (pir_feature){p->edge_count > 0 ? PIR_FEATURE_EDGE : PIR_FEATURE_VERTEX, 0};
}

/* Where t lies on the boundary: `touching` is the first true facet that it is on. */
void pir_result_touching(pir_exact *exact, const pir_placement *placement, const pir_least *touching,
                         pir_query_result *result) {
    const pir_frame *frame = exact->frame;
    pir_touch touch = {{{0}, {0}}, {0, 0, 0}};
    result->distance = 0;
    if (touching->found) {
        result->normal = touching->facet.n;
        pir_touch_facet(exact, placement, &touching->facet, 0, NULL, &touch);
    } else {
        // D has no area, and any direction across it is a normal
        pir_normal normal = {.unit = pir_flat_across(frame), .err = 1};
        pir_meeting meeting = {.normal = &normal, .faces = {whole_of(frame->p.polytope), whole_of(frame->q.polytope)}};
        result->normal = normal.unit;
        pir_touch_find(exact, placement, &meeting, &touch);
    }
    result->witness = touch.witness;
    set_points(result, pir_frame_world(frame, touch.point_q));
}

/*
 * Bodies that are apart by less than their coordinates can tell still have two points, apart by one rounding along the
 * normal.
 */
static void separate_points(pir_query_result *result) {
    pir_vec3 *p = &result->point_p, *q = &result->point_q, n = result->normal;
    if (p->x != q->x || p->y != q->y || p->z != q->z)
        return;
    double *most = fabs(n.x) >= fabs(n.y) && fabs(n.x) >= fabs(n.z) ? &p->x : fabs(n.y) >= fabs(n.z) ? &p->y : &p->z;
    double along = most == &p->x ? n.x : most == &p->y ? n.y : n.z;
    *most = nextafter(*most, along > 0 ? HUGE_VAL : -HUGE_VAL);
}

void pir_result_separation(const pir_frame *frame, const pir_nearest *nearest, pir_query_result *result) {
    pir_result_set_state(result, PIR_OUTSIDE);
    result->distance = pir_frame_length(frame, nearest->distance);
    result->normal = nearest->normal;
    result->witness = nearest->touch.witness;
    set_points(result, pir_frame_world(frame, nearest->touch.point_q));
    separate_points(result);
}

void pir_result_keep_state(pir_query_result *result) {
    const pir_query_result had = *result;
    if (had.state == PIR_BOUNDARY)
        return;
    pir_result_clear(result);
    result->state = had.state;
    // rounded bodies are asked within a cutoff of 0, which is not the caller's
    result->outcome = had.outcome == PIR_BEYOND_CUTOFF ? PIR_SEPARATED : had.outcome;
    result->steps = had.steps;
}

void pir_result_beyond(pir_query_result *result) {
    uint32_t steps = result->steps;
    pir_result_clear(result);
    result->steps = steps;
    result->outcome = PIR_BEYOND_CUTOFF;
}

void pir_result_unfinished(const pir_frame *frame, const pir_simplex *simplex, pir_query_result *result) {
    pir_result_set_state(result, PIR_OUTSIDE);
    result->outcome = PIR_STEP_LIMIT;
    result->distance = pir_frame_length(frame, fmax(0, simplex->upper));
}

void pir_result_depth_at(const pir_frame *frame, pir_vec3 normal, double slack, const pir_touch *touch,
                         pir_query_result *result) {
    result->normal = normal;
    result->distance = -pir_frame_length(frame, slack);
    result->witness = touch->witness;
    set_points(result, pir_frame_world(frame, touch->point_q));
}

void pir_result_depth_of(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack,
                         pir_query_result *result) {
    const pir_frame *frame = exact->frame;
    pir_touch touch;
    // exactly inside: a slack that rounds below zero is one of next to nothing
    slack = slack > 0 ? slack : 0;
    // in a region the foot may be beside the facet
    if (!pir_touch_facet(exact, placement, facet, slack, NULL, &touch))
        touch = (pir_touch){facet->faces, pir_facet_point(frame, placement, facet, slack)};
    pir_result_depth_at(frame, facet->n, slack, &touch, result);
}

/* Grows both bodies by their radii in an answer that knows the signed distance. */
void pir_result_add_radii(const pir_query_input *input, pir_query_result *result) {
    double sum = input->radius_p + input->radius_q;
    if (result->outcome == PIR_BEYOND_CUTOFF)
        result->distance = fmax(input->cutoff, 0);
    if (sum == 0 || result->outcome == PIR_BEYOND_CUTOFF)
        return;
    result->distance -= sum;
    result->point_q = pir_vec_add(result->point_q, pir_vec_scale(result->normal, input->radius_q));
    result->point_p = pir_vec_add(result->point_q, pir_vec_scale(result->normal, result->distance));
    pir_outcome outcome = result->outcome;
    pir_result_set_state(result, result->distance > 0    ? PIR_OUTSIDE
                                 : result->distance == 0 ? PIR_BOUNDARY
                                                         : PIR_INSIDE);
    if (outcome == PIR_STEP_LIMIT)
        result->outcome = outcome;
}
