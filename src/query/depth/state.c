/* SPDX-License-Identifier: MIT */
/*
 * The exact state: inside, on the boundary, or outside.
 *
 * The facet that decided last time comes first, then the groups that may hold a slack of zero or less. What doubles
 * leave open is decided by integers.
 */
#include "query/depth/depth.h"

#include "query/decide/flat.h"
#include "query/decide/placed.h"

/* The piece of least slack in a group that has one of certainly negative slack. */
static pir_piece separating(const pir_groups *groups, const pir_group *group, const pir_placement *placement) {
    uint32_t best = group->start;
    double least = HUGE_VAL;
    for (uint32_t i = group->start; i < group->start + group->count; i++) {
        double s = pir_planes_slack(groups->planes, i, placement->x) + placement->error * groups->planes->err[i];
        if (s < least) {
            least = s;
            best = i;
        }
    }
    return groups->planes->piece[best];
}

/* Keeps the true facet of a piece that t lies on, where it is the first in order. */
static void offer_touching(pir_exact *exact, pir_piece piece, pir_least *touching) {
    pir_facet facet;
    if (!pir_facet_of(exact, piece, &facet))
        return;
    if (!touching->found || pir_facet_before(&facet, &touching->facet))
        touching->facet = facet;
    touching->found = true;
}

/* Decides what doubles leave open, by the exact signs of slacks near zero. */
static pir_state settle(pir_search *search, const pir_placement *placement, pir_piece *ret_separating,
                        pir_least *ret_touching) {
    const pir_groups *groups = &search->groups;
    const pir_frame *frame = groups->frame;
    const pir_planes *planes = groups->planes;
    bool touches = false, any = false;
    ret_touching->found = false;
    for (uint32_t g = 0; g < groups->count; g++) {
        const pir_group *group = &groups->at[g];
        any |= search->slack[g] == HUGE_VAL || group->count > 0;
        if (search->slack[g] > 0)
            continue;
        for (uint32_t i = group->start; i < group->start + group->count; i++) {
            if (pir_planes_slack(planes, i, placement->x) > placement->error * planes->err[i])
                continue;
            int sign = pir_side_exact(groups->exact, planes->piece[i], placement->translation);
            if (sign < 0) {
                *ret_separating = planes->piece[i];
                return PIR_OUTSIDE;
            }
            if (sign == 0) {
                touches = true;
                offer_touching(groups->exact, planes->piece[i], ret_touching);
            }
        }
    }
    if (any && !touches)
        return PIR_INSIDE;
    bool flat = frame->p.polytope->dimension < 3 && frame->q.polytope->dimension < 3;
    ret_separating->kind = PIR_NO_PIECE;
    return flat && !pir_flat_holds(groups->exact, placement->translation) ? PIR_OUTSIDE : PIR_BOUNDARY;
}

pir_state pir_state_find(pir_search *search, const pir_placement *placement, const pir_query_cache *cache,
                         pir_piece *ret_separating, pir_least *ret_touching, uint32_t *steps) {
    pir_groups *groups = &search->groups;
    pir_plane last;
    if (pir_piece_recall(groups, cache, &last)) {
        ++*steps;
        if (pir_plane_separates(&last, placement)) {
            *ret_separating = last.piece;
            return PIR_OUTSIDE;
        }
    }
    pir_bounds_find(&search->bounds, groups, placement, 0);
    bool open = groups->count == 0;
    for (uint32_t g = 0; g < groups->count; g++) {
        search->slack[g] = HUGE_VAL;
        if (search->bounds.low[g] > 0)
            continue;
        double high;
        pir_bounds_look(&search->bounds, groups, g, placement, &search->slack[g], &high);
        ++*steps;
        if (high < 0) {
            *ret_separating = separating(groups, &groups->at[g], placement);
            return PIR_OUTSIDE;
        }
        open |= search->slack[g] <= 0 || groups->at[g].count == 0;
    }
    return open ? settle(search, placement, ret_separating, ret_touching) : PIR_INSIDE;
}

/* --- a facet that separates --- */

/*
 * A proof that the bodies are apart: a facet of D that certainly separates them.
 *
 * The pairing knows the facets of D at a vertex exactly, so this proves what a climb with its rounding does not. The
 * facet that separated last time comes first, then all facets around the vertices of the simplex. Where those hold
 * the nearest point, one of the facets separates.
 */
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
