/* SPDX-License-Identifier: MIT */
/*
 * Proof, in exact arithmetic, that a mesh is a given Minkowski sum. Every function returns NULL when all holds,
 * otherwise what does not.
 */
#ifndef PIR_ORACLE_CHECK_SUM_H
#define PIR_ORACLE_CHECK_SUM_H

#include "oracle/points.h"

/*
 * That `mesh`, which holds exact coordinates, is the sum of the hulls of p (rotated already) and q, with maximal convex
 * facets:
 *
 *   - each vertex is the sum of the vertices that its pair names, hence in the sum;
 *   - facets are strictly convex polygons, each directed edge is there once and its reverse once, neighbouring facets
 *     bend strictly inwards, V − E + F = 2: the boundary of a convex body, with nothing left to merge;
 *   - each facet's plane supports the sum: the body holds all of it.
 *
 * Flat sums have the corresponding proof. Points are brought to a common denominator.
 */
const char *oracle_check_sum(const pir_mesh *mesh, oracle_points *p, oracle_points *q);

/* That the doubles of an exact mesh are the nearest to its exact coordinates, or at least within
   `ulps` of the bodies' size. */
const char *oracle_check_doubles(const pir_mesh *mesh, double ulps, double size);

/*
 * The same sum by brute force, for a few points: of all planes through three points of one operand, or along a pair of
 * points of each, those that support the sum in a polygon must be the facets of the mesh, corner by corner. The points
 * need not be extreme or distinct.
 */
const char *oracle_compare_brute_force(const pir_mesh *mesh, oracle_points *p, oracle_points *q);

#endif
