/* SPDX-License-Identifier: MIT */
/* The difference of two bodies and a query on it. */
#ifndef PIR_TEST_QUERY_OF_H
#define PIR_TEST_QUERY_OF_H

#include "support/test.h"

#include <pirouette/query.h>

static inline void test_query_make(pir_polytope *p, pir_polytope *q, pir_quat rotation, pir_sum **ret_sum,
                                   pir_query **ret_query) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    assert_int_equal(pir_sum_create(p, q, rotation, &options, ret_sum), PIR_OK);
    assert_int_equal(pir_query_create(*ret_sum, ret_query), PIR_OK);
}

static inline void test_query_free(pir_query *query, pir_sum *sum) {
    pir_query_destroy(query);
    pir_sum_destroy(sum);
}

#endif
