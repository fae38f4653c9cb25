/* SPDX-License-Identifier: MIT */
/*
 * Many translations at one rotation. All planes are made once and stand in leaves (leaves.h). Two balls about D's
 * middle decide most states: within the depth of the middle everything is inside, beyond the sizes of the bodies
 * everything is outside. What leaves and balls leave open goes to single queries.
 */
#include "query/answer/follow.h"

struct batch {
    pir_query *query;
    pir_query_input input;
    double inner; /* lower bound on the slacks at the middle */
};

/* Makes the leaves' struct, once. */
static pir_status need_leaves(pir_query *query) {
    if (!query->leaves)
        query->leaves = PIR_ZEROED(&query->allocator, pir_leaves, 1);
    return query->leaves ? PIR_OK : PIR_ERR_MEMORY;
}

/* Whether each translation can be placed, so that no answer is written where one cannot. */
static pir_status check(const pir_frame *frame, const pir_vec3 *translations, size_t count) {
    pir_status status = PIR_OK;
    pir_placement placement;
    double all = 0;
    for (size_t i = 0; i < count; i++)
        all += fabs(translations[i].x) + fabs(translations[i].y) + fabs(translations[i].z);
    // where one is not finite the sum is not, and no translation is beyond it
    if (pir_frame_place(frame, (pir_vec3){all, 0, 0}, &placement) == PIR_OK)
        return PIR_OK;
    for (size_t i = 0; i < count && status == PIR_OK; i++)
        status = pir_frame_place(frame, translations[i], &placement);
    return status;
}

static pir_status begin(struct batch *batch, pir_query *query, const pir_vec3 *translations, size_t count,
                        const void *ret) {
    pir_placement middle;
    if (!query || (!translations && count > 0) || !ret)
        return PIR_ERR_ARGUMENT;
    *batch = (struct batch){.query = query, .input = pir_query_input_default()};
    pir_status status = pir_query_begin(query, &batch->input, &middle);
    if (status == PIR_OK)
        status = check(&query->frame, translations, count);
    if (status == PIR_OK)
        status = need_leaves(query);
    if (status == PIR_OK)
        status = pir_leaves_make(query->leaves, &query->search.groups, &query->allocator);
    if (status != PIR_OK)
        return status;
    middle.x = (pir_vec3){0, 0, 0};
    middle.reach = query->frame.p.size + query->frame.q.size;
    middle.error = PIR_SLACK_BOUND * middle.reach;
    // 64 errors hold those of the slacks, and of x in every placement that is compared
    batch->inner = pir_leaves_least(query->leaves, &query->search.groups, &middle) - 64 * middle.error;
    return PIR_OK;
}

/* The state. False where neither ball decides it. */
static bool settle(const struct batch *batch, const pir_placement *placement, pir_state *ret_state) {
    double away = placement->reach - batch->query->frame.p.size - batch->query->frame.q.size;
    if (away + placement->error < batch->inner) {
        *ret_state = PIR_INSIDE;
        return true;
    }
    if (away > (batch->query->frame.p.size + batch->query->frame.q.size) * (1 + 0x1p-40) + 2 * placement->error) {
        *ret_state = PIR_OUTSIDE;
        return true;
    }
    return false;
}

/*
 * The state, and where `ret_depth` is not NULL the depth, 0 outside. False where neither a ball nor the leaves decide
 * it.
 */
static inline __attribute__((always_inline)) bool find(const struct batch *batch, const pir_placement *placement,
                                                       double *ret_depth, pir_state *ret_state) {
    pir_query *query = batch->query;
    pir_facet facet;
    if (!settle(batch, placement, ret_state) &&
        !pir_leaves_state(query->leaves, &query->search.groups, placement, ret_state))
        return false;
    if (!ret_depth)
        return true;
    *ret_depth = 0;
    if (*ret_state != PIR_INSIDE)
        return true;
    if (!pir_leaves_depth(query->leaves, &query->search.groups, placement, &facet))
        return false;
    double slack = pir_facet_slack(&query->exact, placement, &facet);
    *ret_depth = pir_frame_length(&query->frame, slack > 0 ? slack : 0);
    return true;
}

/* The call that answers what a batch leaves open. */
typedef pir_status single_call(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                               pir_query_result *ret_result);

/*
 * Asks for states and, where there is room for them, for depths or distances. Inline in each call, which knows what it
 * asks for: a state takes 10 ns, and 14 where the loop finds out.
 */
static inline __attribute__((always_inline)) pir_status run(struct batch *batch, const pir_vec3 *translations,
                                                            size_t count, single_call *call, double *ret_numbers,
                                                            pir_state *ret_states) {
    const bool distances = call == pir_query_signed_distance;
    pir_status status = PIR_OK;
    for (size_t i = 0; i < count; i++) {
        pir_placement placement;
        pir_query_result result;
        double depth = 0;
        status = pir_frame_place(&batch->query->frame, translations[i], &placement);
        if (status != PIR_OK)
            break;
        if (!find(batch, &placement, ret_numbers ? &depth : NULL, &result.state) ||
            (distances && result.state != PIR_INSIDE)) {
            batch->input.translation = translations[i];
            status = call(batch->query, &batch->input, NULL, &result);
            if (status != PIR_OK)
                break;
            depth = 0 - result.distance;
        }
        if (ret_numbers)
            ret_numbers[i] = distances ? 0 - depth : depth;
        if (ret_states)
            ret_states[i] = result.state;
    }
    return status;
}

pir_status pir_query_batch_states(pir_query *query, const pir_vec3 *translations, size_t count, pir_state *ret_states) {
    struct batch batch;
    pir_status status = begin(&batch, query, translations, count, ret_states);
    return status == PIR_OK ? run(&batch, translations, count, pir_query_overlap, NULL, ret_states) : status;
}

pir_status pir_query_batch_depths(pir_query *query, const pir_vec3 *translations, size_t count, double *ret_depths,
                                  pir_state *ret_states) {
    struct batch batch;
    pir_status status = begin(&batch, query, translations, count, ret_depths);
    return status == PIR_OK ? run(&batch, translations, count, pir_query_penetration, ret_depths, ret_states) : status;
}

pir_status pir_query_batch_distances(pir_query *query, const pir_vec3 *translations, size_t count,
                                     double *ret_distances, pir_state *ret_states) {
    struct batch batch;
    pir_status status = begin(&batch, query, translations, count, ret_distances);
    return status == PIR_OK ? run(&batch, translations, count, pir_query_signed_distance, ret_distances, ret_states)
                            : status;
}
