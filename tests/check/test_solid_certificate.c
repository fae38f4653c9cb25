/* SPDX-License-Identifier: MIT */
/*
 * Certificates of solids in the library: which claim an answer has, what is refused, and memory that runs out at each
 * request. What a certificate says is checked by test_solids.py, with a checker that shares nothing with the library.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/certificate.h>

#include "solid/bodies.h"
#include "support/memory.h"

struct solids {
    pir_solid_query *query;
    pir_workspace *workspace;
};

/* An L in two pieces, 3 long and 1 thick, against another one. */
static struct solids make_solids(const pir_allocator *allocator) {
    static const double corner[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    static solid_facets facets;
    struct solids made = {NULL, NULL};
    pir_pieces *pieces = NULL;
    facets = (solid_facets){.points = 0};
    solid_add_prism(&facets, corner, 6, 1);
    pir_solid *solid = solid_of_facets(&facets);
    assert_int_equal(pir_solid_decompose(solid, NULL, NULL, &pieces), PIR_OK);
    assert_int_equal(pir_pieces_count(pieces), 2);
    assert_int_equal(pir_solid_query_create(pieces, pieces, allocator, &made.query), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &made.workspace), PIR_OK);
    pir_pieces_destroy(pieces);
    pir_solid_release(solid);
    return made;
}

static void destroy_solids(const struct solids *solids) {
    pir_solid_query_destroy(solids->query);
    pir_workspace_destroy(solids->workspace);
}

static pir_pair_input at(double x, double y, double z) {
    pir_pair_input input = pir_pair_input_default();
    input.pose_p.translation = (pir_vec3){x, y, z};
    return input;
}

static pir_query_result ask(const struct solids *solids, const pir_pair_input *input) {
    pir_solid_distance distance;
    assert_int_equal(pir_solid_query_distance(solids->query, solids->workspace, input, &distance), PIR_OK);
    return distance.result;
}

static void expect_claim(const struct solids *solids, pir_pair_input input, pir_proven proven, const char *claim) {
    const pir_query_result answer = ask(solids, &input);
    pir_certificate *certificate = NULL;
    char line[64];
    size_t length;
    assert_int_equal(pir_solid_query_certificate(solids->query, &input, &answer, proven, &certificate), PIR_OK);
    const char *text = pir_certificate_text(certificate, &length);
    snprintf(line, sizeof line, "\n\"claim\": \"%s\",\n", claim);
    assert_non_null(strstr(text, line));
    assert_int_equal(strlen(text), length);
    pir_certificate_destroy(certificate);
}

static void a_claim_is_that_of_the_answer(void **state) {
    (void)state;
    const struct solids solids = make_solids(NULL);
    expect_claim(&solids, at(4, 0, 0), PIR_PROVEN_STATE, "apart");
    expect_claim(&solids, at(4, 0, 0), PIR_PROVEN_NUMBER, "distance");
    expect_claim(&solids, at(1.5, 1.5, 0), PIR_PROVEN_NUMBER, "distance"); // between the arms
    expect_claim(&solids, at(1, 1, 0), PIR_PROVEN_STATE, "touching");
    expect_claim(&solids, at(3, 0, 0), PIR_PROVEN_NUMBER, "touching");
    expect_claim(&solids, at(0, 0, 0), PIR_PROVEN_STATE, "overlap");
    expect_claim(&solids, at(0, 2, 0.5), PIR_PROVEN_NUMBER, "overlap");
    destroy_solids(&solids);
}

static void expect_refused(const struct solids *solids, const pir_pair_input *input, const pir_query_result *answer,
                           pir_status expected) {
    pir_certificate *certificate = NULL;
    assert_int_equal(pir_solid_query_certificate(solids->query, input, answer, PIR_PROVEN_NUMBER, &certificate),
                     expected);
    assert_null(certificate);
}

static void an_answer_that_is_not_right_is_refused(void **state) {
    (void)state;
    const struct solids solids = make_solids(NULL);
    const double places[3] = {4, 3, 0.5};
    for (int k = 0; k < 3; k++) {
        const pir_pair_input input = at(places[k], 0, 0);
        pir_query_result answer = ask(&solids, &input);
        const pir_state right = answer.state;
        for (int wrong = PIR_OUTSIDE; wrong <= PIR_INSIDE; wrong++) {
            answer.state = (pir_state)wrong;
            if (answer.state != right)
                expect_refused(&solids, &input, &answer, PIR_ERR_ARGUMENT);
        }
    }
    pir_pair_input input = at(4, 0, 0);
    pir_query_result answer = ask(&solids, &input);
    answer.distance += 1e-9;
    expect_refused(&solids, &input, &answer, PIR_ERR_ARGUMENT);
    answer.distance = NAN;
    expect_refused(&solids, &input, &answer, PIR_ERR_ARGUMENT);
    input.cutoff = 0.5; // a distance beyond it is not told, and the certificate tells it
    answer = ask(&solids, &input);
    assert_int_equal(answer.outcome, PIR_BEYOND_CUTOFF);
    expect_claim(&solids, input, PIR_PROVEN_NUMBER, "distance");
    destroy_solids(&solids);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    const struct solids solids = make_solids(NULL);
    const pir_pair_input input = at(4, 0, 0);
    const pir_query_result answer = ask(&solids, &input);
    pir_certificate *certificate = NULL;
    assert_int_equal(pir_solid_query_certificate(NULL, &input, &answer, PIR_PROVEN_STATE, &certificate),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_query_certificate(solids.query, NULL, &answer, PIR_PROVEN_STATE, &certificate),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_query_certificate(solids.query, &input, NULL, PIR_PROVEN_STATE, &certificate),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_query_certificate(solids.query, &input, &answer, PIR_PROVEN_STATE, NULL),
                     PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_query_certificate(solids.query, &input, &answer, (pir_proven)2, &certificate),
                     PIR_ERR_ARGUMENT);
    pir_pair_input other = input;
    other.radius_q = 0.5;
    expect_refused(&solids, &other, &answer, PIR_ERR_ARGUMENT);
    other = input;
    other.pose_q.translation.x = 1;
    expect_refused(&solids, &other, &answer, PIR_ERR_ARGUMENT);
    other = at(0, NAN, 0);
    expect_refused(&solids, &other, &answer, PIR_ERR_NOT_FINITE);
    other = input;
    other.pose_p.rotation.w = INFINITY;
    expect_refused(&solids, &other, &answer, PIR_ERR_NOT_FINITE);
    other.pose_p.rotation.w = 0;
    expect_refused(&solids, &other, &answer, PIR_ERR_ZERO_QUATERNION);
    destroy_solids(&solids);
}

static void memory_that_runs_out_is_told_and_all_given_back(void **state) {
    (void)state;
    const double places[3] = {4, 3, 0.5};
    for (int k = 0; k < 3; k++) {
        test_memory memory = {0};
        const pir_allocator allocator = test_allocator(&memory);
        const struct solids solids = make_solids(&allocator);
        const pir_pair_input input = at(places[k], 0, 0);
        const pir_query_result answer = ask(&solids, &input);
        const pir_proven proven = PIR_PROVEN_NUMBER;
        pir_certificate *certificate = NULL, *again = NULL;
        assert_int_equal(pir_solid_query_certificate(solids.query, &input, &answer, proven, &certificate), PIR_OK);
        for (uint64_t fail = 1; !again; fail++) {
            const size_t blocks = memory.blocks;
            memory.fail_at = memory.requests + fail;
            const pir_status status = pir_solid_query_certificate(solids.query, &input, &answer, proven, &again);
            memory.fail_at = 0;
            assert_int_equal(status, again ? PIR_OK : PIR_ERR_MEMORY);
            assert_true(again || memory.blocks == blocks);
        }
        assert_string_equal(pir_certificate_text(again, NULL), pir_certificate_text(certificate, NULL));
        pir_certificate_destroy(again);
        destroy_solids(&solids);
        pir_certificate_destroy(certificate); // it lasts without them
        assert_int_equal(memory.blocks, 0);
        assert_false(memory.wrong_size);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_claim_is_that_of_the_answer),
        cmocka_unit_test(an_answer_that_is_not_right_is_refused),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(memory_that_runs_out_is_told_and_all_given_back),
    };
    return cmocka_run_group_tests_name("certificates of solids", tests, NULL, NULL);
}
