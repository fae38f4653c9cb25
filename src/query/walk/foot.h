/* SPDX-License-Identifier: MIT */
/*
 * The least slack from one facet of D and the foot of x on it.
 *
 * Let F be a facet of D with normal n and slack s at x, y = x + s n the foot of x, and let F hold the disc of radius
 * m about y. Let G be another facet of D with a normal at the angle θ from n, and S = max(s, 0). D is within the plane
 * of G, so the disc is, and the slack of G at x is at least m sin θ + s cos θ. Since 1 − cos θ = tan(θ/2) sin θ,
 * it is above s for θ < θ₁, where tan(θ₁/2) = m / S. For all others one of these is enough:
 *
 *   - The ball of radius r about 0 is in D (frame.h). So the slack of G at x is at least r less what x is along the
 *     normal of G, which is at an angle of at least θ₁ − ψ from x, ψ being the one of n. Where ψ < θ₁ and
 *     r − |x| cos(θ₁ − ψ) is above S, so is the slack of G.
 *   - Let z be a point of D, k below F, and L at least its distance from the line through x and y. The slack of G
 *     at y is at least −k cos θ − L sin θ. Where κ = S / m is below 1, θ is beyond a right angle: −cos θ ≥
 *     (1 − κ²) / (1 + κ²) and sin θ ≤ 2 κ / (1 + κ²). So the slack of G at x is at least
 *     ((k − S)(1 − κ²) − 2 κ L) / (1 + κ²), where that is above S.
 *
 * So a body that rests on another, or that has sunk into it by not much more than the foot is from the rim, needs one
 * facet.
 */
#ifndef PIR_QUERY_WALK_FOOT_H
#define PIR_QUERY_WALK_FOOT_H

#include "query/decide/facet.h"

/* The side of F that a point of its plane is least within, or farthest beyond. */
typedef struct pir_rim {
    double margin;         /* how far it is within, less errors */
    bool of_q;             /* the side is along an edge of Q, not of P */
    uint32_t half, across; /* a halfedge of that edge, and the vertex of the other body that it is put at */
} pir_rim;

/* The side that the foot of x is least within. Neither body is a point or a segment. */
pir_rim pir_foot_rim(const pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack);

/*
 * The sides that a point is less than `within` of them within, in doubles. Where these do not tell which corner is
 * across a side, it is listed with each. Some of those are no sides.
 */
#define PIR_RIMS_MOST 16
typedef struct pir_rims {
    double within;
    uint32_t count; /* above PIR_RIMS_MOST where there are more: then not all are listed */
    pir_rim side[PIR_RIMS_MOST];
} pir_rims;

/* The rim's side that a point y of F's plane is least within; lists the sides near y. */
pir_rim pir_foot_rims(const pir_exact *exact, const pir_placement *placement, const pir_facet *facet, pir_vec3 y,
                      pir_rims *rims);

/*
 * Whether the slack of F, which is at most `slack` and certain to be above −placement->error · facet->err, is below
 * that of all other facets.
 */
bool pir_foot_settles(const pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack);

/* Whether it is so, given that F holds the disc of radius `margin` about the foot. */
bool pir_foot_settles_within(const pir_frame *frame, const pir_placement *placement, const pir_facet *facet,
                             double slack, double margin);

#endif
