/* SPDX-License-Identifier: MIT */
/*
 * OFF that must not read: every fault is refused with what, where and why, nothing is lost, and no count is believed.
 */
#include <float.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "off_texts.h"

/* --- what does not read --- */

static void expect_refusal(const char *text, pir_status status, const char *where_and_what) {
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    pir_status got = read_text(text, &report, &polytope);
    if (got != status || !strstr(report.text, where_and_what))
        fail_msg("status %d, '%s'; expected status %d and '%s'", (int)got, report.text, (int)status, where_and_what);
    assert_int_equal(report.status, status);
    assert_null(polytope);
}

static void test_headers_and_counts_that_are_wrong(void **state) {
    (void)state;
    expect_refusal("", PIR_ERR_EMPTY, "m.off: the file is empty");
    expect_refusal(" \n# nothing here\n\t\n", PIR_ERR_EMPTY, "m.off: the file is empty");
    expect_refusal("OFF\n0 0 0\n", PIR_ERR_EMPTY, "m.off:2: the file has no vertices");
    expect_refusal("solid cube\n", PIR_ERR_FORMAT, "m.off:1: the file begins with 'solid'");
    expect_refusal("\x7f"
                   "ELF\x01\x02",
                   PIR_ERR_FORMAT, "m.off:1: the file begins with '?ELF");
    expect_refusal("\nCOFF\n1 0 0\n0 0 0 1 1 1 1\n", PIR_ERR_FORMAT, "m.off:2: 'COFF' files are not read");
    expect_refusal("OFF BINARY\n", PIR_ERR_FORMAT, "m.off:1: binary OFF is not read");
    expect_refusal("OFF\n", PIR_ERR_FORMAT, "m.off:1: the file ends before the number of vertices");
    expect_refusal("OFF\n4", PIR_ERR_FORMAT, "m.off:2: the file ends before the number of facets");
    expect_refusal("OFF\n4 x 0\n", PIR_ERR_FORMAT, "m.off:2: the number of facets is 'x'");
    expect_refusal("OFF\n-4 0 0\n", PIR_ERR_FORMAT, "m.off:2: the number of vertices is '-4'");
}

static void test_counts_that_lie_allocate_nothing(void **state) {
    (void)state;
    expect_refusal("OFF 4000000000 1 0\n\n", PIR_ERR_FORMAT, "m.off:1: 4000000000 vertices and 1 facets are promised");
    expect_refusal("OFF 1 4000000000 0\n0 0 0", PIR_ERR_FORMAT,
                   "m.off:1: 1 vertices and 4000000000 facets are promised");
    expect_refusal("OFF 99999999999999999999999 1 0\n0 0 0", PIR_ERR_FORMAT, "are promised");
    expect_refusal("OFF 18446744073709551615 18446744073709551615 0\n", PIR_ERR_FORMAT, "are promised");
    expect_refusal("OFF\n1 1 0\n0 0 0\n4000000000 0 0 0\n", PIR_ERR_FORMAT,
                   "m.off:4: facet 0 promises 4000000000 corners");
}

static void test_coordinates_that_are_no_numbers(void **state) {
    (void)state;
    static const struct {
        const char *token;
        pir_status status;
        const char *what;
    } cases[] = {
        {"nan", PIR_ERR_NOT_FINITE, "m.off:4: 'nan' in vertex 1 is not a finite number"},
        {"-INF", PIR_ERR_NOT_FINITE, "m.off:4: '-INF' in vertex 1 is not a finite number"},
        {"Infinity", PIR_ERR_NOT_FINITE, "m.off:4: 'Infinity'"},
        {"1e400", PIR_ERR_NOT_FINITE, "m.off:4: '1e400' is beyond the largest double"},
        {"-1e99999999999999999999", PIR_ERR_NOT_FINITE,
         "m.off:4: '-1e99999999999999999999' is beyond the largest double"},
        {"1/0", PIR_ERR_FORMAT, "m.off:4: division by zero in '1/0'"},
        {"0/-00", PIR_ERR_FORMAT, "m.off:4: division by zero"},
        {"0x10", PIR_ERR_FORMAT, "m.off:4: '0x10' in vertex 1 is not a number"},
        {"1,5", PIR_ERR_FORMAT, "'1,5' in vertex 1 is not a number"},
        {"1.5/2", PIR_ERR_FORMAT, "'1.5/2' in vertex 1 is not a number"},
        {"1/2/3", PIR_ERR_FORMAT, "is not a number"},
        {"1e", PIR_ERR_FORMAT, "is not a number"},
        {".", PIR_ERR_FORMAT, "is not a number"},
        {"--1", PIR_ERR_FORMAT, "is not a number"},
        {"+", PIR_ERR_FORMAT, "is not a number"},
        {"/2", PIR_ERR_FORMAT, "is not a number"},
        {"nano", PIR_ERR_FORMAT, "'nano' in vertex 1 is not a number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[160];
        snprintf(text, sizeof text, "OFF\n2 0 0\n0 0 0\n1 %s 0\n", cases[i].token);
        expect_refusal(text, cases[i].status, cases[i].what);
    }
}

/* `head`, then `count` times `digit`, then `tail`. */
static char *long_text(const char *head, char digit, size_t count, const char *tail) {
    char *text = malloc(strlen(head) + count + strlen(tail) + 1);
    assert_non_null(text);
    strcpy(text, head);
    memset(text + strlen(head), digit, count);
    strcpy(text + strlen(head) + count, tail);
    return text;
}

static void test_numbers_too_long_or_too_large(void **state) {
    (void)state;
    char *text = long_text("OFF\n1 0 0\n0 0 1/", '1', 5000, "\n");
    expect_refusal(text, PIR_ERR_LIMIT, "m.off:3: a number of 5002 characters in vertex 0; 4096 is the limit");
    free(text);
    text = long_text("OFF\n1 0 0\n0 0 -", '9', 400, "\n");
    expect_refusal(text, PIR_ERR_NOT_FINITE, "m.off:3: '-99999999999999999999999...' is beyond the largest double");
    free(text);
    // A long decimal and a long integer below the largest double are welcome.
    text = long_text("OFF\n2 0 0\n0 0 0.", '3', 4000, "\n0 1 0\n");
    expect_counts(must_read(text), 2, 1, 0);
    free(text);
    text = long_text("OFF\n2 0 0\n0 0 ", '9', 300, "\n0 1 0\n");
    expect_counts(must_read(text), 2, 1, 0);
    free(text);
}

static void test_denominators_without_a_common_measure(void **state) {
    (void)state;
    // 24 denominators of 4000 digits, 10^3999 + an odd number each: their common multiple is out of bounds.
    size_t room = 24 * 4020 + 64;
    char *text = malloc(room);
    assert_non_null(text);
    strcpy(text, "OFF\n8 0 0\n");
    char *end = text + strlen(text);
    for (int i = 0; i < 24; i++) {
        *end++ = '1', *end++ = '/', *end++ = '1';
        memset(end, '0', 3996);
        end += 3996;
        end += sprintf(end, "%03d%c", 2 * i + 1, i % 3 < 2 ? ' ' : '\n');
    }
    expect_refusal(text, PIR_ERR_LIMIT, "the common denominator of all coordinates passes 65536 bits");
    free(text);
}

static void test_truncated_files_say_where_they_end(void **state) {
    (void)state;
    expect_refusal("OFF\n8 0 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 10000000000000000000000\n1 0", PIR_ERR_FORMAT,
                   "m.off:8: the file ends in vertex 5 of 8");
    expect_refusal(TETRAHEDRON "3 0 2 1\n3 0 1 3\n3 1 2 3            \n", PIR_ERR_FORMAT,
                   "m.off:9: the file ends before facet 3 of 4");
    expect_refusal(TETRAHEDRON "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0    \n", PIR_ERR_FORMAT,
                   "m.off:10: the file ends in facet 3 of 4");
}

static void test_facets_that_are_wrong(void **state) {
    (void)state;
    expect_refusal(TETRAHEDRON "3 0 2 1\n3 0 1 4\n3 1 2 3\n3 2 0 3\n", PIR_ERR_FORMAT, "m.off:8: facet 1 has corner 4");
    expect_refusal(TETRAHEDRON "3 1 3 4\n3 1 0 3\n3 1 2 3\n3 2 0 3\n", PIR_ERR_FORMAT,
                   "m.off:8: corner 0 here and corner 4 on line 7");
    expect_refusal(TETRAHEDRON "3 0 2 -1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n", PIR_ERR_FORMAT,
                   "m.off:7: '-1' in facet 0 is not an index");
    expect_refusal(TETRAHEDRON "3 0 2 2\n3 0 1 3\n3 1 2 3\n3 2 0 3\n", PIR_ERR_FORMAT,
                   "m.off:7: a facet has corner 2 twice in a row");
    expect_refusal(TETRAHEDRON "4 0 2 0 2\n3 0 1 3\n3 1 2 3\n3 2 0 3\n", PIR_ERR_FORMAT,
                   "m.off:7: facet 0 has fewer than three different corners");
    expect_refusal(TETRAHEDRON "2 0 1 255 0 0\n3 0 1 3\n3 1 2 3\n3 2 0 3\n", PIR_ERR_FORMAT,
                   "m.off:7: facet 0 has '2' corners");
    expect_refusal(TETRAHEDRON "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n3 0 1 2\n", PIR_ERR_FORMAT,
                   "m.off:11: '3' follows the last facet");
    expect_refusal("OFF\n1 0 0\n0 0 0\n0\n", PIR_ERR_FORMAT, "m.off:4: '0' follows the last vertex");
}

static void test_every_prefix_of_a_file(void **state) {
    (void)state;
    for (size_t size = 0; size < strlen(CUBE); size++) {
        // An exact copy, so that a byte read past the end is seen.
        char *text = malloc(size + 1);
        assert_non_null(text);
        memcpy(text, CUBE, size);
        pir_polytope *p = NULL;
        pir_report report = {PIR_OK, ""};
        pir_status status = pir_polytope_read_bytes(&(pir_file_bytes){size ? text : NULL, size, "m.off", "off"}, NULL,
                                                    &report, NULL, &p);
        // Only the last line end is not missed.
        assert_int_equal(status == PIR_OK, size == strlen(CUBE) - 1);
        if (status != PIR_OK)
            assert_true(strncmp(report.text, "m.off:", 6) == 0 && p == NULL);
        pir_polytope_release(p);
        free(text);
    }
}

static void test_every_byte_changed(void **state) {
    (void)state;
    static const char bytes[] = {'\0', '\n', ' ', '#', '-', '/', '9', 'e', (char)0xFF};
    char text[] = CUBE;
    for (size_t at = 0; at < sizeof text - 1; at++) {
        char was = text[at];
        for (size_t i = 0; i < sizeof bytes; i++) {
            text[at] = bytes[i];
            pir_polytope *p = NULL;
            pir_report report = {PIR_OK, ""};
            pir_status status = pir_polytope_read_bytes(&(pir_file_bytes){text, sizeof text - 1, "m.off", "off"}, NULL,
                                                        &report, NULL, &p);
            assert_int_equal(status == PIR_OK, p != NULL);
            assert_int_equal(status == PIR_OK, report.text[0] == '\0');
            if (p)
                assert_int_equal(pir_polytope_is_valid(p), 1);
            pir_polytope_release(p);
        }
        text[at] = was;
    }
}

/* An allocator that gives out `left` blocks and counts the bytes in use. */
struct budget {
    size_t left, in_use;
};

static void *resize_within_budget(void *context, void *block, size_t old_size, size_t new_size) {
    struct budget *budget = context;
    if (new_size > 0 && budget->left == 0)
        return NULL;
    if (new_size > 0)
        budget->left--;
    budget->in_use += new_size - old_size;
    if (new_size > 0)
        return realloc(block, new_size);
    free(block);
    return NULL;
}

static void test_no_memory_at_every_allocation(void **state) {
    (void)state;
    const char *texts[] = {CUBE, TETRAHEDRON "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n", "OFF\n2 0 0\n0 0 1/3\n0 1/7 0\n"};
    for (size_t t = 0; t < 3; t++) {
        pir_status status = PIR_ERR_MEMORY;
        for (size_t n = 0; status != PIR_OK; n++) {
            struct budget budget = {n, 0};
            const pir_allocator allocator = {resize_within_budget, &budget};
            pir_polytope *p = NULL;
            pir_report report = {PIR_OK, ""};
            const pir_read_options options = {.size = sizeof options, .allocator = &allocator};
            status = pir_polytope_read_bytes(&(pir_file_bytes){texts[t], strlen(texts[t]), "m.off", "off"}, &options,
                                             &report, NULL, &p);
            assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && strstr(report.text, "out of memory")));
            pir_polytope_release(p);
            assert_int_equal(budget.in_use, 0);
            assert_true(n < 10000);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_headers_and_counts_that_are_wrong),
        cmocka_unit_test(test_counts_that_lie_allocate_nothing),
        cmocka_unit_test(test_coordinates_that_are_no_numbers),
        cmocka_unit_test(test_numbers_too_long_or_too_large),
        cmocka_unit_test(test_denominators_without_a_common_measure),
        cmocka_unit_test(test_truncated_files_say_where_they_end),
        cmocka_unit_test(test_facets_that_are_wrong),
        cmocka_unit_test(test_every_prefix_of_a_file),
        cmocka_unit_test(test_every_byte_changed),
        cmocka_unit_test(test_no_memory_at_every_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
