/* SPDX-License-Identifier: MIT */
/*
 * Tolerance: a pairing that stays behind the rotation while that costs at most τ.
 *
 * Let the pairing be exact at R₀, let R be the rotation asked for, θ the angle between them, and A the hull of the
 * points R·p + q over the pairing's vertices (p, q). A lies in the sum M, so its support function h_A is at most h_M.
 * For a direction n take the vertex (p, q) that supports M at R₀ in the direction
 *
 *   - n: then q supports Q in n, and p supports P in R₀ᵀn, which is at most θ away from Rᵀn: h_M(n) − h_A(n)
 *     ≤ S_P(θ), where S_B(θ) is how far a vertex that supports B in some direction may fall short of B's support in
 *     another, at most θ away;
 *   - R₀Rᵀn: then p supports P in Rᵀn, and q supports Q in a direction at most θ away from n: the same with
 *     S_Q(θ).
 *
 * Hence |h_M − h_A| ≤ min(S_P(θ), S_Q(θ)) in every direction. While that is at most τ no certificate is read and
 * nothing changes: a rotation costs a few operations whatever the size. Beyond it, one update covers the whole turn
 * since R₀.
 *
 * S_B is a maximum over pairs of vertices v, w, a distance L apart along d. In the cell of v, the directions u that v
 * supports, u·d is negative. It is subharmonic there and convex along arcs, so it is greatest at a corner of the cell,
 * a facet's normal. So u stays below w's horizon by at least δ, where sin δ is the least (h − n·w)/L of the facets
 * around v, and
 *
 *     S_B(θ) = max over v, w of L·sin(θ − δ).
 *
 * So S_B reaches a length s at θ(s), the least δ + asin(s/L) of all pairs farther apart than s. S_B(θ)/sin θ rises
 * with θ, which bounds S_B between the few lengths for which θ is computed. On a ball θ(s) is about √(2s), far
 * beyond s divided by its size.
 *
 * Rounding errs upwards. The angle is an upper bound (rotation.h). asin x ≥ x + x³/6, sin x ≥ x − x³/6 and sin
 * x ≤ x stand for functions that differ between machines.
 */
#include "dymsum/update/lag.h"

/* Angles beyond this are not told apart: the sine in S_B rises up to here. */
#define FARTHEST_LAG 1.5

/* The error of a slack, per size of the body: normals are off by 8u, dot products and vertices by less again. */
#define SLACK_ERROR 0x1p-47

/* At most the angle whose sine is x, 0 ≤ x ≤ 1. */
static double arc_sine_below(double x) {
    return (x + x * x * x * (1.0 / 6)) * (1 - 0x1p-50);
}

/* Lowers angles[k], up to which S_B is at most lengths[k], for the facets around vertex v and its distance from w. */
static void take_pair(double distance, double slack, const double *lengths, double *angles) {
    double below = arc_sine_below(fmin(slack / distance, 1));
    for (int k = 0; k < PIR_LAG_KNOTS; k++)
        if (distance > lengths[k])
            angles[k] = fmin(angles[k], (below + arc_sine_below(lengths[k] / distance)) * (1 - 0x1p-50));
}

/*
 * A power of two that brings p's coordinates below 1, and near it where doubles reach: squares then neither vanish nor
 * overflow.
 */
static double scale_of(const pir_polytope *p) {
    double most = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        pir_vec3 at = p->vertex[v];
        most = fmax(most, fmax(fabs(at.x), fmax(fabs(at.y), fabs(at.z))));
    }
    int exponent;
    frexp(most, &exponent);
    return ldexp(1, exponent < -1000 ? 1000 : -exponent);
}

/* The angles up to which S_B is at most each of the lengths: a pass over facets and vertices. */
static void measure(const pir_polytope *p, const double *given_lengths, double *ret_angles) {
    double far = 0, by = scale_of(p), lengths[PIR_LAG_KNOTS];
    for (int k = 0; k < PIR_LAG_KNOTS; k++)
        lengths[k] = given_lengths[k] * by;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        pir_vec3 at = pir_vec_scale(p->vertex[v], by);
        far = fmax(far, pir_vec_dot(at, at));
    }
    // vertices below the normal doubles are off by more
    double size = sqrt(far), error = size * SLACK_ERROR + by * 0x1p-1070;
    for (int k = 0; k < PIR_LAG_KNOTS; k++)
        ret_angles[k] = FARTHEST_LAG;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        uint32_t start = p->loop_start[f], end = p->loop_start[f + 1];
        double offset = pir_vec_dot(p->normal[f], pir_vec_scale(p->vertex[p->origin[p->loop[start]]], by));
        for (uint32_t w = 0; w < p->vertex_count; w++) {
            pir_vec3 at = pir_vec_scale(p->vertex[w], by);
            double slack = fmax(0, offset - pir_vec_dot(p->normal[f], at) - error);
            // no two vertices are farther apart than twice the size: past this, no angle is lowered
            if (slack > 2 * size * ret_angles[PIR_LAG_KNOTS - 1])
                continue;
            for (uint32_t i = start; i < end; i++) {
                pir_vec3 apart = pir_vec_sub(at, pir_vec_scale(p->vertex[p->origin[p->loop[i]]], by));
                double distance = sqrt(pir_vec_dot(apart, apart)) * (1 + 0x1p-50) + error;
                if (p->origin[p->loop[i]] != w)
                    take_pair(distance, slack, lengths, ret_angles);
            }
        }
    }
}

bool pir_lag_reserve(pir_lag *lag, const pir_allocator *allocator, pir_rotation_integers *integers) {
    if (lag->knots)
        return true;
    lag->knots = PIR_ZEROED(allocator, pir_lag_knots, 1);
    if (!lag->knots)
        return false;
    lag->knots->now.integers = integers;
    return true;
}

void pir_lag_finish(pir_lag *lag, const pir_allocator *allocator) {
    PIR_FREE(allocator, lag->knots, 1);
}

void pir_lag_measure(pir_lag *lag, const pir_polytope *p, const pir_polytope *q) {
    if (lag->tolerance == 0)
        return;
    double of_p[PIR_LAG_KNOTS], of_q[PIR_LAG_KNOTS];
    for (int k = 0; k < PIR_LAG_KNOTS; k++)
        lag->knots->length[k] = ldexp(lag->tolerance, 2 * (k + 1 - PIR_LAG_KNOTS));
    measure(p, lag->knots->length, of_p);
    measure(q, lag->knots->length, of_q);
    for (int k = 0; k < PIR_LAG_KNOTS; k++)
        lag->knots->angle[k] = fmax(of_p[k], of_q[k]);
}

/*
 * An upper bound of what the support function falls short by after a turn by `angle`, which is below the last of
 * lag->knots->angle.
 */
static double shortfall_at(const pir_lag *lag, double angle) {
    int k = 0;
    while (angle > lag->knots->angle[k])
        k++;
    double most = lag->knots->angle[k], sine = (most - most * most * most * (1.0 / 6)) * (1 - 0x1p-50);
    return fmin(lag->knots->length[k], lag->knots->length[k] * (angle / sine) * (1 + 0x1p-50));
}

void pir_lag_show(pir_lag *lag, pir_quat rotation, double angle) {
    pir_rotation_set(&lag->knots->now, rotation);
    lag->bound = shortfall_at(lag, angle);
    lag->lagging = true;
}
