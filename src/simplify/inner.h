/* SPDX-License-Identifier: MIT */
/* The inner polytope: the hull of vertices, each of which was the farthest one from the hull of those before it. */
#ifndef PIR_SIMPLIFY_INNER_H
#define PIR_SIMPLIFY_INNER_H

#include "polytope/polytope.h"
#include "simplify/measure.h"

/* One reference to a polytope in `body`, with at most `most` vertices, and a bound on how far `body` reaches beyond. */
pir_status pir_simplify_inner(pir_measure *measure, pir_polytope *body, uint32_t most, double error,
                              pir_polytope **ret_inner, double *ret_error);

#endif
