/* SPDX-License-Identifier: MIT */
/*
 * Many translations at one rotation. All planes are made at once, with a box around each group's. Two balls about D's middle settle
 * most states at once: within the depth of the middle everything is inside, beyond the sizes of the bodies everything is outside. Of the
 * rest, most are outside by a facet of the group whose box reaches lowest.
 */
#include "query/query.h"

struct batch {
    pir_query *query;
    pir_query_cache cache;
    pir_query_input input;
    double inner; /* slacks at the middle are at least this */
};

static pir_status begin(struct batch *batch, pir_query *query, const pir_vec3 *translations, size_t count,
                        const void *ret) {
    pir_placement middle;
    if (!query || (!translations && count > 0) || !ret)
        return PIR_ERR_ARGUMENT;
    *batch = (struct batch){.query = query, .input = pir_query_input_default()};
    pir_status status = pir_query_begin(query, &batch->input, &middle);
    if (status != PIR_OK)
        return status;
    middle.x = (pir_vec3){0, 0, 0};
    middle.reach = query->size_p + query->size_q;
    middle.error = PIR_SLACK_BOUND * middle.reach;
    double slack = -1;
    uint32_t steps = 0;
    uint32_t slot = pir_depth_find(query, &middle, NULL, &slack, &steps);
    // what is taken off holds the errors of a slack and of x
    batch->inner = slot != PIR_NO_PLANE ? slack - 64 * middle.error - PIR_TIE * middle.reach : -1;
    return PIR_OK;
}

/* Whether the likeliest group separates. */
static bool is_outside(pir_query *query, const pir_placement *placement) {
    double low, high = HUGE_VAL;
    if (query->group_count > 0) {
        pir_groups_bound(query, placement, 0);
        pir_group_look(query, pir_group_likely(query), placement, &low, &high);
    }
    return high < 0;
}

/* The state where a ball settles it. */
static bool settle(const struct batch *batch, const pir_placement *placement, pir_state *ret_state) {
    double away = placement->reach - batch->query->size_p - batch->query->size_q;
    if (away + placement->error < batch->inner) {
        *ret_state = PIR_INSIDE;
        return true;
    }
    if (away > (batch->query->size_p + batch->query->size_q) * (1 + 0x1p-40) + 2 * placement->error) {
        *ret_state = PIR_OUTSIDE;
        return true;
    }
    return false;
}

pir_status pir_query_batch_states(pir_query *query, const pir_vec3 *translations, size_t count, pir_state *ret_states) {
    struct batch batch;
    pir_status status = begin(&batch, query, translations, count, ret_states);
    for (size_t i = 0; i < count && status == PIR_OK; i++) {
        pir_placement placement;
        pir_query_result result;
        status = pir_frame_place(query, translations[i], &placement);
        if (status != PIR_OK || settle(&batch, &placement, &ret_states[i]))
            continue;
        if (is_outside(query, &placement)) {
            ret_states[i] = PIR_OUTSIDE;
            continue;
        }
        batch.input.translation = translations[i];
        status = pir_query_overlap(query, &batch.input, &batch.cache, &result);
        if (status == PIR_OK)
            ret_states[i] = result.state;
    }
    return status;
}

/* The depth where the ball tells that there is one: the least slack, and nothing beside it. */
static bool depth_inside(struct batch *batch, const pir_placement *placement, double *ret_depth) {
    pir_state state;
    if (!settle(batch, placement, &state) || state != PIR_INSIDE)
        return false;
    double slack;
    uint32_t steps = 0, slot = pir_depth_find(batch->query, placement, &batch->cache, &slack, &steps);
    pir_piece_keep(&batch->cache, batch->query->planes.piece[slot]);
    *ret_depth = pir_frame_length(batch->query, slack);
    return true;
}

pir_status pir_query_batch_depths(pir_query *query, const pir_vec3 *translations, size_t count, double *ret_depths,
                                  pir_state *ret_states) {
    struct batch batch;
    pir_status status = begin(&batch, query, translations, count, ret_depths);
    for (size_t i = 0; i < count && status == PIR_OK; i++) {
        pir_placement placement;
        pir_query_result result = {.state = PIR_INSIDE};
        status = pir_frame_place(query, translations[i], &placement);
        if (status == PIR_OK && !depth_inside(&batch, &placement, &ret_depths[i])) {
            batch.input.translation = translations[i];
            status = pir_query_penetration(query, &batch.input, &batch.cache, &result);
            ret_depths[i] = 0 - result.distance;
        }
        if (status == PIR_OK && ret_states)
            ret_states[i] = result.state;
    }
    return status;
}

pir_status pir_query_batch_distances(pir_query *query, const pir_vec3 *translations, size_t count,
                                     double *ret_distances, pir_state *ret_states) {
    struct batch batch;
    pir_status status = begin(&batch, query, translations, count, ret_distances);
    for (size_t i = 0; i < count && status == PIR_OK; i++) {
        pir_query_result result;
        batch.input.translation = translations[i];
        status = pir_query_signed_distance(query, &batch.input, &batch.cache, &result);
        if (status != PIR_OK)
            break;
        ret_distances[i] = result.distance;
        if (ret_states)
            ret_states[i] = result.state;
    }
    return status;
}
