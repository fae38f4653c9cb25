/* SPDX-License-Identifier: MIT */
/*
 * Queries on one placement: overlap, separation, penetration. All of them share the exact state. The searches are in
 * query/search, the decisions in query/decide.
 */
#include "query/answer/follow.h"
#include "query/answer/result.h"
#include "query/decide/flat.h"
#include "query/decide/witness.h"
#include "query/last/facet_simplex.h"
#include "query/last/follow_foot.h"
#include "query/last/foot.h"
#include "query/search/closest.h"
#include "query/search/depth.h"
#include "query/search/separating.h"
#include "query/search/state.h"

pir_query_input pir_query_input_default(void) {
    return (pir_query_input){{0, 0, 0}, 0, 0, HUGE_VAL, 0};
}

/* --- what a cache keeps --- */

static void recall_simplex(const pir_query *query, const pir_query_cache *cache, pir_simplex *simplex) {
    simplex->count = 0;
    for (uint32_t i = 0; i < 4; i++)
        simplex->a[i] = simplex->b[i] = 0;
    if (!cache || cache->points == 0 || cache->points > 3)
        return;
    for (uint32_t i = 0; i < cache->points; i++) {
        if (cache->p[i] >= query->p->vertex_count || cache->q[i] >= query->q->vertex_count)
            return;
        simplex->a[i] = cache->p[i];
        simplex->b[i] = cache->q[i];
    }
    simplex->count = cache->points;
}

/* The result of a nearest point, no farther than the limit. */
static void put_separation(const pir_frame *frame, const pir_nearest *nearest, double limit, pir_query_result *result) {
    pir_result_separation(frame, nearest, result);
    if (result->distance > pir_frame_length(frame, limit))
        pir_result_beyond(result);
}

/* Keeps a simplex in a cache: three vertices, 0 past the count. */
static void keep_simplex(pir_query_cache *cache, const pir_simplex *simplex) {
    if (!cache)
        return;
    cache->points = simplex->count;
    for (uint32_t i = 0; i < 3; i++) {
        cache->p[i] = simplex->a[i];
        cache->q[i] = simplex->b[i];
    }
}

/* --- by the facet of the last answer --- */

/* Whether the last answer was by a facet: inside, or from a simplex of three vertices. */
static bool was_by_facet(const pir_query_cache *cache) {
    return cache && cache->pieces == 1 && (cache->points == 0 || cache->points == 3);
}

/* The facet of a piece, or the one that the foot of x has gone to from there, where doubles prove it. */
static bool prove_near(const pir_frame *frame, const pir_placement *placement, pir_piece piece, pir_same_facet *same) {
    pir_same is = pir_same_facet_prove(frame, placement, piece, same);
    return pir_follow_foot(frame, placement, is, same) == PIR_SAME_PROVEN;
}

/* The answer of the facet of the last one, or near that, where doubles prove it. False where they do not. */
static bool by_last_facet(pir_query *query, const pir_placement *placement, double limit, int want,
                          pir_query_cache *cache, pir_query_result *result) {
    const pir_frame *frame = &query->frame;
    pir_piece piece;
    pir_same_facet same;
    if (!was_by_facet(cache) || !pir_piece_cached(&query->search.groups, cache, &piece) ||
        !prove_near(frame, placement, piece, &same))
        return false;
    if (same.slack > 0 && !pir_foot_settles_within(frame, placement, &same.facet, same.slack, same.margin))
        return false;
    pir_simplex simplex = {.count = 0};
    ++result->steps;
    if (same.slack > 0) {
        pir_result_set_state(result, PIR_INSIDE);
        if (want & PIR_WANT_DEPTH)
            pir_result_depth_at(frame, same.facet.n, same.slack, &same.touch, result);
    } else {
        pir_result_set_state(result, PIR_OUTSIDE);
        if (want & PIR_WANT_SEPARATION)
            put_separation(frame, &(pir_nearest){-same.slack, same.facet.n, same.touch}, limit, result);
        pir_facet_simplex(frame, same.facet.piece, &simplex);
    }
    keep_simplex(cache, &simplex);
    pir_piece_keep(cache, same.facet.piece);
    return true;
}

/* --- separation --- */

/*
 * The separation, or only the state where there is none. Returns the state; on the boundary *ret_touching is as
 * pir_state_find sets it. `limit` is the cutoff in the frame.
 */
static pir_state separation(pir_query *query, const pir_placement *placement, double limit, pir_query_cache *cache,
                            pir_least *ret_touching, pir_query_result *result) {
    pir_simplex simplex;
    pir_nearest nearest;
    recall_simplex(query, cache, &simplex);
    pir_descend_to_point(&query->frame, placement, limit + PIR_DISTANCE_ERROR * placement->reach, &simplex,
                         &result->steps);
    bool far = simplex.lower > PIR_CLEARLY_APART * placement->reach && simplex.lower > 4 * placement->error;
    bool beyond = simplex.lower > limit + PIR_DISTANCE_ERROR * placement->reach;
    bool proven = far && !beyond && pir_closest_prove(&query->search.groups, placement, &simplex, &nearest);
    if (!proven && !(far && pir_prove_outside(&query->search.groups, placement, &simplex, cache))) {
        pir_piece separating;
        pir_state state = pir_state_find(&query->search, placement, cache, &separating, ret_touching, &result->steps);
        if (state != PIR_OUTSIDE)
            return state;
        pir_piece_keep(cache, separating);
    }
    keep_simplex(cache, &simplex);
    if (beyond) {
        pir_result_beyond(result);
        return PIR_OUTSIDE;
    }
    if (!proven && !pir_closest_find(&query->search.groups, placement, &simplex, &nearest, &result->steps)) {
        pir_result_unfinished(&query->frame, &simplex, result);
        return PIR_OUTSIDE;
    }
    put_separation(&query->frame, &nearest, limit, result);
    pir_piece facet;
    if (cache && pir_closest_piece(&query->search.groups, nearest.touch.witness, &facet))
        pir_piece_keep(cache, facet);
    return PIR_OUTSIDE;
}

/* The state alone. Certain answers that cost little come before the search. */
static pir_state overlap(pir_query *query, const pir_placement *placement, pir_query_cache *cache,
                         pir_least *ret_touching, uint32_t *steps) {
    pir_plane last;
    if (pir_piece_recall(&query->search.groups, cache, &last) && pir_plane_separates(&last, placement))
        return PIR_OUTSIDE;
    bool inside = query->search.groups.count > 0;
    pir_bounds_find(&query->search.bounds, &query->search.groups, placement, 0);
    for (uint32_t g = 0; g < query->search.groups.count && inside; g++)
        inside = query->search.bounds.low[g] > 0;
    if (inside)
        return PIR_INSIDE;
    pir_simplex simplex;
    recall_simplex(query, cache, &simplex);
    pir_descend_to_point(&query->frame, placement, PIR_CLEARLY_APART * placement->reach, &simplex, steps);
    if (simplex.lower > PIR_CLEARLY_APART * placement->reach &&
        pir_prove_outside(&query->search.groups, placement, &simplex, cache)) {
        keep_simplex(cache, &simplex);
        return PIR_OUTSIDE;
    }
    pir_piece separating;
    pir_state state = pir_state_find(&query->search, placement, cache, &separating, ret_touching, steps);
    if (state == PIR_OUTSIDE)
        pir_piece_keep(cache, separating);
    return state;
}

/*
 * The state and, inside, the facet of least slack, which most often tells the state as well. On the boundary
 * *ret_least is the first facet that touches.
 */
static pir_state depth_and_state(pir_query *query, const pir_placement *placement, pir_query_cache *cache,
                                 pir_least *ret_least, uint32_t *steps) {
    pir_plane last;
    if (pir_piece_recall(&query->search.groups, cache, &last) && pir_plane_separates(&last, placement))
        return PIR_OUTSIDE;
    ret_least->some = pir_depth_find(&query->search, placement, cache, &ret_least->facet, steps);
    if (ret_least->some) {
        const pir_facet *facet = &ret_least->facet;
        double slack = facet->h - pir_vec_dot(facet->n, placement->x), error = placement->error * facet->err;
        if (slack > error)
            return PIR_INSIDE;
        if (slack < -error) {
            pir_piece_keep(cache, facet->piece);
            return PIR_OUTSIDE;
        }
    }
    pir_least touching;
    pir_piece separating;
    pir_state state = pir_state_find(&query->search, placement, cache, &separating, &touching, steps);
    if (state == PIR_BOUNDARY)
        *ret_least = touching;
    else if (state == PIR_OUTSIDE)
        pir_piece_keep(cache, separating);
    return state;
}

/* The answers of result.c, and the cache after them. */
static void answer_touching(pir_query *query, const pir_placement *placement, const pir_least *touching,
                            pir_query_cache *cache, pir_query_result *result) {
    pir_result_touching(&query->exact, placement, touching, result);
    if (touching->some)
        pir_piece_keep(cache, touching->facet.piece);
}

static void answer_depth(pir_query *query, const pir_placement *placement, const pir_facet *facet,
                         pir_query_cache *cache, pir_query_result *result) {
    pir_result_depth(&query->exact, placement, facet, result);
    pir_piece_keep(cache, facet->piece);
    if (cache)
        cache->points = 0;
}

/* Answers from the facets in the sum's region. */
static void answer_in_region(pir_query *query, const pir_placement *placement, pir_query_cache *cache,
                             pir_query_result *result) {
    pir_least least;
    pir_result_set_state(
        result, pir_regional_find(&query->regional, &query->search.groups, placement, cache, &least, &result->steps));
    if (!least.some) {
        result->outcome = PIR_NO_HIT;
        return;
    }
    if (result->state == PIR_OUTSIDE) {
        pir_piece_keep(cache, least.facet.piece);
    } else {
        answer_depth(query, placement, &least.facet, cache, result);
        result->outcome = PIR_NOT_SEPARATED;
    }
}

/* --- the calls --- */

void pir_query_answer(pir_query *query, const pir_placement *placement, const pir_query_input *input, int want,
                      pir_query_cache *cache, pir_query_result *result) {
    pir_result_clear(result);
    double radii = input->radius_p + input->radius_q,
           limit = pir_frame_from(&query->frame, fmax(input->cutoff, 0) + radii);
    // rounded bodies overlap where the polytopes are apart
    if (radii > 0)
        want |= PIR_WANT_SEPARATION | PIR_WANT_DEPTH;
    if (by_last_facet(query, placement, limit, want, cache, result)) {
        pir_result_add_radii(input, result);
        return;
    }
    bool depth_first = (want & PIR_WANT_DEPTH) &&
                       (!(want & PIR_WANT_SEPARATION) || (cache && cache->points == 0 && cache->pieces == 1));
    pir_least least = {.some = false};
    pir_state state = depth_first ? depth_and_state(query, placement, cache, &least, &result->steps)
                                  : separation(query, placement, limit, cache, &least, result);
    if (depth_first && state == PIR_OUTSIDE && (want & PIR_WANT_SEPARATION))
        separation(query, placement, limit, cache, &least, result);
    if (state != PIR_OUTSIDE || !(want & PIR_WANT_SEPARATION))
        pir_result_set_state(result, state);
    if (state == PIR_BOUNDARY) {
        answer_touching(query, placement, &least, cache, result);
    } else if (state == PIR_INSIDE && (want & PIR_WANT_DEPTH)) {
        if (!depth_first)
            least.some = pir_depth_find(&query->search, placement, cache, &least.facet, &result->steps);
        answer_depth(query, placement, &least.facet, cache, result);
    }
    pir_result_add_radii(input, result);
}

static pir_status answer(pir_query *query, const pir_query_input *input, int want, pir_query_cache *cache,
                         pir_query_result *ret_result) {
    pir_placement placement;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_place(query, input, &placement);
    if (status != PIR_OK)
        return status;
    // separation and rounded bodies need the whole sum
    bool in_region = pir_sum_cone(query->sum)->set;
    if (in_region && (want != PIR_WANT_DEPTH || input->radius_p + input->radius_q > 0))
        return PIR_ERR_UNSUPPORTED;
    if (in_region && (status = pir_query_need_regional(query)) != PIR_OK)
        return status;
    // nothing fails from here on
    if (in_region) {
        pir_result_clear(ret_result);
        answer_in_region(query, &placement, cache, ret_result);
    } else {
        pir_query_answer(query, &placement, input, want, cache, ret_result);
    }
    return PIR_OK;
}

pir_status pir_query_overlap(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                             pir_query_result *ret_result) {
    pir_placement placement;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_begin(query, input, &placement);
    if (status != PIR_OK)
        return status;
    if (input->radius_p + input->radius_q > 0) {
        pir_query_input near = *input;
        near.cutoff = 0;
        status = answer(query, &near, PIR_WANT_SEPARATION, cache, ret_result);
        if (status == PIR_OK)
            pir_result_keep_state(ret_result);
        return status;
    }
    pir_query_result result = {0};
    pir_least touching = {.some = false};
    pir_result_set_state(&result, overlap(query, &placement, cache, &touching, &result.steps));
    if (result.state == PIR_BOUNDARY)
        answer_touching(query, &placement, &touching, cache, &result);
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_query_distance(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                              pir_query_result *ret_result) {
    pir_status status = answer(query, input, PIR_WANT_SEPARATION, cache, ret_result);
    if (status == PIR_OK && ret_result->outcome == PIR_OVERLAPPING)
        ret_result->distance = 0;
    return status;
}

pir_status pir_query_penetration(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                 pir_query_result *ret_result) {
    pir_status status = answer(query, input, PIR_WANT_DEPTH, cache, ret_result);
    if (status == PIR_OK && ret_result->state == PIR_OUTSIDE)
        ret_result->distance = 0;
    return status;
}

pir_status pir_query_signed_distance(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                     pir_query_result *ret_result) {
    return answer(query, input, PIR_WANT_SEPARATION | PIR_WANT_DEPTH, cache, ret_result);
}
