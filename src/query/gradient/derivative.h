/* SPDX-License-Identifier: MIT */
/*
 * The derivatives of a signed distance, from the pair of features that decides it.
 *
 * Let x and y be the points of P and Q, n the normal, d the distance, x = y + d·n. Let u = u_P(x) − u_Q(y) be the
 * motion of P's point relative to Q's, a linear form in the twelve numbers of both motions. To first order d changes
 * by n·u, whatever the features are. For unit vectors T1, T2 across n let b_i = T_i·u, and let ν_i = T_i·δn be the
 * turn of the normal. Minimising the distance over the places on both features, to second order, gives
 *
 *     H = K + Σ (ν_i b_iᵀ + b_i ν_iᵀ − d ν_i ν_iᵀ)
 *
 * where K is the second order of turning x and y themselves. Only ν depends on the features:
 *
 *     vertex, vertex    ν_i = b_i / d
 *     vertex, edge e    e·δn = e·(ω × n), with ω the turn of the edge's body; ν = b / d across e
 *     vertex, facet     T_i·δn = T_i·(ω × n), with ω the turn of the facet's body
 *     edge, edge        e_P·δn = e_P·(ω_P × n) and e_Q·δn = e_Q·(ω_Q × n)
 *
 * The last two hold at d = 0, and below it for the depth to the plane of a facet of the difference.
 */
#ifndef PIR_QUERY_GRADIENT_DERIVATIVE_H
#define PIR_QUERY_GRADIENT_DERIVATIVE_H

#include <pirouette/gradient.h>

#include "query/decide/piece.h"

/* Numbers of an answer's input that derivatives depend on. */
typedef struct pir_deriving {
    double radius_p, radius_q;
    pir_vec3 origin_p, origin_q; /* that the bodies turn about */
} pir_deriving;

/* All that derivatives depend on, in one frame. */
typedef struct pir_decider {
    pir_witness features;        /* a facet and a vertex, two edges, or a vertex and an edge or a vertex */
    pir_vec3 n, x, y;            /* the normal, and the points of the bodies without their radii */
    double distance;             /* between those points */
    pir_vec3 origin_p, origin_q; /* that the bodies turn about */
    pir_vec3 along_p, along_q;   /* unit; of the features that are edges */
} pir_decider;

/*
 * The features that decide an answer with this witness. `decided`: the piece of the facet that the answer is by, or
 * none, where bodies are apart and the witness tells. Where parallel faces meet at a vertex of one on an edge of the
 * other, the facet moves with the body that the piece is named by.
 */
pir_witness pir_deciding_features(const pir_frame *frame, pir_piece decided, pir_witness witness);

/*
 * Sets a decider in Q's frame or, where `turn` is Q's rotation, in the world, where the answer and the origins are.
 * False where the answer has no normal.
 */
bool pir_decider_set(const pir_frame *frame, const pir_mat3 *turn, const pir_query_result *result, pir_witness features,
                     const pir_deriving *deriving, pir_decider *ret_decider);

/* The wrenches on both bodies. */
void pir_gradient_fill(const pir_decider *decider, pir_wrench *ret_p, pir_wrench *ret_q);

void pir_curvature_fill(const pir_decider *decider, pir_curvature *ret_curvature);

/* Both for an answer, all 0 where it has no normal. `ret_curvature` may be NULL. */
void pir_derive(const pir_frame *frame, const pir_mat3 *turn, pir_piece decided, const pir_query_result *result,
                const pir_deriving *deriving, pir_gradient *ret_gradient, pir_curvature *ret_curvature);

#endif
