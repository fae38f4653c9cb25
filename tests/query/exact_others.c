/* SPDX-License-Identifier: MIT */
/* Checks of escapes, the largest distance, radii, cutoff and the manifold: see exact_checks.h. */
#include <math.h>
#include <string.h>

#include "query/exact_checks.h"
#include "query/exact_report.h"

#define ROOM 4096

/* Whether an escape is that of a plane: witness, normal, depth. */
static int is_escape(const exact_pair *pair, const pir_escape *escape, uint32_t i) {
    const oracle_plane *plane = &pair->place->plane[i];
    const exact_body *p = &pair->body[PIR_OPERAND_P], *q = &pair->body[PIR_OPERAND_Q];
    return exact_same_feature(p, escape->witness.p, exact_feature_of(p, plane->p)) &&
           exact_same_feature(q, escape->witness.q, exact_feature_of(q, plane->q)) &&
           exact_turn_from(plane, escape->normal) <= 4e-14 &&
           fabs(escape->depth - oracle_place_slack(pair->place, i)) <= 1e-12 * pair->size;
}

/*
 * Checks that the escapes are all planes within the slack, each once, in the order of the tie rule. Planes within
 * `doubtful` of the limit, times the size, may be there or not.
 */
static void check_list(const exact_pair *pair, double most, const pir_escape *escapes, size_t count) {
    const oracle_place *o = pair->place;
    double doubtful = 0x1p-43 * pair->size;
    size_t next = 0;
    for (uint32_t k = 0; k < o->plane_count; k++) {
        uint32_t i = pair->order[k];
        double slack = oracle_place_slack(o, i);
        if (slack > most + doubtful)
            continue;
        if (next < count && is_escape(pair, &escapes[next], i))
            next++;
        else
            exact_check(EXACT_ESCAPES, slack > most - doubtful,
                        "escape %zu of %zu is not the facet of kind %u (%u, %u), normal (%g, %g, %g) and depth %.17g",
                        next, count, pair->rank[i].kind, pair->rank[i].first, pair->rank[i].second, o->plane[i].near[0],
                        o->plane[i].near[1], o->plane[i].near[2], slack);
    }
    exact_check(EXACT_ESCAPES, next == count, "%zu of %zu escapes are facets within %.17g, in order", next, count,
                most);
}

static void check_escapes(exact_pair *pair, const exact_pose *pose, double slack) {
    static pir_escape escapes[ROOM];
    size_t count = 0;
    pir_status status = pir_query_escapes(pair->query, &pose->input, slack, ROOM, escapes, &count);
    exact_check(EXACT_ESCAPES, status == PIR_OK, "escapes: status %d", (int)status);
    if (status != PIR_OK || count > ROOM)
        return;
    exact_check(EXACT_ESCAPES, pose->state == PIR_INSIDE || count == 0, "%zu escapes in state %d", count,
                (int)pose->state);
    oracle_place_set(pair->place, pose->t, (pir_vec3){0, 0, 0});
    if (pose->state == PIR_INSIDE)
        check_list(pair, -pose->should + slack, escapes, count);
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
    exact_check_holds(pair, PIR_OPERAND_P, r.witness.p, r.point_p, pose->t, tolerance);
    exact_check_holds(pair, PIR_OPERAND_Q, r.witness.q, r.point_q, pose->t, tolerance);
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

static double from_body(exact_pair *pair, const exact_pose *pose, pir_operand operand, pir_vec3 point) {
    return exact_distance_from(pair, operand, NULL, point, pose->t, 0x1p-50 * pair->reach) / pair->size;
}

/* Checks a manifold: the first contact is the answer, no other is nearer or deeper, and all lie on the bodies. */
static void check_manifold(exact_pair *pair, test_random *random, const exact_pose *pose) {
    static pir_contact contacts[ROOM];
    size_t count = 0;
    pir_query_input input = pose->input;
    const pir_query_result *r = &pose->answer;
    double largest = fmax(pair->reach, exact_largest(pose->t)), least = HUGE_VAL;
    input.margin = test_random_below(random, 2) ? 0 : pair->size * ldexp(1, -test_random_between(random, 0, 20));
    pir_status status = pir_query_manifold(pair->query, &input, r, ROOM, contacts, &count);
    exact_check(EXACT_MANIFOLD, status == PIR_OK && count > 0, "manifold: status %d, %zu contacts", (int)status, count);
    if (status != PIR_OK || count == 0)
        return;
    exact_check(EXACT_MANIFOLD,
                contacts[0].distance == r->distance &&
                    memcmp(&contacts[0].point_p, &r->point_p, sizeof r->point_p) == 0,
                "the first contact, at %.17g, is not the answer, at %.17g", contacts[0].distance, r->distance);
    for (size_t i = 0; i < count; i++) {
        const pir_contact *c = &contacts[i];
        double tolerance = 1e-12 + 0x1p-49 * largest / pair->size,
               off_p = from_body(pair, pose, PIR_OPERAND_P, c->point_p),
               off_q = from_body(pair, pose, PIR_OPERAND_Q, c->point_q);
        exact_check(EXACT_MANIFOLD, fmax(off_p, off_q) <= tolerance,
                    "contact %zu of %zu, at %.17g, is %.3g of the size off P and %.3g off Q", i, count, c->distance,
                    off_p, off_q);
        pir_vec3 end = exact_add(c->point_q, r->normal, c->distance);
        double miss = exact_length(exact_add(c->point_p, end, -1)) / (pair->size + fabs(pose->should));
        exact_check(EXACT_MANIFOLD, miss <= tolerance,
                    "contact %zu of %zu: point_p is %.3g of the size off point_q + distance · normal", i, count, miss);
        least = fmin(least, c->distance);
    }
    exact_number(EXACT_MANIFOLD, "least contact", least, r->distance, pair->size + fabs(pose->should));
}

void exact_check_others(exact_pair *pair, test_random *random, const exact_pose *pose) {
    check_escapes(pair, pose, 0);
    check_escapes(pair, pose, pair->size * ldexp(1, -test_random_between(random, 1, 40)));
    check_farthest(pair, pose);
    check_rounded(pair, random, pose);
    check_cutoff(pair, random, pose);
    check_manifold(pair, random, pose);
}
