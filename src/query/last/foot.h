/* SPDX-License-Identifier: MIT */
/*
 * The least slack from one facet of D and the foot of x on it.
 *
 * Let F be a facet of D with normal n and slack s at x, y = x + s n the foot of x, and let F hold the disc of radius m
 * about y. Let z be a point of D, k below F, and L at least its distance from the line through x and y. Let G be
 * another facet of D with a normal at the angle θ from n, and S = max(s, 0). D is within the plane of G, so the disc
 * and z are, and the slack of G at y is at least m sin θ and at least −k cos θ − L sin θ. At x it is that, plus
 * s cos θ. Where κ = S / m is below 1 it is above s
 *
 *   - for tan(θ/2) < 1/κ: it is at least m sin θ + s cos θ, and 1 − cos θ = tan(θ/2) sin θ;
 *   - for all others, where −cos θ ≥ (1 − κ²) / (1 + κ²) and sin θ ≤ 2 κ / (1 + κ²): it is at least
 *     ((k − S)(1 − κ²) − 2 κ L) / (1 + κ²), where that is above S.
 *
 * So a body that rests on another, or that has sunk into it by less than the foot is from the rim, needs one facet.
 */
#ifndef PIR_QUERY_LAST_FOOT_H
#define PIR_QUERY_LAST_FOOT_H

#include "query/decide/facet.h"

/*
 * Whether the slack of F, which is at most `slack` and certain to be above −placement->error · facet->err, is below
 * that of all other facets.
 */
bool pir_foot_settles(const pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack);

/* The same where F is known to hold the disc of radius `margin`. */
bool pir_foot_settles_within(const pir_frame *frame, const pir_placement *placement, const pir_facet *facet,
                             double slack, double margin);

#endif
