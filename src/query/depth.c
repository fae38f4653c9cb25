/* SPDX-License-Identifier: MIT */
/*
 * The least slack: the global penetration depth.
 *
 * An upper bound comes from the facet that won last time, lower bounds from the groups; those that cannot win are not looked at. A group is
 * sieved the first time at a rotation, and has its planes made the second. Among what is left, edge pairs at small angles get exact normals, and ties are settled by the order of pieces, so that the answer
 * depends on the placement alone and not on what was asked before.
 */
#include "query/query.h"

bool pir_piece_before(pir_piece a, pir_piece b) {
    if (a.kind != b.kind)
        return a.kind < b.kind;
    return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/* The slots that a search is left with: those of part `k` of looked_count + 1, the groups that were looked at and then the candidates. */
static uint32_t part_of(const pir_query *query, uint32_t k, uint32_t *ret_end) {
    if (k == query->looked_count) {
        *ret_end = query->planes.capacity - PIR_SPARE_SLOTS;
        return query->candidates;
    }
    const pir_group *group = &query->groups[query->looked[k]];
    *ret_end = group->start + group->count;
    return group->start;
}

static void forget(pir_query *query) {
    query->looked_count = 0;
    query->candidates = query->planes.capacity - PIR_SPARE_SLOTS;
}

/* The least slack of what is left, edge pairs at small angles made exact on the way. */
static double least_refined(pir_query *query, const pir_placement *placement, double limit) {
    pir_planes *planes = &query->planes;
    double least = HUGE_VAL;
    for (uint32_t k = 0, end; k <= query->looked_count; k++)
        for (uint32_t i = part_of(query, k, &end); i < end; i++) {
            if (pir_plane_slack(planes, i, placement->x) - placement->error * planes->err[i] > limit)
                continue;
            pir_plane_refine(query, i);
            double s = pir_plane_slack(planes, i, placement->x);
            least = s < least ? s : least;
        }
    return least;
}

/* The first piece in order whose slack is at most `limit`. */
static uint32_t first_within(const pir_query *query, const pir_placement *placement, double limit) {
    const pir_planes *planes = &query->planes;
    uint32_t best = PIR_NO_PLANE;
    for (uint32_t k = 0, end; k <= query->looked_count; k++)
        for (uint32_t i = part_of(query, k, &end); i < end; i++)
            if (pir_plane_slack(planes, i, placement->x) <= limit &&
                (best == PIR_NO_PLANE || pir_piece_before(planes->piece[i], planes->piece[best])))
                best = i;
    return best;
}

/* Looks at group g, and notes it where it may hold a slack of at most *limit, which it may lower. */
static void look_at(pir_query *query, uint32_t g, const pir_placement *placement, double tie, double *limit,
                    uint32_t *steps) {
    double low, high;
    pir_group_look(query, g, placement, &low, &high);
    ++*steps;
    if (low > *limit + tie)
        return;
    query->low[g] = low;
    query->looked[query->looked_count++] = g;
    *limit = high < *limit ? high : *limit;
}

uint32_t pir_depth_find(pir_query *query, const pir_placement *placement, const pir_query_cache *cache,
                        double *ret_slack, uint32_t *steps) {
    if (query->group_count == 0)
        return PIR_NO_PLANE;
    double tie = PIR_TIE * (query->size_p + query->size_q), limit = HUGE_VAL;
    uint32_t slot;
    forget(query);
    if (pir_piece_recall(query, cache, &slot)) {
        limit = pir_plane_slack(&query->planes, slot, placement->x) + placement->error * query->planes.err[slot];
        ++*steps;
    }
    double high = pir_groups_bound(query, placement, limit + tie);
    limit = high < limit ? high : limit;
    for (uint32_t g = 0; g < query->group_count; g++)
        if (query->low[g] <= limit + tie) {
            // planes pay from the second time at a rotation on
            if (query->groups[g].stamp == query->stamp || query->groups[g].sieved == query->stamp) {
                look_at(query, g, placement, tie, &limit, steps);
            } else {
                limit = pir_group_sieve(query, g, placement, tie, limit);
                ++*steps;
            }
        }
    // but for groups that were looked at before the limit fell
    uint32_t kept = 0;
    for (uint32_t k = 0; k < query->looked_count; k++)
        if (query->low[query->looked[k]] <= limit + tie)
            query->looked[kept++] = query->looked[k];
    query->looked_count = kept;
    // what a refined slack may rise above an unrefined one is within its error, which limit holds
    double least = least_refined(query, placement, limit + tie);
    uint32_t best = first_within(query, placement, least + tie);
    if (best == PIR_NO_PLANE)
        return best;
    *ret_slack = pir_plane_slack(&query->planes, best, placement->x);
    // to where no group's planes come
    slot = query->planes.capacity - 2;
    pir_plane_copy(&query->planes, best, slot);
    return slot;
}

/* --- every way out --- */

/* The slot of the next piece in order after `after`, with a slack of at most `limit`. */
static uint32_t next_within(const pir_query *query, const pir_placement *placement, double limit,
                            const pir_piece *after) {
    const pir_planes *planes = &query->planes;
    uint32_t best = PIR_NO_PLANE;
    for (uint32_t k = 0, end; k <= query->looked_count; k++)
        for (uint32_t i = part_of(query, k, &end); i < end; i++) {
            pir_piece piece = planes->piece[i];
            if ((!after || pir_piece_before(*after, piece)) &&
                (best == PIR_NO_PLANE || pir_piece_before(piece, planes->piece[best])) &&
                pir_plane_slack(planes, i, placement->x) <= limit)
                best = i;
        }
    return best;
}

pir_status pir_query_escapes(pir_query *query, const pir_query_input *input, double slack, size_t capacity,
                             pir_escape *ret_escapes, size_t *ret_count) {
    pir_placement placement;
    if ((!ret_escapes && capacity > 0) || !ret_count || !(slack >= 0))
        return PIR_ERR_ARGUMENT;
    pir_query_result least;
    pir_status status = pir_query_penetration(query, input, NULL, &least);
    if (status == PIR_OK)
        status = pir_query_begin(query, input, &placement);
    if (status != PIR_OK)
        return status;
    size_t count = 0;
    double radii = input->radius_p + input->radius_q;
    if (least.outcome == PIR_OVERLAPPING && -least.distance >= radii) {
        double limit =
            pir_frame_from(query, -least.distance - radii + slack) + PIR_TIE * (query->size_p + query->size_q);
        uint32_t steps = 0;
        double unlimited = HUGE_VAL;
        forget(query);
        for (uint32_t g = 0; g < query->group_count; g++)
            look_at(query, g, &placement, HUGE_VAL, &unlimited, &steps);
        least_refined(query, &placement, limit);
        const pir_planes *planes = &query->planes;
        pir_piece last;
        for (uint32_t i = next_within(query, &placement, limit, NULL); i != PIR_NO_PLANE;
             i = next_within(query, &placement, limit, &last), count++) {
            last = planes->piece[i];
            if (count < capacity)
                ret_escapes[count] =
                    (pir_escape){pir_frame_length(query, pir_plane_slack(planes, i, placement.x)) + radii,
                                 pir_plane_normal(planes, i), pir_witness_of_piece(query, last)};
        }
    }
    *ret_count = count;
    return PIR_OK;
}
