/* SPDX-License-Identifier: MIT */
/*
 * How far the convex hull of two convex polytopes reaches out of them, bounded from above.
 *
 * The distance to a convex set is a convex function: on a segment it is at most what its ends have, in proportion, and
 * in a convex polygon it is greatest at a corner. Let A be below a plane. A point x of the hull of A and B is on a
 * segment from some a of A to some b of B. Where b is above the plane, let c be the segment's point in it. All such c
 * are in the convex polygon in which the plane cuts the hull of A and what B has above, with corners on segments from
 * vertex to vertex. So the distances of a, b and c from A and from B are bounded by those of a few points. Between them
 * x has two bounds that are linear along the segment, one by A and one by B, and the less counts. Where b is below the
 * plane there is no c between, and b is in the hull of the vertices of what B has below. All this holds whatever the
 * plane; it is one of a facet, of A or of B.
 *
 * Rounding, with u = 2^-53 and R the greatest coordinate: vertices are off by 4 u R, being cut to doubles, a point c
 * by 16 u R, being made of products no greater than 4 R, and a distance by 64 u R (convex_distance.h), which together
 * is less than the 128 u R that are added to each distance. A height over the plane is a sum of three products, off by
 * 8 u R at the most; the plane is 64 u R farther out than it seems, and a height is taken to be off by as much, m. So a
 * share below / (below + above) is off by 4 m / (below + above) at most, where that is no more than a half.
 */
#ifndef PIR_SOLID_PIECES_JOINT_ERROR_H
#define PIR_SOLID_PIECES_JOINT_ERROR_H

#include <pirouette/polytope.h>

/* A polytope that contains a part of a body, and reaches out of it by no more than `error`. */
typedef struct pir_joint_part {
    const pir_polytope *polytope; /* of dimension 2 at least, its vertices cut to doubles, of about 1 */
    double error;
} pir_joint_part;

/* A bound on how far the hull of both reaches out of the body that they contain parts of, unless that is `limit`. */
double pir_joint_error(const pir_joint_part *a, const pir_joint_part *b, double limit);

#endif
