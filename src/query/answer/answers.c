/* SPDX-License-Identifier: MIT */
/*
 * Queries on one placement: overlap, separation, penetration. All of them share the exact state. The searches are in
 * query/search, the decisions in query/decide.
 */
#include "query/answer/follow.h"
#include "query/decide/flat.h"
#include "query/decide/witness.h"
#include "query/search/closest.h"
#include "query/search/depth.h"
#include "query/search/proof.h"
#include "query/search/state.h"

/*
 * Distances above this, relative to the placement's reach, are tried for a quick proof in doubles, which know them to
 * 2^-44. Nearer bodies go to the exact search at once.
 */
#define CLEARLY_APART 0x1p-40

pir_query_input pir_query_input_default(void) {
    return (pir_query_input){{0, 0, 0}, 0, 0, HUGE_VAL, 0};
}

/* --- answers --- */

static const pir_outcome outcome_of[] = {
    [PIR_OUTSIDE] = PIR_SEPARATED, [PIR_BOUNDARY] = PIR_TOUCHING, [PIR_INSIDE] = PIR_OVERLAPPING};

/* Clears member by member: what compilers make of clearing the whole struct takes a fifth of a query. */
static void clear(pir_query_result *result) {
    const pir_vec3 none = {0, 0, 0};
    result->state = PIR_OUTSIDE;
    result->outcome = PIR_SEPARATED;
    result->distance = 0;
    result->normal = result->point_p = result->point_q = none;
    result->witness.p = result->witness.q = (pir_feature){PIR_FEATURE_NONE, 0};
    result->steps = 0;
}

static void set_state(pir_query_result *result, pir_state state) {
    result->state = state;
    result->outcome = outcome_of[state];
}

/* Sets both points from Q's: point_p = point_q + distance · normal. */
static void set_points(pir_query_result *result, pir_vec3 point_q) {
    result->point_q = point_q;
    result->point_p = pir_vec_add(point_q, pir_vec_scale(result->normal, result->distance));
}

/* The face of a body that is a point or lies on a line: the whole body. */
static pir_feature whole_of(const pir_polytope *p) {
    return (pir_feature){p->edge_count > 0 ? PIR_FEATURE_EDGE : PIR_FEATURE_VERTEX, 0};
}

/* Answers where t lies on the boundary. `touching` is the first true facet that t is on. */
static void answer_touching(pir_query *query, const pir_placement *placement, const pir_least *touching,
                            pir_query_cache *cache, pir_query_result *result) {
    pir_touch touch = {{{0}, {0}}, {0, 0, 0}};
    result->distance = 0;
    if (touching->some) {
        result->normal = touching->facet.n;
        pir_touch_facet(&query->exact, placement, &touching->facet, 0, NULL, &touch);
        pir_piece_keep(cache, touching->facet.piece);
    } else {
        // D has no area, so that any direction across it is a normal
        pir_normal normal = {.unit = pir_flat_across(&query->frame), .err = 1};
        pir_meeting meeting = {.normal = &normal, .faces = {whole_of(query->p), whole_of(query->q)}};
        result->normal = normal.unit;
        pir_touch_find(&query->exact, placement, &meeting, &touch);
    }
    result->witness = touch.witness;
    set_points(result, pir_frame_world(&query->frame, touch.point_q));
}

/* --- separation --- */

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

/*
 * Sees to it that the points of two bodies that are apart differ. Bodies that are apart by less than coordinates can
 * tell get points one rounding apart along the normal.
 */
static void separate_points(pir_query_result *result) {
    pir_vec3 *p = &result->point_p, *q = &result->point_q, n = result->normal;
    if (p->x != q->x || p->y != q->y || p->z != q->z)
        return;
    double *most = fabs(n.x) >= fabs(n.y) && fabs(n.x) >= fabs(n.z) ? &p->x : fabs(n.y) >= fabs(n.z) ? &p->y : &p->z;
    double along = most == &p->x ? n.x : most == &p->y ? n.y : n.z;
    *most = nextafter(*most, along > 0 ? HUGE_VAL : -HUGE_VAL);
}

/* The error of a distance, relative to the placement's reach, whichever way it is found. */
#define DISTANCE_ERROR 0x1p-42

static void answer_separation(const pir_query *query, const pir_nearest *nearest, pir_query_result *result) {
    set_state(result, PIR_OUTSIDE);
    result->distance = pir_frame_length(&query->frame, nearest->distance);
    result->normal = nearest->normal;
    result->witness = nearest->touch.witness;
    set_points(result, pir_frame_world(&query->frame, nearest->touch.point_q));
    separate_points(result);
}

static void answer_beyond(pir_query_result *result) {
    uint32_t steps = result->steps;
    clear(result);
    result->steps = steps;
    result->outcome = PIR_BEYOND_CUTOFF;
}

/* Answers where the search for the nearest point has reached its bound on steps: with the best so far. */
static void answer_unfinished(const pir_query *query, const pir_simplex *simplex, pir_query_result *result) {
    set_state(result, PIR_OUTSIDE);
    result->outcome = PIR_STEP_LIMIT;
    result->distance = pir_frame_length(&query->frame, fmax(0, simplex->upper));
}

/*
 * Answers with the separation, where there is one, and returns the state. On the boundary *ret_touching is as
 * pir_state_find sets it. `limit` is the cutoff in the frame.
 */
static pir_state separation(pir_query *query, const pir_placement *placement, double limit, pir_query_cache *cache,
                            pir_least *ret_touching, pir_query_result *result) {
    pir_simplex simplex;
    pir_nearest nearest;
    recall_simplex(query, cache, &simplex);
    pir_descend_to_point(&query->frame, placement, limit + DISTANCE_ERROR * placement->reach, &simplex, &result->steps);
    bool far = simplex.lower > CLEARLY_APART * placement->reach && simplex.lower > 4 * placement->error;
    bool beyond = simplex.lower > limit + DISTANCE_ERROR * placement->reach;
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
        answer_beyond(result);
        return PIR_OUTSIDE;
    }
    if (!proven && !pir_closest_find(&query->search.groups, placement, &simplex, &nearest, &result->steps)) {
        answer_unfinished(query, &simplex, result);
        return PIR_OUTSIDE;
    }
    answer_separation(query, &nearest, result);
    if (result->distance > pir_frame_length(&query->frame, limit))
        answer_beyond(result);
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
    pir_descend_to_point(&query->frame, placement, CLEARLY_APART * placement->reach, &simplex, steps);
    if (simplex.lower > CLEARLY_APART * placement->reach &&
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

static void answer_depth(pir_query *query, const pir_placement *placement, const pir_facet *facet,
                         pir_query_cache *cache, pir_query_result *result) {
    // the state is exact: a slack that rounds below zero is nearly zero
    double slack = fmax(pir_facet_slack(&query->exact, placement, facet), 0);
    pir_touch touch;
    // in a region the foot may lie beside the facet
    if (!pir_touch_facet(&query->exact, placement, facet, slack, NULL, &touch))
        touch = (pir_touch){facet->faces, pir_facet_point(&query->frame, placement, facet, slack)};
    pir_piece_keep(cache, facet->piece);
    if (cache)
        cache->points = 0;
    result->normal = facet->n;
    result->distance = -pir_frame_length(&query->frame, slack);
    result->witness = touch.witness;
    set_points(result, pir_frame_world(&query->frame, touch.point_q));
}

/* Answers from the facets in the sum's region. */
static void answer_in_region(pir_query *query, const pir_placement *placement, pir_query_cache *cache,
                             pir_query_result *result) {
    pir_least least;
    set_state(result,
              pir_regional_find(&query->regional, &query->search.groups, placement, cache, &least, &result->steps));
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

/* --- radii --- */

/* Grows both bodies by their radii, in an answer with the signed distance. */
static void add_radii(const pir_query_input *input, pir_query_result *result) {
    double sum = input->radius_p + input->radius_q;
    if (result->outcome == PIR_BEYOND_CUTOFF)
        result->distance = fmax(input->cutoff, 0);
    if (sum == 0 || result->outcome == PIR_BEYOND_CUTOFF)
        return;
    result->distance -= sum;
    result->point_q = pir_vec_add(result->point_q, pir_vec_scale(result->normal, input->radius_q));
    result->point_p = pir_vec_add(result->point_q, pir_vec_scale(result->normal, result->distance));
    pir_outcome outcome = result->outcome;
    set_state(result, result->distance > 0 ? PIR_OUTSIDE : result->distance == 0 ? PIR_BOUNDARY : PIR_INSIDE);
    if (outcome == PIR_STEP_LIMIT)
        result->outcome = outcome;
}

/* --- the calls --- */

/* What a call asks for. */
enum { WANT_SEPARATION = 1, WANT_DEPTH = 2 };

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
    if (in_region && (want != WANT_DEPTH || input->radius_p + input->radius_q > 0))
        return PIR_ERR_UNSUPPORTED;
    // nothing fails from here on
    pir_query_result *const result = ret_result;
    clear(result);
    if (in_region) {
        answer_in_region(query, &placement, cache, result);
        return PIR_OK;
    }
    double radii = input->radius_p + input->radius_q,
           limit = pir_frame_from(&query->frame, fmax(input->cutoff, 0) + radii);
    // rounded bodies may overlap where the polytopes are apart
    if (radii > 0)
        want |= WANT_SEPARATION;
    bool depth_first =
        (want & WANT_DEPTH) && (!(want & WANT_SEPARATION) || (cache && cache->points == 0 && cache->pieces == 1));
    pir_least least = {.some = false};
    pir_state state = depth_first ? depth_and_state(query, &placement, cache, &least, &result->steps)
                                  : separation(query, &placement, limit, cache, &least, result);
    if (depth_first && state == PIR_OUTSIDE && (want & WANT_SEPARATION))
        separation(query, &placement, limit, cache, &least, result);
    if (state != PIR_OUTSIDE || !(want & WANT_SEPARATION))
        set_state(result, state);
    if (state == PIR_BOUNDARY) {
        answer_touching(query, &placement, &least, cache, result);
    } else if (state == PIR_INSIDE && ((want & WANT_DEPTH) || radii > 0)) {
        if (!depth_first)
            least.some = pir_depth_find(&query->search, &placement, cache, &least.facet, &result->steps);
        answer_depth(query, &placement, &least.facet, cache, result);
    }
    add_radii(input, result);
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
        return answer(query, &near, WANT_SEPARATION, cache, ret_result);
    }
    pir_query_result result = {0};
    pir_least touching = {.some = false};
    set_state(&result, overlap(query, &placement, cache, &touching, &result.steps));
    if (result.state == PIR_BOUNDARY)
        answer_touching(query, &placement, &touching, cache, &result);
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_query_distance(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                              pir_query_result *ret_result) {
    pir_status status = answer(query, input, WANT_SEPARATION, cache, ret_result);
    if (status == PIR_OK && ret_result->outcome == PIR_OVERLAPPING)
        ret_result->distance = 0;
    return status;
}

pir_status pir_query_penetration(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                 pir_query_result *ret_result) {
    pir_status status = answer(query, input, WANT_DEPTH, cache, ret_result);
    if (status == PIR_OK && ret_result->state == PIR_OUTSIDE)
        ret_result->distance = 0;
    return status;
}

pir_status pir_query_signed_distance(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                     pir_query_result *ret_result) {
    return answer(query, input, WANT_SEPARATION | WANT_DEPTH, cache, ret_result);
}
