/* SPDX-License-Identifier: MIT */
/*
 * The lead of the least facet: how much less its slack is than the distance of all else from x, proven once and used
 * while the motion since cannot have consumed it.
 *
 * Let f(n) be the distance from x at which a plane with unit normal n touches D. When the lead was proven, a closed
 * surface in D about x (inner_surface.h) had its triangles either in the facet F, of slack s₀ and normal n₀, or at
 * least `others` away. The ray from x along any n leaves the surface through a triangle, so f(n) was at least `others`,
 * or at least s₀ / (n·n₀), where it left through F. Since then no support of D has changed against x by more than
 * δ, so f has fallen by δ at most.
 *
 * Now F has the slack s and the normal n₁, with |n₁ − n₀| ≤ c, and holds the disc of radius m about the foot
 * of x. Let G be another facet of D with normal n, at the angle θ from n₁. The plane of G is beyond the disc, so its
 * slack is at least m sin θ + s cos θ. That is above s where cos θ > k = (s² − m²) / (s² + m²). Otherwise
 * n·n₀ ≤ max(k, 0) + c. So the slack of G is above s where
 *
 *     others − δ > s     and     s₀ > (s + δ) (max(k, 0) + c).
 */
#ifndef PIR_PAIR_FACET_LEAD_H
#define PIR_PAIR_FACET_LEAD_H

#include "query/last/same_facet.h"

typedef struct pir_lead {
    double others; /* 0 where there is no lead */
    double slack;  /* at most s₀ */
    pir_vec3 n;    /* n₀ */
} pir_lead;

/* The lead of a facet at a placement. */
pir_lead pir_lead_of(const pir_placement *placement, const pir_facet *facet, double others);

/* Whether the facet is the least still; nothing has moved by more than `moved`. */
bool pir_lead_lasts(const pir_lead *lead, const pir_placement *placement, const pir_same_facet *same, double moved);

#endif
