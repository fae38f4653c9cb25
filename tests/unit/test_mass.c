/* SPDX-License-Identifier: MIT */
/*
 * Masses, and polytopes moved without loss: known bodies, integrals over another decomposition, what a motion keeps and
 * changes, all in rationals; what is refused, memory that fails.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/mass.h>
#include <pirouette/shape.h>

#include "support/bodies.h"
#include "support/memory.h"
#include "support/vectors.h"

/* An exact mass: volume, centroid, inertia xx, yy, zz, yz, xz, xy. */
typedef struct exact_mass {
    mpq_t volume, centroid[3], inertia[6];
} exact_mass;

static void exact_mass_init(exact_mass *mass) {
    mpq_init(mass->volume);
    for (int k = 0; k < 3; k++)
        mpq_init(mass->centroid[k]);
    for (int k = 0; k < 6; k++)
        mpq_init(mass->inertia[k]);
}

static void exact_mass_of(exact_mass *mass, const pir_polytope *p) {
    exact_mass_init(mass);
    assert_int_equal(pir_polytope_mass_exact(p, mass->volume, mass->centroid, mass->inertia), PIR_OK);
}

static void exact_mass_clear(exact_mass *mass) {
    mpq_clear(mass->volume);
    for (int k = 0; k < 3; k++)
        mpq_clear(mass->centroid[k]);
    for (int k = 0; k < 6; k++)
        mpq_clear(mass->inertia[k]);
}

static pir_polytope *box(pir_vec3 low, pir_vec3 high) {
    test_points points = {.count = 8};
    for (int i = 0; i < 8; i++)
        points.at[i] = (pir_vec3){i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
    return test_polytope(&points);
}

static void a_box_has_the_mass_of_a_box(void **state) {
    (void)state;
    pir_polytope *p = box((pir_vec3){1, -2, 3}, (pir_vec3){3, 4, 4});
    pir_mass mass;
    assert_int_equal(pir_polytope_mass(p, &mass), PIR_OK);
    assert_true(mass.volume == 12);
    assert_true(mass.centroid.x == 2 && mass.centroid.y == 1 && mass.centroid.z == 3.5);
    // m/12 (b² + c²)
    assert_true(mass.inertia[0][0] == 37 && mass.inertia[1][1] == 5 && mass.inertia[2][2] == 40);
    assert_true(mass.inertia[0][1] == 0 && mass.inertia[1][2] == 0 && mass.inertia[2][0] == 0);
    pir_polytope_release(p);
}

static void a_corner_of_a_cube_has_its_products_of_inertia(void **state) {
    (void)state;
    test_points points = {4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    pir_polytope *p = test_polytope(&points);
    pir_mass mass;
    assert_int_equal(pir_polytope_mass(p, &mass), PIR_OK);
    assert_true(mass.volume == 1. / 6 && mass.centroid.x == 0.25);
    // ∫x² = 1/60, ∫xy = 1/120, less V/16 each
    assert_true(mass.inertia[0][0] == 1. / 80);
    assert_true(mass.inertia[0][1] == 1. / 480 && mass.inertia[1][0] == mass.inertia[0][1]);
    pir_polytope_release(p);
}

static void flat_bodies_have_a_centroid_alone(void **state) {
    (void)state;
    test_points triangle = {3, {{0, 0, 0}, {3, 0, 3}, {0, 3, 0}}}, segment = {3, {{1, 2, 3}, {3, 4, 5}, {2, 3, 4}}},
                point = {1, {{5, 6, 7}}};
    const test_points *bodies[3] = {&triangle, &segment, &point};
    const pir_vec3 centroids[3] = {{1, 1, 1}, {2, 3, 4}, {5, 6, 7}};
    for (int i = 0; i < 3; i++) {
        pir_polytope *p = test_polytope(bodies[i]);
        pir_mass mass, zero = {.centroid = centroids[i]};
        assert_int_equal(pir_polytope_mass(p, &mass), PIR_OK);
        assert_memory_equal(&mass, &zero, sizeof mass);
        pir_polytope_release(p);
    }
}

/* The same integrals in doubles, over cones from the origin to triangles of the facets. */
static void integrate(const pir_polytope *p, double *ret_volume, double ret_first[3], double ret_second[3][3]) {
    double volume = 0, first[3] = {0}, second[3][3] = {{0}};
    for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
        uint32_t corners[TEST_POINTS_MAX], n = pir_polytope_facet_size(p, f);
        pir_polytope_facet(p, f, corners);
        for (uint32_t i = 1; i + 1 < n; i++) {
            pir_vec3 v[3] = {pir_polytope_vertex(p, corners[0]), pir_polytope_vertex(p, corners[i]),
                             pir_polytope_vertex(p, corners[i + 1])};
            double d = test_dot(v[0], test_cross(v[1], v[2])), c[3][3], s[3] = {0};
            for (int k = 0; k < 3; k++) {
                memcpy(c[k], &v[k], sizeof c[k]);
                for (int j = 0; j < 3; j++)
                    s[j] += c[k][j];
            }
            volume += d / 6;
            for (int j = 0; j < 3; j++) {
                first[j] += d * s[j] / 24;
                for (int k = 0; k < 3; k++)
                    second[j][k] += d * (s[j] * s[k] + c[0][j] * c[0][k] + c[1][j] * c[1][k] + c[2][j] * c[2][k]) / 120;
            }
        }
    }
    *ret_volume = volume;
    memcpy(ret_first, first, sizeof first);
    memcpy(ret_second, second, sizeof second);
}

static void masses_are_those_of_another_decomposition(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 100; i++) {
        test_random random = test_random_case("mass", i);
        pir_polytope *p = test_random_polytope(&random, (test_body)(i % (TEST_PRISM + 1)), 30);
        pir_mass mass;
        double volume, first[3], second[3][3];
        assert_int_equal(pir_polytope_mass(p, &mass), PIR_OK);
        integrate(p, &volume, first, second);
        double size = 1, c[3] = {mass.centroid.x, mass.centroid.y, mass.centroid.z};
        for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++)
            size = fmax(size, test_length(pir_polytope_vertex(p, v)));
        double error = 1e-13 * pow(size, 5);
        expect(fabs(mass.volume - volume) <= 1e-13 * pow(size, 3), "case %llu", (unsigned long long)i);
        double trace = second[0][0] + second[1][1] + second[2][2];
        for (int j = 0; pir_polytope_dimension(p) == 3 && j < 3; j++) {
            expect(fabs(mass.volume * c[j] - first[j]) <= 1e-13 * pow(size, 4), "case %llu", (unsigned long long)i);
            for (int k = 0; k < 3; k++) {
                double square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
                double about = (j == k ? trace - volume * square : 0) - second[j][k] + volume * c[j] * c[k];
                expect(fabs(mass.inertia[j][k] - about) <= error, "case %llu, %d %d", (unsigned long long)i, j, k);
            }
        }
        pir_polytope_release(p);
    }
}

/* Features under the same numbers. */
static void expect_same_features(const pir_polytope *p, const pir_polytope *q) {
    assert_true(pir_polytope_is_valid(q));
    assert_int_equal(pir_polytope_vertex_count(p), pir_polytope_vertex_count(q));
    assert_int_equal(pir_polytope_facet_count(p), pir_polytope_facet_count(q));
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++)
        assert_int_equal(pir_polytope_source(p, v), pir_polytope_source(q, v));
    for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
        uint32_t a[TEST_POINTS_MAX], b[TEST_POINTS_MAX], n = pir_polytope_facet_size(p, f);
        assert_int_equal(pir_polytope_facet_size(q, f), n);
        pir_polytope_facet(p, f, a);
        pir_polytope_facet(q, f, b);
        assert_memory_equal(a, b, n * sizeof *a);
    }
}

/* The squared distance of two vertices. */
static void set_square(mpq_t square, const pir_polytope *p, uint32_t a, uint32_t b) {
    mpq_t x[3], y[3];
    mpq_inits(x[0], x[1], x[2], y[0], y[1], y[2], NULL);
    pir_polytope_vertex_exact(p, a, x);
    pir_polytope_vertex_exact(p, b, y);
    mpq_set_ui(square, 0, 1);
    for (int k = 0; k < 3; k++) {
        mpq_sub(x[k], x[k], y[k]);
        mpq_mul(x[k], x[k], x[k]);
        mpq_add(square, square, x[k]);
    }
    mpq_clears(x[0], x[1], x[2], y[0], y[1], y[2], NULL);
}

/* A rigid motion keeps distances, volume and the trace of the inertia, and takes vertices where doubles say. */
static void motions_are_rigid_and_lose_nothing(void **state) {
    (void)state;
    mpq_t before, after;
    mpq_inits(before, after, NULL);
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("transform", i);
        pir_polytope *p = test_random_polytope(&random, (test_body)(i % TEST_BODY_COUNT), 12), *q;
        pir_pose pose = {i % 3 ? test_integer_rotation(&random) : test_general_rotation(&random),
                         test_random_direction(&random)};
        assert_int_equal(pir_polytope_transform(p, pose, &q), PIR_OK);
        expect_same_features(p, q);
        double size = 0;
        for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
            set_square(before, p, 0, v);
            set_square(after, q, 0, v);
            expect(mpq_equal(before, after), "case %llu, vertex %u", (unsigned long long)i, v);
            size = fmax(size, test_length(pir_polytope_vertex(p, v)));
        }
        for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
            pir_vec3 at = test_add(test_turn(pose.rotation, pir_polytope_vertex(p, v), 1), pose.translation, 1);
            expect(test_length(test_add(at, pir_polytope_vertex(q, v), -1)) <= 1e-14 * (size + 1), "case %llu",
                   (unsigned long long)i);
        }
        exact_mass a, b;
        exact_mass_of(&a, p);
        exact_mass_of(&b, q);
        assert_true(mpq_equal(a.volume, b.volume));
        for (int k = 1; k < 3; k++) {
            mpq_add(a.inertia[0], a.inertia[0], a.inertia[k]);
            mpq_add(b.inertia[0], b.inertia[0], b.inertia[k]);
        }
        assert_true(mpq_equal(a.inertia[0], b.inertia[0]));
        exact_mass_clear(&a);
        exact_mass_clear(&b);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    mpq_clears(before, after, NULL);
}

static void recentring_moves_by_the_offset_that_it_tells(void **state) {
    (void)state;
    mpq_t x[3], y[3], offset;
    mpq_inits(x[0], x[1], x[2], y[0], y[1], y[2], offset, NULL);
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("recentre", i);
        pir_polytope *p = test_random_polytope(&random, (test_body)(i % TEST_BODY_COUNT), 12), *q;
        pir_vec3 by;
        assert_int_equal(pir_polytope_recentre(p, &q, &by), PIR_OK);
        expect_same_features(p, q);
        double d[3] = {by.x, by.y, by.z};
        for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
            pir_polytope_vertex_exact(p, v, x);
            pir_polytope_vertex_exact(q, v, y);
            for (int k = 0; k < 3; k++) {
                mpq_set_d(offset, d[k]);
                mpq_add(y[k], y[k], offset);
                expect(mpq_equal(x[k], y[k]), "case %llu, vertex %u", (unsigned long long)i, v);
            }
        }
        pir_mass mass;
        assert_int_equal(pir_polytope_mass(q, &mass), PIR_OK);
        expect(test_length(mass.centroid) <= 0x1p-52 * test_length(by), "case %llu", (unsigned long long)i);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    mpq_clears(x[0], x[1], x[2], y[0], y[1], y[2], offset, NULL);
}

static void two_halves_weigh_what_the_whole_does(void **state) {
    (void)state;
    pir_polytope *left = box((pir_vec3){0, 0, 0}, (pir_vec3){1, 2, 3}),
                 *right = box((pir_vec3){1, 0, 0}, (pir_vec3){4, 2, 3}),
                 *all = box((pir_vec3){0, 0, 0}, (pir_vec3){4, 2, 3});
    pir_mass halves[2], whole, sum;
    assert_int_equal(pir_polytope_mass(left, &halves[0]), PIR_OK);
    assert_int_equal(pir_polytope_mass(right, &halves[1]), PIR_OK);
    assert_int_equal(pir_polytope_mass(all, &whole), PIR_OK);
    assert_int_equal(pir_mass_combine(halves, 2, &sum), PIR_OK);
    assert_true(sum.volume == whole.volume);
    assert_true(test_length(test_add(sum.centroid, whole.centroid, -1)) < 1e-14);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            assert_true(fabs(sum.inertia[i][k] - whole.inertia[i][k]) < 1e-12);
    // flat ones: the mean of their centroids
    pir_mass flat[2] = {{.centroid = {1, 0, 0}}, {.centroid = {3, 2, 0}}};
    assert_int_equal(pir_mass_combine(flat, 2, &sum), PIR_OK);
    assert_true(sum.volume == 0 && sum.centroid.x == 2 && sum.centroid.y == 1);
    halves[1].volume = NAN;
    assert_int_equal(pir_mass_combine(halves, 2, &sum), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_mass_combine(halves, 0, &sum), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mass_combine(NULL, 1, &sum), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mass_combine(halves, 1, NULL), PIR_ERR_ARGUMENT);
    pir_polytope_release(left);
    pir_polytope_release(right);
    pir_polytope_release(all);
}

static void what_cannot_be_is_refused(void **state) {
    (void)state;
    pir_polytope *p = box((pir_vec3){0, 0, 0}, (pir_vec3){1, 1, 1}), *const none = (pir_polytope *)&none, *moved = none;
    pir_mass mass;
    pir_vec3 offset = {1, 2, 3};
    assert_int_equal(pir_polytope_mass(NULL, &mass), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_mass(p, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_translate(NULL, offset, &moved), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_translate(p, offset, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_translate(p, (pir_vec3){0, NAN, 0}, &moved), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_polytope_transform(p, (pir_pose){{0, 0, 0, 0}, offset}, &moved), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_polytope_transform(p, (pir_pose){{0, 0, INFINITY, 1}, offset}, &moved), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_polytope_recentre(p, NULL, &offset), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_recentre(p, &moved, NULL), PIR_ERR_ARGUMENT);
    pir_polytope *large = box((pir_vec3){0, 0, 0}, (pir_vec3){1e300, 1, 1}), *wide;
    assert_int_equal(pir_polytope_scale(large, 1e8, &wide), PIR_OK);
    assert_int_equal(pir_polytope_mass(wide, &mass), PIR_ERR_LIMIT);
    assert_int_equal(pir_polytope_translate(wide, (pir_vec3){1.7e308, 0, 0}, &moved), PIR_ERR_LIMIT);
    assert_ptr_equal(moved, none);
    pir_polytope_release(wide);
    pir_polytope_release(large);
    pir_polytope_release(p);
}

static void memory_that_fails_leaves_nothing_behind(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_polytope_options options = {sizeof options, &allocator, 0};
    const pir_vec3 points[5] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    pir_polytope *p, *moved;
    assert_int_equal(pir_polytope_create(points, 5, &options, &p), PIR_OK);
    pir_status status = PIR_ERR_MEMORY;
    size_t bytes = memory.bytes;
    uint64_t failures = 0;
    for (; status == PIR_ERR_MEMORY; failures++) {
        memory.fail_at = memory.requests + failures + 1;
        status = pir_polytope_transform(p, (pir_pose){{1, 2, 3, 4}, {1, 2, 3}}, &moved);
        if (status == PIR_ERR_MEMORY)
            assert_int_equal(memory.bytes, bytes);
    }
    assert_int_equal(status, PIR_OK);
    assert_true(failures > 3);
    pir_polytope_release(moved);
    pir_polytope_release(p);
    assert_int_equal(memory.blocks, 0);
    assert_false(memory.wrong_size);
}

/* --- grown by a ball --- */

static bool is_near(double a, double b, double size) {
    return fabs(a - b) <= 1e-12 * size;
}

/* A ball, and a capsule of length 2 h along x: two half balls and a cylinder. */
static void points_and_segments_are_balls_and_capsules(void **state) {
    (void)state;
    const double pi = 3.14159265358979323846, r = 0.75, h = 1.25;
    test_points point = {1, {{3, -2, 1}}}, ends = {2, {{1 - h, 4, 5}, {1 + h, 4, 5}}};
    pir_polytope *ball = test_polytope(&point), *segment = test_polytope(&ends);
    pir_mass mass;
    assert_int_equal(pir_polytope_rounded_mass(ball, r, &mass), PIR_OK);
    const double of_ball = 4 * pi / 3 * r * r * r;
    assert_true(is_near(mass.volume, of_ball, 1) && is_near(mass.inertia[0][0], 0.4 * of_ball * r * r, 1) &&
                is_near(mass.inertia[2][2], mass.inertia[0][0], 1) && is_near(mass.inertia[0][1], 0, 1));
    assert_true(mass.centroid.x == 3 && mass.centroid.y == -2 && mass.centroid.z == 1);
    assert_int_equal(pir_polytope_rounded_mass(segment, r, &mass), PIR_OK);
    const double of_tube = pi * r * r * 2 * h;
    assert_true(is_near(mass.volume, of_ball + of_tube, 10));
    assert_true(is_near(mass.centroid.x, 1, 10) && is_near(mass.centroid.y, 4, 10) && is_near(mass.centroid.z, 5, 10));
    assert_true(is_near(mass.inertia[0][0], 0.5 * of_tube * r * r + 0.4 * of_ball * r * r, 10));
    const double across = of_tube * (r * r / 4 + h * h / 3) + of_ball * (0.4 * r * r + h * h + 0.75 * h * r);
    assert_true(is_near(mass.inertia[1][1], across, 10) && is_near(mass.inertia[2][2], across, 10));
    assert_int_equal(pir_polytope_rounded_mass(segment, -1, &mass), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_rounded_mass(segment, INFINITY, &mass), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_rounded_mass(segment, NAN, &mass), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_polytope_rounded_mass(NULL, 1, &mass), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_rounded_mass(segment, 1, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_rounded_mass(segment, 1e150, &mass), PIR_ERR_LIMIT);
    pir_polytope_release(ball);
    pir_polytope_release(segment);
}

/*
 * Any body, flat ones too: the mass of the hull of it and all directions of a geodesic sphere at its vertices, of two
 * levels, extrapolated: errors fall as the square of the sphere's edges.
 */
static void a_grown_body_has_the_mass_of_what_it_is_near_to(void **state) {
    (void)state;
    test_random random = test_random_case("grown", 0);
    static const test_body kinds[4] = {TEST_SPHERE, TEST_BOX, TEST_POLYGON, TEST_SEGMENT};
    double worst = 0;
    for (int n = 0; n < 8; n++) {
        test_points points;
        pir_mass mass, of[2];
        test_body_points(&random, kinds[n % 4], 8, &points);
        for (size_t i = 0; i < points.count; i++)
            points.at[i] = test_add((pir_vec3){1, 2, 3}, points.at[i], 1. / (1 + test_length(points.at[i])));
        pir_polytope *p = test_polytope(&points);
        const double r = 0.5;
        assert_int_equal(pir_polytope_rounded_mass(p, r, &mass), PIR_OK);
        for (int level = 0; level < 2; level++) {
            pir_polytope *ball, *grown;
            assert_int_equal(pir_shape_create(level ? "geodesic?level=12" : "geodesic?level=6", NULL, NULL, &ball),
                             PIR_OK);
            const uint32_t count = pir_polytope_vertex_count(ball);
            pir_vec3 *at = malloc((size_t)count * points.count * sizeof *at);
            assert_non_null(at);
            for (uint32_t v = 0; v < count; v++) {
                const pir_vec3 x = pir_polytope_vertex(ball, v);
                for (size_t i = 0; i < points.count; i++)
                    at[v * points.count + i] = test_add(points.at[i], x, r / test_length(x));
            }
            assert_int_equal(pir_polytope_create(at, (size_t)count * points.count, NULL, &grown), PIR_OK);
            assert_int_equal(pir_polytope_mass(grown, &of[level]), PIR_OK);
            free(at);
            pir_polytope_release(ball);
            pir_polytope_release(grown);
        }
        worst = fmax(worst, fabs((4 * of[1].volume - of[0].volume) / 3 / mass.volume - 1));
        worst = fmax(worst, test_length(test_add(of[1].centroid, mass.centroid, -1)));
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                worst = fmax(worst, fabs((4 * of[1].inertia[i][k] - of[0].inertia[i][k]) / 3 - mass.inertia[i][k]) /
                                        mass.inertia[0][0]);
        pir_polytope_release(p);
    }
    print_message("extrapolated masses differ by %.2g\n", worst);
    assert_true(worst < 3e-3);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_has_the_mass_of_a_box),
        cmocka_unit_test(a_corner_of_a_cube_has_its_products_of_inertia),
        cmocka_unit_test(flat_bodies_have_a_centroid_alone),
        cmocka_unit_test(masses_are_those_of_another_decomposition),
        cmocka_unit_test(motions_are_rigid_and_lose_nothing),
        cmocka_unit_test(recentring_moves_by_the_offset_that_it_tells),
        cmocka_unit_test(two_halves_weigh_what_the_whole_does),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(memory_that_fails_leaves_nothing_behind),
        cmocka_unit_test(points_and_segments_are_balls_and_capsules),
        cmocka_unit_test(a_grown_body_has_the_mass_of_what_it_is_near_to),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
