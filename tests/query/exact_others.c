/* SPDX-License-Identifier: MIT */
/* See exact_checks.h: escapes, the largest distance, radii, cutoff, the manifold. */
#include <math.h>
#include <stdlib.h>

#include "query/exact_checks.h"
#include "query/exact_report.h"

#define ROOM 4096

/* Whether some escape has the plane's normal and slack. */
static int is_listed(const oracle_plane *plane, double slack, const pir_escape *escapes, size_t count, double bound) {
    for (size_t i = 0; i < count; i++) {
        pir_vec3 n = escapes[i].normal;
        if (fabs(n.x - plane->near[0]) + fabs(n.y - plane->near[1]) + fabs(n.z - plane->near[2]) < 1e-13 &&
            fabs(escapes[i].depth - slack) <= bound)
            return 1;
    }
    return 0;
}

static int is_plane(const exact_pair *pair, const pir_escape *escape, double most, double bound) {
    for (uint32_t i = 0; i < pair->place->plane_count; i++) {
        double slack = oracle_place_slack(pair->place, i);
        if (slack <= most + bound && is_listed(&pair->place->plane[i], slack, escape, 1, bound))
            return 1;
    }
    return 0;
}

static void check_escapes(exact_pair *pair, const exact_pose *pose, double slack) {
    static pir_escape escapes[ROOM];
    size_t count = 0;
    double bound = 2e-12 * pair->size, most = -pose->should + slack;
    pir_status status = pir_query_escapes(pair->query, &pose->input, slack, ROOM, escapes, &count);
    exact_check(EXACT_ESCAPES, status == PIR_OK, "escapes: status %d", (int)status);
    if (status != PIR_OK || count > ROOM)
        return;
    exact_check(EXACT_ESCAPES, pose->state == PIR_INSIDE || count == 0, "%zu escapes in state %d", count,
                (int)pose->state);
    if (pose->state != PIR_INSIDE)
        return;
    oracle_place_set(pair->place, pose->t, (pir_vec3){0, 0, 0});
    for (uint32_t i = 0; i < pair->place->plane_count; i++) {
        double is = oracle_place_slack(pair->place, i);
        const double *n = pair->place->plane[i].near;
        if (is <= most - bound)
            exact_check(EXACT_ESCAPES, is_listed(&pair->place->plane[i], is, escapes, count, bound),
                        "the facet of normal (%g, %g, %g) and depth %.17g is not among the %zu escapes within %.17g",
                        n[0], n[1], n[2], is, count, most);
    }
    for (size_t i = 0; i < count; i++)
        exact_check(EXACT_ESCAPES, is_plane(pair, &escapes[i], most, bound),
                    "escape %zu of %zu, normal (%g, %g, %g) and depth %.17g, is no facet within %.17g", i, count,
                    escapes[i].normal.x, escapes[i].normal.y, escapes[i].normal.z, escapes[i].depth, most);
}

static void check_farthest(exact_pair *pair, const exact_pose *pose) {
    pir_query_result r;
    pir_status status = pir_query_largest_distance(pair->query, &pose->input, &r);
    exact_check(EXACT_FARTHEST, status == PIR_OK && r.state == pose->state, "largest distance: status %d, state %d",
                (int)status, (int)r.state);
    if (status != PIR_OK)
        return;
    oracle_place_set(pair->place, pose->t, (pir_vec3){0, 0, 0});
    double should = oracle_place_farthest(pair->place);
    double coordinates = fmax(pair->reach, fmax(exact_largest(pose->t), exact_largest(r.point_p)));
    exact_number(EXACT_FARTHEST, "largest distance", r.distance, should, pair->size + should);
    pir_vec3 end = exact_add(r.point_q, r.normal, r.distance);
    exact_check(EXACT_FARTHEST, exact_length(exact_add(r.point_p, end, -1)) <= 0x1p-49 * (coordinates + should),
                "point_p is not point_q + distance · normal");
    exact_check(EXACT_FARTHEST, r.witness.p.kind == PIR_FEATURE_VERTEX && r.witness.q.kind == PIR_FEATURE_VERTEX,
                "witness of kinds %d, %d", (int)r.witness.p.kind, (int)r.witness.q.kind);
    double tolerance = 0x1p-50 * coordinates + 1e-14 * pair->size;
    exact_contact contact = {.t = pose->t, .there = pose->t};
    exact_check_holds(pair, PIR_OPERAND_P, r.witness.p, r.point_p, &contact, tolerance);
    exact_check_holds(pair, PIR_OPERAND_Q, r.witness.q, r.point_q, &contact, tolerance);
}

static void check_rounded(exact_pair *pair, test_random *random, const exact_pose *pose) {
    pir_query_input input = pose->input;
    input.radius_p = pair->size * ldexp(1, -test_random_between(random, 0, 12));
    input.radius_q = test_random_below(random, 2) ? 0 : pair->size * fabs(test_random_unit(random));
    if (test_random_below(random, 3) == 0 && pose->should > 0)
        input.radius_p = pose->should * 0.5;
    double should = pose->should - input.radius_p - input.radius_q;
    double scale = pair->size + fabs(pose->should) + input.radius_p + input.radius_q;
    pir_query_result r;
    pir_status status = pir_query_signed_distance(pair->query, &input, NULL, &r);
    exact_check(EXACT_ROUNDED, status == PIR_OK, "with radii: status %d", (int)status);
    if (status != PIR_OK)
        return;
    exact_number(EXACT_ROUNDED, "with radii", r.distance, should, scale);
    pir_state right = should > 0 ? PIR_OUTSIDE : PIR_INSIDE;
    exact_check(EXACT_ROUNDED, r.state == right || fabs(should) <= 2e-12 * scale,
                "with radii %.17g and %.17g: state %d at %.17g", input.radius_p, input.radius_q, (int)r.state, should);
    double coordinates = fmax(pair->reach, fmax(exact_largest(pose->t), exact_largest(r.point_p)));
    pir_vec3 end = exact_add(r.point_q, r.normal, r.distance);
    exact_check(EXACT_ROUNDED, exact_length(exact_add(r.point_p, end, -1)) <= 0x1p-49 * (coordinates + scale),
                "with radii: point_p is not point_q + distance · normal");
}

static void check_cutoff(exact_pair *pair, test_random *random, const exact_pose *pose) {
    pir_query_input input = pose->input;
    pir_query_result r;
    double distance = pose->should > 0 ? pose->should : 0, bound = 1e-12 * (pair->size + distance);
    input.cutoff = test_random_below(random, 4) == 0
                       ? 0
                       : (distance + 1e-3 * pair->size) * ldexp(1, test_random_between(random, -3, 1));
    pir_status status = pir_query_signed_distance(pair->query, &input, NULL, &r);
    exact_check(EXACT_CUTOFF, status == PIR_OK && r.state == pose->state, "cutoff: status %d, state %d, not %d",
                (int)status, (int)r.state, (int)pose->state);
    if (status != PIR_OK)
        return;
    if (r.outcome == PIR_BEYOND_CUTOFF)
        exact_check(EXACT_CUTOFF,
                    distance >= input.cutoff - bound && r.distance <= distance + bound &&
                        r.distance >= input.cutoff - bound,
                    "beyond a cutoff of %.17g: bound %.17g, distance %.17g", input.cutoff, r.distance, distance);
    else
        exact_number(EXACT_CUTOFF, "within a cutoff", r.distance, pose->should, pair->size + distance);
}

static void check_manifold(exact_pair *pair, const exact_pose *pose) {
    static pir_contact contacts[ROOM];
    size_t count = 0;
    double scale = pair->size + fabs(pose->should), least = HUGE_VAL;
    pir_status status = pir_query_manifold(pair->query, &pose->input, &pose->answer, ROOM, contacts, &count);
    exact_check(EXACT_MANIFOLD, status == PIR_OK && count > 0, "manifold: status %d, %zu contacts", (int)status, count);
    for (size_t i = 0; status == PIR_OK && i < count; i++)
        least = fmin(least, contacts[i].distance);
    if (status == PIR_OK && count > 0)
        exact_number(EXACT_MANIFOLD, "least contact", least, pose->answer.distance, scale);
}

void exact_check_others(exact_pair *pair, test_random *random, const exact_pose *pose) {
    check_escapes(pair, pose, 0);
    check_escapes(pair, pose, pair->size * ldexp(1, -test_random_between(random, 1, 40)));
    check_farthest(pair, pose);
    check_rounded(pair, random, pose);
    check_cutoff(pair, random, pose);
    check_manifold(pair, pose);
}
