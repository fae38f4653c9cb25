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

/* Makes those of a facet of `a`, the first of its group, with a vertex of b, by their numbers in the bodies. */
void pir_candidates_at_vertex(const pir_shell_body *a, const pir_shell_body *b, uint32_t facet, uint32_t vertex,
                              pir_polygons *polygons);

/* Makes that of an edge of p and one of q, if their arcs cross. */
void pir_candidate_of_edges(const pir_shell_body *p, const pir_shell_body *q, uint32_t e, uint32_t g,
                            pir_polygons *polygons);

#endif
