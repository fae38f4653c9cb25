/* SPDX-License-Identifier: MIT */
/*
 * A pair answers as a query on the difference does, bit for bit: state, outcome, distance, normal, points, witness and
 * contacts, at the poses of the property suite of exact answers, whose scenes are aligned, nearly aligned and
 * general by thirds, some of them of size 1e150 or 1e-150. The query is held against exact arithmetic by that
 * suite.
 *
 * Of each kind there is a pair that lives as long as its scene, so that its hints come from other poses, and one
 * that is new at each pose; at all levels, and with the highest level forced. Between two poses of the suite the
 * lasting pair is taken along a line, so that levels change by small motions.
 *
 * PIR_TEST_SCENES sets how many scenes there are, PIR_TEST_SCENE names one of them.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pair.h>

#include "query/exact_poses.h"
#include "query/query_of.h"
#include "support/answers.h"
#include "support/bodies.h"

#define TURNS 2
#define POSES 12
#define STEPS 4
#define ROOM  64

struct bench {
    uint64_t number;
    exact_scene scene;
    pir_polytope *p, *q;
    pir_sum *sum;
    pir_query *query;
    pir_pair *lasting, *whole;
    pir_workspace *workspace;
    uint64_t asked, by_whole, contacts;
};

typedef pir_status ask_pair(pir_pair *, pir_workspace *, const pir_pair_input *, pir_query_result *);
typedef pir_status ask_query(pir_query *, const pir_query_input *, pir_query_cache *, pir_query_result *);

static const struct {
    const char *name;
    ask_pair *pair;
    ask_query *query;
} calls[4] = {{"overlap", pir_pair_overlap, pir_query_overlap},
              {"distance", pir_pair_distance, pir_query_distance},
              {"penetration", pir_pair_penetration, pir_query_penetration},
              {"signed distance", pir_pair_signed_distance, pir_query_signed_distance}};

/* One pair against the answer of the query. */
static void check_pair(struct bench *bench, pir_pair *pair, const char *which, int call, const pir_pair_input *input,
                       const pir_query_result *expected) {
    pir_query_result result;
    pir_status status = calls[call].pair(pair, bench->workspace, input, &result);
    pir_vec3 t = input->pose_p.translation;
    pir_quat r = input->pose_p.rotation;
    expect(
        status == PIR_OK && test_same_result(&result, expected),
        "scene %llu (%s), %s pair, %s, rotation %.17g,%.17g,%.17g,%.17g, t %.17g,%.17g,%.17g, cutoff %g: status %d, "
        "level %d, state %d not %d, outcome %d not %d, distance %.17g not %.17g, witness %d %u %d %u not %d %u %d %u",
        (unsigned long long)bench->number, bench->scene.situation, which, calls[call].name, r.x, r.y, r.z, r.w, t.x,
        t.y, t.z, input->cutoff, (int)status, (int)pir_pair_level(pair), (int)result.state, (int)expected->state,
        (int)result.outcome, (int)expected->outcome, result.distance, expected->distance, result.witness.p.kind,
        result.witness.p.index, result.witness.q.kind, result.witness.q.index, expected->witness.p.kind,
        expected->witness.p.index, expected->witness.q.kind, expected->witness.q.index);
    bench->asked++;
    bench->by_whole += pir_pair_level(pair) == PIR_LEVEL_WHOLE;
}

/* The contacts of an answer: those of the query, bit for bit, on a workspace that may still be at the pose or not. */
static void check_contacts(struct bench *bench, pir_pair *pair, const char *which, const pir_pair_input *input,
                           const pir_query_result *answer) {
    pir_contact contacts[ROOM], expected[ROOM];
    size_t count = 0, expected_count = 0;
    pir_query_input asked = pir_query_input_default();
    asked.translation = input->pose_p.translation;
    asked.radius_p = input->radius_p;
    asked.radius_q = input->radius_q;
    asked.margin = input->margin;
    pir_status right = pir_query_manifold(bench->query, &asked, answer, ROOM, expected, &expected_count);
    pir_status status = pir_pair_manifold(pair, bench->workspace, input, answer, ROOM, contacts, &count);
    size_t written = expected_count < ROOM ? expected_count : ROOM, same = 0;
    while (same < written && contacts[same].id == expected[same].id &&
           memcmp(&contacts[same].point_p, &expected[same].point_p, 24) == 0 &&
           memcmp(&contacts[same].point_q, &expected[same].point_q, 24) == 0 &&
           memcmp(&contacts[same].distance, &expected[same].distance, 8) == 0)
        same++;
    expect(status == right && count == expected_count && same == written,
           "scene %llu (%s), %s pair: manifold with status %d not %d, %zu contacts not %zu, the first %zu alike",
           (unsigned long long)bench->number, bench->scene.situation, which, (int)status, (int)right, count,
           expected_count, same);
    bench->contacts += count;
}

static void check_pose(struct bench *bench, test_random *random, pir_quat rotation, pir_vec3 t, int fresh) {
    pir_pair_input input = pir_pair_input_default();
    pir_query_input asked = pir_query_input_default();
    input.pose_p = (pir_pose){rotation, t};
    asked.translation = t;
    if (test_random_below(random, 4) == 0)
        input.cutoff = asked.cutoff = bench->scene.scale * ldexp(1, test_random_between(random, -8, 3));
    if (test_random_below(random, 6) == 0) {
        input.radius_p = asked.radius_p = bench->scene.scale * ldexp(1, -test_random_between(random, 1, 8));
        input.radius_q = asked.radius_q = test_random_below(random, 2) ? input.radius_p : 0;
    }
    input.margin = test_random_below(random, 3) ? 0 : bench->scene.scale * ldexp(1, test_random_between(random, -8, 3));
    pir_pair *new_pair = NULL;
    if (fresh)
        assert_int_equal(pir_pair_create(bench->p, bench->q, NULL, &new_pair), PIR_OK);
    int first = (int)test_random_below(random, 4);
    for (int i = 0; i < (fresh ? 4 : 1); i++) {
        pir_query_result expected;
        int call = fresh ? (first + i) % 4 : 3;
        pir_status status = calls[call].query(bench->query, &asked, NULL, &expected);
        if (status == PIR_ERR_LIMIT)
            break;
        assert_int_equal(status, PIR_OK);
        check_pair(bench, bench->lasting, "lasting", call, &input, &expected);
        if (call == 3)
            check_contacts(bench, bench->lasting, "lasting", &input, &expected);
        if (fresh)
            check_pair(bench, new_pair, "new", call, &input, &expected);
        if (fresh && call == 3) {
            check_contacts(bench, bench->lasting, "lasting", &input, &expected);
            check_contacts(bench, new_pair, "new", &input, &expected);
        }
        if (i == 0)
            check_pair(bench, bench->whole, "whole", call, &input, &expected);
    }
    pir_pair_destroy(new_pair);
}

static void check_turn(struct bench *bench, test_random *random, pir_quat rotation, const oracle_place *place,
                       double size) {
    pir_vec3 last = {0, 0, 0};
    for (int i = 0; i < POSES; i++) {
        pir_vec3 t = exact_translation(random, place, size);
        for (int k = 1; k < STEPS && i > 0; k++) {
            double part = (double)k / STEPS;
            pir_vec3 between = {last.x + part * (t.x - last.x), last.y + part * (t.y - last.y),
                                last.z + part * (t.z - last.z)};
            check_pose(bench, random, rotation, between, 0);
        }
        check_pose(bench, random, rotation, t, 1);
        last = t;
    }
}

static void check_scene(struct bench *bench, uint64_t number) {
    test_random random = test_random_case("pairs and sums", number);
    bench->number = number;
    exact_scene_make(&random, number, &bench->scene);
    bench->p = test_polytope(&bench->scene.points_p);
    bench->q = test_polytope(&bench->scene.points_q);
    double size = test_size_of(bench->p) + test_size_of(bench->q);
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    assert_int_equal(pir_sum_create(bench->p, bench->q, bench->scene.rotation, &options, &bench->sum), PIR_OK);
    pir_status status = pir_query_create(bench->sum, &bench->query);
    pir_pair_options whole = pir_pair_options_default();
    whole.least = PIR_LEVEL_WHOLE;
    assert_int_equal(pir_pair_create(bench->p, bench->q, NULL, &bench->lasting), status);
    if (status == PIR_OK) {
        assert_int_equal(pir_pair_create(bench->p, bench->q, &whole, &bench->whole), PIR_OK);
        oracle_solid *p = oracle_solid_make(bench->p), *q = oracle_solid_make(bench->q);
        pir_quat rotation = bench->scene.rotation;
        for (int turn = 0; turn < TURNS; turn++) {
            oracle_place *place = oracle_place_make(p, q, rotation);
            assert_int_equal(pir_sum_rotate(bench->sum, rotation, PIR_METHOD_AUTO), PIR_OK);
            check_turn(bench, &random, rotation, place, size > 0 ? size : bench->scene.scale);
            oracle_place_free(place);
            rotation = exact_rotation(&random, &bench->scene);
        }
        oracle_solid_free(p);
        oracle_solid_free(q);
        pir_pair_destroy(bench->lasting);
        pir_pair_destroy(bench->whole);
        pir_query_destroy(bench->query);
    }
    pir_sum_destroy(bench->sum);
    pir_polytope_release(bench->p);
    pir_polytope_release(bench->q);
}

static void a_pair_answers_as_the_query_on_its_difference(void **state) {
    (void)state;
    const char *scenes = getenv("PIR_TEST_SCENES"), *one = getenv("PIR_TEST_SCENE");
    uint64_t count = scenes ? strtoull(scenes, NULL, 10) : 60;
    struct bench bench = {0};
    assert_int_equal(pir_workspace_create(NULL, &bench.workspace), PIR_OK);
    if (one)
        check_scene(&bench, strtoull(one, NULL, 10));
    else
        for (uint64_t number = 0; number < count; number++)
            check_scene(&bench, number);
    print_message("# %llu answers, %llu of them by the whole difference; %llu contacts\n",
                  (unsigned long long)bench.asked, (unsigned long long)bench.by_whole,
                  (unsigned long long)bench.contacts);
    pir_workspace_destroy(bench.workspace);
}

/*
 * P stands as it was made, with the quaternion (0, 0, 0, 1) or twice that, and Q is turned: the same bits, though the
 * one is taken as it comes and the other scaled, with GMP where numbers are close.
 */
static void a_body_that_stands_answers_by_any_multiple_of_its_quaternion(void **state) {
    (void)state;
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint64_t number = 0; number < 200; number++) {
        test_random random = test_random_case("standing", number);
        exact_scene scene;
        exact_scene_make(&random, number % 60, &scene);
        pir_polytope *p = test_polytope(&scene.points_p), *q = test_polytope(&scene.points_q);
        const double size = test_size_of(p) + test_size_of(q);
        pir_pair *pair[2] = {NULL, NULL};
        for (int k = 0; k < 2; k++)
            (void)pir_pair_create(p, q, NULL, &pair[k]);
        for (int i = 0; i < 20 && pair[0] && pair[1]; i++) {
            pir_pair_input input = pir_pair_input_default();
            pir_query_result result[2];
            pir_contact contact[2][ROOM];
            size_t count[2] = {0, 0};
            const pir_quat turn = i % 2 ? test_general_rotation(&random) : exact_rotation(&random, &scene);
            // of length 1, as most are, or as it comes
            const double n = sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + turn.w * turn.w);
            const double by = i % 4 == 1 ? 1 / n : 1;
            input.pose_q.rotation = (pir_quat){by * turn.x, by * turn.y, by * turn.z, by * turn.w};
            const pir_vec3 way = test_random_direction(&random);
            input.pose_q.translation = (pir_vec3){0.6 * size * way.x, 0.6 * size * way.y, 0.6 * size * way.z};
            for (int k = 0; k < 2; k++) {
                input.pose_p.rotation = (pir_quat){0, 0, 0, k + 1};
                assert_int_equal(pir_pair_signed_distance(pair[k], workspace, &input, &result[k]), PIR_OK);
                assert_int_equal(pir_pair_manifold(pair[k], workspace, &input, &result[k], ROOM, contact[k], &count[k]),
                                 PIR_OK);
            }
            assert_true(test_same_result(&result[0], &result[1]));
            assert_int_equal(count[0], count[1]);
            assert_memory_equal(contact[0], contact[1], count[0] * sizeof **contact);
        }
        for (int k = 0; k < 2; k++)
            pir_pair_destroy(pair[k]);
        pir_polytope_release(p);
        pir_polytope_release(q);
    }
    pir_workspace_destroy(workspace);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pair_answers_as_the_query_on_its_difference),
        cmocka_unit_test(a_body_that_stands_answers_by_any_multiple_of_its_quaternion),
    };
    return cmocka_run_group_tests_name("pairs and sums", tests, NULL, NULL);
}
