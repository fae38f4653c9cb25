/* SPDX-License-Identifier: MIT */
/*
 * Poses and motions answered for slices, against exact answers: those of differences made at each pose's rotation for
 * all, those of the brute oracle for some. PIR_TEST_POSES poses and PIR_TEST_MOTIONS motions are asked in all, at
 * levels up to PIR_TEST_LEVEL.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include "cspace/answer_world.h"
#include "oracle/place.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/turning.h"
#include "support/vectors.h"

static uint32_t number_of(const char *variable, uint32_t otherwise) {
    const char *text = getenv(variable);
    return text && *text ? (uint32_t)strtoul(text, NULL, 0) : otherwise;
}

static pir_grid *hopf(uint32_t level) {
    pir_grid *grid = NULL;
    assert_int_equal(pir_grid_hopf(level, NULL, &grid), PIR_OK);
    return grid;
}

/* The state by the brute oracle. */
static pir_state brute_state(answer_world *world, const pir_pose *pose) {
    pir_state most = PIR_OUTSIDE;
    for (uint32_t k = 0; k < world->robot_count; k++)
        for (uint32_t l = 0; l < world->obstacle_count; l++) {
            oracle_solid *p = oracle_solid_make(world->robot[k]), *q = oracle_solid_make(world->obstacle[l]);
            oracle_place *place = oracle_place_make(p, q, pose->rotation);
            oracle_place_set(place, pose->translation, test_zero);
            pir_state state = oracle_place_state(place);
            most = state > most ? state : most;
            oracle_place_free(place);
            oracle_solid_free(p);
            oracle_solid_free(q);
        }
    return most;
}

static pir_configuration classify(answer_world *world, const pir_pose *pose) {
    pir_configuration configuration;
    pir_report report = {0};
    double gap;
    pir_status status = pir_answers_classify(&world->answers, pose, PIR_WISH_PLACE, &report, &configuration, &gap);
    expect(status == PIR_OK && report.text[0] == '\0', "%s", report.text);
    return configuration;
}

static int is_right(pir_verdict verdict, pir_state state) {
    return verdict == (state == PIR_OUTSIDE ? PIR_VERDICT_FREE : PIR_VERDICT_BLOCKED);
}

/* What is wanted changes neither the verdict nor the pair of pieces; where all within the gap is free, it is so. */
static void check_wishes(answer_world *world, const pir_pose *pose, const pir_configuration *answer) {
    pir_configuration verdict, all;
    double none, gap;
    assert_int_equal(pir_answers_classify(&world->answers, pose, PIR_WISH_VERDICT, NULL, &verdict, &none), PIR_OK);
    assert_int_equal(pir_answers_classify(&world->answers, pose, PIR_WISH_GAP, NULL, &all, &gap), PIR_OK);
    assert_true(verdict.verdict == answer->verdict && all.verdict == answer->verdict);
    assert_true(verdict.place.robot == answer->place.robot && all.place.robot == answer->place.robot);
    assert_true(verdict.place.obstacle == answer->place.obstacle && all.place.obstacle == answer->place.obstacle);
    assert_true(all.place.slice == answer->place.slice && all.turn == answer->turn && gap >= 0);
    for (int k = 0; k < 6; k++) {
        pir_pose moved = *pose;
        double way = (k % 2 ? -1 : 1) * gap * (1 - 1e-12);
        moved.translation.x += k / 2 == 0 ? way : 0;
        moved.translation.y += k / 2 == 1 ? way : 0;
        moved.translation.z += k / 2 == 2 ? way : 0;
        assert_true(is_right(answer->verdict, answer_world_state(world, &moved)));
    }
}

static void ask_poses(int kind, uint32_t level, uint32_t count) {
    answer_world world;
    answer_world_init(&world, kind, hopf(level));
    uint32_t verdicts[3] = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        test_random random = test_random_case("poses", (uint64_t)kind << 32 | i);
        pir_pose pose = answer_world_pose(&world, &random);
        pir_configuration answer = classify(&world, &pose);
        pir_state state = answer_world_sum_state(&world, &pose);
        if (i % 50 == 0)
            assert_int_equal(brute_state(&world, &pose), state);
        check_wishes(&world, &pose, &answer);
        expect(is_right(answer.verdict, state), "world %d level %u pose %u: verdict %d, state %d", kind, level, i,
               (int)answer.verdict, (int)state);
        assert_true(!answer.on_grid && answer.place.slice < pir_grid_get_info(world.grid).count);
        double turn = pir_grid_turn(pose.rotation, pir_grid_rotation(world.grid, answer.place.slice));
        assert_true(answer.turn >= turn && answer.turn <= turn + 1e-6 + 0.02 * turn);
        verdicts[answer.verdict]++;
    }
    printf("# world %d, level %u: %u poses, %u free, %u blocked\n", kind, level, count, verdicts[PIR_VERDICT_FREE],
           verdicts[PIR_VERDICT_BLOCKED]);
    answer_world_finish(&world);
}

static void no_pose_is_answered_wrongly(void **state) {
    (void)state;
    const uint32_t most = number_of("PIR_TEST_LEVEL", 2);
    const uint32_t each = number_of("PIR_TEST_POSES", 900) / (WORLD_KINDS * (most + 1));
    for (int kind = 0; kind < WORLD_KINDS; kind++)
        for (uint32_t level = 0; level <= most; level++)
            ask_poses(kind, level, each);
}

/* At the rotations of the grid every pose has its exact state, whatever the length of the quaternion. */
static void rotations_of_the_grid_have_exact_states(void **state) {
    (void)state;
    uint32_t states[3] = {0, 0, 0};
    for (int kind = 0; kind < WORLD_KINDS; kind++) {
        answer_world world;
        pir_grid *grid = NULL;
        assert_int_equal(pir_grid_axis((pir_vec3){0, 0, 1}, 8, NULL, &grid), PIR_OK);
        answer_world_init(&world, kind, grid);
        for (uint32_t i = 0; i < 100; i++) {
            test_random random = test_random_case("on grid", (uint64_t)kind << 32 | i);
            pir_quat q = pir_grid_rotation(grid, test_random_below(&random, 8));
            double scale = test_random_scaled(&random, -300, 300);
            // an exact multiple: its factor a power of two or, where components are 0 and ±1, any
            double factor = i % 2 ? ldexp(1, (int)(i % 200) - 100) : 1;
            pir_pose pose = {{factor * q.x, factor * q.y, factor * q.z, factor * q.w}, {0, 0, 0}};
            if (i % 10 == 0)
                pose.rotation = (pir_quat){0, 0, i % 20 ? scale : 0, i % 20 ? 0 : scale};
            if (i % 3 == 0) {
                // touching, exactly: multiples of a quarter
                pose.translation = (pir_vec3){0.25 * test_random_between(&random, -8, 8),
                                              0.25 * test_random_between(&random, -8, 8), 0};
            } else {
                pir_quat kept = pose.rotation;
                pose = answer_world_pose(&world, &random);
                pose.rotation = kept;
            }
            pir_configuration answer = classify(&world, &pose);
            pir_state exact = answer_world_sum_state(&world, &pose);
            expect(answer.on_grid && answer.turn == 0, "world %d pose %u", kind, i);
            expect(answer.state == exact, "world %d pose %u: %d, exactly %d", kind, i, answer.state, exact);
            assert_true(is_right(answer.verdict, exact));
            states[exact]++;
        }
        // nearly a rotation of the grid is none
        pir_pose pose = {{0, 0, 0x1p-60, 1}, {100, 0, 0}};
        assert_false(classify(&world, &pose).on_grid);
        answer_world_finish(&world);
    }
    assert_true(states[PIR_OUTSIDE] > 50 && states[PIR_BOUNDARY] > 10 && states[PIR_INSIDE] > 50);
}

/* --- motions --- */

static pir_pose between(const pir_pose *a, const pir_pose *b, double time) {
    pir_quat p = a->rotation, q = b->rotation;
    double n = sqrt(p.x * p.x + p.y * p.y + p.z * p.z + p.w * p.w),
           m = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    double dot = (p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w) / (n * m), sign = dot < 0 ? -1 : 1;
    double angle = acos(fmin(1, fabs(dot))), s = sin(angle);
    double u = (s > 1e-9 ? sin((1 - time) * angle) / s : 1 - time) / n,
           v = sign * (s > 1e-9 ? sin(time * angle) / s : time) / m;
    return (pir_pose){{u * p.x + v * q.x, u * p.y + v * q.y, u * p.z + v * q.z, u * p.w + v * q.w},
                      test_add(test_add(test_zero, a->translation, 1 - time), b->translation, time)};
}

/* Whether some pose of the motion overlaps, by many samples. */
static int hits(answer_world *world, const pir_pose *from, const pir_pose *to, double until, int samples) {
    for (int k = 0; k <= samples; k++) {
        pir_pose pose = between(from, to, until * k / samples);
        if (answer_world_state(world, &pose) != PIR_OUTSIDE)
            return 1;
    }
    return 0;
}

/* The same by conservative advancement of each pair of pieces: 1 it hits, 0 it does not, −1 neither is known. */
static int advances_into(answer_world *world, const pir_pose *from, const pir_pose *to) {
    pir_quat p = from->rotation, q = to->rotation;
    // q·conj(p): its vector part is the axis in the frame that stands
    double x = -q.w * p.x + q.x * p.w - q.y * p.z + q.z * p.y, y = -q.w * p.y + q.y * p.w - q.z * p.x + q.x * p.z;
    double z = -q.w * p.z + q.z * p.w - q.x * p.y + q.y * p.x, w = q.x * p.x + q.y * p.y + q.z * p.z + q.w * p.w;
    double sign = w < 0 ? -1 : 1, angle = pir_grid_turn(p, q);
    const test_turning motion = {
        p, from->translation, test_add(to->translation, from->translation, -1), {sign * x, sign * y, sign * z}, angle};
    int found = 0;
    for (uint32_t k = 0; k < world->robot_count; k++)
        for (uint32_t l = 0; l < world->obstacle_count && found != 1; l++) {
            const pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = true};
            pir_sum *sum;
            pir_query *query;
            pir_impact result;
            assert_int_equal(pir_sum_create(world->robot[k], world->obstacle[l], p, &options, &sum), PIR_OK);
            assert_int_equal(pir_query_create(sum, &query), PIR_OK);
            assert_int_equal(test_impact(query, sum, &motion, 1e-9, &result), PIR_OK);
            found = result.outcome == PIR_CAST_START_INSIDE ? 1 : result.outcome == PIR_CAST_MISS ? found : -1;
            pir_query_destroy(query);
            pir_sum_destroy(sum);
        }
    return found;
}

static void check_motion(answer_world *world, const pir_pose *from, const pir_pose *to, const pir_cspace_motion *motion,
                         uint32_t number) {
    if (motion->verdict == PIR_VERDICT_FREE) {
        expect(!hits(world, from, to, 1, 60), "motion %u is called free", number);
        expect(number % 4 != 0 || advances_into(world, from, to) <= 0, "motion %u is called free", number);
        return;
    }
    assert_true(motion->from >= 0 && motion->from < motion->to && motion->to <= 1);
    // up to where it begins the motion is free
    if (motion->from > 0)
        expect(!hits(world, from, to, motion->from, 40), "motion %u up to %g", number, motion->from);
    if (motion->verdict == PIR_VERDICT_BLOCKED && !hits(world, from, to, 1, 60) && !hits(world, from, to, 1, 20000))
        expect(advances_into(world, from, to) != 0, "motion %u is called blocked", number);
}

static void no_motion_is_answered_wrongly(void **state) {
    (void)state;
    const uint32_t most = number_of("PIR_TEST_LEVEL", 2);
    const uint32_t each = number_of("PIR_TEST_MOTIONS", 90) / (WORLD_KINDS * (most + 1));
    for (int kind = 0; kind < WORLD_KINDS; kind++)
        for (uint32_t level = 0; level <= most; level++) {
            answer_world world;
            answer_world_init(&world, kind, hopf(level));
            uint32_t verdicts[3] = {0, 0, 0};
            for (uint32_t i = 0; i < each; i++) {
                test_random random = test_random_case("motions", (uint64_t)kind << 32 | i);
                pir_pose from = answer_world_pose(&world, &random), to = answer_world_pose(&world, &random);
                if (i % 3 == 0) // a short one
                    to = between(&from, &to, 0.05);
                if (i % 5 == 0) // without a turn, at a rotation of the grid
                    from.rotation = to.rotation =
                        pir_grid_rotation(world.grid, i % pir_grid_get_info(world.grid).count);
                pir_cspace_motion motion;
                pir_report report = {0};
                expect(pir_answers_segment(&world.answers, &from, &to, &report, &motion) == PIR_OK, "%s", report.text);
                check_motion(&world, &from, &to, &motion, i);
                verdicts[motion.verdict]++;
            }
            printf("# world %d, level %u: %u motions, %u free, %u blocked, %u unknown\n", kind, level, each,
                   verdicts[PIR_VERDICT_FREE], verdicts[PIR_VERDICT_BLOCKED], verdicts[PIR_VERDICT_UNKNOWN]);
            answer_world_finish(&world);
        }
}

/* A motion through a wall tells where it stops being free; one beside it is free. */
static void a_motion_tells_where(void **state) {
    (void)state;
    answer_world world;
    answer_world_init(&world, 0, hopf(2));
    pir_cspace_motion motion;
    pir_pose from = {{0, 0, 0, 1}, {-3, 0, 0}}, to = {{0, 0, 0, 1}, {3, 0, 0}};
    assert_int_equal(pir_answers_segment(&world.answers, &from, &to, NULL, &motion), PIR_OK);
    assert_int_equal(motion.verdict, PIR_VERDICT_BLOCKED);
    printf("# through a cube: not proven free from %.4f to %.4f\n", motion.from, motion.to);
    // two unit cubes meet at x = −1, a third of the way, and part at two thirds
    assert_true(motion.from <= 1.0 / 3 && motion.from > 0.29 && motion.to >= 2.0 / 3 && motion.to < 0.71);
    from.translation.y = to.translation.y = 1.5;
    assert_int_equal(pir_answers_segment(&world.answers, &from, &to, NULL, &motion), PIR_OK);
    assert_true(motion.verdict == PIR_VERDICT_FREE && motion.from == 0 && motion.to == 0);
    answer_world_finish(&world);
}

static void bad_poses_are_refused(void **state) {
    (void)state;
    answer_world world;
    answer_world_init(&world, 0, hopf(0));
    pir_configuration answer = {.turn = 7};
    pir_cspace_motion motion = {.from = 7};
    pir_report report = {0};
    double gap;
    const pir_pose good = {{0, 0, 0, 1}, {0, 0, 0}};
    const pir_pose bad[] = {{{0, 0, 0, 0}, {0, 0, 0}}, {{0, 0, NAN, 1}, {0, 0, 0}}, {{0, 0, 0, 1}, {0, INFINITY, 0}}};
    for (int k = 0; k < 3; k++) {
        pir_status expected = k == 0 ? PIR_ERR_ZERO_QUATERNION : PIR_ERR_NOT_FINITE;
        assert_int_equal(pir_answers_classify(&world.answers, &bad[k], PIR_WISH_PLACE, &report, &answer, &gap),
                         expected);
        assert_int_equal(report.status, expected);
        assert_int_equal(pir_answers_segment(&world.answers, &good, &bad[k], &report, &motion), expected);
        assert_int_equal(pir_answers_segment(&world.answers, &bad[k], &good, NULL, &motion), expected);
    }
    assert_true(answer.turn == 7 && motion.from == 7);
    // far away is free, near the largest double too
    const pir_pose far = {{1, 2, 3, 4}, {1e300, -1e300, 1e300}};
    assert_int_equal(classify(&world, &far).verdict, PIR_VERDICT_FREE);
    answer_world_finish(&world);
}

/* Memory that runs out at every n-th request: a status each time, and later the same answer as ever. */
static void no_memory_is_a_status(void **state) {
    (void)state;
    answer_world world;
    answer_world_init(&world, 3, hopf(1));
    test_random random = test_random_case("memory", 0);
    pir_pose pose = answer_world_pose(&world, &random);
    pir_configuration whole = classify(&world, &pose);
    uint32_t failures = 0;
    for (uint64_t n = 1;; n++) {
        test_memory memory = {.fail_at = n};
        pir_allocator allocator = test_allocator(&memory);
        pir_answers answers;
        pir_configuration answer;
        double gap;
        pir_status status = pir_answers_init(&answers, &world.answers.bodies, &allocator);
        if (status == PIR_OK)
            status = pir_answers_classify(&answers, &pose, PIR_WISH_GAP, NULL, &answer, &gap);
        if (status != PIR_OK) {
            assert_int_equal(status, PIR_ERR_MEMORY);
            failures++;
        } else {
            assert_true(answer.verdict == whole.verdict && answer.place.slice == whole.place.slice);
        }
        pir_answers_finish(&answers);
        assert_true(memory.blocks == 0 && !memory.wrong_size && !memory.overrun);
        if (status == PIR_OK)
            break;
    }
    assert_true(failures >= 4);
    answer_world_finish(&world);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_pose_is_answered_wrongly),   cmocka_unit_test(rotations_of_the_grid_have_exact_states),
        cmocka_unit_test(no_motion_is_answered_wrongly), cmocka_unit_test(a_motion_tells_where),
        cmocka_unit_test(bad_poses_are_refused),         cmocka_unit_test(no_memory_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
