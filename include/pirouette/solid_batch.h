/* SPDX-License-Identifier: MIT */
/**
 * Batches of solids: many poses of two bodies in convex pieces in one call, from arrays into arrays.
 *
 * An answer is that of solid_query.h, bit for bit, whatever comes before it and on however many threads. Poses, bad
 * ones, threads and memory are as in pair_batch.h, whose options and inputs these calls take; a query stands for each
 * thread, which has its own copy of the pieces.
 */
#ifndef PIROUETTE_SOLID_BATCH_H
#define PIROUETTE_SOLID_BATCH_H

#include <pirouette/base.h>
#include <pirouette/pair_batch.h>
#include <pirouette/solid.h>
#include <pirouette/solid_query.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_solid_query_batch pir_solid_query_batch;

/**
 * A batch of two bodies. `options` may be NULL. Both may be the same pieces.
 *
 * p, q       copied.
 * options    as of pir_pair_batch_create.
 * ret_batch  to be freed with pir_solid_query_batch_destroy.
 *
 * Cost: that of pir_solid_query_create for each thread.
 *
 * Errors: those of pir_solid_query_create; PIR_ERR_ARGUMENT (threads out of range, tasks without their functions),
 * PIR_ERR_VERSION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_solid_query_batch_create(const pir_pieces *p, const pir_pieces *q,
                                                const pir_pair_batch_options *options,
                                                pir_solid_query_batch **ret_batch);

/** Frees and ends its threads; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_solid_query_batch_destroy(pir_solid_query_batch *batch);

/**
 * Where answers go: arrays of the caller's with an element for each pose, or NULL for what is not wanted. Elements
 * touch. What a call does not tell is 0; of a bad pose numbers are NaN, and pieces and pairs 0.
 */
typedef struct pir_solid_query_batch_arrays {
    uint8_t *state;       /**< a pir_state, or PIR_POSE_BAD */
    uint8_t *status;      /**< a pir_status: PIR_OK, or why the pose is bad */
    double *distance;     /**< the separation, or of pir_solid_query_batch_depth the depth */
    double (*normal)[3];  /**< unit, from Q to P, or along which P leaves; zeros where it is not set */
    double (*point_p)[3]; /**< this and the next: the points of the answer in the world */
    double (*point_q)[3];
    uint32_t *piece_p, *piece_q; /**< the pieces that decide; of a depth those of the first facet */
} pir_solid_query_batch_arrays;

/**
 * The exact states.
 *
 * batch, input  the bodies, and the poses of both.
 * count         how many poses there are.
 * arrays        where answers go.
 * ret_summary   NULL, or how many poses are bad.
 *
 * Cost: `count` queries of solids.
 *
 * Errors: PIR_ERR_ARGUMENT (NULL, a stride that is no multiple of 8 or shorter than an element, a radius or a margin
 * below 0), PIR_ERR_NOT_FINITE (radii, cutoff, margin). The arrays are then untouched.
 */
PIR_API pir_status pir_solid_query_batch_overlap(pir_solid_query_batch *batch, const pir_pair_batch_input *input,
                                                 size_t count, const pir_solid_query_batch_arrays *arrays,
                                                 pir_pair_batch_summary *ret_summary);

/**
 * The separations.
 *
 * batch, input, count, arrays, ret_summary  as of pir_solid_query_batch_overlap.
 *
 * Cost: `count` queries of solids.
 *
 * Errors: as of pir_solid_query_batch_overlap.
 */
PIR_API pir_status pir_solid_query_batch_distance(pir_solid_query_batch *batch, const pir_pair_batch_input *input,
                                                  size_t count, const pir_solid_query_batch_arrays *arrays,
                                                  pir_pair_batch_summary *ret_summary);

/**
 * The depths, over all ways out.
 *
 * batch, input, count, arrays, ret_summary  as of pir_solid_query_batch_overlap.
 *
 * Cost: `count` depths of solids (pir_solid_query_depth).
 *
 * Errors: as of pir_solid_query_batch_overlap.
 */
PIR_API pir_status pir_solid_query_batch_depth(pir_solid_query_batch *batch, const pir_pair_batch_input *input,
                                               size_t count, const pir_solid_query_batch_arrays *arrays,
                                               pir_pair_batch_summary *ret_summary);

#ifdef __cplusplus
}
#endif

#endif
