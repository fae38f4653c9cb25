/* SPDX-License-Identifier: MIT */
/* Which features and which points attain an answer. */
#ifndef PIR_QUERY_DECIDE_WITNESS_H
#define PIR_QUERY_DECIDE_WITNESS_H

#include "query/decide/facet.h"

/* The least face of `polytope` that holds the given vertices; the first vertex where no face holds all. */
pir_feature pir_feature_of(const pir_polytope *polytope, const uint32_t *vertices, uint32_t count);

/*
 * A point of Q's for a foot of x, `slack` along the normal from it, that may be beside the facet: relative to Q's
 * middle. On the facet, it is one that touches where the faces are not parallel.
 */
pir_vec3 pir_facet_point(const pir_frame *frame, const pir_placement *placement, const pir_facet *facet, double slack);

#endif
