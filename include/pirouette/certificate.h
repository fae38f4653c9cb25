/* SPDX-License-Identifier: MIT */
/**
 * Certificates: answers written as what proves them, for a checker that shares nothing with the library.
 *
 * A certificate is a text: one JSON object of integers and rationals, which states the question (both bodies where
 * they stand, exactly), the answer, and its proof. `check/check.py`, of some 300 lines, reads it with the models and
 * says "proven" or names the line that fails. docs/proofs.md has the format, and what each proof is:
 *
 * - "apart": a plane with P on one side and Q on the other, and the gap.
 * - "overlap": pairs of vertices with positive weights, not in one plane: a point of both interiors.
 * - "touching": pairs with weights, a common point, and a plane with P and Q on its sides.
 * - "distance": pairs with weights, the two nearest points, and that no vertex is on the near side of the planes there.
 * - "depth": all facets of the difference, each with a plane that supports both bodies, and their edges closed.
 * - "sum": the same of a sum; "difference": of a difference.
 *
 * Sums of solids have certificates of another form, which `check/solid_sum.py` reads (docs/proofs.md).
 * Of two solids in convex pieces `check/solids.py` takes the certificates: "apart", "distance", "touching" and
 * "overlap", by a plane for each pair of pieces, or a common inner point of one pair.
 *
 * Every number is found anew, by integers alone. An answer that it contradicts is refused.
 */
#ifndef PIROUETTE_CERTIFICATE_H
#define PIROUETTE_CERTIFICATE_H

#include <pirouette/base.h>
#include <pirouette/query.h>
#include <pirouette/solid.h>
#include <pirouette/solid_query.h>
#include <pirouette/sum.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_certificate pir_certificate;

/** The part of an answer that a certificate proves. */
typedef enum pir_proven {
    PIR_PROVEN_STATE = 0, /**< its state: "apart", "touching" or "overlap" */
    PIR_PROVEN_NUMBER,    /**< its state and its distance or depth: "distance", "touching" or "depth" */
} pir_proven;

/**
 * The certificate of an answer of pir_query_signed_distance, pir_query_separation, pir_query_penetration or
 * pir_query_overlap, at the rotation that the query's sum has, with the same input. It lasts without the query. Of the
 * allocator of the query's sum; its integers are in GMP's memory meanwhile, and GMP ends the process when that runs
 * out.
 *
 * input   where P is; radii must be 0, and a cutoff does not count.
 * answer  the answer. Its state must be the true one. Its distance must be within 1e-11 of the true one, relative to
 *         the largest coordinate of bodies and translation, where PIR_PROVEN_NUMBER asks for it and it is no cutoff.
 * proven  what of it.
 *
 * Cost: O(steps · (p + q)) for bodies of p and q vertices, in exact arithmetic. Where the bodies touch or overlap,
 * O(size of the sum) as well.
 *
 * Errors: PIR_ERR_ARGUMENT (NULL, an answer that is not right, radii, a sum that a tolerance lets stay behind),
 * PIR_ERR_NOT_FINITE, PIR_ERR_REGION, PIR_ERR_LIMIT (as of pir_sum_mesh), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_query_certificate(pir_query *query, const pir_query_input *input, const pir_query_result *answer,
                                         pir_proven proven, pir_certificate **ret_certificate);

/**
 * The certificate of an answer of pir_solid_query_distance, with the same input. Pieces have to be those of
 * pir_solid_decompose without a tolerance or a number: the checker holds that they do not overlap, and are the solids.
 * It lasts without the query, and is of its allocator; integers as above. The query is used, and so belongs to this
 * thread meanwhile.
 *
 * input   where P is; Q is not posed. Radii must be 0; cutoff and margin do not count.
 * answer  `result` of a pir_solid_distance: its state must be the true one; its distance as above.
 * proven  what of it. Of solids that overlap it is the state alone: their depth has no certificate.
 *
 * Cost: for each pair of a piece of P and one of Q, near or far, O(steps · (p + q)) for their p and q vertices, and
 * O(size of their sum) where they share a point; in exact arithmetic. The text has a plane for each pair, but for
 * solids that overlap.
 *
 * Errors: PIR_ERR_ARGUMENT (NULL, an answer that is not right, radii, a pose of Q), PIR_ERR_NOT_FINITE,
 * PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (as of pir_sum_create and pir_sum_mesh), PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_solid_query_certificate(pir_solid_query *query, const pir_pair_input *input,
                                               const pir_query_result *answer, pir_proven proven,
                                               pir_certificate **ret_certificate);

/**
 * The certificate of a sum or difference, as pir_sum_mesh has it: its vertices as pairs, its facets as cycles of them.
 * Otherwise as of pir_query_certificate.
 *
 * sum  of dimension 2 or 3.
 *
 * Cost: O(size of the sum).
 *
 * Errors: as of pir_query_certificate, and PIR_ERR_ARGUMENT for a sum that is a point or a segment.
 */
PIR_API pir_status pir_sum_certificate(pir_sum *sum, pir_certificate **ret_certificate);

/**
 * The certificate that the mesh of a closed sum or difference of solids, as pir_solid_sum_mesh has it, bounds exactly
 * that sum: convex pieces of both, a box divided until each part is in the sum of two pieces or free of all, and the
 * mesh. `check/solid_sum.py` reads it. It lasts without the sum, and is of its allocator; rationals are in GMP's
 * memory. A call belongs to the thread that the sum belongs to. The sum's `memory` bounds what is held meanwhile.
 *
 * sum              neither open nor scaled; what it keeps may change as by pir_solid_sum_mesh, its answers do not.
 * ret_certificate  to be freed with pir_certificate_destroy.
 *
 * Cost: pir_solid_decompose of each; for k sums of pairs of bounded size that all meet O(k³) parts, mostly some tens
 * for each sum.
 *
 * Errors: PIR_ERR_ARGUMENT (NULL, an open or scaled sum); PIR_ERR_LIMIT where more memory or more than 2,000,000 parts
 * are needed, which the sum's report tells; PIR_ERR_MEMORY; else as of pir_solid_sum_mesh.
 */
PIR_API pir_status pir_solid_sum_certificate(pir_solid_sum *sum, pir_certificate **ret_certificate);

/**
 * The text, with a zero behind its end; valid as long as the certificate.
 *
 * ret_length  NULL, or the number of bytes without the zero.
 *
 * Cost: O(1).
 */
PIR_API const char *pir_certificate_text(const pir_certificate *certificate, size_t *ret_length);

/** Frees a certificate. NULL is accepted. Cost: the time to free it. */
PIR_API void pir_certificate_destroy(pir_certificate *certificate);

#ifdef __cplusplus
}
#endif

#endif
