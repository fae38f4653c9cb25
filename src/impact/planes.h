/* SPDX-License-Identifier: MIT */
/*
 * Planes that separate, and proofs that bodies touch.
 *
 * Facets of the difference at its vertex a − b are: the facets of P at a, with b; those of Q at b, with a; the edges
 * of both there. When the point nearest to the origin of Q is on a face, one of the facets that hold that face
 * separates.
 */
#ifndef PIR_IMPACT_PLANES_H
#define PIR_IMPACT_PLANES_H

#include <pirouette/query.h>

#include "impact/search.h"

/* The plane with the greatest distance around the features of an answer now, in doubles. False where none has one. */
bool pir_candidates_near(const pir_impact_search *search, const pir_witness *witness, pir_condition *ret_plane);

/* Whether a plane separates strictly now; at the beginning, where SOON, a hair after it. */
bool pir_parts_strictly(pir_impact_search *search, const pir_condition *plane, pir_sign_when when);

/* A plane that separates strictly, among all. */
bool pir_candidates_any(pir_impact_search *search, pir_sign_when when, pir_condition *ret_plane);

/* Whether some plane has the bodies on its sides a hair after the beginning, touching it or not. */
bool pir_candidates_rest(pir_impact_search *search);

/*
 * Whether the two features of a plane, which ends to separate now, touch: a vertex within a facet, or two edges that
 * cross. False proves nothing.
 */
bool pir_features_touch(pir_impact_search *search, const pir_condition *slack);

/* Whether a vertex that an answer of now names is in the other's face there. False proves nothing. */
bool pir_witness_touches(pir_impact_search *search, const pir_witness *witness);

#endif
