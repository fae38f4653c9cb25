/* SPDX-License-Identifier: MIT */
/* Polytopes of another size: every vertex is the factor times what it was, exactly, and all
   features keep their numbers. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/exact.h>

#include "support/bodies.h"
#include "support/memory.h"

static void expect_scaled(const pir_polytope *p, const pir_polytope *scaled, const mpq_t factor, uint64_t number) {
    mpq_t x[3], y[3];
    mpq_inits(x[0], x[1], x[2], y[0], y[1], y[2], NULL);
    assert_true(pir_polytope_is_valid(scaled));
    assert_int_equal(pir_polytope_vertex_count(scaled), pir_polytope_vertex_count(p));
    assert_int_equal(pir_polytope_dimension(scaled), pir_polytope_dimension(p));
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        pir_polytope_vertex_exact(p, v, x);
        pir_polytope_vertex_exact(scaled, v, y);
        for (int k = 0; k < 3; k++) {
            mpq_mul(x[k], x[k], factor);
            expect(mpq_equal(x[k], y[k]), "case %llu, vertex %u", (unsigned long long)number, v);
        }
        assert_int_equal(pir_polytope_source(scaled, v), pir_polytope_source(p, v));
    }
    assert_int_equal(pir_polytope_edge_count(scaled), pir_polytope_edge_count(p));
    for (uint32_t e = 0; e < pir_polytope_edge_count(p); e++) {
        uint32_t before[2], after[2];
        pir_polytope_edge(p, e, before);
        pir_polytope_edge(scaled, e, after);
        assert_memory_equal(before, after, sizeof before);
    }
    assert_int_equal(pir_polytope_facet_count(scaled), pir_polytope_facet_count(p));
    for (uint32_t f = 0; f < pir_polytope_facet_count(p); f++) {
        uint32_t before[TEST_POINTS_MAX], after[TEST_POINTS_MAX], n = pir_polytope_facet_size(p, f);
        assert_int_equal(pir_polytope_facet_size(scaled, f), n);
        pir_polytope_facet(p, f, before);
        pir_polytope_facet(scaled, f, after);
        assert_memory_equal(before, after, n * sizeof *before);
    }
    mpq_clears(x[0], x[1], x[2], y[0], y[1], y[2], NULL);
}

static void every_vertex_is_the_factor_times_what_it_was(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 120; i++) {
        test_random random = test_random_case("scale", i);
        pir_polytope *p = test_random_polytope(&random, (test_body)(i % TEST_BODY_COUNT), 20), *scaled, *again;
        mpq_t factor, inverse, one;
        mpq_inits(factor, inverse, one, NULL);
        mpq_set_si(one, 1, 1);
        mpq_set_si(factor, test_random_between(&random, 1, 99), (unsigned long)test_random_between(&random, 1, 99));
        mpq_canonicalize(factor);
        mpq_inv(inverse, factor);
        assert_int_equal(pir_polytope_scale_exact(p, factor, &scaled), PIR_OK);
        expect_scaled(p, scaled, factor, i);
        // and back to what it was
        assert_int_equal(pir_polytope_scale_exact(scaled, inverse, &again), PIR_OK);
        expect_scaled(p, again, one, i);
        pir_polytope_release(again);
        pir_polytope_release(scaled);
        // a double is the rational that it stands for
        double number = fabs(test_random_scaled(&random, -30, 30));
        mpq_set_d(factor, number);
        assert_int_equal(pir_polytope_scale(p, number, &scaled), PIR_OK);
        expect_scaled(p, scaled, factor, i);
        pir_polytope_release(scaled);
        mpq_clears(factor, inverse, one, NULL);
        pir_polytope_release(p);
    }
}

static void bad_factors_are_refused(void **state) {
    (void)state;
    test_random random = test_random_case("scale refused", 0);
    pir_polytope *p = test_random_polytope(&random, TEST_BOX, 8), *const before = (pir_polytope *)&before,
                 *scaled = before;
    mpq_t factor;
    mpq_init(factor);
    assert_int_equal(pir_polytope_scale_exact(p, factor, &scaled), PIR_ERR_ARGUMENT);
    mpq_set_si(factor, -1, 3);
    assert_int_equal(pir_polytope_scale_exact(p, factor, &scaled), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_scale(p, -1, &scaled), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_scale(p, 0, &scaled), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_scale(p, INFINITY, &scaled), PIR_ERR_NOT_FINITE);
    mpq_set_si(factor, 1, 3);
    assert_int_equal(pir_polytope_scale_exact(NULL, factor, &scaled), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_polytope_scale_exact(p, factor, NULL), PIR_ERR_ARGUMENT);
    assert_ptr_equal(scaled, before);
    // more than 65536 bits, above and below, and vertices that no double holds
    mpz_ui_pow_ui(mpq_denref(factor), 3, 41400);
    assert_int_equal(pir_polytope_scale_exact(p, factor, &scaled), PIR_ERR_LIMIT);
    mpq_inv(factor, factor);
    assert_int_equal(pir_polytope_scale_exact(p, factor, &scaled), PIR_ERR_LIMIT);
    mpq_set_si(factor, 1, 1);
    mpz_mul_2exp(mpq_numref(factor), mpq_numref(factor), 2000);
    assert_int_equal(pir_polytope_scale_exact(p, factor, &scaled), PIR_ERR_LIMIT);
    assert_ptr_equal(scaled, before);
    mpq_clear(factor);
    pir_polytope_release(p);
}

static void memory_may_run_out_anywhere(void **state) {
    (void)state;
    for (int body = 0; body < TEST_BODY_COUNT; body++) {
        test_random random = test_random_case("scale memory", (uint64_t)body);
        test_points points;
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_polytope *p = NULL;
        test_body_points(&random, (test_body)body, 10, &points);
        assert_int_equal(pir_polytope_create(points.at, points.count,
                                             &(pir_polytope_options){sizeof(pir_polytope_options), &allocator, 0}, &p),
                         PIR_OK);
        size_t blocks = memory.blocks;
        pir_status status = PIR_ERR_MEMORY;
        for (uint64_t fail_at = 1; status != PIR_OK; fail_at++) {
            pir_polytope *const before = (pir_polytope *)&before, *scaled = (pir_polytope *)before;
            memory.requests = 0;
            memory.fail_at = fail_at;
            status = pir_polytope_scale(p, 1.5, &scaled);
            if (status == PIR_OK) {
                assert_true(memory.requests < fail_at && fail_at > 5);
                pir_polytope_release(scaled);
            } else {
                assert_int_equal(status, PIR_ERR_MEMORY);
                assert_ptr_equal(scaled, before);
            }
            expect(memory.blocks == blocks && !memory.wrong_size, "body %d, request %llu", body,
                   (unsigned long long)fail_at);
        }
        pir_polytope_release(p);
        assert_int_equal(memory.blocks, 0);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_vertex_is_the_factor_times_what_it_was),
        cmocka_unit_test(bad_factors_are_refused),
        cmocka_unit_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests_name("scale", tests, NULL, NULL);
}
