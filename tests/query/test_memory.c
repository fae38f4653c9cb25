/* SPDX-License-Identifier: MIT */
/*
 * Queries whose planes must grow and cannot. Between two rotations the crossings of the sum become far more than a
 * query has memory for. A call that finds no memory says so and leaves its results untouched. With memory again the
 * same query answers as a new one, bit for bit.
 */
#include "support/test.h"

#include <string.h>

#include <pirouette/query.h>

#include "support/bodies.h"
#include "support/memory.h"

/* The difference reflects P: its narrow sides are turned away first, and then towards those of Q. */
static const pir_quat few = {0.001, 0.002, 0, 1}, many = {0, 0, 1, 0.001};

#define TRANSLATIONS 3
static const pir_vec3 translations[TRANSLATIONS] = {{0.1, 0.2, -0.1}, {2.5, 0.25, 0.5}, {-1, 1, 1}};

/* What the calls put out. */
struct answers {
    pir_query_result overlap, distance, penetration;
    double depths[TRANSLATIONS], distances[TRANSLATIONS];
    pir_state states[TRANSLATIONS];
};

enum { CALLS = 6 };

static pir_status call(pir_query *query, int which, struct answers *ret_answers) {
    pir_query_input input = pir_query_input_default();
    input.translation = translations[0];
    switch (which) {
    case 0:
        return pir_query_overlap(query, &input, NULL, &ret_answers->overlap);
    case 1:
        return pir_query_signed_distance(query, &input, NULL, &ret_answers->distance);
    case 2:
        return pir_query_penetration(query, &input, NULL, &ret_answers->penetration);
    case 3:
        return pir_query_batch_depths(query, translations, TRANSLATIONS, ret_answers->depths, NULL);
    case 4:
        return pir_query_batch_distances(query, translations, TRANSLATIONS, ret_answers->distances, NULL);
    default:
        return pir_query_batch_states(query, translations, TRANSLATIONS, ret_answers->states);
    }
}

/* All answers of a query that has the memory it needs. */
static struct answers ask_all(pir_query *query) {
    struct answers answers;
    memset(&answers, 0, sizeof answers);
    for (int which = 0; which < CALLS; which++)
        assert_int_equal(call(query, which, &answers), PIR_OK);
    return answers;
}

static bool same_result(const pir_query_result *a, const pir_query_result *b) {
    return a->state == b->state && a->outcome == b->outcome &&
           memcmp(&a->distance, &b->distance, sizeof a->distance) == 0 &&
           memcmp(&a->normal, &b->normal, sizeof a->normal) == 0;
}

static void expect_same_answers(const struct answers *a, const struct answers *b) {
    assert_true(same_result(&a->overlap, &b->overlap) && same_result(&a->distance, &b->distance) &&
                same_result(&a->penetration, &b->penetration));
    assert_memory_equal(a->depths, b->depths, sizeof a->depths);
    assert_memory_equal(a->distances, b->distances, sizeof a->distances);
    assert_memory_equal(a->states, b->states, sizeof a->states);
}

static pir_sum *difference_of(pir_polytope *p, pir_polytope *q, const pir_allocator *allocator) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    options.allocator = allocator;
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, few, &options, &sum), PIR_OK);
    return sum;
}

static void queries_whose_planes_cannot_grow_say_so(void **state) {
    (void)state;
    pir_polytope *p = test_fluted_prism(1), *q = test_fluted_prism(0);
    pir_sum *there = difference_of(p, q, NULL);
    pir_query *fresh = NULL;
    assert_int_equal(pir_sum_rotate(there, many, PIR_METHOD_WALK), PIR_OK);
    assert_int_equal(pir_query_create(there, &fresh), PIR_OK);
    struct answers expected = ask_all(fresh);
    for (int which = 0; which < CALLS; which++) {
        uint64_t failures = 0, n = 0;
        for (bool failed = true; failed;) {
            test_memory memory = {0};
            pir_allocator allocator = test_allocator(&memory);
            pir_sum *sum = difference_of(p, q, &allocator);
            pir_query *query = NULL;
            assert_int_equal(pir_query_create(sum, &query), PIR_OK);
            // the memory of batches is there already, but too small for the next one
            ask_all(query);
            assert_int_equal(pir_sum_rotate(sum, many, PIR_METHOD_UPDATE), PIR_OK);
            memory.fail_at = memory.requests + ++n;
            struct answers answers, before;
            memset(&answers, 0xa5, sizeof answers);
            before = answers;
            pir_status status = call(query, which, &answers);
            failed = status != PIR_OK;
            if (failed) {
                assert_int_equal(status, PIR_ERR_MEMORY);
                assert_memory_equal(&answers, &before, sizeof before);
                failures++;
            }
            memory.fail_at = 0;
            answers = ask_all(query);
            expect_same_answers(&answers, &expected);
            pir_query_destroy(query);
            pir_sum_destroy(sum);
            expect(memory.blocks == 0 && !memory.wrong_size, "call %d, request %llu", which, (unsigned long long)n);
        }
        // planes and work space; batches have leaves as well
        expect(failures >= (which < 3 ? 2 : 3), "call %d failed %llu times", which, (unsigned long long)failures);
    }
    pir_query_destroy(fresh);
    pir_sum_destroy(there);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void queries_that_cannot_be_made_leave_nothing(void **state) {
    (void)state;
    uint64_t failures = 0;
    for (int body = 0; body < TEST_BODY_COUNT; body++) {
        test_random random = test_random_case("query memory", (uint64_t)body);
        pir_polytope *p = test_random_polytope(&random, (test_body)body, 12),
                     *q = test_random_polytope(&random, TEST_GRID, 12);
        pir_status status = PIR_ERR_MEMORY;
        for (uint64_t n = 1; status != PIR_OK; n++) {
            test_memory memory = {0};
            pir_allocator allocator = test_allocator(&memory);
            pir_sum *sum = difference_of(p, q, &allocator);
            pir_query *const before = (pir_query *)&before, *query = before;
            memory.fail_at = memory.requests + n;
            status = pir_query_create(sum, &query);
            if (status == PIR_OK) {
                pir_query_destroy(query);
            } else {
                assert_int_equal(status, PIR_ERR_MEMORY);
                assert_ptr_equal(query, before);
                failures++;
            }
            pir_sum_destroy(sum);
            expect(memory.blocks == 0 && !memory.wrong_size, "body %d, request %llu", body, (unsigned long long)n);
        }
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    // the query, its room, limbs there, its arrays
    assert_true(failures >= 4 * TEST_BODY_COUNT);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(queries_whose_planes_cannot_grow_say_so),
        cmocka_unit_test(queries_that_cannot_be_made_leave_nothing),
    };
    return cmocka_run_group_tests_name("query memory", tests, NULL, NULL);
}
