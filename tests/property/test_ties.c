/* SPDX-License-Identifier: MIT */
/*
 * Sums with far more pairs than facets: prisms and polygons in one plane, whose caps pair every side of one with every
 * side of the other. Their meshes are what the hull of all sums of vertices is, and making them takes memory for
 * facets, not for pieces.
 */
#include "support/test.h"

#include <math.h>

#include <pirouette/baseline.h>
#include <pirouette/sum.h>

#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"

#define SIDES_MAX 400

/* A regular polygon of so many sides in the plane z = 0, and again at z = 1 when `prism`. */
static pir_polytope *make_body(uint32_t sides, bool prism) {
    pir_vec3 at[2 * SIDES_MAX];
    for (uint32_t i = 0; i < sides; i++) {
        double angle = 2 * 3.14159265358979323846 * i / sides;
        at[i] = (pir_vec3){cos(angle), sin(angle), 0};
        at[sides + i] = (pir_vec3){cos(angle), sin(angle), 1};
    }
    pir_polytope *polytope = NULL;
    assert_int_equal(pir_polytope_create(at, prism ? 2 * (size_t)sides : sides, NULL, &polytope), PIR_OK);
    return polytope;
}

/* The most bytes that were out, a pair, while a sum and its mesh were made. */
static double bytes_a_pair(pir_polytope *p, pir_polytope *q, pir_quat rotation, uint32_t facets) {
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_sum_options options = pir_sum_options_default();
    options.allocator = &allocator;
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_sum_create(p, q, rotation, &options, &sum), PIR_OK);
    assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
    assert_int_equal(pir_mesh_facet_count(mesh), facets);
    double pairs = pir_polytope_facet_count(p) + pir_polytope_facet_count(q) + pir_sum_ee_count(sum);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(sum);
    assert_int_equal(memory.blocks, 0);
    return (double)memory.peak / pairs;
}

static void sum_of_aligned_prisms_takes_below_100_bytes_a_pair(void **state) {
    (void)state;
    const pir_quat same = {0, 0, 0, 1}, turned = {0, 0, 0.3, 1};
    pir_polytope *prism = make_body(SIDES_MAX, true), *polygon = make_body(SIDES_MAX, false);
    const struct {
        pir_polytope *p, *q;
        pir_quat rotation;
        uint32_t facets;
    } cases[] = {
        {prism, prism, same, SIDES_MAX + 2},   {prism, prism, turned, 2 * SIDES_MAX + 2},
        {polygon, polygon, same, 2},           {polygon, polygon, turned, 2},
        {prism, polygon, same, SIDES_MAX + 2}, {polygon, prism, turned, 2 * SIDES_MAX + 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double bytes = bytes_a_pair(cases[i].p, cases[i].q, cases[i].rotation, cases[i].facets);
        expect(bytes < 100, "case %zu: %g bytes a pair", i, bytes);
    }
    pir_polytope_release(polygon);
    pir_polytope_release(prism);
}

/*
 * A body over a polygon of small integers: the polygon, a prism, or a frustum whose caps are the polygon and part of
 * it.
 */
static void random_body(test_random *random, test_points *points) {
    test_body_points(random, TEST_POLYGON, 12, points);
    size_t count = points->count;
    uint32_t kind = (uint32_t)test_random_below(random, 3);
    for (size_t i = 0; i < count; i++) {
        points->at[i].z = 0;
        if (kind > 0 && (kind == 1 || i % 2))
            points->at[points->count++] = (pir_vec3){points->at[i].x, points->at[i].y, 2};
    }
}

static void mesh_of_tied_facets_is_the_hull_of_all_sums(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 500; i++) {
        test_random random = test_random_case("tied facets", i);
        test_points at_p, at_q;
        random_body(&random, &at_p);
        random_body(&random, &at_q);
        pir_polytope *p = test_polytope(&at_p), *q = test_polytope(i % 3 ? &at_q : &at_p);
        // turns about the common axis, half turns that swap the caps, and any quaternion of integers
        pir_quat rotation = test_integer_rotation(&random);
        if (i % 4)
            rotation = i % 2 ? (pir_quat){0, 0, rotation.z, 1} : (pir_quat){rotation.x, 1, 0, 0};
        pir_sum_options options = pir_sum_options_default();
        options.difference = i % 5 == 0;
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL, *hull = NULL;
        assert_int_equal(pir_sum_create(p, q, rotation, &options, &sum), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
        assert_int_equal(pir_hull_sum(p, q, rotation, &options, PIR_EXACT, &hull), PIR_OK);
        expect(test_hash_mesh(TEST_HASH_START, mesh) == test_hash_mesh(TEST_HASH_START, hull), "case %llu",
               (unsigned long long)i);
        const char *wrong = test_prove_mesh(sum, mesh);
        expect(!wrong, "case %llu: %s", (unsigned long long)i, wrong);
        pir_mesh_destroy(hull);
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sum_of_aligned_prisms_takes_below_100_bytes_a_pair),
        cmocka_unit_test(mesh_of_tied_facets_is_the_hull_of_all_sums),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
