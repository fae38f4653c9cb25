/* SPDX-License-Identifier: MIT */
/* Checks along a direction: see exact_checks.h. */
#include <math.h>
#include <string.h>

#include "query/exact_checks.h"
#include "query/exact_report.h"

/* Checks what a query says of the contact at t + s·d. */
struct said {
    pir_vec3 point, normal;
    pir_witness witness;
};

/* Checks that the normal is that of a plane through the point, or lies between the normals of such planes. */
static void check_normal(exact_pair *pair, const exact_contact *contact, pir_vec3 normal, double scale) {
    oracle_place *o = pair->place;
    double coordinates = fmax(pair->reach, exact_largest(contact->there));
    oracle_place_set(o, contact->there, (pir_vec3){0, 0, 0});
    double reach = oracle_place_reach(o, normal);
    exact_check(EXACT_CONTACT, fabs(exact_length(normal) - 1) <= 4e-15, "the normal's length is 1 + %.3g",
                exact_length(normal) - 1);
    exact_check(EXACT_CONTACT, fabs(reach) <= 4e-12 * scale + 0x1p-48 * coordinates,
                "the difference reaches %.3g of the scale beyond the contact along its normal (%g, %g, %g)",
                reach / scale, normal.x, normal.y, normal.z);
    oracle_place_set(o, contact->t, contact->direction);
}

/* The contact at time s, through plane i, unless the bodies touch at the start. */
static void check_contact(exact_pair *pair, const exact_pose *pose, double s, uint32_t i, const struct said *said) {
    // a gap or a depth that counts as 0 in numbers, though not in the state
    if (pose->state != PIR_BOUNDARY && fabs(pose->should) <= 0x1p-900 * pair->size)
        return;
    double scale = pair->size + s * exact_length(pose->direction);
    exact_contact contact = {pose->state == PIR_BOUNDARY ? EXACT_NEAREST : EXACT_ALONG, i, pose->t, pose->direction,
                             exact_add(pose->t, pose->direction, s)};
    double coordinates = fmax(pair->reach, fmax(exact_largest(contact.there), exact_largest(said->point)));
    double tolerance = 2e-12 * scale + 0x1p-49 * coordinates;
    check_normal(pair, &contact, said->normal, scale);
    exact_check_witness(pair, &contact, &said->witness, said->point, said->point, tolerance);
}

/* Checks that a query object without a history of other rotations answers the same, bit for bit. */
static void check_same(exact_pair *pair, const exact_pose *pose, const char *name,
                       pir_status (*ask)(pir_query *, const pir_query_input *, pir_vec3, pir_query_result *),
                       const pir_query_result *r) {
    pir_query_result other;
    pir_status status = ask(pair->fresh, &pose->input, pose->direction, &other);
    exact_check(EXACT_CACHE, status == PIR_OK && exact_same_bits(r, &other), "%s: %.17g and %.17g", name, r->distance,
                other.distance);
}

static void check_exit(exact_pair *pair, const exact_pose *pose, const oracle_ray *ray, double length) {
    pir_query_result r;
    pir_status status = pir_query_directional_depth(pair->query, &pose->input, pose->direction, &r);
    exact_check(EXACT_STATE, status == PIR_OK && r.state == pose->state,
                "directional depth: status %d, state %d, not %d", (int)status, (int)r.state, (int)pose->state);
    if (status != PIR_OK)
        return;
    check_same(pair, pose, "directional depth", pir_query_directional_depth, &r);
    exact_check(EXACT_STATE, (r.outcome == PIR_NO_HIT) == (pose->state != PIR_INSIDE),
                "directional depth: outcome %d in state %d", (int)r.outcome, (int)pose->state);
    if (pose->state != PIR_INSIDE)
        return;
    double should = ray->leave * length;
    exact_number(EXACT_EXIT, "directional depth", r.distance, -should, pair->size + should);
    if (fabs(r.distance + should) > 1e-12 * (pair->size + should))
        return;
    check_contact(pair, pose, ray->leave, ray->last, &(struct said){r.point_p, r.normal, r.witness});
}

static void check_approach(exact_pair *pair, const exact_pose *pose, const oracle_ray *ray, double length) {
    pir_query_result r;
    pir_status status = pir_query_directional_distance(pair->query, &pose->input, pose->direction, &r);
    exact_check(EXACT_STATE, status == PIR_OK && r.state == pose->state,
                "directional distance: status %d, state %d, not %d", (int)status, (int)r.state, (int)pose->state);
    if (status != PIR_OK)
        return;
    check_same(pair, pose, "directional distance", pir_query_directional_distance, &r);
    exact_check(EXACT_APPROACH_OUTCOME, (r.outcome == PIR_NO_HIT) == !ray->meets,
                "directional distance: outcome %d at %.17g of the size; exactly: %s at %.17g, state %d", (int)r.outcome,
                r.distance / pair->size, ray->meets ? "meets" : "never meets", ray->enter * length / pair->size,
                (int)pose->state);
    if (!ray->meets || r.outcome == PIR_NO_HIT)
        return;
    double should = ray->enter * length;
    exact_number(EXACT_APPROACH, "directional distance", r.distance, should, pair->size + should);
    if (pose->state != PIR_OUTSIDE || fabs(r.distance - should) > 1e-12 * (pair->size + should))
        return;
    check_contact(pair, pose, ray->enter, ray->first, &(struct said){r.point_p, r.normal, r.witness});
}

static pir_cast_outcome right_outcome(const exact_pose *pose, const oracle_ray *ray, double length) {
    if (pose->state == PIR_INSIDE)
        return PIR_CAST_START_INSIDE;
    if (pose->state == PIR_BOUNDARY)
        return ray->inwards && length > 0 ? PIR_CAST_HIT : PIR_CAST_RECEDING;
    if (length == 0)
        return PIR_CAST_AT_REST;
    return ray->within ? PIR_CAST_HIT : PIR_CAST_MISS;
}

static void check_cast(exact_pair *pair, const exact_pose *pose, const oracle_ray *ray, double length) {
    pir_impact r;
    pir_status status = pir_query_cast(pair->query, &pose->input, pose->direction, &r);
    exact_check(EXACT_STATE, status == PIR_OK, "cast: status %d", (int)status);
    if (status != PIR_OK)
        return;
    pir_impact other;
    status = pir_query_cast(pair->fresh, &pose->input, pose->direction, &other);
    exact_check(EXACT_CACHE,
                status == PIR_OK && other.outcome == r.outcome && memcmp(&other.time, &r.time, sizeof r.time) == 0 &&
                    memcmp(&other.normal, &r.normal, sizeof r.normal) == 0 &&
                    memcmp(&other.point, &r.point, sizeof r.point) == 0 &&
                    memcmp(&other.witness, &r.witness, sizeof r.witness) == 0,
                "cast: outcomes %d and %d, times %.17g and %.17g", (int)r.outcome, (int)other.outcome, r.time,
                other.time);
    pir_cast_outcome right = right_outcome(pose, ray, length);
    exact_check(EXACT_CAST_OUTCOME, r.outcome == right,
                "cast: outcome %d, not %d, time %.17g; exactly %.17g to %.17g, state %d, distance %.3g of the size",
                (int)r.outcome, (int)right, r.time, ray->enter, ray->leave, (int)pose->state,
                pose->should / pair->size);
    if (r.outcome != right)
        return;
    double should = right == PIR_CAST_HIT ? ray->enter : right == PIR_CAST_MISS ? 1 : 0;
    if (right != PIR_CAST_AT_REST)
        exact_number(EXACT_CAST_TIME, "cast, of the size", r.time * (length / pair->size),
                     should * (length / pair->size), 1 + should * (length / pair->size));
    if (right != PIR_CAST_HIT || fabs(r.time - should) * length > 1e-12 * (pair->size + should * length))
        return;
    check_contact(pair, pose, should, ray->first, &(struct said){r.point, r.normal, r.witness});
}

void exact_check_directions(exact_pair *pair, const exact_pose *pose) {
    double length = exact_length(pose->direction);
    oracle_place_set(pair->place, pose->t, pose->direction);
    oracle_ray ray = oracle_place_ray(pair->place);
    check_exit(pair, pose, &ray, length);
    check_approach(pair, pose, &ray, length);
    check_cast(pair, pose, &ray, length);
    if (pose->state == PIR_INSIDE)
        return;
    // no motion at all
    exact_pose still = *pose;
    still.direction = (pir_vec3){0, 0, 0};
    oracle_place_set(pair->place, still.t, still.direction);
    ray = oracle_place_ray(pair->place);
    check_cast(pair, &still, &ray, 0);
}
