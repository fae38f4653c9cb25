/* SPDX-License-Identifier: MIT */
/*
 * Plans with turns by the public calls: a bar of two solids before a plate with a slot, wide enough or not at the
 * angles that it can have, and questions that are none. What the planner itself says is in test_turn_plan.c; here each
 * path is held against exact queries of the convex pieces, and answers against the slot's width.
 */
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/pirouette.h>

/* A box as a solid. */
static pir_solid *solid_box(pir_vec3 low, pir_vec3 high) {
    static const uint32_t sides[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    static const uint32_t starts[7] = {0, 4, 8, 12, 16, 20, 24};
    pir_vec3 p[8];
    pir_solid *solid = NULL;
    for (int i = 0; i < 8; i++)
        p[i] = (pir_vec3){i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
    const pir_solid_facets facets = {p, 8, starts, sides, 6};
    assert_int_equal(pir_solid_create(&facets, NULL, NULL, &solid), PIR_OK);
    return solid;
}

/* A plate about the plane z = 0 with a slot along y, and a bar along y in two halves. */
struct slot {
    pir_solid *robot[2], *wall[4];
    pir_turn_plan_input input;
};

static void make_slot(double width, double length, struct slot *s) {
    const double x = width / 2, y = length / 2;
    const pir_vec3 low[4] = {{-9, -9, -1}, {x, -9, -1}, {-x, -9, -1}, {-x, y, -1}},
                   high[4] = {{-x, 9, 1}, {9, 9, 1}, {x, -y, 1}, {x, 9, 1}};
    for (int i = 0; i < 4; i++)
        s->wall[i] = solid_box(low[i], high[i]);
    s->robot[0] = solid_box((pir_vec3){-.5, -2, -.5}, (pir_vec3){.5, .25, .5});
    s->robot[1] = solid_box((pir_vec3){-.5, -.25, -.5}, (pir_vec3){.5, 2, .5});
    s->input = (pir_turn_plan_input){.robot = (const pir_solid *const *)s->robot,
                                     .robot_count = 2,
                                     .obstacles = (const pir_solid *const *)s->wall,
                                     .obstacle_count = 4,
                                     .axis = {0, 0, 3},
                                     .low = {-4, -4, -4},
                                     .high = {4, 4, 4},
                                     .from = {0, 0, -3},
                                     .to = {0, 0, 3},
                                     .from_turn = .25,
                                     .to_turn = .3};
}

static void release_slot(struct slot *s) {
    for (int i = 0; i < 4; i++)
        pir_solid_release(s->wall[i]);
    for (int i = 0; i < 2; i++)
        pir_solid_release(s->robot[i]);
}

/* Whether the bar is free at a pose, exactly. */
static bool is_free(const struct slot *s, pir_vec3 at, double angle) {
    bool is = true;
    for (int i = 0; i < 8 && is; i++) {
        pir_pieces *p = NULL, *q = NULL;
        pir_solid_query *query = NULL;
        pir_workspace *workspace = NULL;
        pir_pair_input input = pir_pair_input_default();
        pir_state state;
        input.pose_p = (pir_pose){{0, 0, sin(angle / 2), cos(angle / 2)}, at};
        assert_int_equal(pir_solid_decompose(s->robot[i % 2], NULL, NULL, &p), PIR_OK);
        assert_int_equal(pir_solid_decompose(s->wall[i / 2], NULL, NULL, &q), PIR_OK);
        assert_int_equal(pir_solid_query_create(p, q, NULL, &query), PIR_OK);
        assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
        assert_int_equal(pir_solid_query_overlap(query, workspace, &input, &state), PIR_OK);
        is = state == PIR_OUTSIDE;
        pir_workspace_destroy(workspace);
        pir_solid_query_destroy(query);
        pir_pieces_destroy(p);
        pir_pieces_destroy(q);
    }
    return is;
}

static void check_path(const struct slot *s, const pir_turn_plan *plan, const pir_turn_plan_info *info) {
    pir_turn_plan_step step = {{0, 0, 0}, 0, 0}, last = step;
    for (uint32_t i = 0; i < info->steps; i++) {
        assert_int_equal(pir_turn_plan_get_step(plan, i, &step), PIR_OK);
        if (i == 0)
            assert_true(step.at.z == s->input.from.z);
        for (int k = 0; i > 0 && i % 8 == 0 && k < 3; k++) {
            const double part = .1 + .4 * k;
            const pir_vec3 at = {last.at.x + part * (step.at.x - last.at.x), last.at.y + part * (step.at.y - last.at.y),
                                 last.at.z + part * (step.at.z - last.at.z)};
            assert_true(is_free(s, at, k == 1 ? step.low : step.high));
        }
        last = step;
    }
    assert_true(step.at.z == s->input.to.z);
    assert_int_equal(pir_turn_plan_get_step(plan, info->steps, &step), PIR_ERR_ARGUMENT);
}

static void slots_are_passed_or_not(void **state) {
    (void)state;
    // the bar is 1 wide and 4 long; it fits through the third slot at one angle alone that arcs begin at
    const struct {
        double width, length;
        uint32_t arcs;
        pir_turn_plan_answer answer;
    } known[] = {{1.5, 4.5, 256, PIR_TURN_PLAN_PATH},
                 {.9, 4.5, 256, PIR_TURN_PLAN_NO_PATH},
                 {1.01, 4.04, 8, PIR_TURN_PLAN_PATH},
                 {1.5, 3.8, 256, PIR_TURN_PLAN_NO_PATH}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        struct slot s;
        pir_turn_plan *plan = NULL;
        pir_turn_plan_info info;
        pir_turn_plan_options options = pir_turn_plan_options_default();
        options.arcs = known[i].arcs;
        options.proof = tmpfile();
        assert_non_null(options.proof);
        make_slot(known[i].width, known[i].length, &s);
        assert_int_equal(pir_turn_plan_create(&s.input, &options, &plan), PIR_OK);
        pir_turn_plan_describe(plan, &info);
        printf("slot %g x %g: answer %d, %u arcs, %u parts, %u steps\n", known[i].width, known[i].length,
               (int)info.answer, info.arcs, info.parts, info.steps);
        assert_int_equal(info.answer, known[i].answer);
        assert_int_equal(info.robot_pieces, 2);
        assert_int_equal(info.obstacle_pieces, 4);
        assert_int_equal(info.steps > 0, info.answer == PIR_TURN_PLAN_PATH);
        assert_int_equal(ftell(options.proof) > 0, info.answer != PIR_TURN_PLAN_UNKNOWN);
        if (info.steps > 0)
            check_path(&s, plan, &info);
        assert_int_equal(fclose(options.proof), 0);
        pir_turn_plan_destroy(plan);
        release_slot(&s);
    }
}

/* Beside a cube that is small there is room for every turn: a path, whatever the turns are. */
static void a_body_with_room_turns(void **state) {
    (void)state;
    printf("seed 1\n");
    srand(1);
    for (int i = 0; i < 60; i++) {
        struct slot s;
        pir_turn_plan *plan = NULL;
        pir_turn_plan_info info;
        make_slot(1.5, 4.5, &s);
        for (int k = 0; k < 4; k++)
            pir_solid_release(s.wall[k]);
        for (int k = 0; k < 4; k++)
            s.wall[k] = solid_box((pir_vec3){-.5, -.5, -.5}, (pir_vec3){.5, .5, .5});
        s.input.obstacle_count = 1;
        s.input.from_turn = i % 3 == 0 ? rand() % 8 / 8. : rand() / (RAND_MAX + 1.);
        s.input.to_turn = i % 4 == 0 ? rand() % 8 / 8. : rand() / (RAND_MAX + 1.);
        assert_int_equal(pir_turn_plan_create(&s.input, NULL, &plan), PIR_OK);
        pir_turn_plan_describe(plan, &info);
        assert_int_equal(info.answer, PIR_TURN_PLAN_PATH);
        assert_true(info.arcs <= 16);
        check_path(&s, plan, &info);
        pir_turn_plan_destroy(plan);
        release_slot(&s);
    }
}

static void check_refused(const pir_turn_plan_input *input, const pir_turn_plan_options *options, pir_status status,
                          const char *says) {
    pir_report report = {0};
    pir_turn_plan *plan = NULL;
    pir_turn_plan_options how = options ? *options : pir_turn_plan_options_default();
    how.report = &report;
    assert_int_equal(pir_turn_plan_create(input, &how, &plan), status);
    assert_null(plan);
    assert_non_null(strstr(report.text, says));
}

static void questions_that_are_none(void **state) {
    (void)state;
    struct slot s;
    pir_turn_plan *plan = NULL;
    make_slot(1.5, 4.5, &s);
    const pir_turn_plan_input good = s.input;
    pir_turn_plan_input bad = good;
    assert_int_equal(pir_turn_plan_create(NULL, NULL, &plan), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_turn_plan_create(&good, NULL, NULL), PIR_ERR_ARGUMENT);
    bad.axis = (pir_vec3){0, 0, 0};
    check_refused(&bad, NULL, PIR_ERR_ARGUMENT, "axis");
    bad = good, bad.axis.y = NAN;
    check_refused(&bad, NULL, PIR_ERR_NOT_FINITE, "axis");
    bad = good, bad.from.x = INFINITY;
    check_refused(&bad, NULL, PIR_ERR_NOT_FINITE, "from");
    bad = good, bad.to.x = 5;
    check_refused(&bad, NULL, PIR_ERR_ARGUMENT, "to: it is outside");
    bad = good, bad.from_turn = 1;
    check_refused(&bad, NULL, PIR_ERR_ARGUMENT, "from_turn");
    bad = good, bad.to_turn = -.1;
    check_refused(&bad, NULL, PIR_ERR_ARGUMENT, "to_turn");
    bad = good, bad.to_turn = NAN;
    check_refused(&bad, NULL, PIR_ERR_NOT_FINITE, "turn");
    bad = good, bad.high.z = bad.low.z;
    check_refused(&bad, NULL, PIR_ERR_ARGUMENT, "bounds");
    bad = good, bad.robot_count = 0;
    check_refused(&bad, NULL, PIR_ERR_EMPTY, "robot");
    bad = good, bad.obstacles = NULL;
    check_refused(&bad, NULL, PIR_ERR_ARGUMENT, "NULL");
    bad = good, bad.to = (pir_vec3){3, 0, 0};
    check_refused(&bad, NULL, PIR_ERR_ARGUMENT, "meets an obstacle");
    pir_turn_plan_options options = pir_turn_plan_options_default();
    options.arcs = 100;
    check_refused(&good, &options, PIR_ERR_ARGUMENT, "arcs");
    for (int of_memory = 0; of_memory < 2; of_memory++) {
        pir_turn_plan_info info;
        options = pir_turn_plan_options_default();
        options.parts = of_memory ? options.parts : 50;
        options.memory = of_memory ? 80000 : options.memory;
        assert_int_equal(pir_turn_plan_create(&good, &options, &plan), PIR_OK);
        pir_turn_plan_describe(plan, &info);
        assert_int_equal(info.answer, PIR_TURN_PLAN_UNKNOWN);
        assert_int_equal(info.end, of_memory ? PIR_PLAN_END_MEMORY : PIR_PLAN_END_PARTS);
        pir_turn_plan_destroy(plan);
    }
    pir_turn_plan_destroy(NULL);
    release_slot(&s);
}

/* No crash and no hang, whatever is said. */
static void extremes_end(void **state) {
    (void)state;
    const double far[] = {1e17, 1e100, 1e300};
    for (int i = 0; i < 3; i++) {
        struct slot s;
        pir_turn_plan *plan = NULL;
        pir_turn_plan_options options = pir_turn_plan_options_default();
        options.arcs = 8;
        options.parts = 20000;
        make_slot(1.5, 4.5, &s);
        s.input.high.x = far[i];
        s.input.low.y = -far[i];
        s.input.axis = (pir_vec3){0, 0, far[i]};
        const pir_status status = pir_turn_plan_create(&s.input, &options, &plan);
        assert_true(status == PIR_OK || status == PIR_ERR_LIMIT);
        pir_turn_plan_destroy(plan);
        release_slot(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(slots_are_passed_or_not),
                                       cmocka_unit_test(a_body_with_room_turns),
                                       cmocka_unit_test(questions_that_are_none), cmocka_unit_test(extremes_end)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
