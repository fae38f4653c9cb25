/* SPDX-License-Identifier: MIT */
/*
 * The least slack, which is the global penetration depth.
 *
 * The facet that was least last time gives an upper bound, the groups give lower bounds, and groups that cannot hold
 * the least slack are not searched. A group is sieved at the first search at a rotation; its planes are made at the
 * second. Doubles leave the pieces that may have the least slack. Their true facets are compared exactly (facet.h),
 * and the order of facets settles ties. So the answer depends on the placement alone and not on earlier queries.
 */
#include "query/search/depth.h"

#include "query/search/sieve.h"

/*
 * The slots that a search leaves: part `k` of looked_count + 1. The parts are the groups that were searched, then the
 * candidates.
 */
static uint32_t part_of(const pir_search *search, uint32_t k, uint32_t *ret_end) {
    const pir_groups *groups = &search->groups;
    if (k == search->looked_count) {
        *ret_end = groups->planes->capacity;
        return search->candidates;
    }
    const pir_group *group = &groups->at[search->looked[k]];
    *ret_end = group->start + group->count;
    return group->start;
}

static void forget(pir_search *search) {
    search->looked_count = 0;
    search->candidates = search->groups.planes->capacity;
}

/*
 * An upper bound on the least slack of what a search leaves. Planes of edge pairs at small angles are refined on the
 * way.
 */
static double least_refined(pir_search *search, const pir_placement *placement, double limit) {
    pir_groups *groups = &search->groups;
    pir_planes *planes = groups->planes;
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

/* Searches group g, and notes it where it may hold a slack of at most *limit, which it may lower. */
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
            // making planes pays from the second search at a rotation on
            if (groups->at[g].stamp == groups->stamp || groups->at[g].sieved == groups->stamp) {
                look_at(search, g, placement, &limit, steps);
            } else {
                limit = pir_group_sieve(search, g, placement, limit);
                ++*steps;
            }
        }
    // drop groups that were noted before the limit fell
    uint32_t kept = 0;
    for (uint32_t k = 0; k < search->looked_count; k++)
        if (search->bounds.low[search->looked[k]] <= limit)
            search->looked[kept++] = search->looked[k];
    search->looked_count = kept;
    // a refined plane has another slack and a smaller error
    limit = least_refined(search, placement, limit);
    const pir_planes *planes = groups->planes;
    pir_least least = {.some = false};
    for (uint32_t k = 0, end; k <= search->looked_count; k++)
        for (uint32_t i = part_of(search, k, &end); i < end; i++)
            if (pir_planes_slack(planes, i, placement->x) - placement->error * planes->err[i] <= limit)
                pir_least_offer(groups->exact, placement, &least, planes->piece[i]);
    if (least.some)
        *ret_facet = least.facet;
    return least.some;
}
