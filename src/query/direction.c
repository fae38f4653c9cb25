/* SPDX-License-Identifier: MIT */
/*
 * Along a line: where x + λu enters and leaves D, by clipping the line to every facet's halfspace (Cyrus and Beck, 1978). With it the
 * directional depth and distance, and the linear cast.
 *
 * The facets of a flat difference do not bound it sideways; there a hit counts when x + λu is next to D. A needle may have no facet that
 * is not along u as far as doubles tell; the way out of it is found by exact states.
 */
#include "query/query.h"

/* A rate of approach this small, of two unit vectors, is along. */
#define ALONG 0x1p-46

/* How near a hit on a flat difference must be, relative to its reach. */
#define NEAR_FLAT 0x1p-36

struct clip {
    double enter, leave;
    uint32_t enter_slot, leave_slot;
    bool misses; /* parallel to a facet and outside it */
};

static double rate_of(const pir_planes *planes, uint32_t i, pir_vec3 u) {
    return planes->n.x[i] * u.x + planes->n.y[i] * u.y + planes->n.z[i] * u.z;
}

static struct clip clip_once(pir_query *query, const pir_placement *placement, pir_vec3 u) {
    const pir_planes *planes = &query->planes;
    struct clip clip = {-HUGE_VAL, HUGE_VAL, PIR_NO_PLANE, PIR_NO_PLANE, false};
    for (uint32_t g = 0; g < query->group_count; g++) {
        const pir_group *group = &query->groups[g];
        for (uint32_t i = group->start; i < group->start + group->count; i++) {
            double s = pir_plane_slack(planes, i, placement->x), rate = rate_of(planes, i, u);
            if (fabs(rate) <= ALONG * planes->err[i]) {
                clip.misses |= s < -placement->error * planes->err[i];
                continue;
            }
            double at = s / rate;
            if (rate > 0 && at < clip.leave)
                clip.leave = at, clip.leave_slot = i;
            if (rate < 0 && at > clip.enter)
                clip.enter = at, clip.enter_slot = i;
        }
    }
    return clip;
}

/* Clips the line; the facets that decide have exact normals. Each round makes one normal exact, so there are as many as planes at most. */
static struct clip clip_line(pir_query *query, const pir_placement *placement, pir_vec3 u, uint32_t *steps) {
    for (uint32_t g = 0; g < query->group_count; g++)
        pir_group_make(query, g);
    for (uint32_t left = query->planes.used;; left--) {
        ++*steps;
        struct clip clip = clip_once(query, placement, u);
        const uint32_t slots[2] = {clip.enter_slot, clip.leave_slot};
        bool refined = false;
        for (int k = 0; k < 2; k++)
            if (slots[k] != PIR_NO_PLANE && query->planes.err[slots[k]] * PIR_SIN_REFINED >= 1) {
                pir_plane_refine(query, slots[k]);
                refined = true;
            }
        if (!refined || left == 0)
            return clip;
    }
}

/* As many as halve twice the reach down to the last digit of a translation. */
#define HALVINGS 64

/* The way out of a needle along u: halved by states, which are exact. No slot when none shows a facet. */
static void leave_by_halves(pir_query *query, const pir_placement *placement, pir_vec3 u, struct clip *clip,
                            uint32_t *steps) {
    double inside = 0, outside = 2 * placement->reach;
    for (int i = 0; i < HALVINGS; i++) {
        double at = i == 0 ? outside : 0.5 * (inside + outside);
        pir_vec3 t = pir_vec_add(placement->translation, pir_vec_scale(u, pir_frame_length(query, at)));
        pir_placement there;
        uint32_t slot = PIR_NO_PLANE;
        if (pir_frame_place(query, t, &there) != PIR_OK)
            return;
        if (pir_state_find(query, &there, NULL, &slot, steps) == PIR_INSIDE) {
            inside = at;
        } else {
            outside = at;
            clip->leave = at;
            clip->leave_slot = slot;
        }
    }
}

static bool is_flat(const pir_query *query) {
    return query->p->dimension < 3 && query->q->dimension < 3;
}

/* Whether x + λu is next to D. */
static bool is_near(pir_query *query, const pir_placement *placement, pir_vec3 u, double at, uint32_t *steps) {
    pir_placement there = *placement;
    there.x = pir_vec_add(placement->x, pir_vec_scale(u, at));
    there.fine = pir_dd3_from(there.x);
    there.reach += fabs(at);
    pir_simplex simplex = {0};
    pir_descend_finely(query, &there, &simplex, steps);
    return simplex.upper <= NEAR_FLAT * there.reach;
}

bool pir_unit_of(pir_vec3 v, pir_vec3 *ret_unit, double *ret_length) {
    double most = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
    if (most == 0)
        return false;
    int e;
    frexp(most, &e);
    pir_vec3 scaled = {ldexp(v.x, -e), ldexp(v.y, -e), ldexp(v.z, -e)};
    double length = sqrt(pir_vec_dot(scaled, scaled));
    *ret_unit = (pir_vec3){scaled.x / length, scaled.y / length, scaled.z / length};
    *ret_length = ldexp(length, e);
    return true;
}

/* The contact of facet `slot` when t is moved by `at` along u. */
static void set_contact(pir_query *query, const pir_placement *placement, pir_vec3 u, double at, uint32_t slot,
                        pir_vec3 *normal, pir_vec3 *point, pir_witness *witness) {
    pir_placement there = *placement;
    there.x = pir_vec_add(placement->x, pir_vec_scale(u, at));
    *normal = pir_plane_normal(&query->planes, slot);
    *point = pir_witness_point(query, &there, slot, 0);
    *witness = pir_witness_of_piece(query, query->planes.piece[slot]);
}

/* Where P first touches Q along u from outside: false when it never does. */
static bool first_touch(pir_query *query, const pir_placement *placement, pir_vec3 u, double *ret_at,
                        uint32_t *ret_slot, uint32_t *steps) {
    struct clip clip = clip_line(query, placement, u, steps);
    double hair = placement->error;
    if (clip.misses || clip.enter_slot == PIR_NO_PLANE || clip.enter > clip.leave + hair || clip.leave < 0)
        return false;
    *ret_at = fmax(clip.enter, 0);
    *ret_slot = clip.enter_slot;
    return !is_flat(query) || is_near(query, placement, u, *ret_at, steps);
}

static pir_status begin(pir_query *query, const pir_query_input *input, pir_vec3 direction, const void *ret,
                        pir_placement *ret_placement) {
    if (!ret)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_begin(query, input, ret_placement);
    if (status == PIR_OK && !pir_vec_is_finite(direction))
        return PIR_ERR_NOT_FINITE;
    return status;
}

/* The exit from what the facets in the region of the sum bound. */
static void exit_region(pir_query *query, const pir_placement *placement, pir_vec3 u, pir_query_result *result) {
    uint32_t slot;
    double at = 0;
    result->state = pir_region_find(query, placement, NULL, &slot, &at, &result->steps);
    result->outcome = PIR_NO_HIT;
    slot = result->state == PIR_INSIDE ? pir_region_exit(query, placement, u, &at, &result->steps) : PIR_NO_PLANE;
    if (slot == PIR_NO_PLANE)
        return;
    result->outcome = PIR_NOT_SEPARATED;
    set_contact(query, placement, u, at, slot, &result->normal, &result->point_q, &result->witness);
    result->point_p = result->point_q;
    result->distance = -pir_frame_length(query, at);
}

pir_status pir_query_directional_depth(pir_query *query, const pir_query_input *input, pir_vec3 direction,
                                       pir_query_result *ret_result) {
    pir_placement placement;
    if (!ret_result)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_query_place(query, input, &placement);
    if (status != PIR_OK)
        return status;
    if (!pir_vec_is_finite(direction))
        return PIR_ERR_NOT_FINITE;
    pir_vec3 u;
    double length;
    if (!pir_unit_of(direction, &u, &length))
        return PIR_ERR_ARGUMENT;
    pir_query_result result = {0};
    if (query->sum->region.cone.set) {
        exit_region(query, &placement, u, &result);
        *ret_result = result;
        return PIR_OK;
    }
    uint32_t slot = PIR_NO_PLANE;
    result.state = pir_state_find(query, &placement, NULL, &slot, &result.steps);
    result.outcome = PIR_NO_HIT;
    if (result.state == PIR_INSIDE) {
        struct clip clip = clip_line(query, &placement, u, &result.steps);
        if (clip.leave_slot == PIR_NO_PLANE)
            leave_by_halves(query, &placement, u, &clip, &result.steps);
        double at = fmax(clip.leave, 0);
        result.outcome = clip.leave_slot != PIR_NO_PLANE ? PIR_OVERLAPPING : PIR_STEP_LIMIT;
        if (clip.leave_slot != PIR_NO_PLANE)
            set_contact(query, &placement, u, at, clip.leave_slot, &result.normal, &result.point_q, &result.witness);
        result.point_p = result.point_q;
        result.distance = -pir_frame_length(query, at);
    }
    *ret_result = result;
    return PIR_OK;
}

pir_status pir_query_directional_distance(pir_query *query, const pir_query_input *input, pir_vec3 direction,
                                          pir_query_result *ret_result) {
    pir_placement placement;
    pir_status status = begin(query, input, direction, ret_result, &placement);
    if (status != PIR_OK)
        return status;
    pir_vec3 u;
    double length, at;
    if (!pir_unit_of(direction, &u, &length))
        return PIR_ERR_ARGUMENT;
    pir_query_result result = {0};
    uint32_t slot = PIR_NO_PLANE;
    result.state = pir_state_find(query, &placement, NULL, &slot, &result.steps);
    result.outcome = result.state == PIR_INSIDE ? PIR_OVERLAPPING : PIR_TOUCHING;
    if (result.state == PIR_OUTSIDE) {
        result.outcome = PIR_NO_HIT;
        if (first_touch(query, &placement, u, &at, &slot, &result.steps)) {
            result.outcome = PIR_SEPARATED;
            set_contact(query, &placement, u, at, slot, &result.normal, &result.point_q, &result.witness);
            result.point_p = result.point_q;
            result.distance = pir_frame_length(query, at);
        }
    }
    *ret_result = result;
    return PIR_OK;
}

/* --- the cast --- */

/* Whether P, touching, moves into Q along u: every facet that touches lets it in. The normal is that of the one it meets most squarely. */
static bool moves_in(pir_query *query, const pir_placement *placement, pir_vec3 u, uint32_t *ret_slot) {
    const pir_planes *planes = &query->planes;
    double most = 0;
    for (uint32_t g = 0; g < query->group_count; g++) {
        pir_group_make(query, g);
        const pir_group *group = &query->groups[g];
        for (uint32_t i = group->start; i < group->start + group->count; i++) {
            if (fabs(pir_plane_slack(planes, i, placement->x)) > placement->error * planes->err[i] ||
                pir_side_exact(query, planes->piece[i], placement->translation) != 0)
                continue;
            double rate = rate_of(planes, i, u);
            if (rate >= -ALONG * planes->err[i])
                return false;
            if (rate < most)
                most = rate, *ret_slot = i;
        }
    }
    return most < 0;
}

static void cast_from_outside(pir_query *query, const pir_placement *placement, pir_vec3 u, double length,
                              pir_cast_result *result) {
    double at;
    uint32_t slot;
    result->outcome = PIR_CAST_MISS;
    result->time = 1;
    if (!first_touch(query, placement, u, &at, &slot, &result->steps) || !(pir_frame_length(query, at) <= length))
        return;
    result->outcome = PIR_CAST_HIT;
    result->time = fmin(1, pir_frame_length(query, at) / length);
    set_contact(query, placement, u, at, slot, &result->normal, &result->point, &result->witness);
}

pir_status pir_query_cast(pir_query *query, const pir_query_input *input, pir_vec3 motion,
                          pir_cast_result *ret_result) {
    pir_placement placement;
    pir_status status = begin(query, input, motion, ret_result, &placement);
    if (status != PIR_OK)
        return status;
    pir_cast_result result = {0};
    pir_query_result start;
    status = pir_query_signed_distance(query, input, NULL, &start);
    if (status != PIR_OK)
        return status;
    pir_vec3 u;
    double length;
    result.steps = start.steps;
    result.normal = start.normal;
    result.point = start.point_q;
    result.witness = start.witness;
    bool moves = pir_unit_of(motion, &u, &length);
    uint32_t slot = PIR_NO_PLANE;
    if (start.state == PIR_INSIDE) {
        result.outcome = PIR_CAST_START_INSIDE;
    } else if (start.state == PIR_BOUNDARY) {
        result.outcome = PIR_CAST_RECEDING;
        if (moves && moves_in(query, &placement, u, &slot)) {
            result.outcome = PIR_CAST_HIT;
            result.normal = pir_plane_normal(&query->planes, slot);
        }
    } else if (!moves) {
        result.outcome = PIR_CAST_AT_REST;
        result.time = 1;
    } else {
        cast_from_outside(query, &placement, u, length, &result);
    }
    *ret_result = result;
    return PIR_OK;
}
