/* SPDX-License-Identifier: MIT */
/*
 * A pair in smooth motion answers as a query on the difference does, bit for bit, whatever its hints, surfaces and
 * proofs of earlier frames are. P turns by steps from 2 radians to 10^-4 about an axis that changes, and hovers about
 * contact, deep in Q at times. By thirds the bodies are in general position, on a grid, or boxes that spin on one
 * another or sink into one another aligned. With both bodies moved along, a pair answers as one that is new in each
 * frame.
 *
 * PIR_TEST_SCENES sets how many motions there are, PIR_TEST_SCENE names one of them.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pair.h>

#include "support/answers.h"
#include "support/bodies.h"

#define FRAMES 60
#define ROOM   64

struct motion {
    uint64_t number;
    pir_polytope *p, *q;
    pir_sum *sum;
    pir_query *query;
    pir_pair *pair, *near;    /* without and with a cutoff */
    pir_pair *lasting, *anew; /* both bodies being posed */
    pir_workspace *workspace;
    double size;
};

/* What all motions together have used. */
static pir_pair_statistics used;
static uint64_t inside_by_facet, apart;

/* One answer counts once, by a way of its level. */
static void expect_counted(const pir_pair *pair, const pir_pair_statistics *before) {
    const pir_pair_statistics now = pir_pair_get_statistics(pair);
    const uint64_t proof = now.by_proof - before->by_proof, walk = now.by_walk - before->by_walk,
                   nearest = now.by_nearest - before->by_nearest, depth = now.by_depth - before->by_depth,
                   whole = now.by_whole - before->by_whole;
    const pir_level level = pir_pair_level(pair);
    assert_int_equal(now.queries, before->queries + 1);
    assert_true(now.supports - before->supports < 10000 && now.begun - before->begun < 100);
    // facets of a surface tell of bodies that are near as well
    bool is_near = level == PIR_LEVEL_NEAR, is_deep = level == PIR_LEVEL_OVERLAPPING;
    expect(proof == (level == PIR_LEVEL_APART) && whole == (level == PIR_LEVEL_WHOLE) && walk + nearest <= is_near &&
               walk + nearest + depth == (is_near || is_deep),
           "level %d: proof %llu, walk %llu, nearest %llu, depth %llu, whole %llu", (int)level,
           (unsigned long long)proof, (unsigned long long)walk, (unsigned long long)nearest, (unsigned long long)depth,
           (unsigned long long)whole);
}

static bool same_contact(const pir_contact *a, const pir_contact *b) {
    return a->id == b->id && memcmp(&a->distance, &b->distance, 8) == 0 && memcmp(&a->point_p, &b->point_p, 24) == 0 &&
           memcmp(&a->point_q, &b->point_q, 24) == 0;
}

/* The pair with a cutoff and its contacts, the sum being there. */
static void check_near(struct motion *motion, int frame, pir_pair_input input) {
    pir_query_input asked = pir_query_input_default();
    pir_query_result result, expected;
    pir_contact contacts[ROOM], right[ROOM];
    size_t count = 0, right_count = 0, same = 0;
    asked.translation = input.pose_p.translation;
    asked.cutoff = input.cutoff = asked.margin = input.margin = motion->size * (frame % 7 ? 0.02 : 0.1);
    assert_int_equal(pir_query_signed_distance(motion->query, &asked, NULL, &expected), PIR_OK);
    const pir_pair_statistics before = pir_pair_get_statistics(motion->near);
    pir_status status = pir_pair_signed_distance(motion->near, motion->workspace, &input, &result);
    expect_counted(motion->near, &before);
    expect(status == PIR_OK && test_same_result(&result, &expected),
           "motion %llu, frame %d, with a cutoff: status %d, level %d, outcome %d not %d, distance %.17g not %.17g",
           (unsigned long long)motion->number, frame, (int)status, (int)pir_pair_level(motion->near),
           (int)result.outcome, (int)expected.outcome, result.distance, expected.distance);
    status = pir_pair_manifold(motion->near, motion->workspace, &input, &result, ROOM, contacts, &count);
    pir_status of_query = pir_query_manifold(motion->query, &asked, &expected, ROOM, right, &right_count);
    while (same < count && same < ROOM && same < right_count && same_contact(&contacts[same], &right[same]))
        same++;
    expect(status == of_query && count == right_count && (same == count || same == ROOM),
           "motion %llu, frame %d: %zu contacts, not %zu, the first %zu alike", (unsigned long long)motion->number,
           frame, count, right_count, same);
}

static size_t contacts_of(struct motion *motion, pir_pair *pair, const pir_pair_input *input, pir_query_result *result,
                          pir_contact *contacts) {
    size_t count = 0;
    assert_int_equal(pir_pair_signed_distance(pair, motion->workspace, input, result), PIR_OK);
    pir_status status = pir_pair_manifold(pair, motion->workspace, input, result, ROOM, contacts, &count);
    assert_true(status == PIR_OK || status == PIR_ERR_LIMIT);
    return count;
}

/* Q turns as well, far from the origin in one motion of four. */
static void check_posed(struct motion *motion, int frame, pir_pair_input input) {
    pir_query_result result, expected;
    pir_contact contacts[ROOM], right[ROOM];
    double far = motion->number % 4 ? 1 : 1e5, angle = 1e-3 * frame;
    const pir_pose common = {{0.3, sin(angle), -0.2, 1}, {far * motion->size, -motion->size, 1e-4 * frame}};
    input.pose_p = pir_pose_compose(common, input.pose_p);
    input.pose_q = common;
    input.cutoff = motion->size;
    input.margin = motion->number % 2 ? 0 : 0.02 * motion->size;
    assert_int_equal(pir_pair_reset(motion->anew, motion->p, motion->q), PIR_OK);
    size_t right_count = contacts_of(motion, motion->anew, &input, &expected, right), same = 0;
    size_t count = contacts_of(motion, motion->lasting, &input, &result, contacts);
    while (same < count && same < ROOM && same < right_count && same_contact(&contacts[same], &right[same]))
        same++;
    expect(
        test_same_result(&result, &expected) && count == right_count && (same == count || same == ROOM),
        "motion %llu, frame %d, posed: level %d, distance %.17g not %.17g, %zu contacts, not %zu, the first %zu alike",
        (unsigned long long)motion->number, frame, (int)pir_pair_level(motion->lasting), result.distance,
        expected.distance, count, right_count, same);
}

static void check_frame(struct motion *motion, int frame, pir_quat rotation, pir_vec3 t) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_input asked = pir_query_input_default();
    pir_query_result result, expected;
    input.pose_p = (pir_pose){rotation, t};
    asked.translation = t;
    assert_int_equal(pir_sum_rotate(motion->sum, rotation, PIR_METHOD_AUTO), PIR_OK);
    assert_int_equal(pir_query_signed_distance(motion->query, &asked, NULL, &expected), PIR_OK);
    const pir_pair_statistics before = pir_pair_get_statistics(motion->pair);
    pir_status status = pir_pair_signed_distance(motion->pair, motion->workspace, &input, &result);
    inside_by_facet += pir_pair_get_statistics(motion->pair).by_walk > before.by_walk && expected.state == PIR_INSIDE;
    expect_counted(motion->pair, &before);
    expect(status == PIR_OK && test_same_result(&result, &expected),
           "motion %llu, frame %d: status %d, level %d, state %d not %d, distance %.17g not %.17g, witness %d %u %d %u "
           "not "
           "%d %u %d %u",
           (unsigned long long)motion->number, frame, (int)status, (int)pir_pair_level(motion->pair), (int)result.state,
           (int)expected.state, result.distance, expected.distance, result.witness.p.kind, result.witness.p.index,
           result.witness.q.kind, result.witness.q.index, expected.witness.p.kind, expected.witness.p.index,
           expected.witness.q.kind, expected.witness.q.index);
    check_near(motion, frame, input);
    check_posed(motion, frame, input);
}

static pir_vec3 middle_of(const pir_polytope *p) {
    pir_vec3 low, high;
    pir_polytope_bounds(p, &low, &high);
    return (pir_vec3){0.5 * (low.x + high.x), 0.5 * (low.y + high.y), 0.5 * (low.z + high.z)};
}

static pir_vec3 along(pir_vec3 from, double by, pir_vec3 d) {
    return (pir_vec3){from.x + by * d.x, from.y + by * d.y, from.z + by * d.z};
}

/* v turned by a quaternion of length 1: v + 2w (u × v) + 2 u × (u × v). */
static pir_vec3 turned(pir_quat q, pir_vec3 v) {
    pir_vec3 u = {q.x, q.y, q.z}, c = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    pir_vec3 e = {u.y * c.z - u.z * c.y, u.z * c.x - u.x * c.z, u.x * c.y - u.y * c.x};
    return along(along(v, 2 * q.w, c), 2, e);
}

/* How far out along d from the place `from`, where P and Q are one over the other, P touches Q. */
static double contact_along(const struct motion *motion, pir_quat rotation, pir_vec3 from, pir_vec3 d) {
    double far = 8 * motion->size;
    pir_query_input input = pir_query_input_default();
    pir_query_result result;
    input.translation = along(from, far, d);
    assert_int_equal(pir_sum_rotate(motion->sum, rotation, PIR_METHOD_AUTO), PIR_OK);
    pir_vec3 back = {-d.x, -d.y, -d.z};
    assert_int_equal(pir_query_directional_distance(motion->query, &input, back, &result), PIR_OK);
    return far - result.distance;
}

static pir_quat turn_about(pir_vec3 axis, double angle) {
    double s = sin(angle / 2);
    return (pir_quat){axis.x * s, axis.y * s, axis.z * s, cos(angle / 2)};
}

static pir_vec3 unit(pir_vec3 v) {
    double by = 1 / sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return (pir_vec3){v.x * by, v.y * by, v.z * by};
}

/* P turns about an axis that changes, and hovers about contact by up to `depth` of the size. */
static void hover(struct motion *motion, test_random *random, double step, double depth) {
    pir_quat start = test_random_below(random, 2) ? test_general_rotation(random) : test_integer_rotation(random);
    pir_quat rotation = test_compose(start, (pir_quat){0, 0, 0, 1}, 1);
    pir_vec3 axis = test_random_direction(random), d = test_random_direction(random),
             way = test_random_direction(random);
    for (int i = 0; i < FRAMES; i++) {
        if (i % 20 == 0)
            axis = test_random_direction(random);
        rotation = test_compose(turn_about(axis, step), rotation, 1);
        double drift = fmin(step, 0.3), wave = sin(6.283185307179586 * i / 20);
        d = unit((pir_vec3){d.x + drift * way.x, d.y + drift * way.y, d.z + drift * way.z});
        pir_vec3 from = along(middle_of(motion->q), -1, turned(rotation, middle_of(motion->p)));
        double at = contact_along(motion, rotation, from, d) + depth * motion->size * (i % 10 == 0 ? 0 : wave);
        check_frame(motion, i, rotation, along(from, at, d));
    }
}

/* Boxes of integers: P spins on top of Q, or slides over it aligned, at a height that changes every few frames. */
static void rest(struct motion *motion, test_random *random, double step) {
    pir_vec3 low, high, from, to;
    pir_polytope_bounds(motion->p, &low, &high);
    pir_polytope_bounds(motion->q, &from, &to);
    bool spins = test_random_below(random, 2);
    double height = 0, x = 0.125 * (double)test_random_between(random, -8, 8), y = 0.25;
    for (int i = 0; i < FRAMES; i++) {
        if (i % 12 == 0)
            height = ldexp((double)test_random_between(random, -2, 1), -(int)test_random_below(random, 40));
        x += spins ? 0 : ldexp(1, -5);
        pir_quat rotation = spins ? turn_about((pir_vec3){0, 0, 1}, step * i) : (pir_quat){0, 0, 0, 1};
        check_frame(motion, i, rotation, (pir_vec3){x, y, to.z - low.z + height});
    }
}

static void make_bodies(struct motion *motion, test_random *random) {
    test_points points;
    const test_body general[] = {TEST_SPHERE, TEST_BALL, TEST_SPHERE},
                    grid[] = {TEST_GRID, TEST_OCTAHEDRON, TEST_PRISM};
    pir_polytope **made[2] = {&motion->p, &motion->q};
    for (int k = 0; k < 2; k++) {
        uint64_t which = test_random_below(random, 3);
        test_body body = motion->number % 3 == 0 ? general[which] : motion->number % 3 == 1 ? grid[which] : TEST_BOX;
        do {
            test_body_points(random, body, (size_t)test_random_between(random, 8, 60), &points);
            *made[k] = test_polytope(&points);
            if (pir_polytope_dimension(*made[k]) < 3)
                pir_polytope_release(*made[k]), *made[k] = NULL;
        } while (!*made[k]);
    }
}

static void check_motion(uint64_t number) {
    test_random random = test_random_case("pairs in motion", number);
    struct motion motion = {.number = number};
    make_bodies(&motion, &random);
    pir_vec3 low, high, from, to;
    pir_polytope_bounds(motion.p, &low, &high);
    pir_polytope_bounds(motion.q, &from, &to);
    motion.size = fmax(fmax(high.x - low.x, to.x - from.x), fmax(high.z - low.z, to.z - from.z));
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    assert_int_equal(pir_sum_create(motion.p, motion.q, (pir_quat){0, 0, 0, 1}, &options, &motion.sum), PIR_OK);
    assert_int_equal(pir_query_create(motion.sum, &motion.query), PIR_OK);
    assert_int_equal(pir_pair_create(motion.p, motion.q, NULL, &motion.pair), PIR_OK);
    assert_int_equal(pir_pair_create(motion.p, motion.q, NULL, &motion.near), PIR_OK);
    assert_int_equal(pir_pair_create(motion.p, motion.q, NULL, &motion.lasting), PIR_OK);
    assert_int_equal(pir_pair_create(motion.p, motion.q, NULL, &motion.anew), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &motion.workspace), PIR_OK);
    double step = pow(10, -4 + 4.3 * test_random_unit(&random));
    if (number % 3 == 2 && test_random_below(&random, 2))
        rest(&motion, &random, step);
    else
        hover(&motion, &random, step, 0.3 * test_random_unit(&random));
    pir_pair_statistics s = pir_pair_get_statistics(motion.pair);
    used.queries += s.queries;
    used.by_walk += s.by_walk;
    used.by_nearest += s.by_nearest;
    used.by_depth += s.by_depth;
    used.supports += s.supports;
    apart += pir_pair_get_statistics(motion.near).by_proof;
    pir_pair_destroy(motion.pair);
    pir_pair_destroy(motion.near);
    pir_pair_destroy(motion.lasting);
    pir_pair_destroy(motion.anew);
    pir_workspace_destroy(motion.workspace);
    pir_query_destroy(motion.query);
    pir_sum_destroy(motion.sum);
    pir_polytope_release(motion.p);
    pir_polytope_release(motion.q);
}

static void a_pair_in_motion_answers_as_the_sum(void **state) {
    (void)state;
    const char *one = getenv("PIR_TEST_SCENE"), *count = getenv("PIR_TEST_SCENES");
    uint64_t from = one ? strtoull(one, NULL, 10) : 0, motions = one ? 1 : count ? strtoull(count, NULL, 10) : 120;
    for (uint64_t i = from; i < from + motions; i++)
        check_motion(i);
    print_message("%llu frames: %llu by a walk, %llu of them inside, %llu by nearest points, %llu by depths; "
                  "%llu apart\n",
                  (unsigned long long)used.queries, (unsigned long long)used.by_walk,
                  (unsigned long long)inside_by_facet, (unsigned long long)used.by_nearest,
                  (unsigned long long)used.by_depth, (unsigned long long)apart);
    // every way must have been taken often
    assert_true(one || (used.by_walk > used.queries / 5 && inside_by_facet > used.queries / 50 &&
                        used.by_nearest > used.queries / 50 && used.by_depth > used.queries / 50 &&
                        apart > used.queries / 20));
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_pair_in_motion_answers_as_the_sum)};
    return cmocka_run_group_tests_name("pairs in motion", tests, NULL, NULL);
}
