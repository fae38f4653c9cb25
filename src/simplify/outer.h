/* SPDX-License-Identifier: MIT */
/* The outer polytope: planes of facets, each of which cut off the corner that was the farthest from the body. */
#ifndef PIR_SIMPLIFY_OUTER_H
#define PIR_SIMPLIFY_OUTER_H

#include "polytope/polytope.h"
#include "simplify/measure.h"

/* One reference to a polytope around `body`, with at most `most` vertices, and a bound on how far it reaches beyond. */
pir_status pir_simplify_outer(pir_measure *measure, pir_polytope *body, uint32_t most, double error,
                              pir_polytope **ret_outer, double *ret_error);

#endif
