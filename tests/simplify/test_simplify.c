/* SPDX-License-Identifier: MIT */
/*
 * Simplified polytopes against exact distances (oracle/distance.h): the inner one is inside, the outer one around, no
 * vertex is beyond the bounds, and the bounds are not much more than the distances. Bodies are round, aligned, thin,
 * far from the origin, very small and large, and flat.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/simplify.h>

#include "oracle/distance.h"
#include "support/bodies.h"
#include "support/memory.h"

static void stretch(test_points *points, pir_vec3 by, pir_vec3 to) {
    for (size_t i = 0; i < points->count; i++) {
        pir_vec3 x = points->at[i];
        points->at[i] = (pir_vec3){x.x * by.x + to.x, x.y * by.y + to.y, x.z * by.z + to.z};
    }
}

static pir_polytope *some_body(test_random *random, uint64_t number) {
    static const pir_vec3 by[8] = {
        {1, 1, 1}, {1, 1, 1e-7}, {1e6, 1, 1}, {1e-140, 1e-140, 1e-140}, {1e140, 1e140, 1e140},
        {1, 1, 1}, {1, 2, 3},    {1, 1, 1}};
    test_points points;
    test_body_points(random, number % 3 ? TEST_SPHERE : TEST_GRID, 60, &points);
    // now and then far away, or turned so that nothing is aligned
    stretch(&points, by[number % 8], number % 8 == 5 ? (pir_vec3){1e9, -1e9, 1e9} : (pir_vec3){0, 0, 0});
    if (number % 8 == 7)
        test_bake(&points, (pir_quat){1, 2, 3, 4});
    return test_polytope(&points);
}

/* That `around` holds all of `inside`, and reaches beyond it by no more than `bound`, nor much less. */
static void check_between(uint64_t number, const char *which, const pir_polytope *inside, const pir_polytope *around,
                          double bound, double size) {
    oracle_body small, large;
    oracle_body_init(&small, inside);
    oracle_body_init(&large, around);
    expect(oracle_is_within(&small, &large, 0), "body %llu: %s does not hold", (unsigned long long)number, which);
    expect(oracle_is_within(&large, &small, bound), "body %llu: %s beyond %g", (unsigned long long)number, which,
           bound);
    double less = 0.999 * bound - 1e-11 * size;
    if (less > 0)
        expect(!oracle_is_within(&large, &small, less), "body %llu: %s within %g of %g", (unsigned long long)number,
               which, less, bound);
    oracle_body_clear(&large);
    oracle_body_clear(&small);
}

static double size_of(const pir_polytope *polytope) {
    pir_vec3 low, high;
    pir_polytope_bounds(polytope, &low, &high);
    return fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z)) +
           1e-3 * fmax(fabs(low.x), fmax(fabs(low.y), fabs(low.z)));
}

static void check(uint64_t number, pir_polytope *body, const pir_simplify_options *options) {
    pir_simplified s;
    assert_int_equal(pir_polytope_simplify(body, options, &s), PIR_OK);
    uint32_t most = options->vertices ? options->vertices : UINT32_MAX;
    expect(pir_polytope_vertex_count(s.inner) <= most, "body %llu: inner has %u vertices", (unsigned long long)number,
           pir_polytope_vertex_count(s.inner));
    expect(pir_polytope_is_valid(s.inner) && pir_polytope_is_valid(s.outer), "body %llu", (unsigned long long)number);
    if (!options->vertices)
        expect(s.inner_error <= options->error && s.outer_error <= options->error, "body %llu: errors %g and %g of %g",
               (unsigned long long)number, s.inner_error, s.outer_error, options->error);
    if (pir_polytope_dimension(body) == 3 && pir_polytope_dimension(s.inner) == 3) {
        expect(pir_polytope_vertex_count(s.outer) <= most, "body %llu: outer has %u vertices",
               (unsigned long long)number, pir_polytope_vertex_count(s.outer));
        check_between(number, "inner", s.inner, body, s.inner_error, size_of(body));
        check_between(number, "outer", body, s.outer, s.outer_error, size_of(body));
    }
    pir_simplified_release(&s);
    assert_null(s.inner);
}

static void bounds_hold_and_are_near(void **state) {
    (void)state;
    const char *text = getenv("PIR_TEST_BODIES");
    uint64_t count = text ? strtoull(text, NULL, 10) : 24;
    for (uint64_t number = 0; number < count; number++) {
        test_random random = test_random_case("simplify", number);
        pir_polytope *body = some_body(&random, number);
        pir_simplify_options options = pir_simplify_options_default();
        options.vertices = 4 + test_random_below(&random, 16);
        check(number, body, &options);
        options.vertices = 0;
        options.error = size_of(body) * pow(10, -1 - (double)test_random_below(&random, 4));
        check(number, body, &options);
        options.error = size_of(body) * 1e-30;
        check(number, body, &options);
        pir_polytope_release(body);
    }
}

static void flat_bodies_are_their_own_outer_ones(void **state) {
    (void)state;
    static const test_body flat[3] = {TEST_POLYGON, TEST_SEGMENT, TEST_POINT};
    test_random random = test_random_case("flat", 0);
    for (int i = 0; i < 12; i++) {
        pir_polytope *body = test_random_polytope(&random, flat[i % 3], 20);
        pir_simplify_options options = pir_simplify_options_default();
        pir_simplified s;
        options.vertices = 4;
        assert_int_equal(pir_polytope_simplify(body, &options, &s), PIR_OK);
        assert_ptr_equal(s.outer, body);
        assert_true(s.outer_error == 0 && pir_polytope_vertex_count(s.inner) <= 4);
        pir_simplified_release(&s);
        pir_polytope_release(body);
    }
}

/* Where an outer polytope would reach beyond the doubles, or be finer than they are, the body is its own. */
static void bodies_at_the_ends_of_the_doubles_are_their_own_outer_ones(void **state) {
    (void)state;
    static const double sizes[] = {1.5e308, 1e308, 1e-320};
    test_random random = test_random_case("ends of the doubles", 0);
    pir_polytope *sphere = test_sphere(&random, 40);
    for (int i = 0; i < 3; i++) {
        test_points points = {.count = pir_polytope_vertex_count(sphere)};
        pir_simplify_options options = {.vertices = 12};
        pir_simplified s;
        for (uint32_t v = 0; v < points.count; v++) {
            pir_vec3 at = pir_polytope_vertex(sphere, v);
            points.at[v] = (pir_vec3){sizes[i] * at.x, sizes[i] * at.y, sizes[i] * at.z};
        }
        pir_polytope *body = test_polytope(&points);
        expect(pir_polytope_simplify(body, &options, &s) == PIR_OK, "size %g", sizes[i]);
        expect(s.outer == body && s.outer_error == 0, "size %g: an outer polytope %g away", sizes[i], s.outer_error);
        assert_in_range(pir_polytope_vertex_count(s.inner), 4, 12);
        pir_simplified_release(&s);
        pir_polytope_release(body);
    }
    pir_polytope_release(sphere);
}

static void what_is_near_enough_is_the_body_itself(void **state) {
    (void)state;
    test_random random = test_random_case("itself", 0);
    pir_polytope *body = test_sphere(&random, 20);
    pir_simplify_options options = {.vertices = 20};
    pir_simplified s;
    assert_int_equal(pir_polytope_simplify(body, &options, &s), PIR_OK);
    assert_true(s.inner == body && s.outer == body && s.inner_error == 0 && s.outer_error == 0);
    pir_simplified_release(&s);
    pir_polytope_release(body);
}

static void bad_options_are_refused(void **state) {
    (void)state;
    test_random random = test_random_case("refused", 0);
    pir_polytope *body = test_sphere(&random, 20);
    pir_simplified s = {0};
    const pir_simplify_options bad[4] = {{0, 0}, {3, 0}, {8, -1}, {0, NAN}};
    for (int i = 0; i < 4; i++)
        assert_int_equal(pir_polytope_simplify(body, &bad[i], &s), i == 3 ? PIR_ERR_NOT_FINITE : PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_simplify(NULL, &(pir_simplify_options){.vertices = 8}, &s), PIR_ERR_ARGUMENT);
    assert_null(s.inner);
    pir_simplified_release(NULL);
    pir_polytope_release(body);
}

static void memory_that_runs_out_leaves_nothing(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    const pir_polytope_options on = {.allocator = &allocator};
    test_random random = test_random_case("memory", 0);
    test_points points = {.count = 30};
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = test_random_direction(&random);
    pir_status status = PIR_ERR_MEMORY;
    for (uint64_t n = 1; status == PIR_ERR_MEMORY; n++) {
        // the body anew: it keeps what queries make of it
        pir_polytope *body = NULL;
        pir_simplified s = {0};
        assert_int_equal(pir_polytope_create(points.at, points.count, &on, &body), PIR_OK);
        memory.fail_at = memory.requests + n;
        status = pir_polytope_simplify(body, &(pir_simplify_options){.vertices = 8}, &s);
        memory.fail_at = 0;
        assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && !s.inner && !s.outer));
        pir_simplified_release(&s);
        pir_polytope_release(body);
        assert_int_equal(memory.blocks, 0);
    }
    assert_int_equal(status, PIR_OK);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_hold_and_are_near),
        cmocka_unit_test(flat_bodies_are_their_own_outer_ones),
        cmocka_unit_test(bodies_at_the_ends_of_the_doubles_are_their_own_outer_ones),
        cmocka_unit_test(what_is_near_enough_is_the_body_itself),
        cmocka_unit_test(bad_options_are_refused),
        cmocka_unit_test(memory_that_runs_out_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
