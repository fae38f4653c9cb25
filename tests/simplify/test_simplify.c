/* SPDX-License-Identifier: MIT */
/*
 * Simplified polytopes against exact distances (oracle/distance.h): the inner one is inside, the outer one around, no
 * vertex is beyond the bounds, and the bounds are not much more than the distances. Bodies are round, aligned, thin,
 * far from the origin, very small and large, and flat.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/exact.h>
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
    double size = fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z));
    return size > 0 ? size : 1;
}

static void check_simplified(uint64_t number, pir_polytope *body, const pir_simplify_options *options) {
    pir_simplified s;
    pir_status status = pir_polytope_simplify(body, options, &s);
    expect(status == PIR_OK, "body %llu: %s", (unsigned long long)number, pir_status_text(status));
    uint32_t most = options->vertices ? options->vertices : UINT32_MAX;
    expect(pir_polytope_vertex_count(s.inner) <= most, "body %llu: inner has %u vertices", (unsigned long long)number,
           pir_polytope_vertex_count(s.inner));
    expect(pir_polytope_is_valid(s.inner) && pir_polytope_is_valid(s.outer), "body %llu", (unsigned long long)number);
    if (!options->vertices)
        expect(s.inner_error <= options->error && s.outer_error <= options->error, "body %llu: errors %g and %g of %g",
               (unsigned long long)number, s.inner_error, s.outer_error, options->error);
    if (pir_polytope_dimension(body) == 3)
        expect(pir_polytope_vertex_count(s.outer) <= most, "body %llu: outer has %u vertices",
               (unsigned long long)number, pir_polytope_vertex_count(s.outer));
    if (pir_polytope_dimension(body) == 3 && pir_polytope_dimension(s.inner) == 3) {
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
        check_simplified(number, body, &options);
        options.vertices = 0;
        options.error = size_of(body) * pow(10, -1 - (double)test_random_below(&random, 4));
        check_simplified(number, body, &options);
        options.error = size_of(body) * 1e-30;
        check_simplified(number, body, &options);
        pir_polytope_release(body);
    }
}

/* Bodies of size 1 far from the origin, up to where they are a few of the doubles there. */
static void bodies_far_from_the_origin_have_the_vertices_and_bounds_of_others(void **state) {
    (void)state;
    const char *text = getenv("PIR_TEST_BODIES");
    uint64_t count = text ? strtoull(text, NULL, 10) : 120;
    for (uint64_t number = 0; number < count; number++) {
        test_random random = test_random_case("simplify far", number);
        test_points points;
        test_body_points(&random, TEST_SPHERE, 5 + test_random_below(&random, 30), &points);
        double far = ldexp(1, test_random_between(&random, 16, 49));
        stretch(&points, (pir_vec3){1, 1, 1}, (pir_vec3){0.7 * far, -0.3 * far, far});
        pir_polytope *body = test_polytope(&points);
        pir_simplify_options options = {.size = sizeof options, .vertices = 4 + test_random_below(&random, 12)};
        if (number % 2)
            options.error = pow(10, -(double)test_random_below(&random, 7));
        if (pir_polytope_dimension(body) == 3)
            check_simplified(number, body, &options);
        pir_polytope_release(body);
    }
}

static double outer_error_of(const test_points *points, uint32_t vertices) {
    pir_polytope *body = test_polytope(points);
    pir_simplified s;
    assert_int_equal(pir_polytope_simplify(
                         body, &(pir_simplify_options){.size = sizeof(pir_simplify_options), .vertices = vertices}, &s),
                     PIR_OK);
    double error = s.outer_error;
    pir_simplified_release(&s);
    pir_polytope_release(body);
    return error;
}

/* Coarse doubles cost the outer polytope some planes, not most of them. */
static void outer_polytope_far_away_is_nearly_as_near(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 24; number++) {
        test_random random = test_random_case("simplify far, outer", number);
        test_points points;
        test_body_points(&random, TEST_SPHERE, 300, &points);
        uint32_t vertices = 20 + test_random_below(&random, 200);
        double near = outer_error_of(&points, vertices), far = ldexp(1, test_random_between(&random, 30, 44));
        stretch(&points, (pir_vec3){1, 1, 1}, (pir_vec3){0.7 * far, -0.3 * far, far});
        double there = outer_error_of(&points, vertices);
        expect(there <= 2 * near + 0x1p-46 * far, "body %llu, %g away: %g, and %g at the origin",
               (unsigned long long)number, far, there, near);
    }
}

/* Vertices that are no doubles: thirds, far from the origin, and a body much smaller than the doubles are apart. */
static void exact_vertices_are_measured_exactly(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 30; number++) {
        test_random random = test_random_case("simplify exact", number);
        mpq_t at[3 * 20];
        pir_polytope *body = NULL;
        long down = number % 3 == 0 ? 30 : 0;
        for (int i = 0; i < 60; i++) {
            mpq_init(at[i]);
            mpq_set_si(at[i], test_random_between(&random, -100, 100), 30);
            mpq_canonicalize(at[i]);
            mpq_div_2exp(at[i], at[i], (mp_bitcnt_t)down);
            mpz_addmul_ui(mpq_numref(at[i]), mpq_denref(at[i]), 1ul << 46);
        }
        assert_int_equal(pir_polytope_create_exact((const mpq_t *)at, 20, NULL, &body), PIR_OK);
        if (pir_polytope_dimension(body) == 3)
            check_simplified(number, body,
                             &(pir_simplify_options){.size = sizeof(pir_simplify_options),
                                                     .vertices = 4 + test_random_below(&random, 6)});
        pir_polytope_release(body);
        for (int i = 0; i < 60; i++)
            mpq_clear(at[i]);
    }
}

/* The first vertex that is kept is the origin, a point: all others are 10^140 away, or 10^-200. */
static void vertex_at_the_origin_is_measured_from_at_any_size(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 20; number++) {
        test_random random = test_random_case("simplify at the origin", number);
        test_points points;
        test_body_points(&random, TEST_GRID, 30, &points);
        double size = number % 2 ? 1e140 : 1e-200;
        points.at[0] = (pir_vec3){-9, -9, -9};
        stretch(&points, (pir_vec3){size, size, size}, (pir_vec3){9 * size, 9 * size, 9 * size});
        pir_polytope *body = test_polytope(&points);
        check_simplified(number, body,
                         &(pir_simplify_options){.size = sizeof(pir_simplify_options),
                                                 .vertices = 4 + test_random_below(&random, 4)});
        pir_polytope_release(body);
    }
}

/*
 * A polygon in the plane of two axes and one 2^±900 times as large: alike in all but size. Its first vertex, which is
 * kept first, is the origin.
 */
static void flat_bodies_in_a_plane_of_axes_are_alike_at_any_size(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 24; number++) {
        test_random random = test_random_case("simplify flat", number);
        const int exponent = number % 2 ? 900 : -900;
        test_points points = {.count = 24}, large = {.count = 24};
        for (size_t i = 0; i < points.count; i++) {
            const double v[2] = {test_random_between(&random, 1, 99), test_random_between(&random, 1, 99)};
            double at[3] = {0};
            at[number % 3] = v[0];
            at[(number + 1) % 3] = v[1];
            points.at[i] = (pir_vec3){at[0], at[1], at[2]};
            large.at[i] = (pir_vec3){ldexp(at[0], exponent), ldexp(at[1], exponent), ldexp(at[2], exponent)};
        }
        points.at[0] = large.at[0] = (pir_vec3){0, 0, 0};
        pir_polytope *body = test_polytope(&points), *scaled = test_polytope(&large);
        for (uint32_t vertices = 1; vertices < 6; vertices++) {
            const pir_simplify_options options = {.size = sizeof options, .vertices = vertices};
            pir_simplified a = {0}, b = {0};
            const pir_status status = pir_polytope_simplify(body, &options, &a);
            assert_int_equal(pir_polytope_simplify(scaled, &options, &b), status);
            if (status == PIR_OK) {
                const double error = ldexp(b.inner_error, -exponent);
                expect(fabs(error - a.inner_error) <= 1e-9 * (a.inner_error + 1), "body %llu, %u vertices: %g, not %g",
                       (unsigned long long)number, vertices, error, a.inner_error);
                assert_int_equal(pir_polytope_vertex_count(b.inner), pir_polytope_vertex_count(a.inner));
            }
            pir_simplified_release(&a);
            pir_simplified_release(&b);
        }
        pir_polytope_release(scaled);
        pir_polytope_release(body);
    }
}

/* A cube whose corners are the greatest doubles is in no tetrahedron of doubles. */
static void body_as_large_as_doubles_has_no_outer_one_of_fewer_vertices(void **state) {
    (void)state;
    test_points cube = {.count = 8};
    pir_simplified s = {0};
    for (size_t i = 0; i < 8; i++)
        cube.at[i] = (pir_vec3){i & 1 ? 1.5e308 : -1.5e308, i & 2 ? 1.5e308 : -1.5e308, i & 4 ? 1.5e308 : -1.5e308};
    pir_polytope *body = test_polytope(&cube);
    assert_int_equal(
        pir_polytope_simplify(body, &(pir_simplify_options){.size = sizeof(pir_simplify_options), .vertices = 4}, &s),
        PIR_ERR_LIMIT);
    assert_true(!s.inner && !s.outer);
    pir_polytope_release(body);
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

/* What is around a body may be beyond the doubles, though the body is not; where doubles are coarse there is a way. */
static void bodies_at_the_ends_of_the_doubles_have_no_more_vertices_or_are_refused(void **state) {
    (void)state;
    static const double sizes[] = {1.5e308, 1e308, 1e-320};
    test_random random = test_random_case("ends of the doubles", 0);
    pir_polytope *sphere = test_sphere(&random, 40);
    for (int i = 0; i < 3; i++) {
        test_points points = {.count = pir_polytope_vertex_count(sphere)};
        pir_simplified s = {0};
        for (uint32_t v = 0; v < points.count; v++) {
            pir_vec3 at = pir_polytope_vertex(sphere, v);
            points.at[v] = (pir_vec3){sizes[i] * at.x, sizes[i] * at.y, sizes[i] * at.z};
        }
        pir_polytope *body = test_polytope(&points);
        pir_status status = pir_polytope_simplify(
            body, &(pir_simplify_options){.size = sizeof(pir_simplify_options), .vertices = 12}, &s);
        expect(status == (i < 2 ? PIR_ERR_LIMIT : PIR_OK), "size %g: %s", sizes[i], pir_status_text(status));
        if (status == PIR_OK) {
            assert_in_range(pir_polytope_vertex_count(s.inner), 4, 12);
            assert_in_range(pir_polytope_vertex_count(s.outer), 4, 12);
        }
        pir_simplified_release(&s);
        pir_polytope_release(body);
    }
    pir_polytope_release(sphere);
}

static void what_is_near_enough_is_the_body_itself(void **state) {
    (void)state;
    test_random random = test_random_case("itself", 0);
    pir_polytope *body = test_sphere(&random, 20);
    pir_simplify_options options = {.size = sizeof options, .vertices = 20};
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
    const pir_simplify_options bad[4] = {
        {sizeof *bad, 0, 0}, {sizeof *bad, 3, 0}, {sizeof *bad, 8, -1}, {sizeof *bad, 0, NAN}};
    for (int i = 0; i < 4; i++)
        assert_int_equal(pir_polytope_simplify(body, &bad[i], &s), i == 3 ? PIR_ERR_NOT_FINITE : PIR_ERR_ARGUMENT);
    const pir_simplify_options good = {.size = sizeof good, .vertices = 8};
    assert_int_equal(pir_polytope_simplify(NULL, &good, &s), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_simplify(body, NULL, &s), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_simplify(body, &good, NULL), PIR_ERR_ARGUMENT);
    assert_null(s.inner);
    pir_simplified_release(NULL);
    pir_polytope_release(body);
}

static void memory_that_runs_out_leaves_nothing(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    const pir_polytope_options on = {.size = sizeof on, .allocator = &allocator};
    test_random random = test_random_case("memory", 0);
    test_points points = {.count = 30};
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = test_random_direction(&random);
    pir_simplified right;
    pir_polytope *whole = test_polytope(&points);
    assert_int_equal(pir_polytope_simplify(
                         whole, &(pir_simplify_options){.size = sizeof(pir_simplify_options), .vertices = 8}, &right),
                     PIR_OK);
    pir_status status = PIR_ERR_MEMORY;
    for (uint64_t n = 1; status == PIR_ERR_MEMORY; n++) {
        // the body anew: it keeps what queries make of it
        pir_polytope *body = NULL;
        pir_simplified s = {0};
        assert_int_equal(pir_polytope_create(points.at, points.count, &on, &body), PIR_OK);
        memory.fail_at = memory.requests + n;
        status = pir_polytope_simplify(
            body, &(pir_simplify_options){.size = sizeof(pir_simplify_options), .vertices = 8}, &s);
        memory.fail_at = 0;
        assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && !s.inner && !s.outer));
        // the last request only gives memory back, so that it may fail: but nothing else is passed over
        if (status == PIR_OK)
            expect(s.inner_error == right.inner_error && s.outer_error == right.outer_error,
                   "request %llu: errors %g and %g", (unsigned long long)n, s.inner_error, s.outer_error);
        pir_simplified_release(&s);
        pir_polytope_release(body);
        assert_int_equal(memory.blocks, 0);
    }
    assert_int_equal(status, PIR_OK);
    pir_simplified_release(&right);
    pir_polytope_release(whole);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_hold_and_are_near),
        cmocka_unit_test(bodies_far_from_the_origin_have_the_vertices_and_bounds_of_others),
        cmocka_unit_test(outer_polytope_far_away_is_nearly_as_near),
        cmocka_unit_test(exact_vertices_are_measured_exactly),
        cmocka_unit_test(vertex_at_the_origin_is_measured_from_at_any_size),
        cmocka_unit_test(flat_bodies_in_a_plane_of_axes_are_alike_at_any_size),
        cmocka_unit_test(body_as_large_as_doubles_has_no_outer_one_of_fewer_vertices),
        cmocka_unit_test(flat_bodies_are_their_own_outer_ones),
        cmocka_unit_test(bodies_at_the_ends_of_the_doubles_have_no_more_vertices_or_are_refused),
        cmocka_unit_test(what_is_near_enough_is_the_body_itself),
        cmocka_unit_test(bad_options_are_refused),
        cmocka_unit_test(memory_that_runs_out_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
