/* SPDX-License-Identifier: MIT */
/*
 * Merging nearly coplanar facets: bodies that were turned in doubles come back with the facets they had, exactly
 * convex, within the bound they report; the oracle proves both in rationals.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/baseline.h>
#include <pirouette/exact.h>
#include <pirouette/io.h>
#include <pirouette/shape.h>
#include <pirouette/sum.h>

#include "oracle/distance.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"

/* The vertices of a built-in shape. */
static void shape_points(const char *name, test_points *points) {
    pir_polytope *shape = NULL;
    pir_report report;
    expect(pir_shape_create(name, NULL, &report, &shape) == PIR_OK, "%s", report.text);
    points->count = pir_polytope_vertex_count(shape);
    assert_true(points->count <= TEST_POINTS_MAX);
    for (uint32_t v = 0; v < points->count; v++)
        points->at[v] = pir_polytope_vertex(shape, v);
    pir_polytope_release(shape);
}

static double greatest_coordinate(const test_points *points) {
    double most = 0;
    for (size_t i = 0; i < points->count; i++)
        most = fmax(most, fmax(fabs(points->at[i].x), fmax(fabs(points->at[i].y), fabs(points->at[i].z))));
    return most;
}

static pir_polytope *merged_hull(const test_points *points, double tolerance) {
    const pir_polytope_options options = {sizeof options, NULL, tolerance};
    pir_polytope *polytope = NULL;
    assert_int_equal(pir_polytope_create(points->at, points->count, &options, &polytope), PIR_OK);
    return polytope;
}

static void expect_counts(const pir_polytope *polytope, uint32_t vertices, uint32_t edges, uint32_t facets,
                          const char *name) {
    expect(pir_polytope_vertex_count(polytope) == vertices && pir_polytope_edge_count(polytope) == edges &&
               pir_polytope_facet_count(polytope) == facets,
           "%s: %u vertices, %u edges, %u facets", name, pir_polytope_vertex_count(polytope),
           pir_polytope_edge_count(polytope), pir_polytope_facet_count(polytope));
}

/* That `merged` is convex, and within its bound of the hull both ways; by the oracle. */
static void expect_proven(const pir_polytope *merged, const pir_polytope *hull, double tolerance, const char *name) {
    double bound = pir_polytope_merge_bound(merged);
    expect(pir_polytope_is_valid(merged), "%s", name);
    expect(bound >= 0 && bound <= tolerance, "%s: bound %g, tolerance %g", name, bound, tolerance);
    oracle_body of_merged, of_hull;
    oracle_body_init(&of_merged, merged);
    oracle_body_init(&of_hull, hull);
    const char *wrong = oracle_body_is_convex(&of_merged);
    expect(!wrong, "%s: %s", name, wrong);
    expect(oracle_is_within(&of_merged, &of_hull, bound), "%s: beyond %g of the hull", name, bound);
    expect(oracle_is_within(&of_hull, &of_merged, bound), "%s: the hull is beyond %g of it", name, bound);
    oracle_body_clear(&of_hull);
    oracle_body_clear(&of_merged);
}

/* --- named cases --- */

static void bodies_turned_in_doubles_come_back_with_their_facets(void **state) {
    (void)state;
    const struct {
        const char *name;
        uint32_t vertices, edges, facets;
    } cases[] = {
        {"cube", 8, 12, 6},
        {"prism?sides=32", 64, 96, 34},
        {"dodecahedron", 20, 30, 12},
        {"cuboctahedron", 12, 24, 14},
        {"truncated-cuboctahedron", 48, 72, 26},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        test_points points;
        shape_points(cases[i].name, &points);
        test_bake(&points, (pir_quat){0.1, 0.2, 0.3, 0.9});
        pir_polytope *hull = test_polytope(&points);
        assert_true(pir_polytope_facet_count(hull) > cases[i].facets);
        double tolerance = 2e-14 * greatest_coordinate(&points);
        pir_polytope *merged = merged_hull(&points, tolerance);
        expect_counts(merged, cases[i].vertices, cases[i].edges, cases[i].facets, cases[i].name);
        expect_proven(merged, hull, tolerance, cases[i].name);
        assert_true(pir_polytope_merge_bound(merged) > 0);
        pir_polytope_release(merged);
        pir_polytope_release(hull);
    }
}

static void dodecahedron_moved_by_an_ulp_has_twelve_facets(void **state) {
    (void)state;
    test_random random = test_random_case("moved dodecahedron", 0);
    test_points points;
    shape_points("dodecahedron", &points);
    for (size_t i = 0; i < points.count; i++) {
        points.at[i].x += 2e-16 * (2 * test_random_unit(&random) - 1);
        points.at[i].y += 2e-16 * (2 * test_random_unit(&random) - 1);
        points.at[i].z += 2e-16 * (2 * test_random_unit(&random) - 1);
    }
    pir_polytope *hull = test_polytope(&points), *merged = merged_hull(&points, 1e-14);
    assert_true(pir_polytope_facet_count(hull) > 12);
    expect_counts(merged, 20, 30, 12, "dodecahedron");
    expect_proven(merged, hull, 1e-14, "dodecahedron");
    pir_polytope_release(merged);
    pir_polytope_release(hull);
}

static void body_without_nearly_coplanar_facets_stays_exact(void **state) {
    (void)state;
    const char *names[] = {"cube", "icosahedron", "geodesic?level=3", "polygon", "segment", "point"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        test_points points;
        shape_points(names[i], &points);
        pir_polytope *hull = test_polytope(&points), *merged = merged_hull(&points, 1e-14);
        pir_mesh *one = NULL, *two = NULL;
        assert_int_equal(pir_mesh_from_polytope(hull, &one), PIR_OK);
        assert_int_equal(pir_mesh_from_polytope(merged, &two), PIR_OK);
        expect(pir_mesh_equal(one, two), "%s", names[i]);
        assert_true(pir_polytope_merge_bound(merged) == 0);
        pir_mesh_destroy(two);
        pir_mesh_destroy(one);
        pir_polytope_release(merged);
        pir_polytope_release(hull);
    }
}

static void bound_follows_reflection_and_scale(void **state) {
    (void)state;
    test_random random = test_random_case("scaled bound", 0);
    test_points points;
    shape_points("cube", &points);
    test_bake(&points, test_general_rotation(&random));
    pir_polytope *hull = test_polytope(&points), *merged = merged_hull(&points, 1e-14), *other = NULL;
    double bound = pir_polytope_merge_bound(merged);
    assert_int_equal(pir_polytope_reflect(merged, &other), PIR_OK);
    // a turn may leave the cube a cube
    assert_true(bound > 0 || pir_polytope_facet_count(hull) == 6);
    assert_true(pir_polytope_merge_bound(other) == bound);
    pir_polytope_release(other);
    const double factors[] = {4, 0.3, 1e9};
    for (int i = 0; i < 3; i++) {
        pir_polytope *scaled = NULL;
        assert_int_equal(pir_polytope_scale(merged, factors[i], &other), PIR_OK);
        assert_int_equal(pir_polytope_scale(hull, factors[i], &scaled), PIR_OK);
        expect_proven(other, scaled, bound * factors[i] * (1 + 0x1p-50), "scaled cube");
        pir_polytope_release(scaled);
        pir_polytope_release(other);
    }
    pir_polytope_release(merged);
    pir_polytope_release(hull);
}

static void tolerance_that_is_no_length_is_refused(void **state) {
    (void)state;
    const pir_vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const struct {
        double tolerance;
        pir_status status;
    } cases[] = {{-1e-300, PIR_ERR_ARGUMENT},
                 {-1, PIR_ERR_ARGUMENT},
                 {NAN, PIR_ERR_NOT_FINITE},
                 {INFINITY, PIR_ERR_NOT_FINITE},
                 {-INFINITY, PIR_ERR_NOT_FINITE}};
    pir_polytope *const before = (pir_polytope *)&before;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const pir_polytope_options options = {sizeof options, NULL, cases[i].tolerance};
        pir_polytope *polytope = before;
        assert_int_equal(pir_polytope_create(points, 4, &options, &polytope), cases[i].status);
        assert_int_equal(pir_polytope_create_exact(NULL, 0, &options, &polytope), cases[i].status);
        assert_ptr_equal(polytope, before);
    }
    assert_true(pir_polytope_options_default().merge_tolerance == 0);
}

static void hull_read_from_text_is_merged_as_well(void **state) {
    (void)state;
    // a square whose corner is a thousandth off the plane of the others, under an apex
    const char text[] = "OFF\n5 0 0\n0 0 0\n3 0 0\n3 3 1/1000\n0 3 0\n1 1 2\n";
    const pir_read_options options = {.size = sizeof options, .merge_tolerance = 0.01};
    pir_polytope *exact = NULL, *merged = NULL;
    assert_int_equal(
        pir_polytope_read_bytes(&(pir_file_bytes){text, sizeof text - 1, "m.off", "off"}, NULL, NULL, NULL, &exact),
        PIR_OK);
    assert_int_equal(pir_polytope_read_bytes(&(pir_file_bytes){text, sizeof text - 1, "m.off", "off"}, &options, NULL,
                                             NULL, &merged),
                     PIR_OK);
    expect_counts(exact, 5, 9, 6, "exact");
    expect_counts(merged, 5, 8, 5, "merged");
    expect_proven(merged, exact, 0.01, "pyramid");
    // midway between its corners, which are 1/4000 to either side of the plane that fits best, but for its few bits
    assert_true(pir_polytope_merge_bound(merged) < 0.00028);
    pir_polytope_release(merged);
    pir_polytope_release(exact);
}

/* A cube of four by four squares a side, turned: the points inside its edges and sides are no vertices of it. */
static void points_inside_edges_and_facets_are_dropped(void **state) {
    (void)state;
    test_points points = {0};
    for (int i = 0; i < 125; i++) {
        int c[3] = {i % 5, i / 5 % 5, i / 25};
        if (c[0] % 4 == 0 || c[1] % 4 == 0 || c[2] % 4 == 0)
            points.at[points.count++] = (pir_vec3){c[0] - 2, c[1] - 2, c[2] - 2};
    }
    test_bake(&points, (pir_quat){0.1, 0.2, 0.3, 0.9});
    pir_polytope *hull = test_polytope(&points), *merged = merged_hull(&points, 4e-14);
    assert_true(pir_polytope_vertex_count(hull) > 20);
    expect_counts(merged, 8, 12, 6, "cube");
    expect_proven(merged, hull, 4e-14, "cube");
    for (uint32_t v = 0; v < 8; v++) {
        pir_vec3 corner = pir_polytope_vertex(merged, v), given = points.at[pir_polytope_source(merged, v)];
        double away = fmax(fabs(corner.x - given.x), fmax(fabs(corner.y - given.y), fabs(corner.z - given.z)));
        expect(away <= pir_polytope_merge_bound(merged), "vertex %u is %g off its source", v, away);
    }
    pir_polytope_release(merged);
    pir_polytope_release(hull);
}

/* An edge of a triangle broken by a thousandth, and a facet of one raised by as much: the bound is what was lost. */
static void vertices_that_stand_out_by_little_go_with_their_distance(void **state) {
    (void)state;
    const test_points cases[] = {{5, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {2, -0.0009765625, 0}}},
                                 {5, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {1, 1, -0.0009765625}}}};
    for (int i = 0; i < 2; i++) {
        pir_polytope *hull = test_polytope(&cases[i]), *merged = merged_hull(&cases[i], 0.00195);
        assert_int_equal(pir_polytope_vertex_count(merged), 5);
        pir_polytope_release(merged);
        merged = merged_hull(&cases[i], 0.00196);
        expect_counts(merged, 4, 6, 4, "twice the distance");
        expect_proven(merged, hull, 0.0009765625 * (1 + 0x1p-50), "tetrahedron");
        pir_polytope_release(merged);
        pir_polytope_release(hull);
    }
}

/* --- properties --- */

/* A shape, or the exact hull of a random body: its points before it is turned. */
static void random_points(test_random *random, test_points *points) {
    const char *shapes[] = {
        "cube",        "box?x=1&y=7&z=0.25", "prism?sides=9", "pyramid?sides=7",   "antiprism?sides=5",
        "icosahedron", "truncated-cube",     "snub-cube",     "icosidodecahedron", "truncated-octahedron"};
    uint32_t choice = test_random_below(random, 14);
    if (choice < sizeof shapes / sizeof *shapes)
        shape_points(shapes[choice], points);
    else
        test_body_points(random, choice % 2 ? TEST_PRISM : TEST_GRID, 14, points);
}

/* The most facets of four corners and more that meet at a vertex. */
static uint32_t most_polygons_at_a_vertex(const pir_polytope *polytope) {
    uint32_t met[TEST_POINTS_MAX] = {0}, corner[TEST_POINTS_MAX], most = 0;
    for (uint32_t f = 0; f < pir_polytope_facet_count(polytope); f++) {
        uint32_t n = pir_polytope_facet_size(polytope, f);
        pir_polytope_facet(polytope, f, corner);
        for (uint32_t i = 0; i < n && n > 3; i++)
            met[corner[i]]++;
    }
    for (uint32_t v = 0; v < pir_polytope_vertex_count(polytope); v++)
        most = met[v] > most ? met[v] : most;
    return most;
}

static void random_bodies_turned_in_doubles_are_merged_within_the_bound(void **state) {
    (void)state;
    uint32_t merged_count = 0;
    for (uint64_t i = 0; i < 160; i++) {
        test_random random = test_random_case("merging", i);
        char name[32];
        snprintf(name, sizeof name, "case %llu", (unsigned long long)i);
        test_points points;
        random_points(&random, &points);
        pir_polytope *own = test_polytope(&points);
        test_bake(&points, test_general_rotation(&random));
        // of any size, and in a quarter of the cases far from the origin
        int exponent = test_random_between(&random, -900, 900);
        double away = i % 4 ? 0 : ldexp(300 * test_random_unit(&random), exponent);
        for (size_t k = 0; k < points.count; k++)
            points.at[k] = (pir_vec3){ldexp(points.at[k].x, exponent) + away, ldexp(points.at[k].y, exponent),
                                      ldexp(points.at[k].z, exponent)};
        double tolerance = ldexp(greatest_coordinate(&points), test_random_between(&random, -44, -30));
        pir_polytope *hull = test_polytope(&points), *merged = merged_hull(&points, tolerance);
        if (pir_polytope_dimension(hull) == 3) {
            expect_proven(merged, hull, tolerance, name);
            bool fewer = pir_polytope_facet_count(merged) < pir_polytope_facet_count(hull) ||
                         pir_polytope_vertex_count(merged) < pir_polytope_vertex_count(hull);
            expect(fewer == (pir_polytope_merge_bound(merged) > 0), "%s", name);
            merged_count += fewer;
            // a body that was flat before is hardly one after; where four polygons meet some may stay in pieces
            if (pir_polytope_dimension(own) == 3 && most_polygons_at_a_vertex(own) <= 3)
                expect_counts(merged, pir_polytope_vertex_count(own), pir_polytope_edge_count(own),
                              pir_polytope_facet_count(own), name);
        }
        pir_polytope_release(merged);
        pir_polytope_release(hull);
        pir_polytope_release(own);
    }
    expect(merged_count > 80, "%u merged", merged_count);
}

/*
 * Turned by so little that two components of a normal are next to nothing: the slopes of the planes are still those
 * against the steepest axis.
 */
static void bodies_turned_a_little_come_back_with_their_facets(void **state) {
    (void)state;
    static const char *const names[] = {"cube", "box?x=1&y=7&z=0.25", "prism?sides=9", "truncated-cube",
                                        "pyramid?sides=4"};
    for (uint64_t i = 0; i < 40; i++) {
        test_random random = test_random_case("merging after small turns", i);
        char name[32];
        snprintf(name, sizeof name, "case %llu", (unsigned long long)i);
        test_points points;
        shape_points(names[i % 5], &points);
        pir_polytope *own = test_polytope(&points);
        const pir_vec3 axes[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, test_random_direction(&random)};
        pir_vec3 axis = axes[i / 5 % 4];
        double half = ldexp(1, -test_random_between(&random, 3, 45));
        test_bake(&points, (pir_quat){half * axis.x, half * axis.y, half * axis.z, 1});
        // and from one axis to another
        if (i % 3 == 0)
            test_bake(&points, (pir_quat){0.5, 0.5, 0.5, 0.5});
        double tolerance = 4e-15 * greatest_coordinate(&points);
        pir_polytope *hull = test_polytope(&points), *merged = merged_hull(&points, tolerance);
        expect_counts(merged, pir_polytope_vertex_count(own), pir_polytope_edge_count(own),
                      pir_polytope_facet_count(own), name);
        expect_proven(merged, hull, tolerance, name);
        pir_polytope_release(merged);
        // a tolerance of much more than the rounding is not used up: the bound tells what was
        tolerance = 1e-9 * greatest_coordinate(&points);
        merged = merged_hull(&points, tolerance);
        expect_counts(merged, pir_polytope_vertex_count(own), pir_polytope_edge_count(own),
                      pir_polytope_facet_count(own), name);
        expect_proven(merged, hull, tolerance / 4, name);
        pir_polytope_release(merged);
        pir_polytope_release(hull);
        pir_polytope_release(own);
    }
}

/* Points inside edges and facets of a body, before it is turned; the coordinates of the body are small integers. */
static void add_inner_points(test_random *random, const pir_polytope *body, test_points *points) {
    for (uint32_t e = 0; e < pir_polytope_edge_count(body); e++) {
        uint32_t end[2];
        pir_polytope_edge(body, e, end);
        pir_vec3 a = pir_polytope_vertex(body, end[0]), b = pir_polytope_vertex(body, end[1]);
        for (int n = test_random_between(random, 0, 3); n > 0; n--) {
            double s = ldexp(test_random_between(random, 1, 15), -4);
            points->at[points->count++] =
                (pir_vec3){a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z)};
        }
    }
    for (uint32_t f = 0; f < pir_polytope_facet_count(body); f++) {
        uint32_t corner[TEST_POINTS_MAX];
        pir_polytope_facet(body, f, corner);
        pir_vec3 a = pir_polytope_vertex(body, corner[0]), b = pir_polytope_vertex(body, corner[1]),
                 c = pir_polytope_vertex(body, corner[2]);
        for (int n = test_random_between(random, 0, 2); n > 0; n--) {
            double s = ldexp(test_random_between(random, 1, 7), -4), r = ldexp(test_random_between(random, 1, 7), -4);
            points->at[points->count++] =
                (pir_vec3){a.x + s * (b.x - a.x) + r * (c.x - a.x), a.y + s * (b.y - a.y) + r * (c.y - a.y),
                           a.z + s * (b.z - a.z) + r * (c.z - a.z)};
        }
    }
}

static void points_inside_edges_and_facets_change_nothing(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 36; i++) {
        test_random random = test_random_case("merging with inner points", i);
        char name[32];
        snprintf(name, sizeof name, "case %llu", (unsigned long long)i);
        test_points points;
        test_body_points(&random, i % 3 ? TEST_PRISM : i % 2 ? TEST_GRID : TEST_OCTAHEDRON, 10, &points);
        pir_polytope *own = test_polytope(&points);
        if (pir_polytope_dimension(own) == 3 && most_polygons_at_a_vertex(own) <= 3) {
            add_inner_points(&random, own, &points);
            test_shuffle(&random, &points);
            test_bake(&points, test_general_rotation(&random));
            double tolerance = ldexp(greatest_coordinate(&points), test_random_between(&random, -44, -34));
            pir_polytope *hull = test_polytope(&points), *merged = merged_hull(&points, tolerance);
            expect_counts(merged, pir_polytope_vertex_count(own), pir_polytope_edge_count(own),
                          pir_polytope_facet_count(own), name);
            expect_proven(merged, hull, tolerance, name);
            pir_polytope_release(merged);
            pir_polytope_release(hull);
        }
        pir_polytope_release(own);
    }
}

/* Tolerances that are no rounding: what merges is arbitrary, what is promised is not. */
static void coarse_tolerance_keeps_the_bound(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("coarse merging", i);
        char name[32];
        snprintf(name, sizeof name, "case %llu", (unsigned long long)i);
        test_points points;
        test_body_points(&random, i % 3 == 0 ? TEST_SPHERE : i % 3 == 1 ? TEST_BALL : TEST_NEEDLE, 40, &points);
        double tolerance = ldexp(greatest_coordinate(&points), -test_random_between(&random, -1, 12));
        pir_polytope *hull = test_polytope(&points), *merged = merged_hull(&points, tolerance);
        if (pir_polytope_dimension(hull) == 3)
            expect_proven(merged, hull, tolerance, name);
        pir_polytope_release(merged);
        pir_polytope_release(hull);
    }
}

static void sums_of_merged_bodies_are_the_hulls_of_all_sums(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 12; i++) {
        test_random random = test_random_case("merged sums", i);
        test_points at_p, at_q;
        random_points(&random, &at_p);
        shape_points(i % 2 ? "cube" : "prism?sides=6", &at_q);
        test_bake(&at_p, test_general_rotation(&random));
        test_bake(&at_q, test_general_rotation(&random));
        pir_polytope *p = merged_hull(&at_p, 1e-13 * greatest_coordinate(&at_p)), *q = merged_hull(&at_q, 1e-13);
        pir_quat rotation = test_rotation(&random);
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL, *hull = NULL;
        assert_int_equal(pir_sum_create(p, q, (pir_quat){0, 0, 0, 1}, NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_rotate(sum, rotation, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
        assert_int_equal(pir_hull_sum(p, q, rotation, NULL, PIR_EXACT, &hull), PIR_OK);
        expect(pir_mesh_equal(mesh, hull), "case %llu", (unsigned long long)i);
        const char *wrong = test_prove_mesh(sum, mesh);
        expect(!wrong, "case %llu: %s", (unsigned long long)i, wrong);
        pir_mesh_destroy(hull);
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void merging_survives_every_failing_request(void **state) {
    (void)state;
    test_random random = test_random_case("merging without memory", 0);
    test_points points;
    shape_points("prism?sides=7", &points);
    test_bake(&points, test_general_rotation(&random));
    for (uint64_t n = 1;; n++) {
        test_memory memory = {.fail_at = n};
        const pir_allocator allocator = test_allocator(&memory);
        const pir_polytope_options options = {sizeof options, &allocator, 1e-14};
        pir_polytope *const before = (pir_polytope *)&before;
        pir_polytope *polytope = before;
        pir_status status = pir_polytope_create(points.at, points.count, &options, &polytope);
        if (status == PIR_OK) {
            expect_counts(polytope, 14, 21, 9, "prism");
            pir_polytope_release(polytope);
        } else {
            assert_int_equal(status, PIR_ERR_MEMORY);
            assert_ptr_equal(polytope, before);
        }
        expect(memory.blocks == 0 && !memory.wrong_size, "request %llu", (unsigned long long)n);
        assert_int_equal(status == PIR_OK, memory.requests < n);
        if (status == PIR_OK)
            break;
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_turned_in_doubles_come_back_with_their_facets),
        cmocka_unit_test(dodecahedron_moved_by_an_ulp_has_twelve_facets),
        cmocka_unit_test(body_without_nearly_coplanar_facets_stays_exact),
        cmocka_unit_test(bound_follows_reflection_and_scale),
        cmocka_unit_test(tolerance_that_is_no_length_is_refused),
        cmocka_unit_test(hull_read_from_text_is_merged_as_well),
        cmocka_unit_test(points_inside_edges_and_facets_are_dropped),
        cmocka_unit_test(vertices_that_stand_out_by_little_go_with_their_distance),
        cmocka_unit_test(random_bodies_turned_in_doubles_are_merged_within_the_bound),
        cmocka_unit_test(bodies_turned_a_little_come_back_with_their_facets),
        cmocka_unit_test(points_inside_edges_and_facets_change_nothing),
        cmocka_unit_test(coarse_tolerance_keeps_the_bound),
        cmocka_unit_test(sums_of_merged_bodies_are_the_hulls_of_all_sums),
        cmocka_unit_test(merging_survives_every_failing_request),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
