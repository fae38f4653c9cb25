/* SPDX-License-Identifier: MIT */
/**
 * Derivatives of the signed distance: its gradient to the poses of both bodies, the Jacobian of its normal, its
 * Hessian, and where several features tie, the gradients of all of them.
 *
 * The signed distance is that of pir_pair_signed_distance: the distance where the bodies are apart, minus the depth
 * where they overlap, less both rounding radii. It is smooth as long as one pair of features decides it.
 *
 * Perturbations. A small motion of a body is six numbers (v, w), in the world unless said otherwise: the body's origin
 * moves by v, and the body turns about its origin by the rotation vector w,
 *
 *     translation' = translation + v        R' = e^w · R
 *
 * so that (v, w) over a short time is the velocity and angular velocity of pir_pose_integrate. In a query on a sum the
 * world is the frame of Q, P's origin stands at input->translation, and Q's at 0. Derivatives in other coordinates
 * (the body's own axes, the world's origin, quaternions) are below, and docs/gradients.md has a table of them.
 *
 * Features. The numbers are closed forms of the pair of features that decides the answer, which is proven exactly:
 *
 *     apart        vertex, edge or facet of either: the faces of the witness
 *     overlapping  the facet and the vertex, or the two edges, whose plane the depth is measured to
 *
 * They are computed in doubles from those features. They are within 1e-9 of the exact ones, relative to the size of the
 * bodies and coordinates, but for a Hessian where a vertex or an edge is nearer than 1e-4 of that size to a vertex, or
 * where edges are nearly parallel: there the derivatives themselves grow without bound.
 *
 * Ties. Where several pairs of points or several facets decide an answer, the gradient is that of the witness, one of
 * many. pir_pair_active and pir_query_active give all of them. The signed distance then has derivatives in each
 * direction, and they follow from these (Danskin, The Theory of Max-Min, 1967): along (v, w) of P it is the greatest
 * over facets of the least, over the corners of each facet's polygon, of force·v + torque·w. Where bodies are apart
 * there is one such polygon, and the generalised gradient (Clarke, 1983) is the hull of its wrenches. Where bodies
 * touch at a corner or an edge, that holds for motions that make them overlap; along others the distance grows as
 * that to the planes of all facets at once. Where they touch with edges that lie along each other, a turn makes these
 * cross, in a facet between the two beside them: the derivative then is at least that, and at most the greatest over
 * all members.
 *
 * Threads: as for the pair, or the query. No call allocates, but as a query of a pair may.
 */
#ifndef PIROUETTE_GRADIENT_H
#define PIROUETTE_GRADIENT_H

#include <pirouette/base.h>
#include <pirouette/pair.h>
#include <pirouette/polytope.h>
#include <pirouette/pose.h>
#include <pirouette/query.h>
#include <pirouette/witness.h>
#include <pirouette/workspace.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A gradient to a pose: by its v and by its w. Of a distance: no unit, and a length for each radian. */
typedef struct pir_wrench {
    pir_vec3 force;
    pir_vec3 torque; /**< about the body's origin */
} pir_wrench;

/** First derivatives of a signed distance. */
typedef struct pir_gradient {
    pir_wrench p, q;      /**< to P's pose and to Q's; all 0 where the answer has no normal */
    pir_witness features; /**< the pair of features that decides; kinds PIR_FEATURE_NONE where the answer has none */
} pir_gradient;

/**
 * Second derivatives. The twelve columns are v and w of P, then v and w of Q, so that the first six of each are those
 * to P's pose alone. `hessian` is symmetric to the bit: that of the signed distance as a function of (v, w) of both.
 */
typedef struct pir_curvature {
    /**
     * False, all numbers being 0, where the answer has no normal, where two vertices or a vertex and an edge are at one
     * place, or where edges are parallel but for rounding.
     */
    bool is_known;
    double normal[3][12]; /**< the Jacobian of the normal; rows are its x, y, z */
    double hessian[12][12];
} pir_curvature;

/**
 * The signed distance, as pir_pair_signed_distance gives it, with its derivatives.
 *
 * workspace, input  scratch, and the poses of both.
 * ret_result        the answer.
 * ret_gradient      its first derivatives.
 * ret_curvature     NULL where second derivatives are not wanted.
 *
 * Cost: that of pir_pair_signed_distance, and O(1).
 *
 * Errors: those of a query of a pair.
 */
PIR_API pir_status pir_pair_gradient(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                     pir_query_result *ret_result, pir_gradient *ret_gradient,
                                     pir_curvature *ret_curvature);

/**
 * The signed distance, as pir_query_signed_distance gives it, with its derivatives.
 *
 * input, cache   as of pir_query_overlap.
 * ret_result     the answer.
 * ret_gradient   its first derivatives.
 * ret_curvature  NULL where second derivatives are not wanted.
 *
 * Cost: that of a query, and O(1).
 *
 * Errors: those of a query.
 */
PIR_API pir_status pir_query_gradient(pir_query *query, const pir_query_input *input, pir_query_cache *cache,
                                      pir_query_result *ret_result, pir_gradient *ret_gradient,
                                      pir_curvature *ret_curvature);

/** One of the gradients at a tie: of a corner of the polygon of points that attain a facet, or the distance. */
typedef struct pir_active {
    uint32_t facet;            /**< counted from 0; corners of one facet, or of the distance, have one number */
    double distance;           /**< signed: the facet's, or that of the bodies */
    pir_vec3 normal;           /**< unit, from Q to P */
    pir_vec3 point_p, point_q; /**< the corner, as in an answer: point_p = point_q + distance · normal */
    pir_wrench p, q;           /**< as in pir_gradient */
    pir_witness features;      /**< as in pir_gradient */
} pir_active;

/**
 * The active set. Of bodies that overlap or touch: every facet of their difference whose slack is at most the least one
 * plus `slack`, which is decided exactly for the double given, in the order of pir_query_escapes, and of each facet all
 * corners of the polygon, segment or point of places where its two faces are over each other. A facet beside which the
 * places would lie has one member, that of its plane. Of bodies that are apart: the corners of the polygon of nearest
 * points, whatever `slack` is. Corners of one facet are at vertices of Q by number, then at vertices of P by number,
 * then at crossings of edges. The first member of facet 0 is the answer of pir_pair_gradient. There are none where an
 * answer has no normal.
 *
 * The members are decided exactly, so that they depend on the bodies, the poses and `slack` alone.
 *
 * workspace, input      scratch, and the poses of both.
 * slack                 0 or more, a length: 0 for exact ties.
 * capacity, ret_active  room for how many, and that room.
 * ret_count             how many there are, also beyond the capacity.
 *
 * Cost: apart, a few exact steps; else as of pir_pair_escapes.
 *
 * Errors: those of a query of a pair, also PIR_ERR_LIMIT without the level `whole`, and PIR_ERR_ARGUMENT for a slack
 * below 0, infinite or NaN.
 */
PIR_API pir_status pir_pair_active(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input, double slack,
                                   size_t capacity, pir_active *ret_active, size_t *ret_count);

/**
 * The active set of a query on a sum: see pir_pair_active.
 *
 * input                 where P is.
 * slack                 0 or more, a length.
 * capacity, ret_active  room for how many, and that room.
 * ret_count             how many there are, also beyond the capacity.
 *
 * Cost: as of pir_query_escapes.
 *
 * Errors: those of a query, and PIR_ERR_ARGUMENT for a slack below 0, infinite or NaN.
 */
PIR_API pir_status pir_query_active(pir_query *query, const pir_query_input *input, double slack, size_t capacity,
                                    pir_active *ret_active, size_t *ret_count);

/* --- in other coordinates --- */

/**
 * The derivative along a motion: force·velocity + torque·angular_velocity.
 *
 * velocity, angular_velocity  (v, w), in the coordinates of the wrench.
 *
 * Cost: O(1).
 */
PIR_API double pir_wrench_along(pir_wrench wrench, pir_vec3 velocity, pir_vec3 angular_velocity);

/**
 * By right perturbations, in the body's own axes: translation' = translation + R·v, R' = R · e^w.
 *
 * wrench, pose  the body's.
 *
 * Cost: O(1).
 */
PIR_API pir_wrench pir_wrench_in_body(pir_wrench wrench, pir_pose pose);

/**
 * By left perturbations about the world's origin, the spatial twist: translation' = e^w·translation + v, R' = e^w·R.
 * The torque is then about the world's origin.
 *
 * wrench, pose  the body's.
 *
 * Cost: O(1).
 */
PIR_API pir_wrench pir_wrench_in_space(pir_wrench wrench, pir_pose pose);

/**
 * The gradient to the four components of the pose's quaternion, of any length, the rotation being M(q)/|q|². It is
 * across the quaternion, since its length does not count. That to the translation is the wrench's force.
 *
 * rotation  of the body's pose.
 *
 * Cost: O(1).
 */
PIR_API pir_quat pir_wrench_by_quat(pir_wrench wrench, pir_quat rotation);

/**
 * Second derivatives by right perturbations of both bodies, as in pir_wrench_in_body. The normal stays in the world.
 *
 * pose_p, pose_q  the bodies'.
 *
 * Cost: O(1).
 */
PIR_API pir_curvature pir_curvature_in_body(const pir_curvature *curvature, pir_pose pose_p, pir_pose pose_q);

/**
 * A point of a feature as a mean of its vertices: weights that are 0 at least and add up to 1. The gradient of the
 * signed distance to vertex ret_vertices[i], in the body's coordinates, is ret_weights[i] times the force of
 * pir_wrench_in_body, for a vertex of either body with its own wrench. Of a facet the vertices are those of the
 * triangle of its fan that holds the point, the fan being from its first corner. That is exact for triangles; for
 * facets of more corners it is the gradient along motions of the vertices that leave the facet flat.
 *
 * polytope      the body.
 * point         of the feature, in the coordinates of the body: pir_pose_apply_inverse of a point of an answer. What
 *               is beside the feature is brought to it.
 * ret_vertices  room for three.
 * ret_weights   room for three.
 *
 * Returns how many vertices there are, 1 to 3; 0, writing nothing, where the body has no such feature.
 *
 * Cost: O(size of the facet).
 */
PIR_API size_t pir_feature_weights(const pir_polytope *polytope, pir_feature feature, pir_vec3 point,
                                   uint32_t *ret_vertices, double *ret_weights);

#ifdef __cplusplus
}
#endif

#endif
