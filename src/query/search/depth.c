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
#include "query/search/depth.h"

#include "query/search/sieve.h"

/*
 * The slots that a search is left with: those of part `k` of looked_count + 1, the groups that were looked at and then
 * the candidates.
 */
static uint32_t part_of(const pir_search *search, uint32_t k, uint32_t *ret_end) {
    const pir_groups *groups = &search->groups;
    if (k == search->looked_count) {
        *ret_end = groups->planes.capacity;
        return search->candidates;
    }
    const pir_group *group = &groups->at[search->looked[k]];
    *ret_end = group->start + group->count;
    return group->start;
}

static void forget(pir_search *search) {
    search->looked_count = 0;
    search->candidates = search->groups.planes.capacity;
}

/* What the least slack of what is left is not above, edge pairs at small angles made exact on the way. */
static double least_refined(pir_search *search, const pir_placement *placement, double limit) {
    pir_groups *groups = &search->groups;
    pir_planes *planes = &groups->planes;
    for (uint32_t k = 0, end; k <= search->looked_count; k++)
        for (uint32_t i = part_of(search, k, &end); i < end; i++) {
            if (pir_planes_slack(planes, i, placement->x) - placement->error * planes->err[i] > limit)
                continue;
            pir_planes_refine(groups->exact, planes, i);
            double high = pir_planes_slack(planes, i, placement->x) + placement->error * planes->err[i];
            limit = high < limit ? high : limit;
        }
    return limit;
}

/* Looks at group g, and notes it where it may hold a slack of at most *limit, which it may lower. */
static void look_at(pir_search *search, uint32_t g, const pir_placement *placement, double *limit, uint32_t *steps) {
    double low, high;
    pir_bounds_look(&search->bounds, &search->groups, g, placement, &low, &high);
    ++*steps;
    if (low > *limit)
        return;
    search->bounds.low[g] = low;
    search->looked[search->looked_count++] = g;
    *limit = high < *limit ? high : *limit;
}

bool pir_depth_find(pir_search *search, const pir_placement *placement, const pir_query_cache *cache,
                    pir_facet *ret_facet, uint32_t *steps) {
    pir_groups *groups = &search->groups;
    double limit = HUGE_VAL;
    pir_plane last;
    forget(search);
    if (groups->count > 0 && pir_piece_recall(groups, cache, &last)) {
        limit = pir_plane_slack(&last, placement->x) + placement->error * last.err;
        ++*steps;
    }
    double high = pir_bounds_find(&search->bounds, groups, placement, limit);
    limit = high < limit ? high : limit;
    for (uint32_t g = 0; g < groups->count; g++)
        if (search->bounds.low[g] <= limit) {
            // planes pay from the second time at a rotation on
            if (groups->at[g].stamp == groups->stamp || groups->at[g].sieved == groups->stamp) {
                look_at(search, g, placement, &limit, steps);
            } else {
                limit = pir_group_sieve(search, g, placement, limit);
                ++*steps;
            }
        }
    // but for groups that were looked at before the limit fell
    uint32_t kept = 0;
    for (uint32_t k = 0; k < search->looked_count; k++)
        if (search->bounds.low[search->looked[k]] <= limit)
            search->looked[kept++] = search->looked[k];
    search->looked_count = kept;
    // a refined plane's slack and error say more than they did before
    limit = least_refined(search, placement, limit);
    const pir_planes *planes = &groups->planes;
    pir_least least = {.some = false};
    for (uint32_t k = 0, end; k <= search->looked_count; k++)
        for (uint32_t i = part_of(search, k, &end); i < end; i++)
            if (pir_planes_slack(planes, i, placement->x) - placement->error * planes->err[i] <= limit)
                pir_least_offer(groups->exact, placement, &least, planes->piece[i]);
    if (least.some)
        *ret_facet = least.facet;
    return least.some;
}
