/* SPDX-License-Identifier: MIT */
/** Features of polytopes, and which of two bodies attain an answer. */
#ifndef PIROUETTE_WITNESS_H
#define PIROUETTE_WITNESS_H

#include <pirouette/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A kind of feature of a polytope. */
typedef enum pir_feature_kind {
    PIR_FEATURE_NONE = 0,
    PIR_FEATURE_VERTEX,
    PIR_FEATURE_EDGE,
    PIR_FEATURE_FACET,
} pir_feature_kind;

typedef struct pir_feature {
    pir_feature_kind kind;
    uint32_t index;
} pir_feature;

/**
 * The features of P and Q that attain an answer: the least faces that hold the two points. The faces are decided
 * exactly. The points of the result are doubles within 2^-50 of the exact points, relative to the largest coordinate
 * of bodies and translation. Where parallel features leave several pairs of points, one is chosen: the vertex of Q of
 * lowest index that lies on P's face, else the vertex of P of lowest index that lies on Q's face, else the crossing
 * of the first edges in order, by the index of P's edge, then of Q's.
 */
typedef struct pir_witness {
    pir_feature p, q;
} pir_witness;

#ifdef __cplusplus
}
#endif

#endif
