/* SPDX-License-Identifier: MIT */
/* Answers over all of D that a query on a sum and a pair have in common, at a placement in Q's frame. */
#ifndef PIR_QUERY_ANSWER_EXTENT_H
#define PIR_QUERY_ANSWER_EXTENT_H

#include "query/answer/follow.h"

/* Of the input the radii alone count. PIR_ERR_LIMIT for a distance beyond the doubles. */
pir_status pir_query_farthest(pir_query *query, const pir_placement *placement, const pir_query_input *input,
                              pir_query_result *ret_result);

/* A question for ways out: the penetration, by how much more they may take, room for how many. */
typedef struct pir_escapes_ask {
    const pir_query_result *least;
    double radii, slack;
    size_t capacity;
} pir_escapes_ask;

/* How many there are, of which the first ones are written. */
size_t pir_query_ways_out(pir_query *query, const pir_placement *placement, const pir_escapes_ask *ask,
                          pir_escape *ret_escapes);

#endif
