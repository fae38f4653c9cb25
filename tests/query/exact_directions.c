/* SPDX-License-Identifier: MIT */
/* See exact_checks.h: along a direction. */
#include <math.h>

#include "query/exact_checks.h"
#include "query/exact_report.h"

/* The normal at t + s·d is that of a plane which passes there, or lies between such. */
static void check_normal(exact_pair *pair, const exact_pose *pose, double s, pir_vec3 normal, double scale) {
    oracle_place *o = pair->place;
    pir_vec3 there = exact_add(pose->t, pose->direction, s);
    double coordinates = fmax(pair->reach, exact_largest(there));
    oracle_place_set(o, there, (pir_vec3){0, 0, 0});
    double reach = oracle_place_reach(o, normal);
    exact_check(EXACT_CONTACT, fabs(exact_length(normal) - 1) <= 4e-15, "the normal's length is 1 + %.3g",
                exact_length(normal) - 1);
    exact_check(EXACT_CONTACT, fabs(reach) <= 4e-12 * scale + 0x1p-48 * coordinates,
                "the difference reaches %.3g of the scale beyond the contact along its normal (%g, %g, %g)",
                reach / scale, normal.x, normal.y, normal.z);
    oracle_place_set(o, pose->t, pose->direction);
}

static void check_contact(exact_pair *pair, const exact_pose *pose, double s, pir_vec3 point, pir_witness witness,
                          double scale) {
    pir_vec3 there = exact_add(pose->t, pose->direction, s);
    double coordinates = fmax(pair->reach, fmax(exact_largest(there), exact_largest(point)));
    double tolerance = 2e-12 * scale + 0x1p-49 * coordinates;
    exact_check_holds(pair, PIR_OPERAND_P, witness.p, point, there, tolerance);
    exact_check_holds(pair, PIR_OPERAND_Q, witness.q, point, there, tolerance);
    oracle_place_set(pair->place, pose->t, pose->direction);
}

static void check_exit(exact_pair *pair, const exact_pose *pose, const oracle_ray *ray, double length) {
    pir_query_result r;
    pir_status status = pir_query_directional_depth(pair->query, &pose->input, pose->direction, &r);
    exact_check(EXACT_STATE, status == PIR_OK && r.state == pose->state,
                "directional depth: status %d, state %d, not %d", (int)status, (int)r.state, (int)pose->state);
    if (status != PIR_OK)
        return;
    exact_check(EXACT_STATE, (r.outcome == PIR_NO_HIT) == (pose->state != PIR_INSIDE),
                "directional depth: outcome %d in state %d", (int)r.outcome, (int)pose->state);
    if (pose->state != PIR_INSIDE)
        return;
    double should = ray->leave * length;
    exact_number(EXACT_EXIT, "directional depth", r.distance, -should, pair->size + should);
    if (fabs(r.distance + should) > 1e-12 * (pair->size + should))
        return;
    check_normal(pair, pose, ray->leave, r.normal, pair->size);
    check_contact(pair, pose, ray->leave, r.point_p, r.witness, pair->size);
}

static void check_approach(exact_pair *pair, const exact_pose *pose, const oracle_ray *ray, double length) {
    pir_query_result r;
    pir_status status = pir_query_directional_distance(pair->query, &pose->input, pose->direction, &r);
    exact_check(EXACT_STATE, status == PIR_OK && r.state == pose->state,
                "directional distance: status %d, state %d, not %d", (int)status, (int)r.state, (int)pose->state);
    if (status != PIR_OK)
        return;
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
    check_normal(pair, pose, ray->enter, r.normal, pair->size + should);
    check_contact(pair, pose, ray->enter, r.point_p, r.witness, pair->size + should);
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
    pir_cast_result r;
    pir_status status = pir_query_cast(pair->query, &pose->input, pose->direction, &r);
    exact_check(EXACT_STATE, status == PIR_OK, "cast: status %d", (int)status);
    if (status != PIR_OK)
        return;
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
    check_normal(pair, pose, should, r.normal, pair->size + should * length);
    check_contact(pair, pose, should, r.point, r.witness, pair->size + should * length);
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
