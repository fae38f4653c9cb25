/* SPDX-License-Identifier: MIT */
/*
 * What queries refuse: every call with every input that it cannot take. The status of a refusal names the fault, and
 * all results stay as they were.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <pirouette/query.h>

#include "query/query_of.h"
#include "support/queries.h"
#include "support/turning.h"

static const pir_quat still = {0, 0, 0, 1};
static const pir_vec3 right = {1, 0, 0};

struct scene {
    pir_polytope *cube;
    pir_sum *sum;
    pir_query *query;
};

static struct scene make_scene(void) {
    struct scene scene;
    pir_vec3 points[8];
    for (int i = 0; i < 8; i++)
        points[i] = (pir_vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
    assert_int_equal(pir_polytope_create(points, 8, NULL, &scene.cube), PIR_OK);
    test_query_make(scene.cube, scene.cube, still, &scene.sum, &scene.query);
    return scene;
}

static void clear_scene(struct scene *scene) {
    test_query_free(scene->query, scene->sum);
    pir_polytope_release(scene->cube);
}

/* The call ends with this status, and changes no result. */
static void expect_refusal(const test_query_kind *kind, const test_question *q, pir_status right_status, int number) {
    test_answer answer, before;
    memset(&answer, 0x5a, sizeof answer);
    before = answer;
    pir_status status = kind->ask(q, &answer);
    expect(status == right_status, "%s, input %d: status %d, not %d", kind->name, number, (int)status,
           (int)right_status);
    assert_memory_equal(&answer, &before, sizeof before);
}

static void every_call_refuses_what_is_no_placement(void **state) {
    (void)state;
    struct scene s = make_scene();
    const struct {
        pir_query_input input;
        pir_status status;
    } cases[] = {
        {{{NAN, 0, 0}, 0, 0, HUGE_VAL, 0}, PIR_ERR_NOT_FINITE},
        {{{0, NAN, 0}, 0, 0, HUGE_VAL, 0}, PIR_ERR_NOT_FINITE},
        {{{0, 0, -HUGE_VAL}, 0, 0, 1, 0}, PIR_ERR_NOT_FINITE},
        {{{0, 0, 0}, NAN, 0, HUGE_VAL, 0}, PIR_ERR_NOT_FINITE},
        {{{0, 0, 0}, 0, NAN, HUGE_VAL, 0}, PIR_ERR_NOT_FINITE},
        {{{0, 0, 0}, 0, 0, NAN, 0}, PIR_ERR_NOT_FINITE},
        {{{0, 0, 0}, -1e-300, 0, HUGE_VAL, 0}, PIR_ERR_ARGUMENT},
        {{{0, 0, 0}, 0, -1, HUGE_VAL, 0}, PIR_ERR_ARGUMENT},
        {{{0, 0, 0}, HUGE_VAL, 0, HUGE_VAL, 0}, PIR_ERR_ARGUMENT},
        {{{0, 0, 0}, 0, HUGE_VAL, 1, 0}, PIR_ERR_ARGUMENT},
        {{{1e200, 0, 0}, 0, 0, HUGE_VAL, 0}, PIR_ERR_LIMIT},
        {{{0, 0, -1e200}, 0, 0, HUGE_VAL, 0}, PIR_ERR_LIMIT},
    };
    pir_query_input good = pir_query_input_default();
    for (const test_query_kind *kind = test_query_kinds; kind->name; kind++) {
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
            expect_refusal(kind, &(test_question){s.query, &cases[i].input, NULL, right}, cases[i].status, (int)i);
        expect_refusal(kind, &(test_question){NULL, &good, NULL, right}, PIR_ERR_ARGUMENT, -1);
        expect_refusal(kind, &(test_question){s.query, NULL, NULL, right}, PIR_ERR_ARGUMENT, -2);
        const test_question question = {s.query, &good, NULL, right};
        assert_int_equal(kind->ask(&question, NULL), PIR_ERR_ARGUMENT);
        test_answer answer;
        assert_int_equal(kind->ask(&question, &answer), PIR_OK);
    }
    clear_scene(&s);
}

static void directions_have_a_length_and_are_finite(void **state) {
    (void)state;
    struct scene s = make_scene();
    const pir_vec3 wrong[3] = {{NAN, 1, 0}, {1, -HUGE_VAL, 0}, {0, 0, HUGE_VAL}};
    pir_query_input places[3] = {pir_query_input_default(), pir_query_input_default(), pir_query_input_default()};
    places[1].translation = (pir_vec3){2, 0, 0};
    places[2].translation = (pir_vec3){5, 0, 0};
    for (int i = 0; i < 3; i++) {
        const test_question none = {s.query, &places[i], NULL, {0, -0.0, 0}};
        for (const test_query_kind *kind = test_query_kinds; kind->name; kind++) {
            for (int k = 0; k < 3 && kind->traits & TEST_DIRECTED; k++)
                expect_refusal(kind, &(test_question){s.query, &places[i], NULL, wrong[k]}, PIR_ERR_NOT_FINITE, k);
            if (kind->traits & TEST_LENGTH)
                expect_refusal(kind, &none, PIR_ERR_ARGUMENT, 3);
        }
        // a motion may be none
        pir_impact cast;
        const pir_cast_outcome outcome[3] = {PIR_CAST_START_INSIDE, PIR_CAST_RECEDING, PIR_CAST_AT_REST};
        assert_int_equal(pir_query_cast(s.query, none.input, none.direction, &cast), PIR_OK);
        assert_int_equal(cast.outcome, outcome[i]);
    }
    clear_scene(&s);
}

static void escapes_have_room_and_a_slack(void **state) {
    (void)state;
    struct scene s = make_scene();
    pir_query_input input = pir_query_input_default();
    pir_escape escape, before;
    size_t count = 77;
    memset(&escape, 0x5a, sizeof escape);
    before = escape;
    const double slacks[3] = {-1, -1e-300, NAN};
    for (int i = 0; i < 3; i++)
        assert_int_equal(pir_query_escapes(s.query, &input, slacks[i], 1, &escape, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_escapes(s.query, &input, 0, 1, NULL, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_escapes(s.query, &input, 0, 1, &escape, NULL), PIR_ERR_ARGUMENT);
    assert_true(count == 77);
    assert_memory_equal(&escape, &before, sizeof before);
    assert_int_equal(pir_query_escapes(s.query, &input, 0, 0, NULL, &count), PIR_OK);
    assert_int_equal(count, 6);
    clear_scene(&s);
}

static void batches_with_what_is_refused_write_nothing(void **state) {
    (void)state;
    struct scene s = make_scene();
    const pir_vec3 wrong[2] = {{0, NAN, 0}, {1e200, 0, 0}};
    const pir_status status[2] = {PIR_ERR_NOT_FINITE, PIR_ERR_LIMIT};
    for (int i = 0; i < 2; i++) {
        pir_vec3 t[3] = {{0, 0, 1.5}, wrong[i], {9, 0, 0}};
        double numbers[3] = {7, 7, 7}, more[3] = {7, 7, 7};
        const pir_state unset = (pir_state)9;
        pir_state states[3][3] = {{unset, unset, unset}, {unset, unset, unset}, {unset, unset, unset}};
        assert_int_equal(pir_query_batch_states(s.query, t, 3, states[0]), status[i]);
        assert_int_equal(pir_query_batch_depths(s.query, t, 3, numbers, states[1]), status[i]);
        assert_int_equal(pir_query_batch_distances(s.query, t, 3, more, states[2]), status[i]);
        for (int k = 0; k < 3; k++) {
            assert_true(states[k][0] == unset && states[k][1] == unset && states[k][2] == unset);
            assert_true(numbers[k] == 7 && more[k] == 7);
        }
    }
    double number;
    pir_state place;
    assert_int_equal(pir_query_batch_states(NULL, &right, 1, &place), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_batch_states(s.query, NULL, 1, &place), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_batch_states(s.query, &right, 1, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_batch_depths(s.query, &right, 1, NULL, &place), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_batch_distances(s.query, NULL, 1, &number, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_batch_distances(s.query, NULL, 0, &number, NULL), PIR_OK);
    clear_scene(&s);
}

static void advances_refuse_what_is_no_motion(void **state) {
    (void)state;
    struct scene s = make_scene();
    const test_turning good = {
        .rotation = still, .start = {5, 0, 0}, .motion = {-4, 0, 0}, .axis = {0, 0, 1}, .angle = 1};
    test_turning wrong[6] = {good, good, good, good, good, good};
    wrong[0].start.y = NAN;
    wrong[1].motion.z = HUGE_VAL;
    wrong[2].axis.x = NAN;
    wrong[3].angle = NAN;
    wrong[4].angle = 0x1p21;
    wrong[5].rotation = (pir_quat){0, 0, 0, 0};
    pir_impact cast, before;
    memset(&cast, 0x5a, sizeof cast);
    before = cast;
    for (int i = 0; i < 6; i++) {
        pir_status status = test_impact(s.query, s.sum, &wrong[i], 0.1, &cast);
        expect(i < 4 ? status == PIR_ERR_NOT_FINITE : status != PIR_OK && status != PIR_ERR_NOT_FINITE,
               "motion %d: status %d", i, (int)status);
    }
    const double tolerances[4] = {0, -1, HUGE_VAL, NAN};
    for (int i = 0; i < 4; i++)
        assert_int_equal(test_impact(s.query, s.sum, &good, tolerances[i], &cast),
                         i < 3 ? PIR_ERR_ARGUMENT : PIR_ERR_NOT_FINITE);
    pir_motion motion = test_motion(&good);
    const pir_query_input input = pir_query_input_default();
    assert_int_equal(pir_query_time_of_impact(NULL, &input, &motion, 0.1, &cast), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_time_of_impact(s.query, NULL, &motion, 0.1, &cast), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_time_of_impact(s.query, &input, NULL, 0.1, &cast), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_time_of_impact(s.query, &input, &motion, 0.1, NULL), PIR_ERR_ARGUMENT);
    motion.held = -1;
    assert_int_equal(pir_query_time_of_impact(s.query, &input, &motion, 0.1, &cast), PIR_ERR_ARGUMENT);
    motion.held = NAN;
    assert_int_equal(pir_query_time_of_impact(s.query, &input, &motion, 0.1, &cast), PIR_ERR_NOT_FINITE);
    assert_memory_equal(&cast, &before, sizeof before);
    // no axis is needed where nothing turns
    test_turning plain = good;
    plain.angle = 0;
    plain.axis = (pir_vec3){0, 0, 0};
    assert_int_equal(test_impact(s.query, s.sum, &plain, 1e-9, &cast), PIR_OK);
    // 5 − 4t = 2
    assert_true(cast.outcome == PIR_CAST_HIT && fabs(cast.time - 0.75) < 1e-9);
    clear_scene(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_call_refuses_what_is_no_placement),
        cmocka_unit_test(directions_have_a_length_and_are_finite),
        cmocka_unit_test(escapes_have_room_and_a_slack),
        cmocka_unit_test(batches_with_what_is_refused_write_nothing),
        cmocka_unit_test(advances_refuse_what_is_no_motion),
    };
    return cmocka_run_group_tests_name("refusals", tests, NULL, NULL);
}
