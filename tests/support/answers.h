/* SPDX-License-Identifier: MIT */
/* Answers of queries and pairs, compared bit for bit. */
#ifndef PIR_TEST_ANSWERS_H
#define PIR_TEST_ANSWERS_H

#include <stdbool.h>
#include <string.h>

#include <pirouette/query.h>

static inline bool test_same_witness(const pir_witness *a, const pir_witness *b) {
    return a->p.kind == b->p.kind && a->p.index == b->p.index && a->q.kind == b->q.kind && a->q.index == b->q.index;
}

/* All that an answer says, without how much work it was. */
static inline bool test_same_result(const pir_query_result *a, const pir_query_result *b) {
    return a->state == b->state && a->outcome == b->outcome &&
           memcmp(&a->distance, &b->distance, sizeof a->distance) == 0 &&
           memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 &&
           memcmp(&a->point_p, &b->point_p, sizeof a->point_p) == 0 &&
           memcmp(&a->point_q, &b->point_q, sizeof a->point_q) == 0 && test_same_witness(&a->witness, &b->witness);
}

#endif
