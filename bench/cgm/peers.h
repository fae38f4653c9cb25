/* SPDX-License-Identifier: MIT */
/* Others' ways to a Minkowski sum of two convex polytopes, behind one interface: each is there when the
   build found its library. */
#ifndef PIR_BENCH_CGM_PEERS_H
#define PIR_BENCH_CGM_PEERS_H

#include <pirouette/polytope.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What one run took, in milliseconds, and what came out; `facets` is 0 where that peer does not tell maximal ones. */
struct peer_result {
    double milliseconds;
    uint32_t vertices, facets;
};

/* Makes the sum of P turned by `matrix` (rounded to doubles) and Q, timing what the peer's comment says. */
typedef struct peer_result peer_run(const pir_polytope *p, double matrix[3][3], const pir_polytope *q);

/* CGAL's spherical Gaussian map on an exact kernel with filters; the overlay alone is timed, maps being made before. */
peer_run peer_cgal_sgm;

/* CGAL's convex hull of all pairwise sums of vertices: exact predicates, doubles for coordinates. */
peer_run peer_cgal_hull;

/* qhull of all pairwise sums of vertices, in double. */
peer_run peer_qhull;

/* A moment of the thread's CPU time, in milliseconds. */
double peer_clock(void);

/* The median of `count` values, which it sorts. */
double peer_median(double *values, size_t count);

/* The matrix of a quaternion of any length, rounded. */
void peer_matrix(pir_quat q, double m[3][3]);

#ifdef __cplusplus
}
#endif

#endif
