/* SPDX-License-Identifier: MIT */
/*
 * Certificates of sums of solids in the library: what is refused, limits, and memory that runs out at each request.
 * What a certificate says is checked by test_solid_sum.py, with a checker that shares nothing with the library.
 */
#include "support/test.h"

#include <string.h>

#include <pirouette/certificate.h>

#include "solid/bodies.h"
#include "solid/kept/solid_sum.h"
#include "support/memory.h"

static const pir_quat turned = {0, 0, 1, 2};

/* An L of three cells, or one of two; the caller's. */
static pir_solid *some_solid(bool is_long) {
    cells of = {0};
    of.full[0][0][0] = of.full[1][0][0] = of.full[0][is_long][0] = true;
    return solid_of_cells(&of);
}

static pir_solid_sum *some_sum(const pir_solid *p, const pir_solid *q, const pir_solid_sum_options *options) {
    pir_solid_sum *sum = NULL;
    assert_int_equal(pir_solid_sum_create(p, q, turned, options, &sum), PIR_OK);
    return sum;
}

static void a_text_lasts_without_the_sum(void **state) {
    (void)state;
    pir_solid *p = some_solid(true), *q = some_solid(false);
    for (int difference = 0; difference < 2; difference++) {
        pir_solid_sum_options options = pir_solid_sum_options_default();
        options.difference = difference;
        pir_solid_sum *sum = some_sum(p, q, &options);
        pir_certificate *certificate = NULL;
        size_t length = 0;
        assert_int_equal(pir_solid_sum_certificate(sum, &certificate), PIR_OK);
        pir_solid_sum_destroy(sum);
        const char *text = pir_certificate_text(certificate, &length);
        assert_int_equal(strlen(text), length);
        assert_non_null(strstr(text, difference ? "\"claim\": \"difference\"" : "\"claim\": \"sum\""));
        pir_certificate_destroy(certificate);
    }
    pir_solid_release(q);
    pir_solid_release(p);
}

static void what_has_none_is_refused(void **state) {
    (void)state;
    pir_solid *p = some_solid(true);
    pir_report report = {0};
    pir_certificate *certificate = NULL;
    pir_solid_sum_options options = pir_solid_sum_options_default();
    options.report = &report;
    pir_solid_sum *sum = some_sum(p, p, &options);
    assert_int_equal(pir_solid_sum_certificate(NULL, &certificate), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_sum_certificate(sum, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_solid_sum_set_scale(sum, PIR_OPERAND_P, 2), PIR_OK);
    assert_int_equal(pir_solid_sum_certificate(sum, &certificate), PIR_ERR_ARGUMENT);
    assert_non_null(strstr(report.text, "scaled"));
    pir_solid_sum_destroy(sum);
    options.open = true;
    sum = some_sum(p, p, &options);
    assert_int_equal(pir_solid_sum_certificate(sum, &certificate), PIR_ERR_ARGUMENT);
    assert_non_null(strstr(report.text, "open"));
    assert_null(certificate);
    pir_solid_sum_destroy(sum);
    pir_solid_release(p);
}

/* The limit of a sum that is there already grows until its certificate is within it. */
static void a_limit_is_told(void **state) {
    (void)state;
    pir_solid *p = some_solid(true);
    pir_report report = {0};
    pir_certificate *certificate = NULL;
    pir_solid_sum_options options = pir_solid_sum_options_default();
    options.report = &report;
    pir_solid_sum *sum = some_sum(p, p, &options);
    uint32_t limited = 0;
    for (size_t limit = 1000; !certificate; limit += limit / 8) {
        sum->options.memory = limit;
        const pir_status status = pir_solid_sum_certificate(sum, &certificate);
        if (status == PIR_OK)
            break;
        assert_int_equal(status, PIR_ERR_LIMIT);
        // below that the mesh of the sum is not within it
        limited += strstr(report.text, "certificate: more than") != NULL;
    }
    assert_true(limited > 0);
    pir_certificate_destroy(certificate);
    pir_solid_sum_destroy(sum);
    pir_solid_release(p);
}

static void memory_that_runs_out_is_told_and_all_given_back(void **state) {
    (void)state;
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    pir_solid *p = some_solid(true), *q = some_solid(false);
    pir_solid_sum_options options = pir_solid_sum_options_default();
    options.allocator = &allocator;
    pir_solid_sum *sum = some_sum(p, q, &options);
    pir_certificate *certificate = NULL, *again = NULL;
    assert_int_equal(pir_solid_sum_certificate(sum, &certificate), PIR_OK);
    // steps grow, so that not every request fails once
    for (uint64_t fail = 1; !again; fail += 1 + fail / 100) {
        const size_t blocks = memory.blocks;
        memory.fail_at = memory.requests + fail;
        const pir_status status = pir_solid_sum_certificate(sum, &again);
        memory.fail_at = 0;
        assert_int_equal(status, again ? PIR_OK : PIR_ERR_MEMORY);
        assert_true(again || memory.blocks == blocks);
    }
    assert_string_equal(pir_certificate_text(again, NULL), pir_certificate_text(certificate, NULL));
    pir_certificate_destroy(again);
    pir_solid_sum_destroy(sum);
    pir_certificate_destroy(certificate);
    assert_int_equal(memory.blocks, 0);
    assert_false(memory.wrong_size);
    pir_solid_release(q);
    pir_solid_release(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_text_lasts_without_the_sum),
        cmocka_unit_test(what_has_none_is_refused),
        cmocka_unit_test(a_limit_is_told),
        cmocka_unit_test(memory_that_runs_out_is_told_and_all_given_back),
    };
    return cmocka_run_group_tests_name("certificates of solids", tests, NULL, NULL);
}
