/* SPDX-License-Identifier: MIT */
/*
 * Queries on a sum with a region: D is taken to be the intersection of the half-spaces of those of its facets whose normals are in the
 * cone. That holds D, so whoever is outside is outside of D, and the depth is the least among those facets; whether a translation inside is
 * inside of D the facets that are left out would have to say.
 *
 * The sum keeps a superset that depends on how it came here. So every piece is asked whether it is in the cone, and the answer depends on the
 * placement and the region alone. What is kept is little: all of it is looked at, without groups and their bounds. A piece that may hold the
 * least slack by its doubles is made a plane, in the slots that groups have theirs in; those are forgotten.
 */
#include "query/query.h"

struct search {
    pir_query *query;
    const pir_placement *placement;
    const pir_cone *cone;
    double tie, limit; /* the least slack is not above limit */
    pir_vec3 along;    /* of the way out, or zero: then `limit` is of slacks, else of how far along it */
    uint32_t count;    /* planes, from slot 0 */
};

/* A rate of leaving this small, of two unit vectors, is along. */
#define ALONG 0x1p-46

static bool goes_along(const struct search *search) {
    return search->along.x != 0 || search->along.y != 0 || search->along.z != 0;
}

/* How far out of the half-space of slot `slot` it is: the slack, or that along the way; HUGE_VAL where the way does not lead out. */
static double way_out(const struct search *search, uint32_t slot) {
    const pir_planes *planes = &search->query->planes;
    double slack = pir_plane_slack(planes, slot, search->placement->x);
    if (!goes_along(search))
        return slack;
    double rate = pir_vec_dot(pir_plane_normal(planes, slot), search->along);
    return rate > ALONG * planes->err[slot] ? slack / rate : HUGE_VAL;
}

/* Makes a piece a plane and keeps it where it is in the cone and may be the one that is looked for. */
static void take(struct search *search, pir_piece piece) {
    pir_query *query = search->query;
    pir_planes *planes = &query->planes;
    uint32_t slot = search->count;
    if (!pir_plane_make(query, piece, slot) || !pir_plane_refine(query, slot) ||
        !pir_cone_has(search->cone, pir_plane_normal(planes, slot)))
        return;
    double out = way_out(search, slot), error = goes_along(search) ? 0 : search->placement->error * planes->err[slot];
    if (out - error > search->limit + search->tie)
        return;
    search->limit = fmin(search->limit, out + error);
    search->count++;
}

/*
 * Whether a piece may be looked for, its slack, worked out another way than a plane's, being out / √square within error / √square. Most are
 * told without the root.
 */
static inline bool may_win(const struct search *search, double out, double square) {
    double most = search->limit + search->tie, hair = 4 * search->placement->error;
    return goes_along(search) || !(out > hair) || (out - hair) * (out - hair) <= most * most * square;
}

static void take_facets(struct search *search) {
    const pir_query *query = search->query;
    const pir_sum *sum = query->sum;
    const pir_members *of_p = &sum->region.p.members, *of_q = &sum->region.q.members;
    const pir_cone *cone = search->cone;
    pir_vec3 x = search->placement->x;
    for (uint32_t i = 0; i < of_p->count; i++) {
        uint32_t f = of_p->at[i];
        pir_vec3 n = pir_mat_apply(&query->r, query->p->normal[f]);
        if (may_win(search, query->hp[f] + pir_vec_dot(n, pir_vec_sub(query->vq[sum->fv[f]], x)), 1) &&
            pir_vec_dot(n, cone->axis) >= cone->cosine)
            take(search, (pir_piece){PIR_FACET_FV, f, 0});
    }
    pir_vec3 back = pir_mat_apply_transposed(&query->r, x);
    for (uint32_t i = 0; i < of_q->count; i++) {
        uint32_t g = of_q->at[i];
        pir_vec3 n = query->q->normal[g], from = pir_mat_apply(&query->r, pir_vec_sub(query->vp[sum->vf[g]], back));
        if (may_win(search, query->hq[g] + pir_vec_dot(n, from), 1) && pir_vec_dot(n, cone->axis) >= cone->cosine)
            take(search, (pir_piece){PIR_FACET_VF, 0, g});
    }
}

static void take_crossings(struct search *search) {
    const pir_query *query = search->query;
    const pir_sum *sum = query->sum;
    const pir_polytope *p = query->p, *q = query->q;
    for (uint32_t i = 0; i < sum->region.edges.count; i++) {
        uint32_t edge = sum->region.edges.at[i], half = p->edge_half[edge];
        if (sum->first[edge] == PIR_NO_CROSSING)
            continue;
        pir_vec3 e = pir_mat_apply(&query->r, p->direction[half]);
        pir_vec3 from = pir_vec_sub(pir_mat_apply(&query->r, query->vp[p->origin[half]]), search->placement->x);
        for (uint32_t at = sum->first[edge]; at != PIR_NO_CROSSING; at = sum->crossings.next[at]) {
            uint32_t h = sum->crossings.half[at];
            pir_vec3 n = pir_vec_cross(q->direction[h], e);
            double square = pir_vec_dot(n, n), out = pir_vec_dot(n, pir_vec_add(from, query->vq[q->origin[h]]));
            // small angles are told by their exact normals
            if (square >= PIR_SIN_EXACT * PIR_SIN_EXACT &&
                (!may_win(search, out, square) ||
                 (square >= PIR_SIN_REFINED * PIR_SIN_REFINED && !pir_cone_has(search->cone, n))))
                continue;
            take(search, (pir_piece){PIR_FACET_EE, edge, h});
        }
    }
}

/* Whether a piece is one that the sum keeps. */
static bool is_kept(const pir_query *query, pir_piece piece) {
    const pir_sum *sum = query->sum;
    switch (piece.kind) {
    case PIR_FACET_FV:
        return piece.first < query->p->facet_count && sum->fv[piece.first] != PIR_NO_PAIR;
    case PIR_FACET_VF:
        return piece.second < query->q->facet_count && sum->vf[piece.second] != PIR_NO_PAIR;
    case PIR_FACET_EE:
        if (piece.first >= query->p->edge_count)
            return false;
        for (uint32_t at = sum->first[piece.first]; at != PIR_NO_CROSSING; at = sum->crossings.next[at])
            if (sum->crossings.half[at] == piece.second)
                return true;
        return false;
    default:
        return false;
    }
}

/* Looks at all that is kept, first at the piece that won last time. */
static struct search search_all(pir_query *query, const pir_placement *placement, pir_vec3 along,
                                const pir_query_cache *cache) {
    struct search search = {.query = query,
                            .placement = placement,
                            .cone = &query->sum->region.cone,
                            .tie = PIR_TIE * (query->size_p + query->size_q),
                            .limit = HUGE_VAL,
                            .along = along};
    query->stamp++;
    query->planes.used = 0;
    if (cache && cache->pieces == 1) {
        pir_piece last = {cache->kind, cache->first, cache->second};
        if (is_kept(query, last))
            take(&search, last);
        // the limit stays, and the piece comes again
        search.count = 0;
    }
    take_facets(&search);
    take_crossings(&search);
    return search;
}

/* The first piece in order of those whose way out is the least but for a tie, or PIR_NO_PLANE. */
static uint32_t first_of_least(const struct search *search) {
    uint32_t best = PIR_NO_PLANE;
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < search->count; i++)
        least = fmin(least, way_out(search, i));
    for (uint32_t i = 0; i < search->count && least < HUGE_VAL; i++)
        if (way_out(search, i) <= least + search->tie &&
            (best == PIR_NO_PLANE ||
             pir_piece_before(search->query->planes.piece[i], search->query->planes.piece[best])))
            best = i;
    return best;
}

pir_state pir_region_find(pir_query *query, const pir_placement *placement, const pir_query_cache *cache,
                          uint32_t *ret_slot, double *ret_slack, uint32_t *steps) {
    const pir_planes *planes = &query->planes;
    struct search search = search_all(query, placement, (pir_vec3){0, 0, 0}, cache);
    ++*steps;
    *ret_slot = first_of_least(&search);
    if (*ret_slot == PIR_NO_PLANE)
        return PIR_INSIDE;
    *ret_slack = pir_plane_slack(planes, *ret_slot, placement->x);
    // doubles are certain, or the pieces that they leave open are all there, for none of them is above the limit
    pir_state state = PIR_INSIDE;
    for (uint32_t i = 0; i < search.count; i++) {
        double slack = pir_plane_slack(planes, i, placement->x), error = placement->error * planes->err[i];
        if (slack > error)
            continue;
        int sign = slack < -error ? -1 : pir_side_exact(query, planes->piece[i], placement->translation);
        if (sign < 0) {
            *ret_slot = i;
            return PIR_OUTSIDE;
        }
        if (sign == 0 && state == PIR_INSIDE) {
            state = PIR_BOUNDARY;
            *ret_slot = i;
        }
    }
    return state;
}

uint32_t pir_region_exit(pir_query *query, const pir_placement *placement, pir_vec3 along, double *ret_at,
                         uint32_t *steps) {
    struct search search = search_all(query, placement, along, NULL);
    ++*steps;
    uint32_t slot = first_of_least(&search);
    if (slot != PIR_NO_PLANE)
        *ret_at = fmax(way_out(&search, slot), 0);
    return slot;
}
