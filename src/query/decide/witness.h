/* SPDX-License-Identifier: MIT */
/* Which features and which points attain an answer. */
#ifndef PIR_QUERY_DECIDE_WITNESS_H
#define PIR_QUERY_DECIDE_WITNESS_H

#include "query/decide/facet.h"

/* The least face of `polytope` that holds the given vertices, or the first vertex where no face holds all of them. */
pir_feature pir_feature_of(const pir_polytope *polytope, const uint32_t *vertices, uint32_t count);

/*
 * A point of Q, relative to Q's middle, for the foot of x on a facet's plane, which is `slack` along the normal from
 * x. The foot may lie beside the facet. Where it lies on the facet and the faces are not parallel, this is the point
 * that touches.
 */
pir_vec3 pir_facet_point(const pir_frame *frame, const pir_placement *placement, const pir_facet *facet, double slack);

/*
 * The piece that two features make, with its normal on the side of n, and a vertex of P and of Q at it. False where
 * they are not a facet and a vertex, nor two edges.
 */
bool pir_piece_of(const pir_frame *frame, pir_witness faces, uint32_t a, uint32_t b, pir_vec3 n, pir_piece *ret_piece);

#endif
