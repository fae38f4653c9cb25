/* SPDX-License-Identifier: MIT */
/* Grids of rotations: which rotations they have, how evenly they lie, and which of them are nearest. */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/grid.h>

#include "support/bodies.h"
#include "support/memory.h"

#define PI 3.14159265358979323846

static pir_grid *hopf(uint32_t level) {
    pir_grid *grid = NULL;
    assert_int_equal(pir_grid_hopf(level, NULL, &grid), PIR_OK);
    return grid;
}

/* The angle between two rotations of length 1, by the C library. */
static double turn(pir_quat a, pir_quat b) {
    double dot = fabs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w);
    double sign = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0 ? -1 : 1;
    double x = a.x - sign * b.x, y = a.y - sign * b.y, z = a.z - sign * b.z, w = a.w - sign * b.w;
    return dot < 0.9 ? 2 * acos(dot) : 4 * asin(sqrt(x * x + y * y + z * z + w * w) / 2);
}

static pir_quat random_unit(test_random *random) {
    pir_quat q = test_general_rotation(random);
    double n = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return (pir_quat){q.x / n, q.y / n, q.z / n, q.w / n};
}

static void an_axis_has_equal_turns(void **state) {
    (void)state;
    pir_grid *grid;
    for (uint64_t steps = 1; steps < 200; steps++) {
        assert_int_equal(pir_grid_axis((pir_vec3){0, 0, -3e200}, steps, NULL, &grid), PIR_OK);
        for (uint64_t i = 0; i < steps; i++) {
            pir_quat q = pir_grid_rotation(grid, i);
            double half = PI * (double)i / (double)steps;
            assert_true(q.x == 0 && q.y == 0 && fabs(q.z + sin(half)) < 1e-15 && fabs(q.w - cos(half)) < 1e-15);
            assert_int_equal(pir_grid_cell(grid, i), i);
        }
        pir_grid_destroy(grid);
    }
    // quarter turns are exact rotations by 90°: z and w are equal
    assert_int_equal(pir_grid_axis((pir_vec3){0, 0, 1}, 500, NULL, &grid), PIR_OK);
    pir_quat q = pir_grid_rotation(grid, 125), half = pir_grid_rotation(grid, 250);
    assert_true(q.z == q.w && half.w == 0 && half.z == 1);
    pir_grid_turns turns = pir_grid_get_turns(grid);
    assert_true(fabs(turns.mean - PI / 250) < 1e-14 && fabs(turns.most - PI / 250) < 1e-14);
    assert_true(fabs(pir_grid_get_info(grid).spacing - PI / 250) < 1e-15);
    pir_grid_destroy(grid);
}

/* The grid as Yershova et al. define it, from Hopf coordinates by the C library. */
static void the_hopf_grid_is_the_published_one(void **state) {
    (void)state;
    for (uint32_t level = 0; level <= 3; level++) {
        pir_grid *grid = hopf(level);
        pir_grid_info info = pir_grid_get_info(grid);
        const uint64_t around = (uint64_t)6 << level;
        assert_int_equal(info.count, (uint64_t)72 << (3 * level));
        assert_true(fabs(info.spacing * 180 / PI - 60.0 / (1 << level)) < 1e-12);
        uint8_t *seen = calloc(info.count, 1);
        double angle[2] = {0, 0};
        uint64_t last = UINT64_MAX;
        for (uint64_t i = 0; i < info.count; i++) {
            uint64_t source = pir_grid_cell(grid, i);
            assert_true(source < info.count && seen[source]++ == 0);
            pir_quat q = pir_grid_rotation(grid, i);
            assert_true(fabs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) < 1e-15);
            // Hopf coordinates: those of the pixel are the same all round, psi is the middle of its part
            double cosine = q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z;
            double half = atan2(q.x, q.w), phi = atan2(q.z, q.y) - half, psi = 2 * half;
            if (source / around == last) {
                assert_true(fabs(cosine - angle[0]) < 1e-15);
                assert_true(fabs(remainder(phi - angle[1], 2 * PI)) < 1e-14);
            }
            last = source / around;
            angle[0] = cosine;
            angle[1] = phi;
            double middle = 2 * PI * ((double)(source % around) + 0.5) / (double)around;
            assert_true(fabs(remainder(psi - middle, 2 * PI)) < 1e-14);
        }
        free(seen);
        pir_grid_destroy(grid);
    }
}

/*
 * Balls of any radius α hold the share (α − sin α)/π of all rotations. Cells of equal volume let a ball's count
 * be off by those that its surface cuts: the greatest deviation falls as the surface over the volume, 1/2^level.
 */
static void the_hopf_grid_is_equidistributed(void **state) {
    (void)state;
    double before = 1;
    for (uint32_t level = 0; level <= 3; level++) {
        pir_grid *grid = hopf(level);
        const uint64_t count = pir_grid_get_info(grid).count;
        test_random random = test_random_case("balls", 0);
        double worst = 0, second[4][4] = {{0}};
        for (int ball = 0; ball < 40; ball++) {
            pir_quat centre = random_unit(&random);
            double radius = PI * (1 + ball % 10) / 11, held = 0;
            for (uint64_t i = 0; i < count; i++)
                held += turn(centre, pir_grid_rotation(grid, i)) <= radius;
            worst = fmax(worst, fabs(held / (double)count - (radius - sin(radius)) / PI));
        }
        for (uint64_t i = 0; i < count; i++) {
            pir_quat q = pir_grid_rotation(grid, i);
            const double c[4] = {q.x, q.y, q.z, q.w};
            for (int k = 0; k < 16; k++)
                second[k / 4][k % 4] += c[k / 4] * c[k % 4] / (double)count;
        }
        for (int k = 0; k < 16; k++)
            assert_true(fabs(second[k / 4][k % 4] - (k / 4 == k % 4 ? 0.25 : 0)) < 1e-14);
        printf("# level %u: balls hold their share within %.5f\n", level, worst);
        assert_true(worst < 0.09 / (1 << level) && worst < before);
        before = worst;
        pir_grid_destroy(grid);
    }
}

/*
 * The dispersion is the greatest angle from a rotation to the nearest of the grid. Along a circle no rotation is
 * farther than half a step from the grid, on the sphere none is farther than δ from a centre, so it is at most α with
 * cos α/2 = cos δ/2 · cos step/4. Pixels at level 0 reach δ = 48.19°, later ones δ < 48.19° / 2^level.
 */
static void the_dispersion_is_as_published(void **state) {
    (void)state;
    test_random random = test_random_case("dispersion", 0);
    for (uint32_t level = 0; level <= 6; level++) {
        pir_grid *grid = hopf(level);
        double spacing = pir_grid_get_info(grid).spacing, worst = 0;
        double bound = 2 * acos(cos(acos(2.0 / 3) / (1 << level) / 2) * cos(spacing / 4));
        for (int i = 0; i < 4000; i++) {
            pir_quat q = random_unit(&random);
            uint64_t nearest;
            assert_int_equal(pir_grid_nearest(grid, q, 1, &nearest), 1);
            worst = fmax(worst, pir_grid_turn(q, pir_grid_rotation(grid, nearest)));
        }
        printf("# level %u: dispersion at least %.3f°, at most %.3f°; coverage %.2f\n", level, worst * 180 / PI,
               bound * 180 / PI, (double)pir_grid_get_info(grid).count * (worst - sin(worst)) / PI);
        assert_true(worst <= bound && worst > 0.75 * bound);
        pir_grid_destroy(grid);
    }
}

/* The nearest by a look at all of them. */
static void expect_nearest(const pir_grid *grid, pir_quat q, size_t capacity) {
    uint64_t number[64], count = pir_grid_get_info(grid).count;
    size_t found = pir_grid_nearest(grid, q, capacity, number);
    assert_int_equal(found, capacity < count ? capacity : count);
    double last = 0;
    for (size_t k = 0; k < found; k++) {
        double away = pir_grid_turn(q, pir_grid_rotation(grid, number[k]));
        // turns near 0 and near a half turn come from cosines that hardly change
        assert_true(away >= last - 1e-7);
        last = fmax(last, away);
        for (size_t other = 0; other < k; other++)
            assert_true(number[other] != number[k]);
    }
    uint64_t nearer = 0;
    for (uint64_t i = 0; i < count; i++)
        nearer += pir_grid_turn(q, pir_grid_rotation(grid, i)) < last - 1e-7;
    expect(nearer < found, "%zu found, %llu are nearer than the last", found, (unsigned long long)nearer);
}

static pir_grid *random_list(test_random *random, size_t count, int keep_order) {
    pir_quat *q = malloc(count * sizeof *q);
    for (size_t i = 0; i < count; i++)
        q[i] = test_rotation(random);
    pir_grid *grid = NULL;
    assert_int_equal(pir_grid_list(q, count, keep_order, NULL, &grid), PIR_OK);
    free(q);
    return grid;
}

static void the_nearest_are_the_nearest(void **state) {
    (void)state;
    test_random random = test_random_case("nearest", 0);
    for (int kind = 0; kind < 8; kind++) {
        pir_grid *grid;
        if (kind < 3)
            grid = hopf((uint32_t)kind);
        else if (kind < 6)
            assert_int_equal(pir_grid_axis((pir_vec3){1, -2, 0.5}, (uint64_t[]){1, 2, 97}[kind - 3], NULL, &grid),
                             PIR_OK);
        else
            grid = random_list(&random, kind == 6 ? 3 : 300, kind & 1);
        const uint64_t count = pir_grid_get_info(grid).count;
        for (int i = 0; i < 60; i++) {
            pir_quat own = pir_grid_rotation(grid, test_random_bits(&random) % count);
            size_t capacity = 1 + test_random_below(&random, 64);
            expect_nearest(grid, i % 3 == 0 ? own : test_rotation(&random), i % 2 ? 1 : capacity);
        }
        for (uint32_t i = 0; i < TEST_HARD_ROTATIONS; i++)
            expect_nearest(grid, test_hard_rotation(i), 1 + i % 5);
        for (uint64_t i = 0; i < count; i++) {
            uint64_t nearest;
            assert_int_equal(pir_grid_nearest(grid, pir_grid_rotation(grid, i), 1, &nearest), 1);
            assert_true(pir_grid_turn(pir_grid_rotation(grid, i), pir_grid_rotation(grid, nearest)) < 1e-7);
        }
        pir_grid_destroy(grid);
    }
}

/* A rotation as far from up to four of a grid, which lie about a random one, moved by up to 2^-10 to 2^-55. */
static pir_quat between_some(test_random *random, const pir_grid *grid) {
    const pir_quat about = random_unit(random);
    uint64_t near[4];
    pir_grid_nearest(grid, about, 4, near);
    const uint32_t count = 1 + test_random_below(random, 4);
    double sum[4] = {0, 0, 0, 0};
    for (uint32_t k = 0; k < count; k++) {
        const pir_quat q = pir_grid_rotation(grid, near[k]);
        const double sign = q.x * about.x + q.y * about.y + q.z * about.z + q.w * about.w < 0 ? -1 : 1;
        const double c[4] = {q.x, q.y, q.z, q.w};
        for (int i = 0; i < 4; i++)
            sum[i] += sign * c[i];
    }
    const double off = ldexp(1, -10 - test_random_between(random, 0, 45));
    for (int i = 0; i < 4; i++)
        sum[i] += off * (2 * test_random_unit(random) - 1);
    return (pir_quat){sum[0], sum[1], sum[2], sum[3]};
}

/* One rotation alone is told by tables, two are searched: the first is the same, ties included. */
static void tables_tell_what_a_search_finds(void **state) {
    (void)state;
    test_random random = test_random_case("tables", 0);
    for (uint32_t level = 0; level <= 6; level++) {
        pir_grid *grid = hopf(level);
        for (int i = 0; i < 30000; i++) {
            const pir_quat q = i % 3 == 0   ? between_some(&random, grid)
                               : i % 3 == 1 ? test_rotation(&random)
                                            : random_unit(&random);
            uint64_t told, found[2];
            assert_int_equal(pir_grid_nearest(grid, q, 1, &told), 1);
            assert_int_equal(pir_grid_nearest(grid, q, 2, found), 2);
            expect(told == found[0], "level %u, %.17g %.17g %.17g %.17g: %llu and %llu", level, q.x, q.y, q.z, q.w,
                   (unsigned long long)told, (unsigned long long)found[0]);
        }
        pir_grid_destroy(grid);
    }
}

static void the_bits_are_the_same_everywhere(void **state) {
    (void)state;
    uint64_t hash = 0xcbf29ce484222325u;
    for (uint32_t kind = 0; kind < 2; kind++) {
        pir_grid *grid = NULL;
        if (kind)
            assert_int_equal(pir_grid_axis((pir_vec3){1, 2, 3}, 500, NULL, &grid), PIR_OK);
        else
            grid = hopf(3);
        for (uint64_t i = 0; i < pir_grid_get_info(grid).count; i++) {
            pir_quat q = pir_grid_rotation(grid, i);
            uint8_t bytes[sizeof q];
            memcpy(bytes, &q, sizeof q);
            for (size_t k = 0; k < sizeof bytes; k++)
                hash = (hash ^ bytes[k]) * 0x100000001b3u;
        }
        pir_grid_destroy(grid);
    }
    expect(hash == 0x3bcc29a39bac0087u, "the hash of both grids is 0x%llx", (unsigned long long)hash);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    pir_grid *const before = (pir_grid *)&before;
    pir_grid *grid = before;
    assert_int_equal(pir_grid_axis((pir_vec3){0, 0, 0}, 3, NULL, &grid), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_grid_axis((pir_vec3){0, 0, 1}, 0, NULL, &grid), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_grid_axis((pir_vec3){0, 0, NAN}, 3, NULL, &grid), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_grid_axis((pir_vec3){0, 0, 1}, PIR_GRID_STEPS_MAX + 1, NULL, &grid), PIR_ERR_LIMIT);
    assert_int_equal(pir_grid_hopf(PIR_GRID_LEVEL_MAX + 1, NULL, &grid), PIR_ERR_LIMIT);
    const pir_quat good = {0, 0, 0, 1}, zero = {0, 0, 0, 0}, wild = {0, INFINITY, 0, 1};
    assert_int_equal(pir_grid_list(&good, 0, 0, NULL, &grid), PIR_ERR_EMPTY);
    assert_int_equal(pir_grid_list(NULL, 1, 0, NULL, &grid), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_grid_list(&zero, 1, 0, NULL, &grid), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_grid_list(&wild, 1, 0, NULL, &grid), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_grid_list(&good, PIR_GRID_LIST_MAX + 1, 0, NULL, &grid), PIR_ERR_LIMIT);
    assert_ptr_equal(grid, before);
    assert_true(isnan(pir_grid_turn(zero, good)) && isnan(pir_grid_turn(good, wild)));
    assert_int_equal(pir_grid_list(&good, 1, 0, NULL, &grid), PIR_OK);
    uint64_t nearest = 7;
    assert_int_equal(pir_grid_nearest(grid, zero, 1, &nearest), 0);
    assert_int_equal(pir_grid_nearest(grid, wild, 1, &nearest), 0);
    assert_int_equal(pir_grid_nearest(grid, good, 0, &nearest), 0);
    assert_int_equal(nearest, 7);
    pir_grid_turns turns = pir_grid_get_turns(grid);
    assert_true(turns.mean == 0 && turns.most == 0 && pir_grid_get_info(grid).spacing == 0);
    pir_grid_destroy(grid);
    pir_grid_destroy(NULL);
}

/* Memory that runs out at every n-th request. */
static void no_memory_is_a_status(void **state) {
    (void)state;
    test_random random = test_random_case("memory", 0);
    pir_quat q[40];
    for (int i = 0; i < 40; i++)
        q[i] = test_rotation(&random);
    uint32_t failures = 0;
    for (int kind = 0; kind < 3; kind++)
        for (uint64_t n = 1;; n++) {
            test_memory memory = {.fail_at = n};
            pir_allocator allocator = test_allocator(&memory);
            pir_grid *grid = NULL;
            pir_status status = kind == 0   ? pir_grid_axis((pir_vec3){1, 0, 0}, 9, &allocator, &grid)
                                : kind == 1 ? pir_grid_hopf(2, &allocator, &grid)
                                            : pir_grid_list(q, 40, 0, &allocator, &grid);
            assert_true(status == PIR_OK ? grid != NULL : status == PIR_ERR_MEMORY && !grid);
            pir_grid_destroy(grid);
            assert_true(memory.blocks == 0 && memory.bytes == 0 && !memory.wrong_size && !memory.overrun);
            if (status == PIR_OK)
                break;
            failures++;
        }
    assert_true(failures > 4);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_axis_has_equal_turns),
        cmocka_unit_test(the_hopf_grid_is_the_published_one),
        cmocka_unit_test(the_hopf_grid_is_equidistributed),
        cmocka_unit_test(the_dispersion_is_as_published),
        cmocka_unit_test(the_nearest_are_the_nearest),
        cmocka_unit_test(tables_tell_what_a_search_finds),
        cmocka_unit_test(the_bits_are_the_same_everywhere),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(no_memory_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
