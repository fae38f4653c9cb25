/* SPDX-License-Identifier: MIT */
/*
 * The least slack, which is the global penetration depth.
 *
 * The facet that was least last time gives an upper bound, the groups give lower bounds, and groups that cannot hold
 * the least slack are not searched. A group is sieved at the first search at a rotation; its planes are made at the
 * second. Doubles leave the pieces that may have the least slack. Their true facets are compared exactly (facet.h),
 * and the order of facets settles ties. So the answer depends on the placement alone and not on earlier queries.
 *
 * Sieves: a sieve for the pieces of a group that may hold the least slack. It does not make the group's other planes.
 *
 * The slacks of the facets come first. Those of P's facets are computed in P's frame, where their normals and offsets
 * are: n·(p + Rᵀ(b − x)) with b the vertex that the pairing has. Those of Q's facets are computed likewise. An
 * edge of P lies on two facets, 1 and 2. With a vertex p of it and b₁ of facet 1, w = p + Rᵀ(b₁ − x) is a
 * vertex of D − x, so all slacks of edge pairs on the arc from n₁ to n₂ are at least n·w. Along the arc n·w is
 * a·cos(φ − φ₀), and is nowhere less than at the ends while it is positive at both. At the ends it is the slack
 * of facet 1, and the offset of facet 2 plus n₂·Rᵀ(b₁ − x). The same holds with b₂; the greater of the two
 * is the bound. Only the edge pairs of the few edges that it does not rule out are computed.
 *
 * Rounding: each of these is within one error (frame.h) of the exact one, and so is the slack that it is compared
 * with.
 */
#include "query/depth/depth.h"

#include "base/processor.h"

/* --- memory of searches --- */

void pir_search_init(pir_search *search, pir_exact *exact, const pir_pairing *pairing) {
    search->groups.frame = exact->frame;
    search->groups.exact = exact;
    search->groups.pairing = pairing;
    search->groups.scan = pir_processor_best()->scan;
}

void pir_search_add_rows(pir_search *search, pir_layout *layout) {
    uint32_t count = search->groups.count;
    pir_layout_add(layout, (pir_layout_row)PIR_ROW(search->groups.at, count));
    pir_bounds_add_rows(&search->bounds, &search->groups, layout);
    pir_layout_add(layout, (pir_layout_row)PIR_ROW(search->slack, count));
    pir_layout_add(layout, (pir_layout_row)PIR_ROW(search->looked, count));
}

void pir_search_fill(pir_search *search) {
    pir_groups_fill(&search->groups);
    pir_bounds_fill(&search->bounds, &search->groups);
}

/* --- sieves --- */

/* The state of a sieve: upper bound on the least slack of all, lower bound on the slacks of the group. */
struct sieve {
    const pir_placement *placement;
    double limit, low;
};

static inline double lesser(double a, double b) {
    return a < b ? a : b;
}

/* Makes the plane of a piece, and keeps it where it may have the least slack. */
static void try_piece(pir_search *search, pir_piece piece, struct sieve *sieve) {
    pir_groups *groups = &search->groups;
    pir_plane plane;
    if (!pir_plane_of(groups->exact, piece, &plane))
        return;
    double s = pir_plane_slack(&plane, sieve->placement->x), error = sieve->placement->error * plane.err;
    sieve->low = lesser(sieve->low, s - error);
    if (s - error <= sieve->limit) {
        PIR_ASSERT(search->candidates > groups->planes->used);
        pir_planes_put(groups->planes, --search->candidates, &plane);
        sieve->limit = lesser(sieve->limit, s + error);
    }
}

/*
 * Computes the slacks of the group's facets, into work.vector[2].x, and Rᵀ(b − x), or its like, into
 * work.vector[1].
 * *ret_along is the least n·x. Returns the least slack.
 */
static double facet_slacks(const pir_groups *groups, const pir_group *group, const pir_placement *placement,
                           double *ret_along) {
    const pir_frame *frame = groups->frame;
    const pir_group_lists *lists = pir_lists_of(groups, group);
    const uint32_t *list = lists->facet + group->of.facets,
                   *other = group->of_q ? groups->pairing->vf : groups->pairing->fv;
    const pir_vec3 *vertex = group->of_q ? frame->p.vertex : frame->q.vertex;
    pir_lanes from = groups->work->vector[0];
    uint32_t count = group->of.facets_end - group->of.facets;
    for (uint32_t i = 0; i < count; i++)
        pir_lane_put(from, i, vertex[other[list[i]]]);
    pir_mat3 back;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            back.m[i][j] = frame->r.m[j][i];
    pir_vec3 x = group->of_q ? placement->x : pir_mat_apply(&back, placement->x);
    pir_facet_lanes facets = {pir_lanes_from(lists->facet_normal, group->of.facets),
                              lists->facet_offset + group->of.facets};
    pir_slack_lanes slacks = {.to = groups->work->vector[1], .s = groups->work->vector[2].x};
    groups->scan->slacks(count, group->of_q ? &frame->r : &back, from, x, &facets, &slacks);
    *ret_along = slacks.along;
    return slacks.least;
}

/*
 * Computes the slacks of the edge pairs of edge `i` of the list, and tries those pieces that may have the least
 * slack.
 */
static void sieve_crossings(pir_search *search, uint32_t i, uint32_t at, struct sieve *sieve) {
    const pir_groups *groups = &search->groups;
    const pir_frame *frame = groups->frame;
    const pir_polytope *q = frame->q.polytope;
    const pir_pairing *pairing = groups->pairing;
    const pir_group_lists *lists = groups->lists[0];
    pir_vec3 e = pir_mat_apply(&frame->r, pir_lane_get(lists->edge_direction, i));
    pir_vec3 o = pir_vec_sub(pir_mat_apply(&frame->r, pir_lane_get(lists->edge_origin, i)), sieve->placement->x);
    const double off = 2 * sieve->placement->error;
    for (; at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at)) {
        uint32_t h = pir_crossing_half(pairing, at);
        pir_vec3 n = pir_vec_cross(q->direction[h], e);
        double err = 1 / sqrt(pir_vec_dot(n, n)),
               s = pir_vec_dot(n, pir_vec_add(o, frame->q.vertex[q->origin[h]])) * err;
        double low = s - off * err;
        // a normal that is rounding alone is not above the limit either: NaN compares false
        if (low > sieve->limit)
            sieve->low = lesser(sieve->low, low);
        else
            try_piece(search, (pir_piece){PIR_FACET_EE, lists->edge[i], h}, sieve);
    }
}

/* Tries the edges of a group of P's whose arcs may hold the least slack. */
static void sieve_edges(pir_search *search, const pir_group *group, struct sieve *sieve) {
    const pir_groups *groups = &search->groups;
    const pir_group_lists *lists = pir_lists_of(groups, group);
    const pir_lanes normal = pir_lanes_from(lists->facet_normal, group->of.facets), to = groups->work->vector[1];
    const double *s = groups->work->vector[2].x, *offset = lists->facet_offset + group->of.facets,
                 off = 2 * sieve->placement->error;
    // a flat P has arcs of half a turn, which nothing bounds
    bool bounds = groups->frame->p.polytope->dimension == 3;
    for (uint32_t i = group->of.edges; i < group->of.edges_end; i++) {
        uint32_t at = pir_crossing_first(groups->pairing, lists->edge[i]), a = lists->edge_left[i],
                 b = lists->edge_right[i];
        if (at == PIR_NO_CROSSING)
            continue;
        double of_a = offset[b] + pir_vec_dot(pir_lane_get(normal, b), pir_lane_get(to, a));
        double of_b = offset[a] + pir_vec_dot(pir_lane_get(normal, a), pir_lane_get(to, b));
        double first = lesser(s[a], of_a), second = lesser(s[b], of_b);
        double bound = (first > second ? first : second) - off;
        if (bounds && bound > 0 && bound > sieve->limit)
            sieve->low = lesser(sieve->low, bound);
        else
            sieve_crossings(search, i, at, sieve);
    }
}

/*
 * Adds those pieces of group `g` to the candidates whose slack may be at most `limit`, and keeps the group's bound.
 * Returns an upper bound on the least slack of all, `limit` or less.
 */
static double sieve_group(pir_search *search, uint32_t g, const pir_placement *placement, double limit) {
    pir_groups *groups = &search->groups;
    pir_group *group = &groups->at[g];
    const double off = 2 * placement->error;
    double along, least = facet_slacks(groups, group, placement, &along);
    struct sieve sieve = {placement, lesser(limit, least + off), least - off};
    group->sieved = groups->stamp;
    for (uint32_t i = group->of.facets; least - off <= sieve.limit && i < group->of.own_end; i++)
        if (groups->work->vector[2].x[i - group->of.facets] - off <= sieve.limit) {
            uint32_t f = pir_lists_of(groups, group)->facet[i];
            try_piece(search, group->of_q ? pir_piece_vf(groups, f) : pir_piece_fv(groups, f), &sieve);
        }
    sieve_edges(search, group, &sieve);
    pir_bounds_keep(&search->bounds, groups, g, placement, sieve.low, along);
    return sieve.limit;
}

/* --- the search --- */

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
                limit = sieve_group(search, g, placement, limit);
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
    pir_least least = {.found = false};
    for (uint32_t k = 0, end; k <= search->looked_count; k++)
        for (uint32_t i = part_of(search, k, &end); i < end; i++)
            if (pir_planes_slack(planes, i, placement->x) - placement->error * planes->err[i] <= limit)
                pir_least_offer(groups->exact, placement, &least, planes->piece[i]);
    if (least.found)
        *ret_facet = least.facet;
    return least.found;
}
