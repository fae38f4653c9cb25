/* SPDX-License-Identifier: MIT */
/*
 * The order of visiting: a path of small turns. PIR_TEST_LEVEL is the greatest level of the grid of all rotations that
 * is walked (4).
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/grid.h>

#include "support/bodies.h"

static void the_hopf_grid_is_a_path_of_small_turns(void **state) {
    (void)state;
    const char *text = getenv("PIR_TEST_LEVEL");
    const uint32_t most = text ? (uint32_t)atoi(text) : 4;
    for (uint32_t level = 0; level <= most; level++) {
        pir_grid *grid;
        assert_int_equal(pir_grid_hopf(level, NULL, &grid), PIR_OK);
        pir_grid_turns turns = pir_grid_get_turns(grid);
        double spacing = pir_grid_get_info(grid).spacing;
        printf("# level %u: %llu rotations, turns in spacings: mean %.4f, most %.4f\n", level,
               (unsigned long long)pir_grid_get_info(grid).count, turns.mean / spacing, turns.most / spacing);
        assert_true(turns.mean < (level ? 1.001 : 1.0056) * spacing && turns.most < 1.5 * spacing);
        pir_grid_destroy(grid);
    }
}

/* All but one of each 6·2^level steps turn about the x axis of the frame that stands, by the spacing. */
static void most_steps_are_about_one_axis(void **state) {
    (void)state;
    pir_grid *grid;
    assert_int_equal(pir_grid_hopf(2, NULL, &grid), PIR_OK);
    const uint64_t count = pir_grid_get_info(grid).count;
    double half = pir_grid_get_info(grid).spacing / 2;
    uint64_t steady = 0;
    pir_quat a = pir_grid_rotation(grid, 0);
    for (uint64_t i = 1; i < count; i++) {
        pir_quat b = pir_grid_rotation(grid, i);
        // b · conj(a): its vector part is the axis in the frame that stands
        double y = b.y * a.w - b.w * a.y + b.x * a.z - b.z * a.x, z = b.z * a.w - b.w * a.z + b.y * a.x - b.x * a.y;
        double x = b.x * a.w - b.w * a.x + b.z * a.y - b.y * a.z;
        steady += fabs(y) < 1e-15 && fabs(z) < 1e-15 && fabs(fabs(x) - sin(half)) < 1e-15;
        a = b;
    }
    assert_int_equal(steady, count - count / 24);
    pir_grid_destroy(grid);
}

static uint64_t shuffled(uint64_t i, uint64_t count) {
    return i * 7919 % count;
}

/* A grid that a file lists in disorder is visited nearly as well as in its own order. */
static void a_list_in_disorder_becomes_a_path(void **state) {
    (void)state;
    pir_grid *grid, *list;
    assert_int_equal(pir_grid_hopf(2, NULL, &grid), PIR_OK);
    const uint64_t count = pir_grid_get_info(grid).count;
    pir_quat *q = malloc(count * sizeof *q);
    for (uint64_t i = 0; i < count; i++)
        q[i] = pir_grid_rotation(grid, shuffled(i, count));
    assert_int_equal(pir_grid_list(q, count, 0, NULL, &list), PIR_OK);
    pir_grid_turns turns = pir_grid_get_turns(list);
    double spacing = pir_grid_get_info(list).spacing;
    printf("# 4608 rotations of a grid in disorder: mean %.4f, most %.4f of the distance to the nearest\n",
           turns.mean / spacing, turns.most / spacing);
    // as good as the search for exchanges has found it
    assert_true(turns.mean < 1.0161 * spacing && turns.most < 1.34 * spacing);
    uint8_t *seen = calloc(count, 1);
    for (uint64_t i = 0; i < count; i++) {
        uint64_t source = pir_grid_cell(list, i);
        assert_true(source < count && seen[source]++ == 0);
        pir_quat given = pir_grid_rotation(list, i);
        assert_memory_equal(&given, &q[source], sizeof given);
    }
    free(seen);
    free(q);
    pir_grid_destroy(list);
    pir_grid_destroy(grid);
}

/* Random rotations have no neat path: a mean below 1.35 of the distance to the nearest is near what is known. */
static void random_rotations_become_a_path(void **state) {
    (void)state;
    for (size_t count = 2; count <= 4000; count = 3 * count / 2 + 1) {
        test_random random = test_random_case("random path", count);
        pir_quat *q = malloc(count * sizeof *q);
        for (size_t i = 0; i < count; i++)
            // repeated ones and their opposites among them
            q[i] = i > 10 && i % 9 == 0    ? q[i / 2]
                   : i > 10 && i % 10 == 0 ? (pir_quat){-q[i / 3].x, -q[i / 3].y, -q[i / 3].z, -q[i / 3].w}
                                           : test_general_rotation(&random);
        pir_grid *kept, *path;
        assert_int_equal(pir_grid_list(q, count, 1, NULL, &kept), PIR_OK);
        assert_int_equal(pir_grid_list(q, count, 0, NULL, &path), PIR_OK);
        double as_given = pir_grid_get_turns(kept).mean, found = pir_grid_get_turns(path).mean;
        expect(count < 20 || found < 0.75 * as_given, "%zu rotations: %g, as given %g", count, found, as_given);
        expect(count < 500 || found < 1.6 * pir_grid_get_info(path).spacing, "%zu rotations: %g spacings", count,
               found / pir_grid_get_info(path).spacing);
        for (size_t i = 0; i < count; i++)
            assert_int_equal(pir_grid_cell(kept, i), i);
        pir_grid_destroy(kept);
        pir_grid_destroy(path);
        free(q);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hopf_grid_is_a_path_of_small_turns),
        cmocka_unit_test(most_steps_are_about_one_axis),
        cmocka_unit_test(a_list_in_disorder_becomes_a_path),
        cmocka_unit_test(random_rotations_become_a_path),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
