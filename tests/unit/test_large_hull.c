/* SPDX-License-Identifier: MIT */
/*
 * Hulls of more points than the caches hold, which are sorted in space before quickhull runs, and of points that come
 * as doubles: each against the hull of the same points on another way.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>

#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"

/* More than the library sorts from. */
#define MANY 9000

/* Below that. */
#define PART 3000

static pir_polytope *hull_of(const pir_vec3 *points, size_t count) {
    pir_polytope *hull = NULL;
    assert_int_equal(pir_polytope_create(points, count, NULL, &hull), PIR_OK);
    return hull;
}

static bool same_point(pir_vec3 a, pir_vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Facets alike, corner by corner, by the places of their vertices. */
static void expect_same_polytope(const pir_polytope *a, const pir_polytope *b, unsigned long long number) {
    expect(pir_polytope_vertex_count(a) == pir_polytope_vertex_count(b) &&
               pir_polytope_facet_count(a) == pir_polytope_facet_count(b),
           "case %llu: %u and %u vertices, %u and %u facets", number, pir_polytope_vertex_count(a),
           pir_polytope_vertex_count(b), pir_polytope_facet_count(a), pir_polytope_facet_count(b));
    for (uint32_t f = 0; f < pir_polytope_facet_count(a); f++) {
        uint32_t one[512], other[512], size = pir_polytope_facet_size(a, f);
        expect(size <= 512 && size == pir_polytope_facet_size(b, f), "case %llu, facet %u", number, f);
        pir_polytope_facet(a, f, one);
        pir_polytope_facet(b, f, other);
        for (uint32_t i = 0; i < size; i++)
            expect(same_point(pir_polytope_vertex(a, one[i]), pir_polytope_vertex(b, other[i])), "case %llu, facet %u",
                   number, f);
    }
}

/*
 * Points of a sphere, of a ball, of a small grid with each point many times, of a fine grid in a thin plate, on few
 * planes.
 */
static pir_vec3 point_of(test_random *random, unsigned kind) {
    pir_vec3 d = test_random_direction(random);
    double r = test_random_unit(random);
    switch (kind) {
    case 0:
        return d;
    case 1:
        return (pir_vec3){r * d.x, r * d.y, r * d.z};
    case 2:
        return (pir_vec3){round(6 * d.x), round(6 * d.y), round(6 * d.z)};
    case 3:
        return (pir_vec3){round(40 * d.x) / 8, round(40 * d.y) / 8, round(2 * d.z) * 0x1p-30};
    default:
        return (pir_vec3){1e6 + round(d.x * 4) / 4, d.y, fmin(0.5, fmax(-0.5, d.z))};
    }
}

/* The vertices of the hulls of the parts, in the order of the points: their hull is that of all. */
static size_t list_vertices_of_parts(const pir_vec3 *points, size_t count, pir_vec3 *ret_points) {
    size_t listed = 0;
    for (size_t start = 0; start < count; start += PART) {
        pir_polytope *part = hull_of(points + start, count - start < PART ? count - start : PART);
        for (uint32_t v = 0; v < pir_polytope_vertex_count(part); v++)
            ret_points[listed++] = pir_polytope_vertex(part, v);
        pir_polytope_release(part);
    }
    return listed;
}

static void hull_of_many_is_the_hull_of_the_hulls_of_parts(void **state) {
    (void)state;
    pir_vec3 *points = test_malloc(MANY * sizeof *points), *corners = test_malloc(MANY * sizeof *corners);
    for (unsigned i = 0; i < 10; i++) {
        test_random random = test_random_case("large hulls", i);
        // spheres have as many corners as points: one of them shows what a large result is
        unsigned kind = i == 0 ? 0 : 1 + i % 4;
        for (size_t p = 0; p < MANY; p++)
            points[p] = point_of(&random, kind);
        pir_polytope *all = hull_of(points, MANY);
        size_t count = list_vertices_of_parts(points, MANY, corners);
        pir_polytope *of_parts = hull_of(corners, count);
        expect_same_polytope(all, of_parts, i);
        pir_polytope_release(of_parts);
        pir_polytope_release(all);
    }
    test_free(corners);
    test_free(points);
}

static void of_many_equal_points_the_first_is_the_vertex(void **state) {
    (void)state;
    pir_vec3 *points = test_malloc(MANY * sizeof *points);
    test_random random = test_random_case("equal points", 0);
    for (size_t p = 0; p < MANY; p++)
        points[p] = point_of(&random, 2);
    pir_polytope *hull = hull_of(points, MANY);
    for (uint32_t v = 0; v < pir_polytope_vertex_count(hull); v++) {
        uint32_t p = 0;
        while (!same_point(points[p], pir_polytope_vertex(hull, v)))
            p++;
        expect(pir_polytope_source(hull, v) == p, "vertex %u is point %u, and was made from %u", v, p,
               pir_polytope_source(hull, v));
    }
    pir_polytope_release(hull);
    test_free(points);
}

/* The same points as rationals, which are brought near by their integers. */
static pir_polytope *hull_of_rationals(const test_points *points) {
    mpq_t *exact = test_malloc(3 * points->count * sizeof *exact);
    for (size_t i = 0; i < points->count; i++) {
        const double c[3] = {points->at[i].x, points->at[i].y, points->at[i].z};
        for (size_t k = 0; k < 3; k++) {
            mpq_init(exact[3 * i + k]);
            mpq_set_d(exact[3 * i + k], c[k]);
        }
    }
    pir_polytope *hull = NULL;
    assert_int_equal(pir_polytope_create_exact((const mpq_t *)exact, points->count, NULL, &hull), PIR_OK);
    for (size_t i = 0; i < 3 * points->count; i++)
        mpq_clear(exact[i]);
    test_free(exact);
    return hull;
}

/* Moves the points far away, and makes them as large or small as doubles go, axis by axis. */
static void stretch(test_random *random, test_points *points) {
    int k[3];
    for (int axis = 0; axis < 3; axis++)
        k[axis] = test_random_between(random, -1040, 1000);
    for (size_t i = 0; i < points->count; i++) {
        pir_vec3 at = points->at[i];
        points->at[i] = (pir_vec3){ldexp(at.x, k[0]), ldexp(at.y, k[1]), ldexp(at.z, k[2])};
    }
}

static void doubles_and_the_same_rationals_have_one_hull(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 400; i++) {
        test_random random = test_random_case("doubles and rationals", i);
        test_points points;
        test_body_points(&random, (test_body)(i % TEST_BODY_COUNT), 25, &points);
        if (i % 3 == 0)
            stretch(&random, &points);
        pir_polytope *a = test_polytope(&points), *b = hull_of_rationals(&points);
        expect_same_polytope(a, b, (unsigned long long)i);
        pir_polytope_release(b);
        pir_polytope_release(a);
    }
}

static void differences_beyond_the_doubles_make_a_hull(void **state) {
    (void)state;
    // the difference of two coordinates is infinite as a double
    test_points points = {
        .count = 6, .at = {{-0x1.8p1023, 0, 0}, {0x1.8p1023, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
    pir_polytope *a = test_polytope(&points), *b = hull_of_rationals(&points);
    assert_int_equal(pir_polytope_facet_count(a), 8);
    expect_same_polytope(a, b, 0);
    pir_polytope_release(b);
    pir_polytope_release(a);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hull_of_many_is_the_hull_of_the_hulls_of_parts),
        cmocka_unit_test(of_many_equal_points_the_first_is_the_vertex),
        cmocka_unit_test(doubles_and_the_same_rationals_have_one_hull),
        cmocka_unit_test(differences_beyond_the_doubles_make_a_hull),
    };
    return cmocka_run_group_tests_name("large hull", tests, NULL, NULL);
}
