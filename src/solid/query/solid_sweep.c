/* SPDX-License-Identifier: MIT */
/*
 * Sweeps of two bodies in pieces: those of all pairs of pieces that may come to each other, the nearer ones first.
 *
 * Bodies share a point exactly where two pieces do. A pair farther apart at the start than points of both go until a
 * time shares none up to it. A point that turns by φ about the origin of its body, or a pivot, goes no farther than
 * min(φ, 2) times its reach.
 *
 * Invariant: of the pairs that were asked, `sweep` has the outcome, the least `from` of those that are not free, and
 * the least `to` of those that meet, or else the greatest.
 */
#include <pirouette/sweep.h>

#include "base/vec.h"
#include "exact/rotation.h"
#include "query/proof/parting.h"
#include "solid/query/solid_query.h"
#include "solid/query/visit.h"

typedef struct sweep_call {
    pir_solid_query *query;
    pir_workspace *workspace;
    pir_pair_input first, second;
    const pir_exact_motion *screw; /* P's, in place of what `second` says, or NULL */
    uint32_t budget;
    pir_status status;
    pir_sweep_result sweep;
    double way, turn[2]; /* of P's centre relative to Q's; angles, all rounded up */
    double reach;        /* no point of P is farther from its centre */
    double least;        /* radii, and by what boxes are off */
} sweep_call;

/* The distance within which pairs may still meet first. */
static double reach_until(const sweep_call *call) {
    const double time = call->sweep.outcome == PIR_SWEEP_MEETS ? call->sweep.to : 1;
    return time * call->way + fmin(2, time * call->turn[0]) * call->reach +
           fmin(2, time * call->turn[1]) * call->query->q.reach + call->least;
}

static void add(pir_sweep_result *all, const pir_sweep_result *sweep) {
    const bool open = all->outcome != PIR_SWEEP_FREE;
    all->queries += sweep->queries;
    if (sweep->outcome == PIR_SWEEP_FREE)
        return;
    all->from = fmin(all->from, sweep->from);
    if (sweep->outcome == all->outcome)
        all->to = all->outcome == PIR_SWEEP_MEETS ? fmin(all->to, sweep->to) : fmax(all->to, sweep->to);
    else if (!open || sweep->outcome == PIR_SWEEP_MEETS)
        all->to = sweep->to;
    if (all->outcome != PIR_SWEEP_MEETS)
        all->outcome = sweep->outcome;
}

static double ask(void *context, uint32_t i, uint32_t j) {
    sweep_call *call = context;
    pir_solid_query *query = call->query;
    pir_pair *pair;
    pir_sweep_result sweep;
    call->status =
        pir_piece_pairs_get(&query->pairs, &query->p, &query->q, (const uint32_t[]){i, j}, &query->allocator, &pair);
    if (call->status == PIR_OK && call->screw)
        call->status = pir_pair_sweep_screw(pair, call->workspace, &call->first, call->screw, call->budget, &sweep);
    else if (call->status == PIR_OK)
        call->status = pir_pair_sweep(pair, call->workspace, &call->first, &call->second, call->budget, &sweep);
    if (call->status != PIR_OK)
        return -1;
    add(&call->sweep, &sweep);
    return reach_until(call);
}

static pir_status set_turn(pir_quat first, pir_quat second, double *ret_turn) {
    pir_rotation a, b;
    pir_status status = pir_rotation_set(&a, first);
    if (status == PIR_OK)
        status = pir_rotation_set(&b, second);
    if (status == PIR_OK)
        *ret_turn = pir_rotation_angle_bound(a.unit, b.unit);
    return status;
}

/* Sets how far points go; the errors of poses that no pair would be asked about. */
static pir_status set_bounds(sweep_call *call) {
    const pir_vec3 from[2] = {call->first.pose_p.translation, call->first.pose_q.translation};
    const pir_vec3 to[2] = {call->second.pose_p.translation, call->second.pose_q.translation};
    const double reach[2] = {call->query->p.reach, call->query->q.reach};
    const double p = call->first.radius_p, q = call->first.radius_q;
    double size = p + q;
    if (!(p >= 0 && p < HUGE_VAL && q >= 0 && q < HUGE_VAL))
        return isnan(size) ? PIR_ERR_NOT_FINITE : PIR_ERR_ARGUMENT;
    for (int k = 0; k < 2; k++) {
        if (!pir_vec_is_finite(from[k]) || !pir_vec_is_finite(to[k]))
            return PIR_ERR_NOT_FINITE;
        size += reach[k] + pir_vec_size(from[k]) + pir_vec_size(to[k]);
    }
    if (!isfinite(2 * size))
        return PIR_ERR_LIMIT;
    const pir_vec3 way = pir_vec_sub(pir_vec_sub(to[0], from[0]), pir_vec_sub(to[1], from[1]));
    call->way = pir_vec_size(way);
    call->reach = reach[0];
    call->least = p + q + 0x1p-30 * size;
    pir_status status = set_turn(call->first.pose_p.rotation, call->second.pose_p.rotation, &call->turn[0]);
    if (status == PIR_OK)
        status = set_turn(call->first.pose_q.rotation, call->second.pose_q.rotation, &call->turn[1]);
    return status;
}

/* Likewise of a screw, of bounds that have been set for rest. */
static pir_status set_screw(sweep_call *call, const pir_exact_motion *motion) {
    call->screw = motion;
    const pir_status status = pir_screw_check(motion, PIR_SWEEP_DEGREES);
    if (status != PIR_OK)
        return status;
    double size = pir_vec_size(motion->way);
    call->way = size;
    if (motion->degrees != 0) {
        const double lever = pir_vec_size(pir_vec_sub(motion->pivot, call->first.pose_p.translation));
        call->reach += lever;
        call->turn[0] = fabs(motion->degrees) * 0x1.1df46a2529d3ap-6;
        size += lever;
    }
    call->least += 0x1p-30 * size;
    return isfinite(2 * (size + call->reach)) ? PIR_OK : PIR_ERR_LIMIT;
}

static pir_status run(sweep_call *call, pir_sweep_result *ret_sweep) {
    pir_solid_query *query = call->query;
    const pir_relative relative = pir_relative_of(&query->p, &query->q, &call->first);
    call->sweep = (pir_sweep_result){PIR_SWEEP_FREE, 1, 1, 0};
    pir_visit_pairs(&query->p, &query->q, &relative, ++query->visits, reach_until(call), ask, call);
    if (call->status == PIR_OK)
        *ret_sweep = call->sweep;
    return call->status;
}

pir_status pir_solid_query_sweep(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *first,
                                 const pir_pair_input *second, uint32_t budget, pir_sweep_result *ret_sweep) {
    if (!query || !workspace || !first || !second || !ret_sweep)
        return PIR_ERR_ARGUMENT;
    sweep_call call = {.query = query, .workspace = workspace, .first = *first, .second = *second, .budget = budget};
    call.status = set_bounds(&call);
    return call.status == PIR_OK ? run(&call, ret_sweep) : call.status;
}

pir_status pir_solid_query_sweep_screw(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                       const pir_exact_motion *motion, uint32_t budget, pir_sweep_result *ret_sweep) {
    if (!query || !workspace || !input || !motion || !ret_sweep)
        return PIR_ERR_ARGUMENT;
    sweep_call call = {.query = query, .workspace = workspace, .first = *input, .second = *input, .budget = budget};
    call.status = set_bounds(&call);
    if (call.status == PIR_OK)
        call.status = set_screw(&call, motion);
    return call.status == PIR_OK ? run(&call, ret_sweep) : call.status;
}
