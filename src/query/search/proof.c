/* SPDX-License-Identifier: MIT */
/*
 * That the bodies are apart, proven by a facet of D: one that certainly separates.
 *
 * The slopes of D beside a vertex are known from the pairing, so this proves what a climb, which rounds, does not.
 * The facet that did it last time comes first, then all around the vertices of the simplex: where the nearest point
 * is, one of those does.
 */
#include "query/search/proof.h"

/* Whether a piece certainly separates; then it is kept. */
static bool try_piece(const pir_groups *groups, const pir_placement *placement, pir_piece piece,
                      pir_query_cache *cache) {
    pir_plane plane;
    if (!pir_plane_of(groups->exact, piece, &plane) || !pir_plane_separates(&plane, placement))
        return false;
    pir_piece_keep(cache, piece);
    return true;
}

/* The pieces that have vertex (a, b) of D for a corner. */
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
