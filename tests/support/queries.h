/* SPDX-License-Identifier: MIT */
/*
 * Every call of a query that answers for one placement, in one form. Tests that go through this list see to it that
 * each kind of query is refused bad input, allocates nothing after its first answer, survives that memory runs out,
 * answers alike through all handles, and says whether it can answer with a region.
 */
#ifndef PIR_TEST_QUERIES_H
#define PIR_TEST_QUERIES_H

#include <pirouette/gradient.h>

/* A call that takes no direction, or no cache, passes it over. */
typedef struct test_question {
    pir_query *query;
    const pir_query_input *input;
    pir_query_cache *cache;
    pir_vec3 direction;
} test_question;

/* The results of all calls. Each fills its own. */
typedef struct test_answer {
    pir_query_result result;
    pir_impact cast;
    pir_escape escapes[4];
    pir_gradient gradient;
    pir_curvature curvature;
    pir_active active[8];
    size_t count;
} test_answer;

enum {
    TEST_DIRECTED = 1, /* refuses a direction that is not finite */
    TEST_LENGTH = 2,   /* refuses one without a length */
    TEST_REGION = 4,   /* also answers where the sum has a region that holds the direction */
};

typedef struct test_query_kind {
    const char *name;
    int traits;
    pir_status (*ask)(const test_question *q, test_answer *ret_answer); /* ret_answer: NULL gives the call no result */
} test_query_kind;

/* The kinds of query; one without a name ends them. */
extern const test_query_kind test_query_kinds[];

#endif
