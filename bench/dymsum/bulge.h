/* SPDX-License-Identifier: MIT */
/*
 * The cubes of the paper's Figure 5: 12·n² triangles over a 10 × 10 × 10 cube, n × n × 2 on each face.
 *
 * A polytope's facets are maximal, so any tessellation of the cube is one and the same polytope of 6 facets. To have
 * something that grows, this cube bulges: its grid points are scattered by a thousandth and put on the surface |x|∞ +
 * |x|₂/20 = const, which is strictly convex along the faces. All 6n² + 2 of them are corners then, and all 12·n²
 * facets triangles.
 */
#ifndef BENCH_BULGE_H
#define BENCH_BULGE_H

#include <pirouette/polytope.h>

#define BULGE_LARGEST 10

/*
 * The cube of n × n × 2 triangles a side, 1 ≤ n ≤ BULGE_LARGEST, or the grid of the flat one, as it is, when
 * `flat`.
 */
pir_polytope *bulge_cube(unsigned n, int flat);

#endif
