/* SPDX-License-Identifier: MIT */
/*
 * The longest numbers there are, through every path that computes with integers: coordinates from denormals to the
 * greatest doubles in one body, rationals whose common denominator is as long as is allowed, quaternions with denormal
 * parts. Each integer operation compares what it needs with what was reserved and ends the process where that is too
 * little; the answers are compared with those of other paths.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/exact.h>
#include <pirouette/io.h>
#include <pirouette/live_mesh.h>
#include <pirouette/query.h>

#include "oracle/check_sum.h"
#include "support/bodies.h"
#include "support/meshes.h"

/* --- bodies --- */

/* A double of any exponent at all, full mantissa. */
static double any_double(test_random *random) {
    switch (test_random_below(random, 6)) {
    case 0:
        return ldexp(1 + test_random_unit(random), 1023) * (test_random_below(random, 2) ? 0.75 : -0.75);
    case 1:
        return 0x1p-1074 * test_random_between(random, -3, 3);
    case 2:
        return 0;
    default:
        return test_random_scaled(random, -1070, 1020);
    }
}

static pir_polytope *body_of_doubles(test_random *random) {
    test_points points = {.count = 4 + test_random_below(random, 5)};
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = (pir_vec3){any_double(random), any_double(random), any_double(random)};
    return test_polytope(&points);
}

static void append_digits(test_random *random, char **at, uint32_t digits) {
    *(*at)++ = (char)('1' + test_random_below(random, 9));
    for (uint32_t i = 1; i < digits; i++)
        *(*at)++ = (char)('0' + test_random_below(random, 10));
}

/* A body from text: four to six points, numerators and denominators of so many digits, all at random. */
static pir_polytope *body_of_rationals(test_random *random, uint32_t digits) {
    uint32_t count = 4 + test_random_below(random, 3);
    char *text = malloc(64 + (size_t)count * 3 * (2 * (size_t)digits + 8)), *at = text;
    at += sprintf(at, "OFF\n%u 0 0\n", count);
    for (uint32_t i = 0; i < 3 * count; i++) {
        if (test_random_below(random, 2))
            *at++ = '-';
        append_digits(random, &at, digits);
        *at++ = '/';
        append_digits(random, &at, digits - test_random_below(random, digits / 4));
        *at++ = i % 3 == 2 ? '\n' : ' ';
    }
    pir_polytope *polytope = NULL;
    pir_report report = {0};
    pir_status status = pir_polytope_read_bytes(&(pir_file_bytes){text, (size_t)(at - text), "long", "off"}, NULL,
                                                &report, NULL, &polytope);
    expect(status == PIR_OK, "%s", report.text);
    free(text);
    return polytope;
}

/* A quaternion whose parts are as far apart as doubles go. */
static pir_quat any_quaternion(test_random *random) {
    if (test_random_below(random, 4) == 0)
        return test_hard_rotation(test_random_below(random, TEST_HARD_ROTATIONS));
    pir_quat q = {any_double(random), any_double(random), any_double(random), any_double(random)};
    if (q.x == 0 && q.y == 0 && q.z == 0)
        q.w = 0x1p-1074;
    return q;
}

/* --- every path --- */

static void try_maps(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_mesh *mesh, uint64_t number) {
    pir_cgm *of_p = NULL, *of_q = NULL, *both = NULL;
    pir_cgm_locator *locator = NULL;
    pir_mesh *other = NULL;
    assert_int_equal(pir_cgm_create(p, &rotation, NULL, &of_p), PIR_OK);
    assert_int_equal(pir_cgm_create(q, NULL, NULL, &of_q), PIR_OK);
    assert_int_equal(pir_cgm_overlay(of_p, of_q, &both), PIR_OK);
    expect(pir_cgm_is_valid(both), "case %llu", (unsigned long long)number);
    assert_int_equal(pir_cgm_mesh(both, PIR_EXACT, &other), PIR_OK);
    expect(pir_mesh_facet_count(mesh) == pir_mesh_facet_count(other) &&
               pir_mesh_vertex_count(mesh) == pir_mesh_vertex_count(other),
           "case %llu", (unsigned long long)number);
    mpq_t plane[4];
    for (int k = 0; k < 4; k++)
        mpq_init(plane[k]);
    assert_int_equal(pir_cgm_vertex_plane_exact(both, 0, plane), PIR_OK);
    for (int k = 0; k < 4; k++)
        mpq_clear(plane[k]);
    assert_int_equal(pir_cgm_locator_create(both, &locator), PIR_OK);
    const pir_vec3 *vertices = pir_mesh_vertices(mesh);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        pir_cgm_location location;
        pir_status status = pir_cgm_locate(locator, vertices[v], PIR_CGM_NONE, &location);
        assert_true(status == PIR_OK || status == PIR_ERR_NOT_FINITE);
    }
    pir_cgm_locator_destroy(locator);
    pir_mesh_destroy(other);
    pir_cgm_release(both);
    pir_cgm_release(of_q);
    pir_cgm_release(of_p);
}

/* Queries at and about vertices of the difference; bodies beyond what a query takes are refused. */
static void try_queries(pir_sum *difference, test_random *random, const pir_mesh *mesh) {
    pir_query *query = NULL;
    pir_status status = pir_query_create(difference, &query);
    assert_true(status == PIR_OK || status == PIR_ERR_LIMIT);
    for (uint32_t v = 0; query && v < pir_mesh_vertex_count(mesh) && v < 6; v++) {
        pir_query_input input = pir_query_input_default();
        pir_query_result result;
        pir_impact cast;
        pir_state state;
        pir_contact contacts[16];
        size_t count;
        input.translation = pir_mesh_vertices(mesh)[v];
        if (v % 3 == 1)
            input.translation = (pir_vec3){any_double(random), any_double(random), any_double(random)};
        status = pir_query_penetration(query, &input, NULL, &result);
        if (status == PIR_OK) {
            pir_query_signed_distance(query, &input, NULL, &result);
            pir_query_manifold(query, &input, &result, 16, contacts, &count);
            pir_query_directional_depth(query, &input, (pir_vec3){1, 0x1p-1074, 0}, &result);
            pir_query_cast(query, &input, (pir_vec3){-1, 1e-300, 1e300}, &cast);
            pir_query_batch_states(query, &input.translation, 1, &state);
        } else {
            assert_true(status == PIR_ERR_NOT_FINITE || status == PIR_ERR_LIMIT);
        }
    }
    pir_query_destroy(query);
}

static void try_bytes(const pir_sum *sum, uint64_t number) {
    size_t size = pir_sum_serialised_size(sum);
    void *bytes = malloc(size);
    pir_sum *restored = NULL;
    pir_report report = {0};
    assert_int_equal(pir_sum_serialise(sum, bytes, size), PIR_OK);
    expect(pir_sum_restore(bytes, size, NULL, &report, &restored) == PIR_OK, "case %llu: %s",
           (unsigned long long)number, report.text);
    assert_true(pir_sum_same_pairing(sum, restored));
    pir_sum_destroy(restored);
    free(bytes);
}

static void try_sum(pir_polytope *p, pir_polytope *q, test_random *random, uint64_t number) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = number % 2;
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, any_quaternion(random), &options, &sum), PIR_OK);
    pir_quat rotation = pir_sum_rotation(sum);
    for (int method = 0; method < 4; method++) {
        rotation = any_quaternion(random);
        assert_int_equal(pir_sum_rotate(sum, rotation, (pir_method)method), PIR_OK);
        expect(pir_sum_is_valid(sum), "case %llu, method %d", (unsigned long long)number, method);
    }
    assert_int_equal(pir_sum_rotate_brute_force(sum, rotation), PIR_OK);
    pir_mesh *mesh = NULL, *hull = NULL;
    assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
    assert_int_equal(pir_hull_sum(p, q, rotation, &options, PIR_EXACT, &hull), PIR_OK);
    expect(pir_mesh_equal(mesh, hull), "case %llu", (unsigned long long)number);
    pir_live_mesh *live = NULL;
    assert_int_equal(pir_live_mesh_create(sum, &live), PIR_OK);
    pir_live_mesh_destroy(live);
    if (options.difference)
        try_queries(sum, random, mesh);
    else
        try_maps(p, q, rotation, mesh, number);
    try_bytes(sum, number);
    pir_mesh_destroy(hull);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(sum);
}

static void doubles_of_every_exponent_keep_within_their_room(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 30; i++) {
        test_random random = test_random_case("long doubles", i);
        pir_polytope *p = body_of_doubles(&random), *q = body_of_doubles(&random);
        assert_true(pir_polytope_is_valid(p) && pir_polytope_is_valid(q));
        try_sum(p, q, &random, i);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void rationals_of_hundreds_of_digits_keep_within_their_room(void **state) {
    (void)state;
    // 18 denominators of 1090 digits come to 65172 bits, the limit being 65536
    const uint32_t digits[] = {20, 100, 400, 700, 1090};
    for (uint64_t i = 0; i < 5; i++) {
        test_random random = test_random_case("long rationals", i);
        pir_polytope *p = body_of_rationals(&random, digits[i]);
        pir_polytope *q = i % 3 == 0   ? body_of_rationals(&random, digits[i])
                          : i % 3 == 1 ? body_of_doubles(&random)
                                       : pir_polytope_retain(p);
        assert_true(pir_polytope_is_valid(p) && pir_polytope_is_valid(q));
        try_sum(p, q, &random, i);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void numbers_beyond_the_limits_are_refused(void **state) {
    (void)state;
    const struct {
        mp_bitcnt_t numerator, denominator;
        pir_status status;
    } cases[] = {{131071 - 16, 16, PIR_OK},   {131072, 0, PIR_ERR_LIMIT},    {100, 65535, PIR_OK},
                 {100, 65536, PIR_ERR_LIMIT}, {65537, 65535, PIR_ERR_LIMIT}, {10000000, 3, PIR_ERR_LIMIT},
                 {3, 10000000, PIR_ERR_LIMIT}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mpq_t x[6];
        for (int k = 0; k < 6; k++)
            mpq_init(x[k]);
        // an odd number of so many bits over a power of two, and the origin
        mpz_setbit(mpq_numref(x[0]), cases[i].numerator - 1);
        mpz_setbit(mpq_numref(x[0]), 0);
        mpz_set_ui(mpq_denref(x[0]), 0);
        mpz_setbit(mpq_denref(x[0]), cases[i].denominator);
        pir_polytope *const before = (pir_polytope *)&before;
        pir_polytope *polytope = before;
        assert_int_equal(pir_polytope_create_exact((const mpq_t *)x, 2, NULL, &polytope), cases[i].status);
        if (cases[i].status == PIR_OK)
            pir_polytope_release(polytope);
        else
            assert_ptr_equal(polytope, before);
        for (int k = 0; k < 6; k++)
            mpq_clear(x[k]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(doubles_of_every_exponent_keep_within_their_room),
        cmocka_unit_test(rationals_of_hundreds_of_digits_keep_within_their_room),
        cmocka_unit_test(numbers_beyond_the_limits_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
