/* SPDX-License-Identifier: MIT */
/* pirouette query --batch: a file of translations, a file of answers. */
#ifndef TOOLS_QUERY_BATCH_H
#define TOOLS_QUERY_BATCH_H

#include <pirouette/query.h>

#include "args.h"

/*
 * Answers every line of --batch into -o; `start` is when the query's making began. Returns an exit status, having
 * complained unless it is EXIT_DONE.
 */
int query_batch_run(const struct args *args, pir_query *query, const pir_query_input *input, int64_t start);

#endif
