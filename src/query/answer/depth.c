/* SPDX-License-Identifier: MIT */
/*
 * The least slack: the global penetration depth.
 *
 * An upper bound comes from the facet that won last time, lower bounds from the groups; those that cannot win are not
 * looked at. A group is sieved the first time at a rotation, and has its planes made the second. What doubles leave are
 * pieces that may have the least slack; the true facets that they belong to are compared exactly (facet.h), and equal
 * slacks are settled by the order of facets. So the answer depends on the placement alone and not on what was asked
 * before.
 */
#include "query/decide/facet.h"

/*
 * The slots that a search is left with: those of part `k` of looked_count + 1, the groups that were looked at and then
 * the candidates.
 */
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

/* What the least slack of what is left is not above, edge pairs at small angles made exact on the way. */
static double least_refined(pir_query *query, const pir_placement *placement, double limit) {
    pir_planes *planes = &query->planes;
    for (uint32_t k = 0, end; k <= query->looked_count; k++)
        for (uint32_t i = part_of(query, k, &end); i < end; i++) {
            if (pir_plane_slack(planes, i, placement->x) - placement->error * planes->err[i] > limit)
                continue;
            pir_plane_refine(query, i);
            double high = pir_plane_slack(planes, i, placement->x) + placement->error * planes->err[i];
            limit = high < limit ? high : limit;
        }
    return limit;
}

void pir_least_offer(pir_query *query, const pir_placement *placement, pir_least *least, pir_piece piece) {
    pir_facet facet;
    if (!pir_facet_of(query, piece, &facet))
        return;
    int order = -1;
    if (least->some) {
        if (pir_facet_same(&facet, &least->facet))
            return;
        order = pir_facet_compare(query, placement, &facet, &least->facet);
        if (order == 0)
            order = pir_facet_before(&facet, &least->facet) ? -1 : 1;
    }
    if (order < 0)
        least->facet = facet;
    least->some = true;
}

/* Looks at group g, and notes it where it may hold a slack of at most *limit, which it may lower. */
static void look_at(pir_query *query, uint32_t g, const pir_placement *placement, double *limit, uint32_t *steps) {
    double low, high;
    pir_group_look(query, g, placement, &low, &high);
    ++*steps;
    if (low > *limit)
        return;
    query->low[g] = low;
    query->looked[query->looked_count++] = g;
    *limit = high < *limit ? high : *limit;
}

bool pir_depth_find(pir_query *query, const pir_placement *placement, const pir_query_cache *cache,
                    pir_facet *ret_facet, uint32_t *steps) {
    double limit = HUGE_VAL;
    uint32_t slot;
    forget(query);
    if (query->group_count > 0 && pir_piece_recall(query, cache, &slot)) {
        limit = pir_plane_slack(&query->planes, slot, placement->x) + placement->error * query->planes.err[slot];
        ++*steps;
    }
    double high = pir_groups_bound(query, placement, limit);
    limit = high < limit ? high : limit;
    for (uint32_t g = 0; g < query->group_count; g++)
        if (query->low[g] <= limit) {
            // planes pay from the second time at a rotation on
            if (query->groups[g].stamp == query->stamp || query->groups[g].sieved == query->stamp) {
                look_at(query, g, placement, &limit, steps);
            } else {
                limit = pir_group_sieve(query, g, placement, limit);
                ++*steps;
            }
        }
    // but for groups that were looked at before the limit fell
    uint32_t kept = 0;
    for (uint32_t k = 0; k < query->looked_count; k++)
        if (query->low[query->looked[k]] <= limit)
            query->looked[kept++] = query->looked[k];
    query->looked_count = kept;
    // a refined plane's slack and error say more than they did before
    limit = least_refined(query, placement, limit);
    const pir_planes *planes = &query->planes;
    pir_least least = {.some = false};
    for (uint32_t k = 0, end; k <= query->looked_count; k++)
        for (uint32_t i = part_of(query, k, &end); i < end; i++)
            if (pir_plane_slack(planes, i, placement->x) - placement->error * planes->err[i] <= limit)
                pir_least_offer(query, placement, &least, planes->piece[i]);
    if (least.some)
        *ret_facet = least.facet;
    return least.some;
}
