/* SPDX-License-Identifier: MIT */
/*
 * Certificates in the library: which claim an answer has, what is refused, and memory that runs out at each request.
 * What a certificate says is checked by test_check.py, with a checker that shares nothing with the library.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/certificate.h>

#include "query/box_scene.h"
#include "support/bodies.h"
#include "support/memory.h"

static const pir_quat turned = {1, 2, 3, 4};

/* The claim of the certificate of a scene's answer at x, which must be there. */
static void expect_claim(struct scene *scene, double x, pir_proven proven, const char *claim) {
    pir_query_input input = at(x, 0, 0);
    pir_query_result answer;
    pir_certificate *certificate = NULL;
    char line[64];
    size_t length;
    assert_int_equal(pir_query_signed_distance(scene->query, &input, NULL, &answer), PIR_OK);
    assert_int_equal(pir_query_certificate(scene->query, &input, &answer, proven, &certificate), PIR_OK);
    const char *text = pir_certificate_text(certificate, &length);
    snprintf(line, sizeof line, "\n\"claim\": \"%s\",\n", claim);
    assert_non_null(strstr(text, line));
    assert_int_equal(strlen(text), length);
    pir_certificate_destroy(certificate);
}

static void a_claim_is_that_of_the_answer(void **state) {
    (void)state;
    struct scene cubes = make_scene(cube(1), cube(1), still);
    expect_claim(&cubes, 3, PIR_PROVEN_STATE, "apart");
    expect_claim(&cubes, 3, PIR_PROVEN_NUMBER, "distance");
    expect_claim(&cubes, 1, PIR_PROVEN_STATE, "touching");
    expect_claim(&cubes, 1, PIR_PROVEN_NUMBER, "touching");
    expect_claim(&cubes, 0.5, PIR_PROVEN_STATE, "overlap");
    expect_claim(&cubes, 0, PIR_PROVEN_NUMBER, "depth");
    clear_scene(&cubes);
}

static void bodies_without_an_inside_have_certificates(void **state) {
    (void)state;
    const pir_vec3 line[2] = {{-1, 0, 0}, {1, 0, 0}}, across[2] = {{0, -1, 0}, {0, 1, 0}}, point = {0, 0, 0};
    struct scene segments = make_scene(test_hull(line, 2), test_hull(across, 2), still);
    expect_claim(&segments, 0, PIR_PROVEN_NUMBER, "touching");
    expect_claim(&segments, 1, PIR_PROVEN_STATE, "touching");
    expect_claim(&segments, 3, PIR_PROVEN_NUMBER, "distance");
    clear_scene(&segments);
    struct scene parallel = make_scene(test_hull(line, 2), test_hull(line, 2), still);
    expect_claim(&parallel, 0.5, PIR_PROVEN_NUMBER, "touching");
    pir_certificate *certificate = NULL;
    assert_int_equal(pir_sum_certificate(parallel.sum, &certificate), PIR_ERR_ARGUMENT);
    assert_null(certificate);
    clear_scene(&parallel);
    struct scene points = make_scene(test_hull(&point, 1), test_hull(&point, 1), still);
    expect_claim(&points, 0, PIR_PROVEN_NUMBER, "touching");
    expect_claim(&points, 1, PIR_PROVEN_STATE, "apart");
    clear_scene(&points);
}

/* --- refusals --- */

static void expect_refused(struct scene *scene, const pir_query_input *input, const pir_query_result *answer,
                           pir_status expected) {
    for (int proven = PIR_PROVEN_STATE; proven <= PIR_PROVEN_NUMBER; proven++) {
        pir_certificate *certificate = NULL;
        assert_int_equal(pir_query_certificate(scene->query, input, answer, (pir_proven)proven, &certificate),
                         expected);
        assert_null(certificate);
    }
}

static void an_answer_of_another_state_is_refused(void **state) {
    (void)state;
    struct scene cubes = make_scene(cube(1), cube(1), still);
    const double places[3] = {3, 1, 0.5};
    for (int k = 0; k < 3; k++) {
        pir_query_input input = at(places[k], 0, 0);
        pir_query_result answer;
        assert_int_equal(pir_query_signed_distance(cubes.query, &input, NULL, &answer), PIR_OK);
        const pir_state right = answer.state;
        for (int wrong = PIR_OUTSIDE; wrong <= PIR_INSIDE; wrong++) {
            answer.state = (pir_state)wrong;
            if (answer.state != right)
                expect_refused(&cubes, &input, &answer, PIR_ERR_ARGUMENT);
        }
    }
    clear_scene(&cubes);
}

static void an_answer_of_another_number_is_refused(void **state) {
    (void)state;
    struct scene cubes = make_scene(cube(1), cube(1), turned);
    const double places[2] = {3, 0.5};
    for (int k = 0; k < 2; k++) {
        pir_query_input input = at(places[k], 0, 0);
        pir_query_result answer;
        pir_certificate *certificate = NULL;
        assert_int_equal(pir_query_signed_distance(cubes.query, &input, NULL, &answer), PIR_OK);
        answer.distance += 1e-9;
        assert_int_equal(pir_query_certificate(cubes.query, &input, &answer, PIR_PROVEN_NUMBER, &certificate),
                         PIR_ERR_ARGUMENT);
        answer.distance = NAN;
        assert_int_equal(pir_query_certificate(cubes.query, &input, &answer, PIR_PROVEN_NUMBER, &certificate),
                         PIR_ERR_ARGUMENT);
        assert_null(certificate);
        // the state does not rest on the number
        assert_int_equal(pir_query_certificate(cubes.query, &input, &answer, PIR_PROVEN_STATE, &certificate), PIR_OK);
        pir_certificate_destroy(certificate);
    }
    clear_scene(&cubes);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    struct scene cubes = make_scene(cube(1), cube(1), still);
    pir_query_input input = at(3, 0, 0), other = input;
    pir_query_result answer;
    pir_certificate *certificate = NULL;
    assert_int_equal(pir_query_signed_distance(cubes.query, &input, NULL, &answer), PIR_OK);
    assert_int_equal(pir_query_certificate(NULL, &input, &answer, PIR_PROVEN_STATE, &certificate), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_certificate(cubes.query, NULL, &answer, PIR_PROVEN_STATE, &certificate),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_certificate(cubes.query, &input, NULL, PIR_PROVEN_STATE, &certificate),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_certificate(cubes.query, &input, &answer, PIR_PROVEN_STATE, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_certificate(cubes.query, &input, &answer, (pir_proven)2, &certificate),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_certificate(NULL, &certificate), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_certificate(cubes.sum, NULL), PIR_ERR_ARGUMENT);
    other.radius_p = 0.5;
    expect_refused(&cubes, &other, &answer, PIR_ERR_ARGUMENT);
    other = at(NAN, 0, 0);
    expect_refused(&cubes, &other, &answer, PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_sum_set_region(cubes.sum, (pir_vec3){0, 0, 1}, 1), PIR_OK);
    expect_refused(&cubes, &input, &answer, PIR_ERR_REGION);
    assert_int_equal(pir_sum_certificate(cubes.sum, &certificate), PIR_ERR_REGION);
    assert_null(certificate);
    pir_certificate_destroy(NULL);
    clear_scene(&cubes);
}

static void a_sum_that_stays_behind_is_refused(void **state) {
    (void)state;
    struct scene cubes = make_scene(cube(1), cube(1), turned);
    pir_certificate *certificate = NULL;
    assert_int_equal(pir_sum_set_tolerance(cubes.sum, 1), PIR_OK);
    assert_int_equal(pir_sum_rotate(cubes.sum, (pir_quat){1, 2, 3, 4.0625}, PIR_METHOD_UPDATE), PIR_OK);
    assert_int_equal(pir_sum_certificate(cubes.sum, &certificate), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_settle(cubes.sum), PIR_OK);
    assert_int_equal(pir_sum_certificate(cubes.sum, &certificate), PIR_OK);
    pir_certificate_destroy(certificate);
    clear_scene(&cubes);
}

/* --- memory --- */

/* One certificate, of an answer at x or, where there is no query, of the sum. */
static pir_status certify(pir_sum *sum, pir_query *query, double x, pir_certificate **ret_certificate) {
    pir_query_input input = at(x, 0, 0);
    pir_query_result answer;
    if (!query)
        return pir_sum_certificate(sum, ret_certificate);
    pir_status status = pir_query_signed_distance(query, &input, NULL, &answer);
    return status == PIR_OK ? pir_query_certificate(query, &input, &answer, PIR_PROVEN_NUMBER, ret_certificate)
                            : status;
}

static void memory_that_runs_out_is_told_and_all_given_back(void **state) {
    (void)state;
    pir_polytope *p = cube(1), *q = cube(2);
    const double places[4] = {4, 1.5, 0, 0};
    for (int kind = 0; kind < 4; kind++) {
        test_memory memory = {0};
        const pir_allocator allocator = test_allocator(&memory);
        pir_sum_options options = pir_sum_options_default();
        options.allocator = &allocator;
        options.difference = true;
        pir_sum *sum = NULL;
        pir_query *query = NULL;
        assert_int_equal(pir_sum_create(p, q, turned, &options, &sum), PIR_OK);
        if (kind < 3)
            assert_int_equal(pir_query_create(sum, &query), PIR_OK);
        pir_certificate *certificate = NULL, *again = NULL;
        assert_int_equal(certify(sum, query, places[kind], &certificate), PIR_OK);
        for (uint64_t fail = 1; !again; fail++) {
            size_t blocks = memory.blocks;
            memory.fail_at = memory.requests + fail;
            pir_status status = certify(sum, query, places[kind], &again);
            memory.fail_at = 0;
            assert_int_equal(status, again ? PIR_OK : PIR_ERR_MEMORY);
            assert_true(again || memory.blocks == blocks);
        }
        assert_string_equal(pir_certificate_text(again, NULL), pir_certificate_text(certificate, NULL));
        pir_certificate_destroy(again);
        pir_query_destroy(query);
        pir_sum_destroy(sum);
        pir_certificate_destroy(certificate); // it lasts without them
        assert_int_equal(memory.blocks, 0);
        assert_false(memory.wrong_size);
    }
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_claim_is_that_of_the_answer),
        cmocka_unit_test(bodies_without_an_inside_have_certificates),
        cmocka_unit_test(an_answer_of_another_state_is_refused),
        cmocka_unit_test(an_answer_of_another_number_is_refused),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(a_sum_that_stays_behind_is_refused),
        cmocka_unit_test(memory_that_runs_out_is_told_and_all_given_back),
    };
    return cmocka_run_group_tests_name("certificate", tests, NULL, NULL);
}
