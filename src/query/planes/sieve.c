/* SPDX-License-Identifier: MIT */
/*
 * Which pieces of a group may hold the least slack, told without making its planes.
 *
 * The slacks of its facets come first: those of P's in P's own frame, where their normals and offsets stand, n·(p + Rᵀ(b − x)) with b the
 * vertex that fv names; those of Q's likewise. An edge of P lies on both its facets 1 and 2, so with a vertex p of it and b₁ of
 * facet 1, w = p + Rᵀ(b₁ − x) is a vertex of D − x, and the slacks of all crossings on the arc from n₁ to n₂ are at least n·w there. Along
 * the arc n·w runs as a·cos(φ − φ₀), and is nowhere less than at the ends while it is positive at both: there it is the slack of facet 1, and
 * the offset of facet 2 plus n₂·Rᵀ(b₁ − x). The same holds of b₂, and the better of the two is the bound. Only what crosses
 * the few edges that it does not rule out is worked out.
 *
 * Rounding: each of these is within one error (query.h) of the exact one, and so is the slack that it is compared to.
 */
#include "query/query.h"

/* A search at work: what it compares with, and the least that the group in hand can have. */
struct search {
    const pir_placement *placement;
    double limit, low;
};

static inline double lesser(double a, double b) {
    return a < b ? a : b;
}

/* Makes the plane of a piece, and keeps it where it may be the least. */
static void try_piece(pir_query *query, pir_piece piece, struct search *search) {
    pir_planes *planes = &query->planes;
    uint32_t slot = query->candidates - 1;
    PIR_ASSERT(slot >= planes->used);
    if (!pir_plane_make(query, piece, slot))
        return;
    double s = pir_plane_slack(planes, slot, search->placement->x),
           error = search->placement->error * planes->err[slot];
    search->low = lesser(search->low, s - error);
    if (s - error <= search->limit) {
        query->candidates = slot;
        search->limit = lesser(search->limit, s + error);
    }
}

/* The slacks of the group's facets, in work[2].x, and Rᵀ(b − x), or its like, in work[1]; *ret_along is the least n·x. Returns the least slack. */
static double facet_slacks(pir_query *query, const pir_group *group, const pir_placement *placement,
                           double *ret_along) {
    const uint32_t *list = query->facet_list + group->facets,
                   *other = group->of_q ? pir_sum_pairing(query->sum)->vf : pir_sum_pairing(query->sum)->fv;
    const pir_vec3 *vertex = group->of_q ? query->vp : query->vq;
    pir_lanes from = query->work[0];
    uint32_t count = group->facets_end - group->facets;
    for (uint32_t i = 0; i < count; i++)
        pir_lane_put(from, i, vertex[other[list[i]]]);
    pir_mat3 back;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            back.m[i][j] = query->r.m[j][i];
    pir_vec3 x = group->of_q ? placement->x : pir_mat_apply(&back, placement->x);
    double least[2];
    query->scan->slacks(count, group->of_q ? &query->r : &back, from, x,
                        pir_lanes_from(query->facet_normal, group->facets), query->facet_offset + group->facets,
                        query->work[1], query->work[2].x, least);
    *ret_along = least[1];
    return least[0];
}

/* What crosses edge `i` of the list: its slacks by doubles, and those pieces tried that may be the least. */
static void sieve_crossings(pir_query *query, uint32_t i, uint32_t at, struct search *search) {
    const pir_polytope *q = query->q;
    const pir_pairing *pairing = pir_sum_pairing(query->sum);
    pir_vec3 e = pir_mat_apply(&query->r, pir_lane_get(query->edge_direction, i));
    pir_vec3 o = pir_vec_sub(pir_mat_apply(&query->r, pir_lane_get(query->edge_origin, i)), search->placement->x);
    const double off = 2 * search->placement->error;
    for (; at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at)) {
        uint32_t h = pir_crossing_half(pairing, at);
        pir_vec3 n = pir_vec_cross(q->direction[h], e);
        double err = 1 / sqrt(pir_vec_dot(n, n)), s = pir_vec_dot(n, pir_vec_add(o, query->vq[q->origin[h]])) * err;
        double low = s - off * err;
        // a normal that is nothing but rounding is not above the limit either
        if (low > search->limit)
            search->low = lesser(search->low, low);
        else
            try_piece(query, (pir_piece){PIR_FACET_EE, query->edge_list[i], h}, search);
    }
}

/* The edges of a group of P's whose arcs may hold the least slack. */
static void sieve_edges(pir_query *query, const pir_group *group, struct search *search) {
    const pir_lanes normal = pir_lanes_from(query->facet_normal, group->facets), to = query->work[1];
    const double *s = query->work[2].x, *offset = query->facet_offset + group->facets,
                 off = 2 * search->placement->error;
    const pir_pairing *pairing = pir_sum_pairing(query->sum);
    // P flat has arcs of half a turn, which nothing bounds
    bool bounds = query->p->dimension == 3;
    for (uint32_t i = group->edges; i < group->edges_end; i++) {
        uint32_t at = pir_crossing_first(pairing, query->edge_list[i]), a = query->edge_left[i],
                 b = query->edge_right[i];
        if (at == PIR_NO_CROSSING)
            continue;
        double of_a = offset[b] + pir_vec_dot(pir_lane_get(normal, b), pir_lane_get(to, a));
        double of_b = offset[a] + pir_vec_dot(pir_lane_get(normal, a), pir_lane_get(to, b));
        double first = lesser(s[a], of_a), second = lesser(s[b], of_b);
        double bound = (first > second ? first : second) - off;
        if (bounds && bound > 0 && bound > search->limit)
            search->low = lesser(search->low, bound);
        else
            sieve_crossings(query, i, at, search);
    }
}

double pir_group_sieve(pir_query *query, uint32_t g, const pir_placement *placement, double limit) {
    pir_group *group = &query->groups[g];
    const double off = 2 * placement->error;
    double along, least = facet_slacks(query, group, placement, &along);
    struct search search = {placement, lesser(limit, least + off), least - off};
    group->sieved = query->stamp;
    for (uint32_t i = group->facets; least - off <= search.limit && i < group->own_end; i++)
        if (query->work[2].x[i - group->facets] - off <= search.limit) {
            uint32_t f = query->facet_list[i];
            try_piece(query, group->of_q ? (pir_piece){PIR_FACET_VF, 0, f} : (pir_piece){PIR_FACET_FV, f, 0}, &search);
        }
    sieve_edges(query, group, &search);
    pir_bound_keep(query, g, placement, search.low, along);
    return search.limit;
}
