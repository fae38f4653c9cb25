/* SPDX-License-Identifier: MIT */
/*
 * Queries on one placement: overlap, separation, penetration. What they share is the exact state; the rest is told in descent.c and depth.c.
 */
#include "query/query.h"

/* Distances above this, relative to the placement's reach, are tried for a quick proof; nearer ones go to the exact search at once. */
#define CLEARLY_APART 0x1p-40

pir_query_input pir_query_input_default(void) {
    return (pir_query_input){{0, 0, 0}, 0, 0, HUGE_VAL};
}

/* --- answers --- */

static pir_vec3 plane_normal(const pir_query *query, uint32_t slot) {
    return pir_plane_normal(&query->planes, slot);
}

static const pir_outcome outcome_of[] = {
    [PIR_OUTSIDE] = PIR_SEPARATED, [PIR_BOUNDARY] = PIR_TOUCHING, [PIR_INSIDE] = PIR_OVERLAPPING};

/* Member by member: a compiler's way of clearing the whole takes a fifth of a query. */
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

/* The end of P's normal: point_p = point_q + distance · normal. */
static void set_points(pir_query_result *result, pir_vec3 point_q) {
    result->point_q = point_q;
    result->point_p = pir_vec_add(point_q, pir_vec_scale(result->normal, result->distance));
}

/* Any direction that D does not extend along, for touching where no plane shows it: flat D and t at its rim. */
static void touch_anyhow(pir_query *query, const pir_placement *placement, pir_query_result *result) {
    pir_simplex simplex = {0};
    pir_descend_finely(query, placement, &simplex, &result->steps);
    double length = sqrt(pir_vec_dot(simplex.direction, simplex.direction));
    result->normal = length > 0 ? simplex.direction : (pir_vec3){1, 0, 0};
    result->witness.p = pir_feature_of(query->p, simplex.a, simplex.count);
    result->witness.q = pir_feature_of(query->q, simplex.b, simplex.count);
    set_points(result, pir_frame_world(query, query->vq[simplex.b[0]]));
}

static void answer_touching(pir_query *query, const pir_placement *placement, uint32_t slot, pir_query_cache *cache,
                            pir_query_result *result) {
    result->distance = 0;
    if (slot == PIR_NO_PLANE) {
        touch_anyhow(query, placement, result);
        return;
    }
    pir_plane_refine(query, slot);
    result->normal = plane_normal(query, slot);
    result->witness = pir_witness_of_piece(query, query->planes.piece[slot]);
    pir_piece_keep(cache, query->planes.piece[slot]);
    // the features that meet may be less than the piece's: the simplex holds the point itself
    pir_simplex simplex = {0};
    pir_descend_finely(query, placement, &simplex, &result->steps);
    pir_vec3 y = {0, 0, 0};
    double sum = 0;
    for (uint32_t i = 0; i < simplex.count; i++) {
        y = pir_vec_add(y, pir_vec_scale(query->vq[simplex.b[i]], simplex.weight[i]));
        sum += simplex.weight[i];
    }
    set_points(result, pir_frame_world(query, pir_vec_scale(y, 1 / sum)));
}

/* --- separation --- */

static void recall_simplex(const pir_query *query, const pir_query_cache *cache, pir_simplex *simplex) {
    simplex->count = 0;
    simplex->parts = false;
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

/* All three, those past the count being 0. */
static void keep_simplex(pir_query_cache *cache, const pir_simplex *simplex) {
    if (!cache)
        return;
    cache->points = simplex->count;
    for (uint32_t i = 0; i < 3; i++) {
        cache->p[i] = simplex->a[i];
        cache->q[i] = simplex->b[i];
    }
}

/* Whether the facet of slot `slot` certainly separates. */
static bool separates(const pir_query *query, uint32_t slot, const pir_placement *placement) {
    return pir_plane_slack(&query->planes, slot, placement->x) < -placement->error * query->planes.err[slot];
}

/* Bodies that are apart by less than their coordinates can tell still have two points, apart by one rounding along the normal. */
static void separate_points(pir_query_result *result) {
    pir_vec3 *p = &result->point_p, *q = &result->point_q, n = result->normal;
    if (p->x != q->x || p->y != q->y || p->z != q->z)
        return;
    double *most = fabs(n.x) >= fabs(n.y) && fabs(n.x) >= fabs(n.z) ? &p->x : fabs(n.y) >= fabs(n.z) ? &p->y : &p->z;
    double along = most == &p->x ? n.x : most == &p->y ? n.y : n.z;
    *most = nextafter(*most, along > 0 ? HUGE_VAL : -HUGE_VAL);
}

static pir_witness witness_of(const pir_query *query, const pir_simplex *simplex) {
    return (pir_witness){pir_feature_of(query->p, simplex->a, simplex->count),
                         pir_feature_of(query->q, simplex->b, simplex->count)};
}

/* The answer of a descent that ended, the state being outside; the witness is set. */
static void answer_separation(const pir_query *query, const pir_simplex *simplex, pir_query_cache *cache,
                              pir_query_result *result) {
    keep_simplex(cache, simplex);
    result->distance = pir_frame_length(query, simplex->upper);
    result->normal = simplex->direction;
    result->outcome = simplex->certain ? PIR_SEPARATED : PIR_STEP_LIMIT;
    pir_vec3 y = {0, 0, 0};
    for (uint32_t i = 0; i < simplex->count; i++)
        y = pir_vec_add(y, pir_vec_scale(query->vq[simplex->b[i]], simplex->weight[i]));
    set_points(result, pir_frame_world(query, y));
    separate_points(result);
}

/*
 * The separation, or only the state where there is none. Returns the state; *ret_slot as pir_state_find. `limit` is the cutoff in the
 * frame: beyond it, only the bound is told.
 */
static pir_state separation(pir_query *query, const pir_placement *placement, double limit, pir_query_cache *cache,
                            uint32_t *ret_slot, pir_query_result *result) {
    pir_simplex simplex;
    recall_simplex(query, cache, &simplex);
    pir_descend_to_point(query, placement, limit, &simplex, &result->steps);
    bool far = simplex.lower > CLEARLY_APART * placement->reach;
    pir_witness witness = {{0}, {0}};
    if (far)
        witness = witness_of(query, &simplex);
    if (!far || !pir_prove_outside(query, placement, &simplex, &witness, cache)) {
        pir_state state = pir_state_find(query, placement, cache, ret_slot, &result->steps);
        if (state != PIR_OUTSIDE)
            return state;
        if (*ret_slot != PIR_NO_PLANE)
            pir_piece_keep(cache, query->planes.piece[*ret_slot]);
    }
    set_state(result, PIR_OUTSIDE);
    if (simplex.lower > limit) {
        result->outcome = PIR_BEYOND_CUTOFF;
        result->distance = pir_frame_length(query, simplex.lower);
        result->normal = simplex.direction;
        keep_simplex(cache, &simplex);
        return PIR_OUTSIDE;
    }
    bool fine = !simplex.certain;
    if (fine)
        pir_descend_finely(query, placement, &simplex, &result->steps);
    result->witness = far && !fine ? witness : witness_of(query, &simplex);
    bool next_to_nothing = simplex.upper <= PIR_MEET * placement->reach && !simplex.parts;
    if (next_to_nothing)
        simplex.direction = *ret_slot != PIR_NO_PLANE ? plane_normal(query, *ret_slot) : query->beyond;
    answer_separation(query, &simplex, cache, result);
    // apart by less than rounding tells: the facet that separates stands for the features
    if (next_to_nothing && *ret_slot != PIR_NO_PLANE)
        result->witness = pir_witness_of_piece(query, query->planes.piece[*ret_slot]);
    return PIR_OUTSIDE;
}

/* The state alone: cheap certain answers first, then the search. */
static pir_state overlap(pir_query *query, const pir_placement *placement, pir_query_cache *cache, uint32_t *ret_slot,
                         uint32_t *steps) {
    if (pir_piece_recall(query, cache, ret_slot) && separates(query, *ret_slot, placement))
        return PIR_OUTSIDE;
    bool inside = query->group_count > 0;
    pir_groups_bound(query, placement, 0);
    for (uint32_t g = 0; g < query->group_count && inside; g++)
        inside = query->low[g] > 0;
    if (inside)
        return PIR_INSIDE;
    pir_simplex simplex;
    recall_simplex(query, cache, &simplex);
    pir_descend_to_point(query, placement, CLEARLY_APART * placement->reach, &simplex, steps);
    if (simplex.lower > CLEARLY_APART * placement->reach &&
        pir_prove_outside(query, placement, &simplex, NULL, cache)) {
        *ret_slot = query->planes.capacity - 1;
        keep_simplex(cache, &simplex);
        return PIR_OUTSIDE;
    }
    return pir_state_find(query, placement, cache, ret_slot, steps);
}

/*
 * The state and, inside, the slot of the least slack: most often the least slack tells the state as well. *ret_slack is set when inside.
 */
static pir_state depth_and_state(pir_query *query, const pir_placement *placement, const pir_query_cache *cache,
                                 uint32_t *ret_slot, double *ret_slack, uint32_t *steps) {
    if (pir_piece_recall(query, cache, ret_slot) && separates(query, *ret_slot, placement))
        return PIR_OUTSIDE;
    *ret_slot = pir_depth_find(query, placement, cache, ret_slack, steps);
    if (*ret_slot != PIR_NO_PLANE) {
        double error = placement->error * query->planes.err[*ret_slot];
        // a tie may hide a slack below by its width
        if (*ret_slack - PIR_TIE * (query->size_p + query->size_q) > error)
            return PIR_INSIDE;
        if (*ret_slack < -error)
            return PIR_OUTSIDE;
    }
    uint32_t slot = *ret_slot;
    pir_state state = pir_state_find(query, placement, cache, &slot, steps);
    if (state != PIR_INSIDE)
        *ret_slot = slot;
    return state;
}

static void answer_depth(pir_query *query, const pir_placement *placement, uint32_t slot, double slack,
                         pir_query_cache *cache, pir_query_result *result) {
    // exactly inside: a slack that rounds below zero is one of next to nothing
    slack = fmax(slack, 0);
    pir_piece_keep(cache, query->planes.piece[slot]);
    if (cache)
        cache->points = 0;
    result->normal = plane_normal(query, slot);
    result->distance = -pir_frame_length(query, slack);
    result->witness = pir_witness_of_piece(query, query->planes.piece[slot]);
    set_points(result, pir_witness_point(query, placement, slot, slack));
}

/* What the facets in the region of the sum tell. */
static void answer_in_region(pir_query *query, const pir_placement *placement, pir_query_cache *cache,
                             pir_query_result *result) {
    uint32_t slot;
    double slack = 0;
    set_state(result, pir_region_find(query, placement, cache, &slot, &slack, &result->steps));
    if (result->state == PIR_OUTSIDE) {
        pir_piece_keep(cache, query->planes.piece[slot]);
    } else if (slot == PIR_NO_PLANE) {
        result->outcome = PIR_NO_HIT;
    } else {
        answer_depth(query, placement, slot, result->state == PIR_BOUNDARY ? 0 : slack, cache, result);
        result->outcome = PIR_NOT_SEPARATED;
    }
}

/* --- radii --- */

/* Grows both bodies by their radii in an answer that knows the signed distance. */
static void add_radii(const pir_query_input *input, pir_query_result *result) {
    double sum = input->radius_p + input->radius_q;
    if (sum == 0)
        return;
    result->distance -= sum;
    if (result->outcome == PIR_BEYOND_CUTOFF)
        return;
    result->point_q = pir_vec_add(result->point_q, pir_vec_scale(result->normal, input->radius_q));
    result->point_p = pir_vec_add(result->point_q, pir_vec_scale(result->normal, result->distance));
    pir_outcome outcome = result->outcome;
    set_state(result, result->distance > 0 ? PIR_OUTSIDE : result->distance == 0 ? PIR_BOUNDARY : PIR_INSIDE);
    if (outcome == PIR_STEP_LIMIT)
        result->outcome = outcome;
}

/* --- the calls --- */

/* What a call wants to know. */
enum { WANT_SEPARATION = 1, WANT_DEPTH = 2 };

static pir_status answer(pir_query *query, const pir_query_input *input, int want, pir_query_cache *cache,
                         pir_query_result *ret_result) {
    pir_placement placement;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_place(query, input, &placement);
    if (status != PIR_OK)
        return status;
    // separation, and bodies that are rounded, need the whole sum
    bool in_region = query->sum->region.cone.set;
    if (in_region && (want != WANT_DEPTH || input->radius_p + input->radius_q > 0))
        return PIR_ERR_UNSUPPORTED;
    // nothing fails from here on
    pir_query_result *const result = ret_result;
    clear(result);
    if (in_region) {
        answer_in_region(query, &placement, cache, result);
        return PIR_OK;
    }
    double radii = input->radius_p + input->radius_q, slack = 0;
    double limit = pir_frame_from(query, input->cutoff + radii);
    uint32_t slot = PIR_NO_PLANE;
    // rounded bodies overlap where the polytopes are apart
    if (radii > 0)
        want |= WANT_SEPARATION;
    bool depth_first =
        (want & WANT_DEPTH) && (!(want & WANT_SEPARATION) || (cache && cache->points == 0 && cache->pieces == 1));
    pir_state state;
    bool separated = false;
    if (depth_first)
        state = depth_and_state(query, &placement, cache, &slot, &slack, &result->steps);
    else
        state = separation(query, &placement, limit, cache, &slot, result), separated = state == PIR_OUTSIDE;
    if (depth_first && state == PIR_OUTSIDE && (want & WANT_SEPARATION))
        separation(query, &placement, limit, cache, &slot, result), separated = true;
    if (!separated)
        set_state(result, state);
    if (state == PIR_BOUNDARY) {
        answer_touching(query, &placement, slot, cache, result);
    } else if (state == PIR_INSIDE && ((want & WANT_DEPTH) || radii > 0)) {
        if (!depth_first)
            slot = pir_depth_find(query, &placement, cache, &slack, &result->steps);
        answer_depth(query, &placement, slot, slack, cache, result);
    } else if (state == PIR_OUTSIDE && !separated && slot != PIR_NO_PLANE) {
        pir_piece_keep(cache, query->planes.piece[slot]);
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
    uint32_t slot = PIR_NO_PLANE;
    pir_state state = overlap(query, &placement, cache, &slot, &result.steps);
    set_state(&result, state);
    if (state != PIR_INSIDE && slot != PIR_NO_PLANE) {
        result.normal = plane_normal(query, slot);
        result.witness = pir_witness_of_piece(query, query->planes.piece[slot]);
        pir_piece_keep(cache, query->planes.piece[slot]);
    }
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
