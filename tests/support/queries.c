/* SPDX-License-Identifier: MIT */
/* The kinds of query: see queries.h. */
#include "support/queries.h"

#define RESULT (a ? &a->result : NULL)

static pir_status overlap(const test_question *q, test_answer *a) {
    return pir_query_overlap(q->query, q->input, q->cache, RESULT);
}

static pir_status distance(const test_question *q, test_answer *a) {
    return pir_query_distance(q->query, q->input, q->cache, RESULT);
}

static pir_status penetration(const test_question *q, test_answer *a) {
    return pir_query_penetration(q->query, q->input, q->cache, RESULT);
}

static pir_status signed_distance(const test_question *q, test_answer *a) {
    return pir_query_signed_distance(q->query, q->input, q->cache, RESULT);
}

static pir_status largest_distance(const test_question *q, test_answer *a) {
    return pir_query_largest_distance(q->query, q->input, RESULT);
}

static pir_status escapes(const test_question *q, test_answer *a) {
    const size_t capacity = sizeof a->escapes / sizeof *a->escapes;
    size_t count = 0;
    return pir_query_escapes(q->query, q->input, 0, capacity, a ? a->escapes : NULL, a ? &a->count : &count);
}

static pir_status gradient(const test_question *q, test_answer *a) {
    return pir_query_gradient(q->query, q->input, q->cache, RESULT, a ? &a->gradient : NULL, a ? &a->curvature : NULL);
}

static pir_status active(const test_question *q, test_answer *a) {
    const size_t capacity = sizeof a->active / sizeof *a->active;
    return pir_query_active(q->query, q->input, 0, capacity, a ? a->active : NULL, a ? &a->count : NULL);
}

static pir_status directional_depth(const test_question *q, test_answer *a) {
    return pir_query_directional_depth(q->query, q->input, q->direction, RESULT);
}

static pir_status directional_distance(const test_question *q, test_answer *a) {
    return pir_query_directional_distance(q->query, q->input, q->direction, RESULT);
}

static pir_status cast(const test_question *q, test_answer *a) {
    return pir_query_cast(q->query, q->input, q->direction, a ? &a->cast : NULL);
}

const test_query_kind test_query_kinds[] = {
    {"overlap", 0, overlap},
    {"distance", 0, distance},
    {"penetration", TEST_REGION, penetration},
    {"signed distance", 0, signed_distance},
    {"largest distance", 0, largest_distance},
    {"escapes", 0, escapes},
    {"gradient", 0, gradient},
    {"active", 0, active},
    {"directional depth", TEST_DIRECTED | TEST_LENGTH | TEST_REGION, directional_depth},
    {"directional distance", TEST_DIRECTED | TEST_LENGTH, directional_distance},
    {"cast", TEST_DIRECTED, cast},
    {NULL, 0, NULL},
};
