/* SPDX-License-Identifier: MIT */
/*
 * Poses and motions asked of files: the answers are those of the bodies without a file, many at once those of
 * one by one, and files that were cut short or changed are refused or answer rightly.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cspace/answer/piece_ball.h"
#include "cspace/answer_world.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/vectors.h"

/* HDF5 does not free all that it has made of a broken file. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libhdf5";
}

static char folder[] = "classify-XXXXXX";

static const char *path_of(const char *name) {
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static pir_cspace *open_file(const char *name) {
    pir_cspace *cspace = NULL;
    pir_report report = {0};
    expect(pir_cspace_open(path_of(name), NULL, &report, &cspace) == PIR_OK, "%s", report.text);
    return cspace;
}

static pir_grid *make_grid(int which) {
    pir_grid *grid = NULL;
    pir_quat list[12];
    test_random random = test_random_case("list", 0);
    for (int i = 0; i < 12; i++) {
        pir_vec3 v = test_random_direction(&random);
        list[i] = (pir_quat){v.x, v.y, v.z, 3 * test_random_unit(&random)};
    }
    pir_status status = which == 0   ? pir_grid_axis((pir_vec3){1, 1, 0}, 40, NULL, &grid)
                        : which == 1 ? pir_grid_hopf(0, NULL, &grid)
                                     : pir_grid_list(list, 12, 0, NULL, &grid);
    assert_int_equal(status, PIR_OK);
    return grid;
}

/* Every field of an answer, but what padding holds. */
static int same_answer(const pir_configuration *a, const pir_configuration *b) {
    return a->verdict == b->verdict && a->place.robot == b->place.robot && a->place.obstacle == b->place.obstacle &&
           a->place.slice == b->place.slice && a->on_grid == b->on_grid && a->state == b->state && a->turn == b->turn;
}

/* Bodies as long as a ball is wide, with most vertices at one end: the ball around them is hardly wider. */
static void balls_around_pieces_are_hardly_wider_than_their_bodies(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 50; i++) {
        test_random random = test_random_case("balls", i);
        test_points points = {.count = 30};
        for (size_t k = 0; k < points.count; k++) {
            const pir_vec3 d = test_random_direction(&random);
            points.at[k] = (pir_vec3){k == 0 ? -10 : 10 + d.x, d.y, d.z};
        }
        pir_polytope *body = test_polytope(&points);
        const pir_piece_ball ball = pir_piece_ball_of(body);
        double farthest = 0, widest = 0;
        for (uint32_t v = 0; v < pir_polytope_vertex_count(body); v++) {
            const pir_vec3 a = pir_polytope_vertex(body, v);
            farthest = fmax(farthest, hypot(a.x - ball.centre.x, hypot(a.y - ball.centre.y, a.z - ball.centre.z)));
            for (uint32_t w = 0; w < v; w++) {
                const pir_vec3 b = pir_polytope_vertex(body, w);
                widest = fmax(widest, hypot(a.x - b.x, hypot(a.y - b.y, a.z - b.z)));
            }
        }
        expect(farthest <= ball.radius * (1 + 1e-15) && ball.radius < 1.1 * widest / 2,
               "body %llu: radius %g, vertices up to %g from the centre and %g from each other", (unsigned long long)i,
               ball.radius, farthest, widest);
        pir_polytope_release(body);
    }
}

static void a_file_answers_as_the_bodies_do(void **state) {
    (void)state;
    for (int kind = 0; kind < WORLD_KINDS; kind++) {
        answer_world world;
        answer_world_init(&world, kind, make_grid(kind % 3));
        answer_world_write(&world, path_of("whole.h5"));
        pir_cspace *cspace = open_file("whole.h5");
        const uint64_t count = pir_cspace_get_info(cspace).grid.count;
        for (uint32_t i = 0; i < 60; i++) {
            test_random random = test_random_case("file", (uint64_t)kind << 32 | i);
            pir_pose from = answer_world_pose(&world, &random), to = answer_world_pose(&world, &random);
            if (i % 4 == 0)
                from.rotation = pir_grid_rotation(world.grid, test_random_below(&random, (uint32_t)count));
            pir_configuration bodies, file;
            pir_report report = {0};
            double gap;
            assert_int_equal(pir_answers_classify(&world.answers, &from, PIR_WISH_PLACE, NULL, &bodies, &gap), PIR_OK);
            expect(pir_cspace_classify(cspace, &from, &report, &file) == PIR_OK, "%s", report.text);
            expect(same_answer(&bodies, &file), "world %d pose %u", kind, i);
            assert_int_equal(file.verdict, answer_world_sum_state(&world, &from) == PIR_OUTSIDE ? PIR_VERDICT_FREE
                                                                                                : PIR_VERDICT_BLOCKED);
            if (i % 20 != 0)
                continue;
            pir_cspace_motion of_bodies, of_file;
            assert_int_equal(pir_answers_segment(&world.answers, &from, &to, NULL, &of_bodies), PIR_OK);
            expect(pir_cspace_segment(cspace, &from, &to, &report, &of_file) == PIR_OK, "%s", report.text);
            assert_true(of_bodies.verdict == of_file.verdict && of_bodies.from == of_file.from &&
                        of_bodies.to == of_file.to);
        }
        pir_cspace_destroy(cspace);
        answer_world_finish(&world);
    }
}

/* --- many poses --- */

#define MANY 400

/* Poses as rows of 9 doubles: a number that is none of a pose's, the translation, another such, the quaternion. */
typedef struct pose_rows {
    double row[MANY][9];
} pose_rows;

static pir_pose_array rows_of(const pose_rows *rows) {
    return (pir_pose_array){&rows->row[0][5], sizeof rows->row[0], &rows->row[0][1], sizeof rows->row[0], false};
}

static void make_rows(answer_world *world, int kind, pose_rows *rows, pir_pose poses[MANY]) {
    const uint32_t count = (uint32_t)pir_grid_get_info(world->grid).count;
    for (uint32_t i = 0; i < MANY; i++) {
        test_random random = test_random_case("many", (uint64_t)kind << 32 | i);
        poses[i] = answer_world_pose(world, &random);
        if (i % 4 == 0)
            poses[i].rotation = pir_grid_rotation(world->grid, test_random_below(&random, count));
        if (i % 40 == 7)
            poses[i].rotation = (pir_quat){0, 0, 0, 0};
        if (i % 40 == 21)
            poses[i].translation.y = i % 80 == 21 ? NAN : INFINITY;
        memcpy(&rows->row[i][5], &poses[i].rotation, sizeof poses[i].rotation);
        memcpy(&rows->row[i][1], &poses[i].translation, sizeof poses[i].translation);
        rows->row[i][0] = rows->row[i][4] = NAN;
    }
}

/* Each answer is that of the pose alone, a bad one is told by its index, and what is wanted changes nothing. */
static void many_poses_are_single_answers(void **state) {
    (void)state;
    static pose_rows rows;
    static pir_pose poses[MANY];
    static uint8_t verdict[MANY], alone[MANY], status[MANY], exact[MANY], on_grid[MANY];
    static uint32_t robot[MANY], obstacle[MANY];
    static uint64_t slice[MANY];
    static double turn[MANY];
    const pir_cspace_arrays all = {verdict, status, exact, on_grid, robot, obstacle, slice, turn};
    for (int kind = 0; kind < WORLD_KINDS; kind++) {
        answer_world world;
        answer_world_init(&world, kind, make_grid(kind % 3));
        answer_world_write(&world, path_of("whole.h5"));
        pir_cspace *many = open_file("whole.h5"), *single = open_file("whole.h5");
        make_rows(&world, kind, &rows, poses);
        const pir_pose_array array = rows_of(&rows);
        pir_pair_batch_summary summary;
        pir_report report = {0};
        assert_int_equal(pir_cspace_classify_many(many, &array, MANY, &all, &report, &summary), PIR_OK);
        assert_true(summary.bad == 20 && summary.first_bad == 7 && summary.first_status == PIR_ERR_ZERO_QUATERNION);
        for (uint32_t i = 0; i < MANY; i++) {
            pir_configuration one;
            const pir_status is = pir_cspace_classify(single, &poses[i], NULL, &one);
            assert_int_equal(status[i], is);
            if (is != PIR_OK) {
                assert_true(verdict[i] == PIR_POSE_BAD && exact[i] == PIR_POSE_BAD && isnan(turn[i]) && !on_grid[i]);
                continue;
            }
            const pir_configuration told = {
                (pir_verdict)verdict[i], {robot[i], obstacle[i], slice[i]}, on_grid[i], (pir_state)exact[i], turn[i]};
            expect(same_answer(&one, &told), "world %d pose %u", kind, i);
        }
        const pir_cspace_arrays few = {.verdict = alone};
        assert_int_equal(pir_cspace_classify_many(many, &array, MANY, &few, NULL, NULL), PIR_OK);
        assert_memory_equal(alone, verdict, MANY);
        pir_cspace_destroy(many);
        pir_cspace_destroy(single);
        answer_world_finish(&world);
    }
}

static void many_poses_refuse_what_is_wrong(void **state) {
    (void)state;
    answer_world world;
    answer_world_init(&world, 0, make_grid(0));
    answer_world_write(&world, path_of("whole.h5"));
    pir_cspace *cspace = open_file("whole.h5");
    double row[14] = {0, 0, 0, 1, 9, 9, 9, 0, 0, 0, 1, 0, 0, 0};
    uint8_t verdict[2] = {7, 7};
    const pir_cspace_arrays to = {.verdict = verdict};
    pir_pose_array poses = {row, 7 * sizeof *row, row + 4, 7 * sizeof *row, false};
    pir_report report = {0};
    assert_int_equal(pir_cspace_classify_many(NULL, &poses, 2, &to, &report, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cspace_classify_many(cspace, NULL, 2, &to, &report, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cspace_classify_many(cspace, &poses, 2, NULL, &report, NULL), PIR_ERR_ARGUMENT);
    poses.rotation_stride = 12;
    assert_int_equal(pir_cspace_classify_many(cspace, &poses, 2, &to, &report, NULL), PIR_ERR_ARGUMENT);
    assert_non_null(strstr(report.text, "stride"));
    assert_true(verdict[0] == 7 && verdict[1] == 7);
    poses.rotation_stride = 7 * sizeof *row;
    assert_int_equal(pir_cspace_classify_many(cspace, &poses, 2, &to, &report, NULL), PIR_OK);
    assert_true(verdict[0] == PIR_VERDICT_FREE && verdict[1] == PIR_VERDICT_BLOCKED);
    poses.is_one = true;
    assert_int_equal(pir_cspace_classify_many(cspace, &poses, 2, &to, &report, NULL), PIR_OK);
    assert_true(verdict[1] == PIR_VERDICT_FREE);
    assert_int_equal(pir_cspace_classify_many(cspace, &poses, 0, &to, &report, NULL), PIR_OK);
    pir_cspace_destroy(cspace);
    answer_world_finish(&world);
}

/* --- files that are broken --- */

struct bytes {
    uint8_t *data;
    size_t size;
};

static struct bytes load(const char *name) {
    FILE *file = fopen(path_of(name), "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    struct bytes bytes = {.size = (size_t)ftell(file)};
    rewind(file);
    bytes.data = malloc(bytes.size);
    assert_int_equal(fread(bytes.data, 1, bytes.size, file), bytes.size);
    fclose(file);
    return bytes;
}

static void save(const char *name, const uint8_t *data, size_t size) {
    FILE *file = fopen(path_of(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    fclose(file);
}

/* Asks a file that may be broken: 1 where it answers, always rightly; 0 where it says what is wrong. */
static int ask_broken(answer_world *world, const pir_pose *poses, const pir_state *states, int count) {
    pir_cspace *cspace = NULL;
    pir_report report = {0};
    pir_status status = pir_cspace_open(path_of("broken.h5"), NULL, &report, &cspace);
    if (status == PIR_OK && pir_cspace_get_info(cspace).robot_count != world->robot_count)
        status = PIR_ERR_FORMAT;
    int right = 0;
    for (int i = 0; status == PIR_OK && i < count; i++) {
        pir_configuration answer;
        status = pir_cspace_classify(cspace, &poses[i], &report, &answer);
        const pir_cspace_place slice = {0, 0, 3 * (uint64_t)i};
        pir_sum *sum = NULL;
        if (status == PIR_OK)
            status = pir_cspace_sum(cspace, slice, &report, &sum);
        right += status == PIR_OK && (answer.verdict == PIR_VERDICT_FREE) == (states[i] == PIR_OUTSIDE);
        pir_sum_destroy(sum);
    }
    pir_cspace_destroy(cspace);
    if (status == PIR_OK)
        assert_int_equal(right, count);
    else
        assert_true(report.status == status && report.text[0] != '\0');
    return status == PIR_OK;
}

static void broken_files_are_refused_or_right(void **state) {
    (void)state;
    answer_world world;
    answer_world_init(&world, 1, make_grid(0));
    answer_world_write(&world, path_of("whole.h5"));
    struct bytes whole = load("whole.h5");
    pir_pose poses[12];
    pir_state states[12];
    for (uint32_t i = 0; i < 12; i++) {
        test_random random = test_random_case("broken", i);
        poses[i] = answer_world_pose(&world, &random);
        poses[i].rotation = pir_grid_rotation(world.grid, 3 * i);
        states[i] = answer_world_state(&world, &poses[i]);
    }
    save("broken.h5", whole.data, whole.size);
    assert_true(ask_broken(&world, poses, states, 12));
    uint32_t answered = 0, refused = 0;
    for (uint32_t i = 0; i < 30; i++) {
        // cut short
        save("broken.h5", whole.data, whole.size * i / 30);
        refused += !ask_broken(&world, poses, states, 12);
    }
    assert_int_equal(refused, 30);
    for (uint32_t i = 0; i < 120; i++) {
        test_random random = test_random_case("changed file", i);
        uint8_t *data = malloc(whole.size);
        memcpy(data, whole.data, whole.size);
        for (uint32_t k = 0; k <= i % 3; k++) {
            size_t at = test_random_bits(&random) % whole.size;
            data[at] =
                i % 2 ? (uint8_t)(data[at] ^ 1u << test_random_below(&random, 8)) : (uint8_t)test_random_bits(&random);
        }
        save("broken.h5", data, whole.size);
        free(data);
        if (ask_broken(&world, poses, states, 12))
            answered++;
        else
            refused++;
    }
    printf("# 120 changed files: %u refused, %u answer rightly\n", refused - 30, answered);
    assert_true(refused > 40);
    free(whole.data);
    answer_world_finish(&world);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    answer_world world;
    answer_world_init(&world, 0, make_grid(0));
    answer_world_write(&world, path_of("whole.h5"));
    pir_cspace *cspace = open_file("whole.h5");
    pir_configuration answer;
    pir_cspace_motion motion;
    pir_report report = {0};
    const pir_pose pose = {{0, 0, 0, 1}, {0, 0, 0}}, none = {{0, 0, 0, 0}, {0, 0, 0}};
    assert_int_equal(pir_cspace_classify(NULL, &pose, &report, &answer), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cspace_classify(cspace, NULL, NULL, &answer), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cspace_segment(cspace, &pose, NULL, NULL, &motion), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_cspace_classify(cspace, &none, &report, &answer), PIR_ERR_ZERO_QUATERNION);
    assert_string_equal(report.text, "the pose: zero quaternion");
    assert_int_equal(pir_cspace_segment(cspace, &pose, &none, &report, &motion), PIR_ERR_ZERO_QUATERNION);
    pir_cspace_destroy(cspace);
    answer_world_finish(&world);
}

static void no_memory_is_a_status(void **state) {
    (void)state;
    answer_world world;
    answer_world_init(&world, 3, make_grid(0));
    answer_world_write(&world, path_of("whole.h5"));
    const pir_pose pose = {{0.1, 0.2, 0.3, 1}, {0.2, 0.4, 0}};
    uint32_t failures = 0;
    for (uint64_t n = 1;; n++) {
        test_memory memory = {.fail_at = n};
        pir_allocator allocator = test_allocator(&memory);
        pir_cspace *cspace = NULL;
        pir_configuration answer;
        pir_report report = {0};
        pir_status status = pir_cspace_open(path_of("whole.h5"), &allocator, &report, &cspace);
        if (status == PIR_OK)
            status = pir_cspace_classify(cspace, &pose, &report, &answer);
        assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && report.text[0] != '\0'));
        pir_cspace_destroy(cspace);
        expect(memory.blocks == 0 && !memory.wrong_size && !memory.overrun, "request %llu: %zu blocks, wrong size %d",
               (unsigned long long)n, memory.blocks, memory.wrong_size);
        if (status == PIR_OK)
            break;
        failures++;
    }
    assert_true(failures > 20);
    answer_world_finish(&world);
}

static void poses_are_read(void **state) {
    (void)state;
    static const char text[] = "x,y,z,w,tx,ty,tz\n0,0,0,1,1,2,3\n1,0,0,0,-1,-2,-3\n";
    save("poses.csv", (const uint8_t *)text, sizeof text - 1);
    pir_pose *poses = NULL;
    size_t count = 0;
    pir_report report = {0};
    assert_int_equal(pir_cspace_read_poses(path_of("poses.csv"), NULL, &report, &poses, &count), PIR_OK);
    assert_true(count == 2 && poses[1].rotation.x == 1 && poses[1].translation.z == -3);
    pir_cspace_free_poses(poses, count, NULL);
    static const char zero[] = "0,0,0,1,1,2,3\n0,0,0,0,1,2,3\n", wild[] = "0 0 0 1 inf 0 0\n", few[] = "0,0,0,1\n";
    save("poses.csv", (const uint8_t *)zero, sizeof zero - 1);
    assert_int_equal(pir_cspace_read_poses(path_of("poses.csv"), NULL, &report, &poses, &count),
                     PIR_ERR_ZERO_QUATERNION);
    assert_non_null(strstr(report.text, "poses.csv:2: the quaternion 0, 0, 0, 0 is no rotation"));
    save("poses.csv", (const uint8_t *)wild, sizeof wild - 1);
    assert_int_equal(pir_cspace_read_poses(path_of("poses.csv"), NULL, &report, &poses, &count), PIR_ERR_NOT_FINITE);
    save("poses.csv", (const uint8_t *)few, sizeof few - 1);
    assert_int_equal(pir_cspace_read_poses(path_of("poses.csv"), NULL, &report, &poses, &count), PIR_ERR_FORMAT);
    assert_non_null(strstr(report.text, "poses.csv:1: 4 numbers, not 7: x,y,z,w,tx,ty,tz"));
    for (uint64_t n = 1;; n++) {
        test_memory memory = {.fail_at = n};
        pir_allocator allocator = test_allocator(&memory);
        save("poses.csv", (const uint8_t *)text, sizeof text - 1);
        pir_status status = pir_cspace_read_poses(path_of("poses.csv"), &allocator, &report, &poses, &count);
        if (status == PIR_OK)
            pir_cspace_free_poses(poses, count, &allocator);
        assert_true(memory.blocks == 0 && (status == PIR_OK || status == PIR_ERR_MEMORY));
        if (status == PIR_OK)
            break;
    }
    pir_cspace_free_poses(NULL, 0, NULL);
}

static int make_folder(void **state) {
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
    (void)state;
    static const char *const names[] = {"whole.h5", "broken.h5", "poses.csv"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        unlink(path_of(names[i]));
    return rmdir(folder);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_around_pieces_are_hardly_wider_than_their_bodies),
        cmocka_unit_test(a_file_answers_as_the_bodies_do),
        cmocka_unit_test(many_poses_are_single_answers),
        cmocka_unit_test(many_poses_refuse_what_is_wrong),
        cmocka_unit_test(broken_files_are_refused_or_right),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(no_memory_is_a_status),
        cmocka_unit_test(poses_are_read),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
