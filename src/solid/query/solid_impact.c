/* SPDX-License-Identifier: MIT */
/*
 * First contacts of two bodies in pieces, exactly: the first of all pairs of pieces, the nearer ones asked first.
 *
 * Bodies that are apart share a point first where two pieces do, for a body is the union of its pieces. Insides meet
 * just after a touching start exactly where those of two pieces do.
 *
 * A pair farther apart at the start than a point of P goes until a time has no contact up to it. A point that turns by
 * θ about an axis, no farther than r from the pivot, goes no farther than min(θ, 2)·r from its start.
 *
 * Invariant: of the pairs that were asked the first contact is the best, and of equal ones that of the lowest pieces.
 */
#include "base/vec.h"
#include "impact/course.h"
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

    bool any; /* whether there is a best */
    pir_exact_impact best;
    bool has_root; /* whether `root` is the best's */
    mpz_t root[3], other[3];
    double radius, error; /* of points of P about the pivot; of distances of boxes and of `radius` */
} impact_call;

/* How far a point of P may have gone at the best contact, or the end, with the errors; half an angle is told within
 * 2^-32, and so is a time of a way. */
static double gone_at_best(const impact_call *call) {
    const pir_exact_motion *motion = call->motion;
    if (motion->degrees == 0)
        return fmin(1, call->best.impact.time + 0x1p-20) * pir_vec_length(motion->way) + call->error;
    return fmin(2, call->best.degrees * RADIAN + 0x1p-20) * call->radius + call->error;
}

static pir_status ask_pair(impact_call *call, uint32_t i, uint32_t j, pir_exact_impact *ret_impact, mpz_t *root) {
    pir_solid_query *query = call->query;
    pir_pair *pair;
    const pir_status status =
        pir_piece_pairs_get(&query->pairs, &query->p, &query->q, (const uint32_t[]){i, j}, &query->allocator, &pair);
    return status != PIR_OK ? status
                            : pir_pair_impact_run(pair, call->workspace, &call->input, call->motion, ret_impact, root);
}

/* --- the order of contacts --- */

/* The sign of the κ in `other` less that of the best, exactly. */
static int compare_roots(impact_call *call) {
    const pir_quadratic other = pir_course_view(call->other), best = pir_course_view(call->root);
    size_t limbs = 1;
    for (int k = 0; k < 3; k++) {
        const size_t most = mpz_size(call->other[k]), own = mpz_size(call->root[k]);
        limbs = most > limbs ? most : limbs;
        limbs = own > limbs ? own : limbs;
    }
    const pir_allocator *allocator = &call->query->allocator;
    const uint32_t room = PIR_QUADRATIC_SCRATCH((uint32_t)limbs);
    mp_limb_t *base = PIR_ZEROED(allocator, mp_limb_t, room);
    pir_limbs scratch = {base, 0, room};
    if (!base) {
        call->status = PIR_ERR_MEMORY;
        return 0;
    }
    const int order = pir_quadratic_compare(&other, &best, &scratch);
    PIR_FREE(allocator, base, room);
    return order;
}

/* Whether a hit comes before the best, 1, at the same κ, 0, or after it, −1. */
static int order_of(impact_call *call, const pir_exact_impact *hit) {
    const pir_exact_impact *best = &call->best;
    if (hit->kappa[0] > best->kappa[1])
        return 1;
    if (hit->kappa[1] < best->kappa[0])
        return -1;
    pir_exact_impact again;
    if (!call->has_root)
        call->status = ask_pair(call, best->impact.piece_p, best->impact.piece_q, &again, call->root);
    call->has_root = call->status == PIR_OK;
    if (call->status == PIR_OK)
        call->status = ask_pair(call, hit->impact.piece_p, hit->impact.piece_q, &again, call->other);
    return call->status == PIR_OK ? compare_roots(call) : 0;
}

static bool is_lower(const pir_impact *a, const pir_impact *b) {
    return a->piece_p < b->piece_p || (a->piece_p == b->piece_p && a->piece_q < b->piece_q);
}

/* --- pairs --- */

static void take(impact_call *call, const pir_exact_impact *impact) {
    call->best = *impact;
    call->any = true;
    call->has_root = false;
}

/* A pair of bodies that touch at the start. */
static double ask_touching(void *context, uint32_t i, uint32_t j) {
    impact_call *call = context;
    pir_exact_impact impact;
    call->status = ask_pair(call, i, j, &impact, NULL);
    if (call->status != PIR_OK)
        return -1;
    impact.impact.piece_p = i;
    impact.impact.piece_q = j;
    const bool hits = impact.impact.outcome == PIR_CAST_HIT && impact.impact.steps == 0;
    if (!hits && impact.impact.outcome != PIR_CAST_RECEDING)
        return call->error;
    const bool best_hits = call->any && call->best.impact.outcome == PIR_CAST_HIT;
    if (!call->any || hits > best_hits || (hits == best_hits && is_lower(&impact.impact, &call->best.impact)))
        take(call, &impact);
    return call->error;
}

/* A pair of bodies that are apart at the start. */
static double ask_apart(void *context, uint32_t i, uint32_t j) {
    impact_call *call = context;
    pir_exact_impact hit;
    call->status = ask_pair(call, i, j, &hit, NULL);
    if (call->status != PIR_OK)
        return -1;
    hit.impact.piece_p = i;
    hit.impact.piece_q = j;
    if (hit.impact.outcome == PIR_CAST_HIT) {
        const int order = call->any ? order_of(call, &hit) : 1;
        if (call->status != PIR_OK)
            return -1;
        if (order > 0 || (order == 0 && is_lower(&hit.impact, &call->best.impact)))
            take(call, &hit);
    }
    return gone_at_best(call);
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
    call.best = (pir_exact_impact){.kappa = {INFINITY, INFINITY}};
    mpz_inits(call.root[0], call.root[1], call.root[2], call.other[0], call.other[1], call.other[2], NULL);
    set_bounds(&call);
    if (state == PIR_INSIDE) {
        call.best.impact.outcome = PIR_CAST_START_INSIDE;
    } else if (state == PIR_BOUNDARY) {
        visit(&call, call.error, ask_touching);
    } else if (rests) {
        call.best.impact.outcome = PIR_CAST_AT_REST;
    } else {
        call.best.impact = (pir_impact){.outcome = PIR_CAST_MISS, .time = 1};
        call.best.degrees = fabs(motion->degrees);
        visit(&call, gone_at_best(&call), ask_apart);
    }
    mpz_clears(call.root[0], call.root[1], call.root[2], call.other[0], call.other[1], call.other[2], NULL);
    if (call.status == PIR_OK)
        *ret_impact = call.best;
    return call.status;
}
