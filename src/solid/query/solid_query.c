/* SPDX-License-Identifier: MIT */
/*
 * Queries of two bodies in pieces: any of all pairs, the least, or the first (visit.c). Of a pair of inner points, both
 * may be moved alike off the walls between pieces, so the insides of two bodies meet exactly where those of two pieces
 * do. What is first looked at is the pair of the last answer, which bounds what else is of interest.
 */
#include "solid/query/solid_query.h"

#include "base/vec.h"
#include "pair/flight.h"
#include "query/proof/parting.h"
#include "solid/query/visit.h"

struct solid_call {
    pir_solid_query *query;
    pir_workspace *workspace;
    pir_pair_input input;
    pir_status status;
    pir_state state;             /* of overlap */
    pir_relative relative;       /* likewise */
    pir_solid_distance distance; /* of distance */
    pir_flight flight;           /* of casts */
    double speed;                /* no point of P moves faster */
    pir_impact impact;
    bool any; /* whether `distance` is set */
    pir_pair_asker *ask;
    uint32_t first[2]; /* the pair that was asked first, and what it said */
    double within;
};

/* --- life --- */

pir_status pir_solid_query_create(const pir_pieces *p, const pir_pieces *q, const pir_allocator *allocator,
                                  pir_solid_query **ret_query) {
    if (!p || !q || !ret_query)
        return PIR_ERR_ARGUMENT;
    const pir_allocator a = pir_allocator_or_default(allocator);
    pir_solid_query *query = PIR_ZEROED(&a, pir_solid_query, 1);
    if (!query)
        return PIR_ERR_MEMORY;
    query->allocator = a;
    pir_status status = pir_compound_init(&query->p, p, &a);
    if (status == PIR_OK)
        status = pir_compound_init(&query->q, q, &a);
    if (status != PIR_OK) {
        pir_solid_query_destroy(query);
        return status;
    }
    *ret_query = query;
    return PIR_OK;
}

void pir_solid_query_destroy(pir_solid_query *query) {
    if (!query)
        return;
    const pir_allocator a = query->allocator;
    if (query->depth)
        pir_depth_search_finish(query->depth);
    PIR_FREE(&a, query->depth, 1);
    pir_piece_pairs_finish(&query->pairs);
    pir_compound_finish(&query->p, &a);
    pir_compound_finish(&query->q, &a);
    PIR_FREE(&a, query, 1);
}

/* --- what calls share --- */

static pir_pair *pair_of(struct solid_call *call, uint32_t i, uint32_t j) {
    pir_pair *pair = NULL;
    pir_solid_query *query = call->query;
    call->status =
        pir_piece_pairs_get(&query->pairs, &query->p, &query->q, (const uint32_t[]){i, j}, &query->allocator, &pair);
    return call->status == PIR_OK ? pair : NULL;
}

/* Whether a pair of pieces comes before another. */
static bool comes_before(uint32_t i, uint32_t j, uint32_t other_i, uint32_t other_j) {
    return i < other_i || (i == other_i && j < other_j);
}

static double ask_once(void *context, uint32_t i, uint32_t j) {
    struct solid_call *call = context;
    if (i != call->first[0] || j != call->first[1])
        call->within = call->ask(call, i, j);
    return call->within;
}

/* Asks the pair of the last answer, which checks the input as well, then all others that may matter. */
static pir_status visit(struct solid_call *call, pir_pair_asker *ask) {
    pir_solid_query *query = call->query;
    call->ask = ask;
    call->first[0] = query->last[0];
    call->first[1] = query->last[1];
    call->within = ask(call, query->last[0], query->last[1]);
    if (call->within >= 0 && call->status == PIR_OK) {
        const pir_relative relative = pir_relative_of(&query->p, &query->q, &call->input);
        pir_visit_pairs(&query->p, &query->q, &relative, ++query->visits, call->within, ask_once, call);
    }
    return call->status;
}

/* --- state --- */

static double ask_state(void *context, uint32_t i, uint32_t j) {
    struct solid_call *call = context;
    pir_query_result result;
    pir_pair *pair = pair_of(call, i, j);
    if (pair)
        call->status = pir_pair_overlap(pair, call->workspace, &call->input, &result);
    if (call->status != PIR_OK)
        return -1;
    if (result.state <= call->state)
        return call->state == PIR_INSIDE ? -1 : 0;
    call->state = result.state;
    call->query->last[0] = i;
    call->query->last[1] = j;
    return call->state == PIR_INSIDE ? -1 : 0;
}

/* The state of two pieces, asked of a pair only where doubles do not tell. */
static double ask_likely(void *context, uint32_t i, uint32_t j) {
    struct solid_call *call = context;
    const pir_likely likely = pir_pieces_look(&call->relative, &call->query->p, i, &call->query->q, j);
    if (likely == PIR_LIKELY_UNKNOWN)
        return ask_state(call, i, j);
    if (likely == PIR_CERTAINLY_APART)
        return 0;
    call->state = PIR_INSIDE;
    call->query->last[0] = i;
    call->query->last[1] = j;
    return -1;
}

pir_status pir_solid_query_overlap(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                   pir_state *ret_state) {
    if (!query || !workspace || !input || !ret_state)
        return PIR_ERR_ARGUMENT;
    struct solid_call call = {.query = query, .workspace = workspace, .input = *input, .state = PIR_OUTSIDE};
    pir_status status = PIR_OK;
    if (pir_relative_is_plain(input)) {
        call.relative = pir_relative_of(&query->p, &query->q, input);
        pir_visit_pairs(&query->p, &query->q, &call.relative, ++query->visits, 0, ask_likely, &call);
        status = call.status;
    } else {
        // the first pair finds what is wrong with it, if anything is
        status = visit(&call, ask_state);
    }
    if (status == PIR_OK)
        *ret_state = call.state;
    return status;
}

/* --- distance --- */

static double ask_distance(void *context, uint32_t i, uint32_t j) {
    struct solid_call *call = context;
    pir_solid_distance *least = &call->distance;
    pir_query_result result;
    pir_pair *pair = pair_of(call, i, j);
    least->pairs++;
    if (pair)
        call->status = pir_pair_distance(pair, call->workspace, &call->input, &result);
    if (call->status != PIR_OK)
        return -1;
    if (result.state == PIR_INSIDE) {
        const uint32_t pairs = least->pairs;
        *least = (pir_solid_distance){.pairs = pairs, .result = {.state = PIR_INSIDE, .outcome = PIR_OVERLAPPING}};
        call->any = true;
        call->query->last[0] = i;
        call->query->last[1] = j;
        return -1;
    }
    if (result.outcome != PIR_BEYOND_CUTOFF &&
        (!call->any || result.distance < least->result.distance ||
         (result.distance == least->result.distance && comes_before(i, j, least->piece_p, least->piece_q)))) {
        *least = (pir_solid_distance){result, i, j, least->pairs};
        call->any = true;
        call->query->last[0] = i;
        call->query->last[1] = j;
        // what is farther need not be known
        call->input.cutoff = fmax(result.distance, 0);
    }
    return call->input.cutoff;
}

pir_status pir_solid_query_distance(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                    pir_solid_distance *ret_distance) {
    if (!query || !workspace || !input || !ret_distance)
        return PIR_ERR_ARGUMENT;
    struct solid_call call = {.query = query, .workspace = workspace, .input = *input};
    const pir_status status = visit(&call, ask_distance);
    if (status != PIR_OK)
        return status;
    if (!call.any)
        call.distance.result =
            (pir_query_result){.state = PIR_OUTSIDE, .outcome = PIR_BEYOND_CUTOFF, .distance = input->cutoff};
    *ret_distance = call.distance;
    return PIR_OK;
}

/* --- casts --- */

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

static bool meets(const pir_impact *impact) {
    return impact->outcome != PIR_CAST_MISS;
}

/* How far off pairs may be that are met in time. */
static double reach_until(const struct solid_call *call) {
    const double error = 0x1p-30 * call->flight.size;
    return (meets(&call->impact) ? call->impact.time : 1) * call->speed * (1 + 0x1p-40) + call->flight.tolerance +
           error;
}

static double ask_flight(void *context, uint32_t i, uint32_t j) {
    struct solid_call *call = context;
    pir_impact *first = &call->impact;
    pir_pair_input input = call->input;
    pir_flight flight = call->flight;
    pir_flight_end end = {.outcome = PIR_CAST_MISS};
    pir_pair *pair = pair_of(call, i, j);
    flight.p = call->query->p.piece[i];
    if (pair)
        call->status = pir_pair_fly(pair, call->workspace, &input, &flight, meets(first) ? first->time : 1, &end);
    if (call->status != PIR_OK)
        return -1;
    if (end.outcome != PIR_CAST_MISS &&
        (!meets(first) || end.time < first->time ||
         (end.time == first->time && comes_before(i, j, first->piece_p, first->piece_q)))) {
        *first = (pir_impact){.outcome = end.outcome,
                              .time = end.time,
                              .normal = end.answer.normal,
                              .point = end.answer.point_q,
                              .witness = end.answer.witness,
                              .piece_p = i,
                              .piece_q = j};
        call->query->last[0] = i;
        call->query->last[1] = j;
    }
    return reach_until(call);
}

pir_status pir_solid_query_cast(pir_solid_query *query, pir_workspace *workspace, const pir_pair_input *input,
                                const pir_motion *motion, double tolerance, pir_impact *ret_impact) {
    if (!query || !workspace || !input || !motion || !ret_impact)
        return PIR_ERR_ARGUMENT;
    const pir_status checked = pir_motion_check(motion, tolerance);
    if (checked != PIR_OK)
        return checked;
    struct solid_call call = {.query = query, .workspace = workspace, .input = *input};
    call.impact = (pir_impact){.outcome = PIR_CAST_MISS, .time = 1};
    call.input.cutoff = HUGE_VAL;
    call.speed = length(motion->way) + length(motion->turn) * query->p.reach;
    call.flight =
        (pir_flight){.from = input->pose_p, .motion = motion, .reach = query->p.reach, .tolerance = tolerance};
    call.flight.size = query->p.reach + input->radius_p + query->q.reach + input->radius_q +
                       length(input->pose_p.translation) + length(motion->way) + length(input->pose_q.translation);
    const pir_status status = visit(&call, ask_flight);
    if (status == PIR_OK)
        *ret_impact = call.impact;
    return status;
}
