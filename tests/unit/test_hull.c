/* SPDX-License-Identifier: MIT */
/* The exact hull of awkward points: duplicate, collinear, coplanar, interior, flat, thin, far, tiny, huge. */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/check_sum.h"
#include "support/bodies.h"
#include "support/meshes.h"

/* A hull by its counts, proven by the oracle. */
static void expect_hull(const pir_vec3 *points, size_t count, int dimension, uint32_t vertices, uint32_t edges,
                        uint32_t facets) {
    pir_polytope *hull = NULL;
    assert_int_equal(pir_polytope_create(points, count, NULL, &hull), PIR_OK);
    const char *wrong = test_prove_hull(hull, points, count);
    expect(!wrong, "%s", wrong);
    assert_int_equal(pir_polytope_dimension(hull), dimension);
    assert_int_equal(pir_polytope_vertex_count(hull), vertices);
    assert_int_equal(pir_polytope_edge_count(hull), edges);
    assert_int_equal(pir_polytope_facet_count(hull), facets);
    pir_polytope_release(hull);
}

static void full_grid_of_a_cube_has_six_facets(void **state) {
    (void)state;
    pir_vec3 points[250];
    size_t n = 0;
    // every grid point twice: corners, edge points, facet points and inner ones, each with a duplicate
    for (int copy = 0; copy < 2; copy++)
        for (int x = 0; x < 5; x++)
            for (int y = 0; y < 5; y++)
                for (int z = 0; z < 5; z++)
                    points[n++] = (pir_vec3){x, y, z};
    expect_hull(points, n, 3, 8, 12, 6);
}

static void cube_octahedron_with_all_its_lattice_points_keeps_fourteen_facets(void **state) {
    (void)state;
    pir_vec3 points[125];
    size_t n = 0;
    for (int x = -2; x <= 2; x++)
        for (int y = -2; y <= 2; y++)
            for (int z = -2; z <= 2; z++)
                if (abs(x) + abs(y) + abs(z) <= 4)
                    points[n++] = (pir_vec3){x, y, z};
    expect_hull(points, n, 3, 12, 24, 14);
}

static void points_of_a_plane_make_a_polygon_with_two_sides(void **state) {
    (void)state;
    pir_vec3 points[49];
    size_t n = 0;
    for (int i = 0; i < 7; i++)
        for (int j = 0; j < 7; j++)
            points[n++] = (pir_vec3){i + j, i - 2 * j, 3 * i};
    expect_hull(points, n, 2, 4, 4, 2);
}

static void points_of_a_line_make_a_segment(void **state) {
    (void)state;
    pir_vec3 points[20];
    for (int i = 0; i < 20; i++)
        points[i] = (pir_vec3){0.5 * (i % 7), -i % 7, 3 * (i % 7)};
    expect_hull(points, 20, 1, 2, 1, 0);
}

static void equal_points_make_a_point(void **state) {
    (void)state;
    pir_vec3 points[5] = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    expect_hull(points, 5, 0, 1, 0, 0);
    expect_hull((pir_vec3[]){{0.0, 0.0, 0.0}, {-0.0, 0.0, -0.0}}, 2, 0, 1, 0, 0);
}

static void corner_a_last_bit_off_its_plane_is_kept(void **state) {
    (void)state;
    // The eight corners of a cube, one of them a last bit too high: its three quadrilaterals fall apart in exact
    // arithmetic.
    pir_vec3 points[8];
    for (int i = 0; i < 8; i++)
        points[i] = (pir_vec3){i & 1, i >> 1 & 1, i >> 2 & 1};
    expect_hull(points, 8, 3, 8, 12, 6);
    points[7].z = nextafter(1, 2);
    expect_hull(points, 8, 3, 8, 13, 7);
    points[7].z = nextafter(1, 0);
    expect_hull(points, 8, 3, 8, 13, 7);
    // and one that is a last bit inside is none at all
    points[7].z = 1;
    pir_vec3 nine[9];
    for (int i = 0; i < 8; i++)
        nine[i] = points[i];
    nine[8] = (pir_vec3){0.5, 0.5, nextafter(1, 0)};
    expect_hull(nine, 9, 3, 8, 12, 6);
    nine[8].z = nextafter(1, 2);
    expect_hull(nine, 9, 3, 9, 16, 9);
}

static void tiny_apex_over_a_polygon_makes_a_body(void **state) {
    (void)state;
    pir_vec3 points[5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 5e-324}};
    expect_hull(points, 5, 3, 5, 8, 5);
    points[4].z = 0x1p1023;
    expect_hull(points, 5, 3, 5, 8, 5);
}

static void random_bodies_of_every_kind_are_proven(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 1500; i++) {
        test_random random = test_random_case("hull bodies", i);
        test_points points;
        test_body_points(&random, (test_body)(i % TEST_BODY_COUNT), i % 5 ? 20 : 120, &points);
        pir_polytope *hull = test_polytope(&points);
        const char *wrong = test_prove_hull(hull, points.at, points.count);
        expect(!wrong, "case %llu: %s", (unsigned long long)i, wrong);
        pir_polytope_release(hull);
    }
}

static void small_hulls_are_those_of_brute_force(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 400; i++) {
        test_random random = test_random_case("hull brute force", i);
        test_points points;
        test_body_points(&random, (test_body)(i % TEST_BODY_COUNT), 10, &points);
        pir_polytope *hull = test_polytope(&points);
        pir_mesh *mesh;
        assert_int_equal(pir_mesh_from_polytope(hull, &mesh), PIR_OK);
        oracle_points p, q;
        oracle_points_from_doubles(&p, points.at, points.count);
        oracle_points_from_doubles(&q, &(pir_vec3){0, 0, 0}, 1);
        const char *wrong = oracle_compare_brute_force(mesh, &p, &q);
        expect(!wrong, "case %llu: %s", (unsigned long long)i, wrong);
        oracle_points_clear(&q);
        oracle_points_clear(&p);
        pir_mesh_destroy(mesh);
        pir_polytope_release(hull);
    }
}

static void order_of_the_points_changes_nothing_but_numbers(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 300; i++) {
        test_random random = test_random_case("hull order", i);
        test_points points;
        test_body_points(&random, (test_body)(i % TEST_BODY_COUNT), 40, &points);
        pir_polytope *first = test_polytope(&points);
        for (int again = 0; again < 3; again++) {
            test_shuffle(&random, &points);
            pir_polytope *other = test_polytope(&points);
            expect(pir_polytope_dimension(first) == pir_polytope_dimension(other) &&
                       pir_polytope_vertex_count(first) == pir_polytope_vertex_count(other) &&
                       pir_polytope_edge_count(first) == pir_polytope_edge_count(other) &&
                       pir_polytope_facet_count(first) == pir_polytope_facet_count(other),
                   "case %llu", (unsigned long long)i);
            const char *wrong = test_prove_hull(other, points.at, points.count);
            expect(!wrong, "case %llu: %s", (unsigned long long)i, wrong);
            pir_polytope_release(other);
        }
        pir_polytope_release(first);
    }
}

static void scaling_by_a_power_of_two_changes_no_facet(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        test_random random = test_random_case("hull scale", i);
        test_points points, scaled;
        test_body_points(&random, i % 2 ? TEST_BALL : TEST_GRID, 30, &points);
        int k = test_random_between(&random, -900, 900);
        scaled = points;
        for (size_t n = 0; n < points.count; n++)
            scaled.at[n] = (pir_vec3){ldexp(points.at[n].x, k), ldexp(points.at[n].y, k), ldexp(points.at[n].z, k)};
        pir_polytope *a = test_polytope(&points), *b = test_polytope(&scaled);
        assert_int_equal(pir_polytope_facet_count(a), pir_polytope_facet_count(b));
        for (uint32_t f = 0; f < pir_polytope_facet_count(a); f++) {
            uint32_t one[64], other[64], size = pir_polytope_facet_size(a, f);
            assert_int_equal(size, pir_polytope_facet_size(b, f));
            pir_polytope_facet(a, f, one);
            pir_polytope_facet(b, f, other);
            expect(memcmp(one, other, size * sizeof *one) == 0, "case %llu", (unsigned long long)i);
        }
        pir_polytope_release(b);
        pir_polytope_release(a);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_grid_of_a_cube_has_six_facets),
        cmocka_unit_test(cube_octahedron_with_all_its_lattice_points_keeps_fourteen_facets),
        cmocka_unit_test(points_of_a_plane_make_a_polygon_with_two_sides),
        cmocka_unit_test(points_of_a_line_make_a_segment),
        cmocka_unit_test(equal_points_make_a_point),
        cmocka_unit_test(corner_a_last_bit_off_its_plane_is_kept),
        cmocka_unit_test(tiny_apex_over_a_polygon_makes_a_body),
        cmocka_unit_test(random_bodies_of_every_kind_are_proven),
        cmocka_unit_test(small_hulls_are_those_of_brute_force),
        cmocka_unit_test(order_of_the_points_changes_nothing_but_numbers),
        cmocka_unit_test(scaling_by_a_power_of_two_changes_no_facet),
    };
    return cmocka_run_group_tests_name("hull", tests, NULL, NULL);
}
