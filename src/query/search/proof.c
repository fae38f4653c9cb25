/* SPDX-License-Identifier: MIT */
/*
 * That the bodies are apart, proven by a facet of D: one that certainly separates.
 *
 * The slopes of D beside a vertex are known from the pairing, so this proves what a climb, which rounds, does not. The facet that did it last time
 * comes first, then all around the vertices of the simplex: where the nearest point is, one of those does.
 */
#include "query/query.h"

/* Whether a piece certainly separates; then it is kept, and its plane is in the spare slot. */
static bool try_piece(pir_query *query, const pir_placement *placement, pir_piece piece, pir_query_cache *cache) {
    uint32_t slot = query->planes.capacity - 1;
    if (!pir_plane_make(query, piece, slot) ||
        !(pir_plane_slack(&query->planes, slot, placement->x) < -placement->error * query->planes.err[slot]))
        return false;
    pir_piece_keep(cache, piece);
    return true;
}

/* The pieces that have vertex (a, b) of D for a corner. */
static bool try_around(pir_query *query, const pir_placement *placement, uint32_t a, uint32_t b,
                       pir_query_cache *cache) {
    const pir_polytope *p = query->p, *q = query->q;
    const pir_pairing *pairing = pir_sum_pairing(query->sum);
    for (uint32_t h = p->ring_start[a]; h < p->ring_start[a + 1]; h++)
        if (pairing->fv[p->left[h]] == b &&
            try_piece(query, placement, (pir_piece){PIR_FACET_FV, p->left[h], 0}, cache))
            return true;
    for (uint32_t h = q->ring_start[b]; h < q->ring_start[b + 1]; h++)
        if (pairing->vf[q->left[h]] == a &&
            try_piece(query, placement, (pir_piece){PIR_FACET_VF, 0, q->left[h]}, cache))
            return true;
    for (uint32_t h = p->ring_start[a]; h < p->ring_start[a + 1]; h++)
        for (uint32_t at = pir_crossing_first(pairing, p->edge[h]); at != PIR_NO_CROSSING;
             at = pir_crossing_next(pairing, at)) {
            uint32_t half = pir_crossing_half(pairing, at);
            if ((q->origin[half] == b || q->target[half] == b) &&
                try_piece(query, placement, (pir_piece){PIR_FACET_EE, p->edge[h], half}, cache))
                return true;
        }
    return false;
}

bool pir_prove_outside(pir_query *query, const pir_placement *placement, const pir_simplex *simplex,
                       pir_query_cache *cache) {
    uint32_t slot;
    if (pir_piece_recall(query, cache, &slot) &&
        pir_plane_slack(&query->planes, slot, placement->x) < -placement->error * query->planes.err[slot])
        return true;
    for (uint32_t i = 0; i < simplex->count; i++)
        if (try_around(query, placement, simplex->a[i], simplex->b[i], cache))
            return true;
    return false;
}
