/* SPDX-License-Identifier: MIT */
/*
 * One pair of pieces, one slice. In words of turned.h: at the slice the query tells how far t' is from D(B), outside or
 * inside. Outside by more than δ, some direction separates t' from D(B) by that much, hence t from D(A). Inside by
 * more than δ, every direction leaves that much room, and still some at A. Distances of queries are within 1e-12 of
 * the exact ones, relative to the bodies and the answer; the state is exact.
 */
#include "cspace/answer/pair_proof.h"

#include <math.h>

#include "base/report.h"

/* Twice what distances of queries may be off by. */
#define QUERY_ERROR 4e-12

static double query_error(const pir_asked_pair *pair, double distance) {
    return QUERY_ERROR * (pair->p->radius + pair->q->radius + fabs(distance));
}

bool pir_balls_apart(const pir_asked_pair *pair, const pir_rotation *pose, pir_vec3 translation, pir_proof *proof) {
    pir_turned turned = pir_turned_of(pose, translation, pose);
    pir_vec3 centre = pir_vec_add(pir_mat_apply(&turned.a, pair->p->centre), translation);
    pir_vec3 between = pir_vec_sub(centre, pair->q->centre);
    double gap =
        pir_safe_length(between) - pair->p->radius - pair->q->radius - pir_turned_error(&turned, pair->p, pair->q);
    if (!(gap > 0))
        return false;
    *proof = (pir_proof){.free = true, .gap = gap};
    return true;
}

/* The rotation of a slice, and the slice, with the translation at which the centres meet for its inner point. */
static pir_status hold_slice(const pir_asked_pair *pair, uint64_t number, pir_rotation *ret_rotation,
                             pir_held_slice **ret_slice) {
    pir_status status = pir_rotation_set(ret_rotation, pir_grid_rotation(pair->source->grid, number));
    if (status != PIR_OK)
        return status;
    pir_vec3 meeting = pir_vec_sub(pair->q->centre, pir_mat_apply(&ret_rotation->r, pair->p->centre));
    return pir_held_get(pair->held, pair->source, (pir_cspace_place){pair->robot, pair->obstacle, number}, meeting,
                        pair->report, ret_slice);
}

static pir_status fail_query(const pir_asked_pair *pair, pir_status status) {
    if (pair->report)
        pir_fail(pair->report, status, "the pose: %s", pir_status_text(status));
    return status;
}

/* Where a translation lies beside the difference at the slice's rotation, and how far from its boundary. */
static pir_status ask_slice(const pir_asked_pair *pair, pir_held_slice *slice, pir_vec3 translation,
                            pir_query_result *ret_result) {
    pir_query_input input = pir_query_input_default();
    input.translation = translation;
    pir_status status = pir_query_signed_distance(slice->query, &input, &slice->cache, ret_result);
    return status == PIR_OK ? PIR_OK : fail_query(pair, status);
}

pir_status pir_pair_at_slice(const pir_asked_pair *pair, uint64_t slice, pir_vec3 translation, pir_state *ret_state,
                             pir_proof *proof) {
    pir_rotation rotation;
    pir_held_slice *held;
    pir_query_result result;
    pir_status status = hold_slice(pair, slice, &rotation, &held);
    if (status == PIR_OK)
        status = ask_slice(pair, held, translation, &result);
    if (status != PIR_OK)
        return status;
    *ret_state = result.state;
    proof->free = result.state == PIR_OUTSIDE;
    proof->blocked = !proof->free;
    proof->gap = fmax(0, fabs(result.distance) - query_error(pair, result.distance));
    return PIR_OK;
}

/* Whether more than δ and what else the distance may be off by are between t' and the boundary. */
static void by_distance(const pir_query_result *result, double moved, pir_proof *proof) {
    double left = fabs(result->distance) - moved;
    if (!(left > 0))
        return;
    proof->free = result->state == PIR_OUTSIDE;
    proof->blocked = result->state == PIR_INSIDE;
    proof->gap = left;
}

/* The ball around the slice's inner point, moved to the pose's rotation. */
static void put_ball(const pir_held_slice *slice, double error, double moved, pir_carrying *carrying) {
    carrying->centre = pir_vec_sub(slice->inner_at, pir_turned_shift(carrying->turned, carrying->p));
    carrying->radius = slice->inner - moved - error;
}

/* The features that the ray from the inner point through t' leaves D(B) by. */
static pir_status carry_exit(const pir_carrying *carrying, pir_held_slice *slice, const pir_rotation *at,
                             pir_vec3 translation, pir_proof *proof) {
    pir_query_input input = pir_query_input_default();
    input.translation = slice->inner_at;
    pir_vec3 way = pir_vec_sub(translation, slice->inner_at);
    if (!(slice->inner > 0) || (way.x == 0 && way.y == 0 && way.z == 0))
        return PIR_OK;
    pir_query_result result;
    pir_status status = pir_query_directional_depth(slice->query, &input, way, &result);
    if (status == PIR_OK && result.outcome == PIR_OVERLAPPING)
        pir_carry(carrying, &at->r, result.witness, result.normal, proof);
    return status;
}

pir_status pir_pair_by_slice(const pir_asked_pair *pair, const pir_rotation *pose, pir_vec3 translation, uint64_t slice,
                             pir_proof *proof) {
    pir_rotation at;
    pir_held_slice *held;
    pir_status status = hold_slice(pair, slice, &at, &held);
    if (status != PIR_OK)
        return status;
    pir_turned turned = pir_turned_of(pose, translation, &at);
    pir_vec3 shifted = pir_vec_add(translation, pir_turned_shift(&turned, pair->p));
    pir_query_result result;
    status = ask_slice(pair, held, shifted, &result);
    if (status != PIR_OK)
        return status;
    // the bound by the ball, then the closer one by the vertices
    double error = pir_turned_error(&turned, pair->p, pair->q) + query_error(pair, result.distance);
    double moved = pir_turned_by_ball(&turned, pair->p);
    by_distance(&result, moved + error, proof);
    if (proof->free || proof->blocked)
        return PIR_OK;
    moved = fmin(moved, pir_turned_by_vertices(&turned, pair->p));
    by_distance(&result, moved + error, proof);
    if (proof->free || proof->blocked)
        return PIR_OK;
    pir_carrying carrying = {.turned = &turned, .p = pair->p, .q = pair->q};
    carrying.error = pir_turned_error(&turned, pair->p, pair->q);
    put_ball(held, carrying.error + query_error(pair, held->inner), moved, &carrying);
    pir_carry(&carrying, &at.r, result.witness, result.normal, proof);
    if (proof->free || proof->blocked)
        return PIR_OK;
    status = carry_exit(&carrying, held, &at, shifted, proof);
    return status == PIR_OK ? PIR_OK : fail_query(pair, status);
}
