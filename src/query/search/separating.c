/* SPDX-License-Identifier: MIT */
/*
 * A proof that the bodies are apart: a facet of D that certainly separates them.
 *
 * The pairing knows the facets of D at a vertex exactly, so this proves what a climb with its rounding does not. The
 * facet that separated last time comes first, then all facets around the vertices of the simplex. Where those hold
 * the nearest point, one of the facets separates.
 */
#include "query/search/separating.h"

/* Whether a piece certainly separates. Then the cache keeps it. */
static bool try_piece(const pir_groups *groups, const pir_placement *placement, pir_piece piece,
                      pir_query_cache *cache) {
    pir_plane plane;
    if (!pir_plane_of(groups->exact, piece, &plane) || !pir_plane_separates(&plane, placement))
        return false;
    pir_piece_keep(cache, piece);
    return true;
}

/* Tries the pieces that have vertex (a, b) of D as a corner. */
static bool try_around(const pir_groups *groups, const pir_placement *placement, uint32_t a, uint32_t b,
                       pir_query_cache *cache) {
    const pir_polytope *p = groups->frame->p.polytope, *q = groups->frame->q.polytope;
    const pir_pairing *pairing = groups->pairing;
    for (uint32_t h = p->ring_start[a]; h < p->ring_start[a + 1]; h++)
        if (pairing->fv[p->left[h]] == b && try_piece(groups, placement, pir_piece_fv(groups, p->left[h]), cache))
            return true;
    for (uint32_t h = q->ring_start[b]; h < q->ring_start[b + 1]; h++)
        if (pairing->vf[q->left[h]] == a && try_piece(groups, placement, pir_piece_vf(groups, q->left[h]), cache))
            return true;
    for (uint32_t h = p->ring_start[a]; h < p->ring_start[a + 1]; h++)
        for (uint32_t at = pir_crossing_first(pairing, p->edge[h]); at != PIR_NO_CROSSING;
             at = pir_crossing_next(pairing, at)) {
            uint32_t half = pir_crossing_half(pairing, at);
            if ((q->origin[half] == b || q->target[half] == b) &&
                try_piece(groups, placement, (pir_piece){PIR_FACET_EE, p->edge[h], half}, cache))
                return true;
        }
    return false;
}

bool pir_prove_outside(const pir_groups *groups, const pir_placement *placement, const pir_simplex *simplex,
                       pir_query_cache *cache) {
    pir_plane last;
    if (pir_piece_recall(groups, cache, &last) && pir_plane_separates(&last, placement))
        return true;
    for (uint32_t i = 0; i < simplex->count; i++)
        if (try_around(groups, placement, simplex->a[i], simplex->b[i], cache))
            return true;
    return false;
}
