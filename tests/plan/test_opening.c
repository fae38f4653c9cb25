/* SPDX-License-Identifier: MIT */
/*
 * Walls whose holes are too narrow: the answers against what is known of windows, of gates by widths, and of boxes of
 * rotations. test_openings.py holds proofs against the checker, and lies about them.
 */
#include "gates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double uniform(double low, double high) {
    return low + (high - low) * rand() / RAND_MAX;
}

struct told {
    uint32_t calls, end;
};

static bool on_progress(void *context, uint32_t made, uint32_t written) {
    struct told *told = context;
    (void)made;
    (void)written;
    return ++told->calls != told->end;
}

/* Asks with openings, or with boxes alone; the text of the proof is from malloc. */
static pir_rigid_plan_info ask(const pir_rigid_plan_input *in, bool boxes_alone, uint32_t boxes, uint32_t threads,
                               uint32_t *calls, uint32_t end, char **ret_proof) {
    pir_rigid_plan_options options = pir_rigid_plan_options_default();
    pir_rigid_plan *plan = NULL;
    pir_rigid_plan_info info;
    struct told told = {0, end};
    size_t size = 0;
    *ret_proof = NULL;
    options.boxes_alone = boxes_alone;
    options.boxes = boxes;
    options.threads = threads;
    options.progress = on_progress;
    options.context = &told;
    options.proof = open_memstream(ret_proof, &size);
    assert_non_null(options.proof);
    assert_int_equal(pir_rigid_plan_create(in, &options, &plan), PIR_OK);
    fclose(options.proof);
    pir_rigid_plan_describe(plan, &info);
    pir_rigid_plan_destroy(plan);
    if (calls)
        *calls = told.calls;
    return info;
}

/* The tetrahedron of edge 1 before a thin plate of sectors about a window of corners on a circle. */
struct round_window {
    pir_solid *robot[1], *sector[24];
    pir_rigid_plan_input input;
};

static double moved(double x, bool is_moved) {
    return !is_moved || rand() % 3 == 0 ? x : nextafter(x, rand() % 2 ? 9 : -9);
}

/* With corners of each sector moved by an ulp, or not, such that some overlap and others leave slits. */
static void make_round(double diameter, bool is_moved, struct round_window *w) {
    const double e = sqrt(1. / 8), step = acos(-1) / 12;
    const pir_vec3 p[4] = {{e, e, e}, {e, -e, -e}, {-e, e, -e}, {-e, -e, e}};
    pir_polytope *shape = NULL;
    w->robot[0] = make_simplex(p);
    for (int i = 0; i < 24; i++) {
        pir_vec3 q[8];
        for (int k = 0; k < 8; k++) {
            // both sectors on a corner have it in the same doubles
            const double angle = step * ((i + (k & 1)) % 24), radius = k & 2 ? 3 : diameter / 2;
            q[k] = (pir_vec3){moved(radius * cos(angle), is_moved), moved(radius * sin(angle), is_moved),
                              moved(k & 4 ? 0x1p-20 : -0x1p-20, is_moved)};
        }
        assert_int_equal(pir_polytope_create(q, 8, NULL, &shape), PIR_OK);
        assert_int_equal(pir_solid_from_polytope(shape, NULL, &w->sector[i]), PIR_OK);
        pir_polytope_release(shape);
    }
    w->input = (pir_rigid_plan_input){.robot = (const pir_solid *const *)w->robot,
                                      .robot_count = 1,
                                      .obstacles = (const pir_solid *const *)w->sector,
                                      .obstacle_count = 24,
                                      .low = {-1, -1, -2},
                                      .high = {1, 1, 2},
                                      .from = {{0, 0, 0, 1}, {0, 0, -1.5}},
                                      .to = {{.3, -.2, .1, -.9}, {0, 0, 1.5}}};
}

static void release_round(struct round_window *w) {
    pir_solid_release(w->robot[0]);
    for (int i = 0; i < 24; i++)
        pir_solid_release(w->sector[i]);
}

/* No path through windows that the tetrahedron cannot pass, the same proof for any threads; a path through another. */
static void test_windows(void **state) {
    (void)state;
    const double diameter[] = {.2, .97, .5, .7, .8};
    const size_t cases = getenv("PIR_TEST_CASES") ? sizeof diameter / sizeof *diameter : 2;
    for (size_t i = 0; i < 2 * cases; i++) {
        struct round_window w;
        char *proof[2];
        const double d = diameter[i / 2];
        make_round(d, i % 2, &w);
        for (uint32_t k = 0; k < 2; k++) {
            const pir_rigid_plan_info info = ask(&w.input, false, 32768, k + 1, NULL, 0, &proof[k]);
            printf("window %g: answer %d, %u cells\n", d, (int)info.answer, info.cells);
            assert_int_equal(info.answer, d < .895 ? PIR_TURN_PLAN_NO_PATH : PIR_TURN_PLAN_PATH);
            assert_int_equal(info.boxes, 0);
            assert_int_equal(info.cells > 0, info.answer == PIR_TURN_PLAN_NO_PATH);
        }
        assert_string_equal(proof[0], proof[1]);
        free(proof[0]);
        free(proof[1]);
        release_round(&w);
    }
}

/* What is not decided with few cells is left to boxes, and progress may end it at any call. */
static void test_budgets(void **state) {
    (void)state;
    struct round_window w;
    uint32_t calls = 0, all;
    char *proof;
    make_round(.5, false, &w);
    pir_rigid_plan_info info = ask(&w.input, false, 32, 1, NULL, 0, &proof);
    assert_true(info.answer != PIR_TURN_PLAN_PATH && info.boxes >= 32 && info.cells > 0);
    free(proof);
    info = ask(&w.input, false, 4096, 1, &all, 0, &proof);
    assert_int_equal(info.answer, PIR_TURN_PLAN_NO_PATH);
    free(proof);
    for (uint32_t end = 1; end <= all; end += 1 + all / 4) {
        info = ask(&w.input, false, 4096, 1, &calls, end, &proof);
        assert_true(info.answer == PIR_TURN_PLAN_UNKNOWN && info.end == PIR_PLAN_END_CALLER && calls == end);
        free(proof);
    }
    release_round(&w);
}

/* Plates with no hole, two holes, and one that is not convex: boxes that a ball within the robot passes, or not. */
static void test_plates(void **state) {
    (void)state;
    // squares of a grid of 8 by 8 that are holes
    const struct {
        const char *holes[8];
        double half;  /* of a cube's edge, squares being 1 wide */
        bool is_open; /* whether it passes */
        bool has_cells;
    } plate[] = {{{"........", "........", "........", "........", "........", "........", "........", "........"},
                  .75,
                  false,
                  false},
                 {{"........", ".o......", "........", "........", "....o...", "........", "........", "........"},
                  .75,
                  false,
                  true},
                 {{"........", "...oo...", "...o....", "........", "........", "......o.", "........", "........"},
                  1.25,
                  false,
                  true},
                 {{"........", "..oo....", "..oo....", "........", "........", "......o.", "........", "........"},
                  .75,
                  true,
                  true}};
    for (size_t i = 0; i < sizeof plate / sizeof *plate; i++) {
        pir_solid *square[64], *robot[1];
        uint32_t squares = 0;
        char *proof;
        for (int y = 0; y < 8; y++)
            for (int x = 0; x < 8; x++)
                if (plate[i].holes[y][x] == '.')
                    square[squares++] = make_box((pir_vec3){x - 4, y - 4, -.25}, (pir_vec3){x - 3, y - 3, .25}, NULL);
        const double e = plate[i].half;
        robot[0] = make_box((pir_vec3){-e, -e, -e}, (pir_vec3){e, e, e}, NULL);
        const pir_rigid_plan_input in = {.robot = (const pir_solid *const *)robot,
                                         .robot_count = 1,
                                         .obstacles = (const pir_solid *const *)square,
                                         .obstacle_count = squares,
                                         .low = {-3, -3, -3},
                                         .high = {3, 3, 3},
                                         .from = {{0, 0, 0, 1}, {0, 0, 2}},
                                         .to = {{0, 0, 0, 1}, {1, 1, -2}}};
        const pir_rigid_plan_info info = ask(&in, false, 2048, 1, NULL, 0, &proof);
        printf("plate %zu: answer %d, %u cells\n", i, (int)info.answer, info.cells);
        assert_int_equal(info.answer == PIR_TURN_PLAN_NO_PATH, !plate[i].is_open);
        if (!plate[i].is_open)
            assert_true(info.boxes == 0 && (info.cells > 0) == plate[i].has_cells);
        free(proof);
        pir_solid_release(robot[0]);
        for (uint32_t k = 0; k < squares; k++)
            pir_solid_release(square[k]);
    }
}

/* Random gates: never no path where a box passes by translations, and never another answer than that of boxes. */
static void test_gates(void **state) {
    (void)state;
    const char *told = getenv("PIR_TEST_CASES");
    const int cases = told ? atoi(told) : 3;
    int count[3] = {0, 0, 0}, openings = 0;
    for (int i = 0; i < cases; i++) {
        const double a = uniform(.6, 2), b = uniform(a, 2.2), c = uniform(b, 2.4);
        const double width = uniform(.5, 2.4), length = uniform(width, 3);
        pir_solid *robot, *wall[4];
        pir_turn_plan_answer answer[2];
        char *proof;
        robot = make_box((pir_vec3){-c / 2, -a / 2, -b / 2}, (pir_vec3){c / 2, a / 2, b / 2}, NULL);
        const pir_rigid_plan_input in = make_gate_of(width, length, 3, &robot, wall, NULL);
        for (int k = 0; k < 2; k++) {
            const pir_rigid_plan_info info = ask(&in, k == 1, told ? 256 : 64, 1, NULL, 0, &proof);
            answer[k] = info.answer;
            openings += k == 0 && info.answer == PIR_TURN_PLAN_NO_PATH && info.boxes == 0;
            assert_false(info.answer == PIR_TURN_PLAN_NO_PATH && a < width && b < length);
            assert_false(info.answer == PIR_TURN_PLAN_PATH && a > width);
            free(proof);
        }
        printf("box %g x %g x %g, window %g x %g: %d %d\n", a, b, c, width, length, (int)answer[0], (int)answer[1]);
        assert_int_not_equal(answer[0] + answer[1], PIR_TURN_PLAN_PATH + PIR_TURN_PLAN_NO_PATH);
        count[answer[0]]++;
        pir_solid_release(robot);
        for (int k = 0; k < 4; k++)
            pir_solid_release(wall[k]);
    }
    printf("gates: %d unknown, %d paths, %d without, %d of these by openings\n", count[0], count[1], count[2],
           openings);
}

/* With the name of a file: writes a proof for check/openings.py, of a window. */
static int write_proof(const char *path) {
    struct round_window w;
    char *proof;
    make_round(.3, true, &w);
    FILE *file = fopen(path, "w");
    const pir_rigid_plan_info info = ask(&w.input, false, 4096, 1, NULL, 0, &proof);
    const bool is_good = file && info.answer == PIR_TURN_PLAN_NO_PATH && fputs(proof, file) >= 0;
    free(proof);
    release_round(&w);
    return (file && fclose(file) != 0) || !is_good;
}

int main(int count, char **words) {
    if (count > 1)
        return write_proof(words[1]);
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_windows), cmocka_unit_test(test_budgets),
                                       cmocka_unit_test(test_plates), cmocka_unit_test(test_gates)};
    const char *told = getenv("PIR_TEST_SEED");
    const unsigned seed = told ? (unsigned)atoi(told) : 1;
    srand(seed);
    printf("seed %u\n", seed);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
