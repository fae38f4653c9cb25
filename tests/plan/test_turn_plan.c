/* SPDX-License-Identifier: MIT */
/*
 * Plans that turn about an axis. A bar 4 by 1 by 1 before a plate with a slot goes through only where it turns, and
 * only where the slot is wider and longer than it; the slot lies across it, or at an angle that no arc begins at. A bar
 * of length l and width 1 in a corridor of width c with a square corner gets round it where l < 2 (1.414… c - 1), one
 * way.
 *
 * The oracle of paths asks exact queries of the bar itself, at random moments of each motion and turn.
 */
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <pirouette/pirouette.h>

#include "plan/turn_plan.h"

/* A box, turned about z. */
static pir_polytope *box(double turn, double x, double y, double z, double x1, double y1, double z1) {
    pir_vec3 p[8];
    pir_polytope *made = NULL;
    for (int i = 0; i < 8; i++) {
        const double u = i & 1 ? x1 : x, v = i & 2 ? y1 : y;
        p[i] = (pir_vec3){cos(turn) * u - sin(turn) * v, sin(turn) * u + cos(turn) * v, i & 4 ? z1 : z};
    }
    assert_int_equal(pir_polytope_create(p, 8, NULL, &made), PIR_OK);
    return made;
}

static void check_pose(const pir_plan_pieces *robot, const pir_plan_pieces *obstacles, const double t[3],
                       double angle) {
    pir_workspace *workspace = NULL;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint32_t l = 0; l < obstacles->count; l++) {
        pir_pair *pair = NULL;
        pir_query_result result;
        pir_pair_input input = pir_pair_input_default();
        input.pose_p = (pir_pose){{0, 0, sin(angle / 2), cos(angle / 2)}, {t[0], t[1], t[2]}};
        assert_int_equal(pir_pair_create(robot->at[0], obstacles->at[l], NULL, &pair), PIR_OK);
        assert_int_equal(pir_pair_overlap(pair, workspace, &input, &result), PIR_OK);
        assert_int_equal(result.state, PIR_OUTSIDE);
        pir_pair_destroy(pair);
    }
    pir_workspace_destroy(workspace);
}

static void check_path(const pir_turn_result *r, const pir_plan_pieces *robot, const pir_plan_pieces *obstacles) {
    for (uint32_t i = 1; i < r->steps; i++)
        for (int s = 0; s < 10; s++) {
            double t[3];
            const double part = rand() / (double)RAND_MAX, angle = rand() / (double)RAND_MAX;
            for (int k = 0; k < 3; k++)
                t[k] = r->step[i - 1].at[k] + part * (r->step[i].at[k] - r->step[i - 1].at[k]);
            check_pose(robot, obstacles, t, r->step[i].low + angle * (r->step[i].high - r->step[i].low));
        }
}

/* The file for proofs of no path, or NULL. */
static const char *proof;

static pir_turn_plan_answer ask(pir_turn_question *q, pir_polytope *bar, pir_polytope **wall, uint32_t walls) {
    uint32_t body[4] = {0, 0, 0, 0};
    const pir_plan_pieces robot = {.at = &bar, .body = body, .count = 1};
    const pir_plan_pieces obstacles = {.at = wall, .body = body, .count = walls};
    pir_turn_result r;
    const clock_t start = clock();
    q->robot = &robot;
    q->obstacles = &obstacles;
    q->proof = proof ? fopen(proof, "w") : NULL;
    assert_int_equal(pir_plan_turn(q, &r), PIR_OK);
    printf("answer %d, %u arcs, %u parts, %u steps, %.2f s\n", (int)r.answer, r.arcs, r.parts, r.steps,
           (double)(clock() - start) / CLOCKS_PER_SEC);
    assert_int_equal(r.end, r.answer == PIR_TURN_PLAN_UNKNOWN ? PIR_PLAN_END_BOXES : PIR_PLAN_END_DECIDED);
    check_path(&r, &robot, &obstacles);
    if (q->proof)
        assert_int_equal(fclose(q->proof), 0);
    free(r.step);
    for (uint32_t i = 0; i < walls; i++)
        pir_polytope_release(wall[i]);
    pir_polytope_release(bar);
    return r.answer;
}

static pir_turn_question question(uint32_t arcs) {
    return (pir_turn_question){.axis = {0, 0, 1}, .most_arcs = arcs, .most_parts = 2000000, .memory = (size_t)1 << 30};
}

/* The answer for a slot of a width and a length, along y but for a turn. */
static pir_turn_plan_answer slot(double turn, double width, double length, uint32_t arcs) {
    const double x = width / 2, y = length / 2;
    pir_polytope *wall[4] = {box(turn, -9, -9, -1, -x, 9, 1), box(turn, x, -9, -1, 9, 9, 1),
                             box(turn, -x, -9, -1, x, -y, 1), box(turn, -x, y, -1, x, 9, 1)};
    pir_turn_question q = question(arcs);
    for (int k = 0; k < 3; k++) {
        q.low[k] = -4;
        q.high[k] = 4;
    }
    q.from[2] = -3;
    q.to[2] = 3;
    printf("slot %g x %g turned by %g: ", width, length, turn);
    return ask(&q, box(0, -2, -.5, -.5, 2, .5, .5), wall, 4);
}

/* The answer for a bar of a length in a bent corridor of width 2. */
static pir_turn_plan_answer corridor(double length, double turn, uint32_t arcs) {
    pir_polytope *wall[3] = {box(0, -20, -20, -9, 0, 0, 9), box(0, -20, 2, -9, 9, 9, 9), box(0, 2, -20, -9, 9, 2, 9)};
    pir_turn_question q = question(arcs);
    const double low[3] = {-8, -8, -.1}, high[3] = {4, 4, .1}, from[3] = {-6, 1, 0}, to[3] = {1, -6, 0};
    for (int k = 0; k < 3; k++) {
        q.low[k] = low[k];
        q.high[k] = high[k];
        q.from[k] = from[k];
        q.to[k] = to[k];
    }
    q.to_turn = turn;
    printf("corridor, bar of %g, to %g: ", length, turn);
    return ask(&q, box(0, -length / 2, -.5, -.5, length / 2, .5, .5), wall, 3);
}

/* How near to the least that would do gaps are: a hundredth with PIR_TEST_CASES, else a tenth. */
static double gap(void) {
    return getenv("PIR_TEST_CASES") ? .01 : .1;
}

static void test_wide(void **state) {
    (void)state;
    assert_int_equal(slot(0, 1.5, 4.5, 256), PIR_TURN_PLAN_PATH);
    assert_int_equal(slot(0, 1.01, 4.04, 1024), PIR_TURN_PLAN_PATH);
    assert_int_equal(slot(.3, 1 + gap(), 4 + 4 * gap(), 4096), PIR_TURN_PLAN_PATH);
}

static void test_tight(void **state) {
    (void)state;
    assert_int_equal(slot(0, .7, 4.5, 256), PIR_TURN_PLAN_NO_PATH);
    assert_int_equal(slot(0, .99, 4.04, 1024), PIR_TURN_PLAN_NO_PATH);
    assert_int_equal(slot(.3, .99, 4.04, 1024), PIR_TURN_PLAN_NO_PATH);
    assert_int_equal(slot(.3, 1.01, 3.96, 1024), PIR_TURN_PLAN_NO_PATH);
}

static void test_corridor(void **state) {
    (void)state;
    const double longest = 2 * (2 * sqrt(2) - 1);
    assert_int_equal(corridor(longest * (1 - gap()), .75, 2048), PIR_TURN_PLAN_PATH);
    assert_int_equal(corridor(longest * (1 - gap()), .25, 2048), PIR_TURN_PLAN_NO_PATH);
    assert_int_equal(corridor(longest * (1 + gap()), .75, 2048), PIR_TURN_PLAN_NO_PATH);
}

static void test_budget(void **state) {
    (void)state;
    assert_int_equal(slot(.3, 1.01, 4.04, 8), PIR_TURN_PLAN_UNKNOWN);
}

/* Whether a slot lets the bar through: at some angle between them it fits. */
static bool fits(double width, double length) {
    for (int i = 0; i <= 100000; i++) {
        const double a = i * 1.5707963267948966e-5;
        if (4 * sin(a) + cos(a) < width && 4 * cos(a) + sin(a) < length)
            return true;
    }
    return false;
}

/* Random slots, at random angles: what is decided is right. PIR_TEST_CASES of them. */
static void test_gates(void **state) {
    (void)state;
    const char *told = getenv("PIR_TEST_CASES");
    const int cases = told ? atoi(told) : 10;
    int count[3] = {0, 0, 0};
    for (int i = 0; i < cases; i++) {
        const double turn = 3 * (rand() / (double)RAND_MAX), width = .8 + 2 * (rand() / (double)RAND_MAX);
        const double length = 3.2 + 1.5 * (rand() / (double)RAND_MAX);
        const pir_turn_plan_answer answer = slot(turn, width, length, 64);
        count[answer]++;
        if (answer != PIR_TURN_PLAN_UNKNOWN)
            assert_int_equal(answer == PIR_TURN_PLAN_PATH, fits(width, length));
    }
    printf("gates: %d unknown, %d paths, %d without\n", count[0], count[1], count[2]);
}

/* With the name of a file: writes a proof for check/turns.py. */
int main(int count, char **words) {
    if (count == 2) {
        proof = words[1];
        return slot(.3, .99, 4.04, 64) != PIR_TURN_PLAN_NO_PATH;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_wide), cmocka_unit_test(test_tight),
                                       cmocka_unit_test(test_corridor), cmocka_unit_test(test_budget),
                                       cmocka_unit_test(test_gates)};
    srand(1);
    printf("seed 1\n");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
