/* SPDX-License-Identifier: MIT */
/**
 * Pairs asked by support functions alone, through libccd: a second opinion. Stateless, not exact, in doubles; pair.h
 * and query.h hold the exact answers. This header is of libpirouette-ccd, which stands beside libpirouette:
 * pkg-config's pirouette-ccd.
 *
 * Threads: a call reads its polytopes and writes nothing but its results; a pir_support_body belongs to one thread at a
 * time.
 */
#ifndef PIROUETTE_CCD_H
#define PIROUETTE_CCD_H

#include <pirouette/base.h>
#include <pirouette/polytope.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A pair to ask by support functions alone. */
typedef struct pir_ccd_pair {
    const pir_polytope *p, *q;
    pir_quat rotation;
    pir_vec3 translation;
} pir_ccd_pair;

typedef enum pir_ccd_outcome {
    PIR_CCD_SEPARATED = 0,
    PIR_CCD_OVERLAPPING, /**< overlap, or too close to tell: the arithmetic is not exact here */
    PIR_CCD_FAILED,      /**< the engine gave no usable answer */
} pir_ccd_outcome;

/**
 * Overlap by libccd's MPR on supports of ours, scale-normalised; not exact. PIR_ERR_NOT_BUILT in
 * a build without libccd.
 *
 * pair  the bodies, borrowed for the call, and the pose of P relative to Q.
 *
 * Cost: a bounded number of supports, O(√n) steps each for n vertices.
 *
 * Errors: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (a translation beyond the
 * doubles at the size of the bodies), PIR_ERR_NOT_BUILT.
 */
PIR_API pir_status pir_ccd_overlap(const pir_ccd_pair *pair, pir_ccd_outcome *ret_outcome);

/**
 * Distance likewise, by descent on libccd's distances to segments and triangles. *ret_distance is 0 unless separated;
 * within 1e-9 of the size.
 *
 * pair         as of pir_ccd_overlap.
 * ret_outcome  says whether there is a distance.
 *
 * Cost: a bounded number of supports, O(√n) steps each for n vertices.
 *
 * Errors as of pir_ccd_overlap.
 */
PIR_API pir_status pir_ccd_distance(const pir_ccd_pair *pair, pir_ccd_outcome *ret_outcome, double *ret_distance);

/** A polytope in a pose, for libccd and engines like it. Plain; the polytope is borrowed. */
typedef struct pir_support_body {
    const pir_polytope *polytope;
    pir_quat rotation;
    pir_vec3 translation;
    uint32_t last; /**< where the last climb ended: where the next one starts */
} pir_support_body;

/**
 * Support functions of the form of ccd_support_fn of a double-precision libccd: `object` is a pir_support_body, or a
 * pir_sum, whether it keeps R·P ⊕ Q or the difference; `direction` and `ret_point` point to three doubles. O(√n)
 * steps where the last climb is no help.
 */
PIR_API void pir_support_body_ccd(const void *object, const double *direction, double *ret_point);
PIR_API void pir_support_sum_ccd(const void *object, const double *direction, double *ret_point);

#ifdef __cplusplus
}
#endif

#endif
