/* SPDX-License-Identifier: MIT */
/*
 * Answers along a line that a query on a sum and a pair with its whole difference have in common, at a placement in Q's
 * frame. Results begin as zeros.
 */
#ifndef PIR_QUERY_ANSWER_ALONG_H
#define PIR_QUERY_ANSWER_ALONG_H

#include "query/answer/follow.h"
#include "query/decide/line.h"

void pir_query_depth_along(pir_query *query, const pir_line *line, pir_query_result *result);
void pir_query_distance_along(pir_query *query, const pir_line *line, pir_query_result *result);

/* `start` is the signed distance where the cast begins, `moves` whether it moves at all. */
void pir_query_cast_along(pir_query *query, const pir_line *line, bool moves, const pir_query_result *start,
                          pir_impact *impact);

#endif
