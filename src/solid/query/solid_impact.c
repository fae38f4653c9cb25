/* SPDX-License-Identifier: MIT */
/*
 * First contacts of two bodies in pieces, exactly: the first of all pairs of pieces, the nearer ones asked first.
 *
 * Bodies that are apart share a point first where two pieces do, for a body is the union of its pieces. Insides meet
 * just after a touching start exactly where those of two pieces do.
 *
 * A pair farther apart at the start than a point of P goes until a time has no contact up to it. A point that turns by
 * θ about an axis, no farther than r from the pivot, goes no farther than min(θ, 2)·r from its start; in a screw by
 * at most the way farther.
 *
 * Invariant: of the pairs that were asked the first contact is the best, and of equal ones that of the lowest pieces.
 */
#include "base/vec.h"
#include "impact/first_contact.h"
#include "impact/pair_impact.h"
#include "solid/query/solid_query.h"
#include "solid/query/visit.h"

#define RADIAN 0.017453292519943295

typedef struct impact_call {
    pir_solid_query *query;
    pir_workspace *workspace;
    pir_pair_input input;
    const pir_exact_motion *motion;
    pir_status status;
    pir_first_contact first;
    double radius, error; /* of points of P about the pivot; of distances of boxes and of `radius` */
} impact_call;

/* How far a point of P may have gone at the best contact, or the end, with the errors; half an angle is told within
 * 2^-32, and so is a time of a way. */
static double gone_at_best(const impact_call *call) {
    const pir_exact_motion *motion = call->motion;
    const pir_exact_impact *best = call->first.any ? &call->first.best : NULL;
    if (motion->degrees == 0)
        return fmin(1, (best ? best->impact.time : 1) + 0x1p-20) * pir_vec_length(motion->way) + call->error;
    const double degrees = best ? best->degrees : fabs(motion->degrees);
    return fmin(2, degrees * RADIAN + 0x1p-20) * call->radius + pir_vec_length(motion->way) + call->error;
}

static pir_status ask_pair(impact_call *call, uint32_t i, uint32_t j, pir_exact_impact *ret_impact, mpz_t *root) {
    pir_solid_query *query = call->query;
    pir_pair *pair;
    const pir_status status =
        pir_piece_pairs_get(&query->pairs, &query->p, &query->q, (const uint32_t[]){i, j}, &query->allocator, &pair);
    return status != PIR_OK ? status
                            : pir_pair_impact_run(pair, call->workspace, &call->input, call->motion, ret_impact, root);
}

static pir_status ask_again(void *context, const pir_impact *of, mpz_t *root) {
    pir_exact_impact again;
    return ask_pair(context, of->piece_p, of->piece_q, &again, root);
}

/* --- pairs --- */

/* A pair of bodies that touch at the start, of which only that start counts. */
static double ask_touching(void *context, uint32_t i, uint32_t j) {
    impact_call *call = context;
    pir_exact_impact impact;
    call->status = ask_pair(call, i, j, &impact, NULL);
    impact.impact.piece_p = i;
    impact.impact.piece_q = j;
    if (call->status == PIR_OK && impact.impact.steps == 0)
        call->status = pir_first_contact_offer(&call->first, &impact);
    return call->status == PIR_OK ? call->error : -1;
}

/* A pair of bodies that are apart at the start. */
static double ask_apart(void *context, uint32_t i, uint32_t j) {
    impact_call *call = context;
    pir_exact_impact hit;
    call->status = ask_pair(call, i, j, &hit, NULL);
    hit.impact.piece_p = i;
    hit.impact.piece_q = j;
    if (call->status == PIR_OK)
        call->status = pir_first_contact_offer(&call->first, &hit);
    return call->status == PIR_OK ? gone_at_best(call) : -1;
}

/* --- the call --- */

static void visit(impact_call *call, double within, pir_pair_asker *ask) {
    pir_solid_query *query = call->query;
    const pir_relative relative = pir_relative_of(&query->p, &query->q, &call->input);
    pir_visit_pairs(&query->p, &query->q, &relative, ++query->visits, within, ask, call);
}

static void set_bounds(impact_call *call) {
    const pir_solid_query *query = call->query;
    const pir_vec3 p = call->input.pose_p.translation, q = call->input.pose_q.translation;
    const pir_vec3 pivot = call->motion->degrees != 0 ? call->motion->pivot : p;
    call->radius = query->p.reach + pir_vec_length(pir_vec_sub(p, pivot));
    call->error = 0x1p-30 * (call->radius + query->p.reach + query->q.reach + pir_vec_length(p) + pir_vec_length(q) +
                             pir_vec_length(pivot) + pir_vec_length(call->motion->way));
}

pir_status pir_solid_query_impact(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                  const pir_exact_motion *motion, pir_exact_impact *ret_impact) {
    if (!query || !workspace || !input || !motion || !ret_impact)
        return PIR_ERR_ARGUMENT;
    impact_call call = {.query = query, .workspace = workspace, .input = pir_pair_input_default(), .motion = motion};
    call.input.pose_p = input->pose_p;
    call.input.pose_q = input->pose_q;
    pir_state state;
    pir_status status = pir_exact_motion_check(motion);
    if (status == PIR_OK)
        status = pir_solid_query_overlap(query, workspace, &call.input, &state);
    if (status != PIR_OK)
        return status;
    const bool rests = motion->degrees == 0 && pir_vec_size(motion->way) == 0;
    pir_exact_impact impact = {.kappa = {INFINITY, INFINITY}};
    pir_first_contact_init(&call.first, &query->allocator, motion, ask_again, &call);
    set_bounds(&call);
    if (state == PIR_INSIDE) {
        impact.impact.outcome = PIR_CAST_START_INSIDE;
    } else if (state == PIR_BOUNDARY) {
        visit(&call, call.error, ask_touching);
    } else if (rests) {
        impact.impact.outcome = PIR_CAST_AT_REST;
    } else {
        impact.impact = (pir_impact){.outcome = PIR_CAST_MISS, .time = 1};
        impact.degrees = fabs(motion->degrees);
        visit(&call, gone_at_best(&call), ask_apart);
    }
    if (call.status == PIR_OK)
        *ret_impact = call.first.any ? call.first.best : impact;
    pir_first_contact_finish(&call.first);
    return call.status;
}
