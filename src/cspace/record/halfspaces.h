/* SPDX-License-Identifier: MIT */
/*
 * The half-space of a pair, by doubles, proven to hold the whole difference.
 *
 * A normal in doubles is within some units of rounding of the pair's own, n. In its direction the support of D exceeds
 * that of the pair's facet by at most the error of the normal times the diameter of D, and the corner that is put into
 * the offset is off by its own rounding. Both are below 2^-44 times the reach, the greatest distance of a vertex of
 * −P from the origin and the same of Q added; for a pair of edges, below that by the sine of the angle between them.
 * That much is added to the offset. Where the sine is below 2^-30, the half-space is that of the facet of −P beside
 * the edge.
 */
#ifndef PIR_CSPACE_RECORD_HALFSPACES_H
#define PIR_CSPACE_RECORD_HALFSPACES_H

#include <pirouette/cspace.h>

#include "exact/rotation.h"
#include "polytope/polytope.h"

typedef struct pir_halfspaces {
    const pir_polytope *p, *q; /* −P and Q; borrowed */
    const pir_mat3 *r;
    double slack; /* 2^-44 times the reach */
} pir_halfspaces;

/* O(vertices). */
pir_halfspaces pir_halfspaces_of(const pir_polytope *minus_p, const pir_polytope *q, const pir_mat3 *r);

/* Of facet f of −P and vertex v of Q; of facet g of Q and vertex u of −P. */
pir_halfspace pir_halfspace_fv(const pir_halfspaces *of, uint32_t f, uint32_t v);
pir_halfspace pir_halfspace_vf(const pir_halfspaces *of, uint32_t g, uint32_t u);

/* Of edge e of −P and halfedge h of Q, which leaves the cell before the crossing; fv as in the pairing. */
pir_halfspace pir_halfspace_ee(const pir_halfspaces *of, uint32_t e, uint32_t h, const uint32_t *fv);

#endif
