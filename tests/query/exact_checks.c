/* SPDX-License-Identifier: MIT */
/* The checks of single queries at a pose: see exact_checks.h. */
#include "query/exact_checks.h"

#include <math.h>
#include <string.h>

#include "query/exact_report.h"

/* --- the tie rule --- */

/* The first facet by the tie rule, of those whose slacks tie exactly with the least. */
static uint32_t least_plane(const exact_pair *pair) {
    const oracle_place *o = pair->place;
    uint32_t deepest = oracle_place_deepest(o);
    double least = oracle_place_slack(o, deepest);
    for (uint32_t k = 0; k < o->plane_count; k++) {
        uint32_t i = pair->order[k];
        if (oracle_place_slack(o, i) <= least * (1 + 0x1p-40) && oracle_place_compare(o, i, deepest) == 0)
            return i;
    }
    return deepest;
}

/* --- ways to ask --- */

int exact_same_bits(const pir_query_result *a, const pir_query_result *b) {
    return a->state == b->state && a->outcome == b->outcome &&
           memcmp(&a->distance, &b->distance, sizeof a->distance) == 0 &&
           memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
           memcmp(&a->point_p, &b->point_p, sizeof a->point_p) == 0 &&
           memcmp(&a->point_q, &b->point_q, sizeof a->point_q) == 0 &&
           memcmp(&a->witness, &b->witness, sizeof a->witness) == 0;
}

static void expect_same_answer(const char *how, const pir_query_result *a, const pir_query_result *b) {
    exact_check(EXACT_CACHE, a->steps < 100000 && b->steps < 100000, "%s: %u and %u steps", how, a->steps, b->steps);
    exact_check(EXACT_CACHE, exact_same_bits(a, b),
                "%s: state %d %d, distance %.17g %.17g, normal (%.17g, %.17g, %.17g) (%.17g, %.17g, %.17g), point_p "
                "(%.17g, %.17g, %.17g) (%.17g, %.17g, %.17g), witness %d %u, %d %u and %d %u, %d %u",
                how, (int)a->state, (int)b->state, a->distance, b->distance, a->normal.x, a->normal.y, a->normal.z,
                b->normal.x, b->normal.y, b->normal.z, a->point_p.x, a->point_p.y, a->point_p.z, b->point_p.x,
                b->point_p.y, b->point_p.z, (int)a->witness.p.kind, a->witness.p.index, (int)a->witness.q.kind,
                a->witness.q.index, (int)b->witness.p.kind, b->witness.p.index, (int)b->witness.q.kind,
                b->witness.q.index);
}

static pir_query_cache some_cache(test_random *random) {
    uint32_t x[11];
    int small = (int)test_random_below(random, 2);
    for (int i = 0; i < 11; i++)
        x[i] = small ? test_random_below(random, 12) : (uint32_t)test_random_bits(random);
    return (pir_query_cache){.points = test_random_below(random, 5),
                             .p = {x[1], x[2], x[3]},
                             .q = {x[4], x[5], x[6]},
                             .pieces = test_random_below(random, 2),
                             .kind = test_random_below(random, 4),
                             .first = x[9],
                             .second = x[10]};
}

typedef pir_status ask(pir_query *, const pir_query_input *, pir_query_cache *, pir_query_result *);

static const struct {
    const char *name;
    ask *call;
} asks[4] = {{"signed distance", pir_query_signed_distance},
             {"penetration", pir_query_penetration},
             {"distance", pir_query_distance},
             {"overlap", pir_query_overlap}};

/*
 * Asks each query with no cache, with the caller's cache and with an arbitrary one, of a query object with a history
 * and of one without. All answers must be the same.
 */
static void ask_all_ways(exact_pair *pair, test_random *random, exact_pose *pose, pir_query_result *results) {
    for (int k = 0; k < 4; k++) {
        pir_query_result cold, other;
        pir_query_cache zero = {0}, any = some_cache(random);
        pir_status status = asks[k].call(pair->fresh, &pose->input, NULL, &cold);
        pose->limit |= status == PIR_ERR_LIMIT;
        exact_check(EXACT_STATE, status == PIR_OK || status == PIR_ERR_LIMIT, "%s: status %d", asks[k].name,
                    (int)status);
        if (status != PIR_OK)
            continue;
        results[k] = cold;
        asks[k].call(pair->query, &pose->input, &zero, &other);
        expect_same_answer(asks[k].name, &cold, &other);
        asks[k].call(pair->query, &pose->input, &pair->cache, &other);
        expect_same_answer(asks[k].name, &cold, &other);
        asks[k].call(pair->query, &pose->input, &any, &other);
        expect_same_answer(asks[k].name, &cold, &other);
    }
}

/* --- answers --- */

/* Checks what each call says of a state. */
static void check_outcome(const char *name, const pir_query_result *r, pir_state state) {
    static const pir_outcome outcome[3] = {PIR_SEPARATED, PIR_TOUCHING, PIR_OVERLAPPING};
    exact_check(EXACT_STATE, r->state == state && r->outcome == outcome[state],
                "%s: state %d and outcome %d, state %d is right", name, (int)r->state, (int)r->outcome, (int)state);
}

/* The error of a point. It is that of coordinates: of the bodies, of the translation, of the point itself. */
static void check_points(exact_pair *pair, const exact_pose *pose, const pir_query_result *r, uint32_t plane) {
    double largest = fmax(exact_largest(r->point_p), exact_largest(r->point_q)),
           coordinates = fmax(fmax(largest, pair->reach), exact_largest(pose->t));
    pir_vec3 end = exact_add(r->point_q, r->normal, r->distance), miss = exact_add(r->point_p, end, -1);
    exact_check(EXACT_RELATION, exact_length(miss) <= 0x1p-51 * fmax(largest, fabs(r->distance)) + 0x1p-1073,
                "point_p is not point_q + distance · normal by %.3g of coordinates", exact_length(miss) / largest);
    exact_check(EXACT_NORMAL, fabs(exact_length(r->normal) - 1) <= 4e-15, "the normal's length is 1 + %.3g",
                exact_length(r->normal) - 1);
    exact_contact contact = {.t = pose->t, .direction = pose->direction, .there = pose->t};
    contact.way = pose->state == PIR_INSIDE ? EXACT_TO_PLANE : EXACT_NEAREST;
    contact.plane = plane;
    exact_check_witness(pair, &contact, &r->witness, r->point_p, r->point_q,
                        0x1p-50 * coordinates + 1e-14 * pair->size);
}

/* Checks that a call without a number and points to give sets none. */
static int is_bare(const pir_query_result *r) {
    return r->distance == 0 && exact_largest(r->normal) == 0 && exact_largest(r->point_p) == 0 &&
           exact_largest(r->point_q) == 0 && r->witness.p.kind == PIR_FEATURE_NONE &&
           r->witness.q.kind == PIR_FEATURE_NONE;
}

static void check_apart(exact_pair *pair, exact_pose *pose, const pir_query_result *r) {
    oracle_nearest nearest = oracle_place_nearest(pair->place, NULL, NULL);
    double scale = pair->size + nearest.distance;
    exact_check(EXACT_ORACLE, nearest.apart, "outside of a half-space, but in the hull");
    pose->should = nearest.distance;
    exact_number(EXACT_DISTANCE, "signed distance", r[0].distance, nearest.distance, scale);
    // no point that is right can be nearer
    exact_number(EXACT_NORMAL, "separation's normal is off by",
                 exact_length(exact_add(r[0].normal, nearest.normal, -1)), 0, scale / nearest.distance);
    exact_check(EXACT_CACHE, exact_same_bits(&r[0], &r[2]), "signed distance is not distance");
    exact_check(EXACT_DEPTH, r[1].distance == 0, "penetration %.17g, not 0", r[1].distance);
    exact_check(EXACT_STATE, is_bare(&r[3]), "overlap tells more than the state");
    // a gap that counts as 0 in numbers, though not in the state
    if (nearest.distance > 0x1p-900 * pair->size)
        check_points(pair, pose, &r[0], 0);
}

static void check_inside(exact_pair *pair, exact_pose *pose, const pir_query_result *r) {
    uint32_t plane = least_plane(pair);
    double turn = exact_turn_from(&pair->place->plane[plane], r[0].normal);
    pose->should = -oracle_place_slack(pair->place, plane);
    exact_number(EXACT_DEPTH, "signed distance", r[0].distance, pose->should, pair->size);
    exact_check(EXACT_TIE, turn <= 4e-15,
                "depth's normal (%.17g, %.17g, %.17g) is %.3g off that of the least facet, of kind %u (%u, %u)",
                r[0].normal.x, r[0].normal.y, r[0].normal.z, turn, pair->rank[plane].kind, pair->rank[plane].first,
                pair->rank[plane].second);
    exact_check(EXACT_CACHE, exact_same_bits(&r[0], &r[1]), "signed distance is not penetration");
    exact_check(EXACT_DISTANCE, r[2].distance == 0, "distance %.17g, not 0", r[2].distance);
    exact_check(EXACT_STATE, is_bare(&r[3]), "overlap tells more than the state");
    check_points(pair, pose, &r[0], plane);
}

static void check_touching(exact_pair *pair, exact_pose *pose, const pir_query_result *r) {
    pose->should = 0;
    exact_check(EXACT_DISTANCE, r[0].distance == 0, "touching at %.17g, not 0", r[0].distance);
    exact_number(EXACT_NORMAL, "reach along the normal of touching", oracle_place_reach(pair->place, r[0].normal), 0,
                 pair->size);
    for (int k = 1; k < 4; k++)
        exact_check(EXACT_CACHE, exact_same_bits(&r[0], &r[k]), "signed distance is not %s", asks[k].name);
    check_points(pair, pose, &r[0], 0);
}

void exact_check_pose(exact_pair *pair, test_random *random, exact_pose *pose) {
    void (*const check[3])(exact_pair *, exact_pose *, const pir_query_result *) = {check_apart, check_touching,
                                                                                    check_inside};
    pir_query_result r[4];
    oracle_place_set(pair->place, pose->t, pose->direction);
    pose->state = oracle_place_state(pair->place);
    ask_all_ways(pair, random, pose, r);
    if (pose->limit) {
        exact_check(EXACT_STATE, exact_largest(pose->t) > 0x1p390 * pair->size, "refused as too far");
        return;
    }
    pose->answer = r[0];
    if (pose->state != PIR_OUTSIDE)
        exact_check(EXACT_ORACLE, !oracle_place_nearest(pair->place, NULL, NULL).apart,
                    "in no half-space's outside, but not in the hull");
    for (int k = 0; k < 4; k++)
        check_outcome(asks[k].name, &r[k], pose->state);
    check[pose->state](pair, pose, r);
}
