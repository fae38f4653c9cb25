/* SPDX-License-Identifier: MIT */
/* OFF texts, and what the tests of reading do with a text. */
#ifndef TESTS_UNIT_OFF_TEXTS_H
#define TESTS_UNIT_OFF_TEXTS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <pirouette/pirouette.h>

#define CUBE                                                                                                           \
    "OFF\n8 6 12\n"                                                                                                    \
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"                                                         \
    "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"
#define TETRAHEDRON "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"

static inline pir_status read_text(const char *text, pir_report *report, pir_polytope **ret_polytope) {
    return pir_polytope_read_bytes(&(pir_file_bytes){text, strlen(text), "m.off", "off"}, NULL, report, NULL,
                                   ret_polytope);
}

static inline pir_polytope *must_read(const char *text) {
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    if (read_text(text, &report, &polytope) != PIR_OK)
        fail_msg("%s", report.text);
    assert_int_equal(pir_polytope_is_valid(polytope), 1);
    return polytope;
}

/* Checks vertices, edges and facets, and releases. */
static inline void expect_counts(pir_polytope *polytope, uint32_t vertices, uint32_t edges, uint32_t facets) {
    assert_int_equal(pir_polytope_vertex_count(polytope), vertices);
    assert_int_equal(pir_polytope_edge_count(polytope), edges);
    assert_int_equal(pir_polytope_facet_count(polytope), facets);
    pir_polytope_release(polytope);
}

#endif
