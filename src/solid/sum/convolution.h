/* SPDX-License-Identifier: MIT */
/*
 * The facets that the boundary of a sum can consist of: convex polygons, from features of P and Q that support each
 * other locally.
 */
#ifndef PIR_SOLID_SUM_CONVOLUTION_H
#define PIR_SOLID_SUM_CONVOLUTION_H

#include "solid/body/solid_body.h"
#include "solid/space/polygons.h"

/* Takes a candidate: a polygon of the list that was given. What it leaves in the list stays. */
typedef void pir_candidate_taker(void *context, uint32_t polygon);

/* Hands every candidate of the sum of p and q, made in `polygons`, to `take`. */
void pir_candidates(const pir_shell_body *p, const pir_shell_body *q, pir_polygons *polygons, pir_candidate_taker *take,
                    void *context);

#endif
