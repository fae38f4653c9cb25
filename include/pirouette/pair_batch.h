/* SPDX-License-Identifier: MIT */
/**
 * Batches: many poses of one pair in one call, from arrays into arrays.
 *
 * An answer is that of pair.h, bit for bit, whatever comes before it and on however many threads. Poses are asked in
 * order, in runs, so that each begins with what the one before left: an array that follows a motion costs less than
 * one at random.
 *
 * A pose that is bad (not finite, a quaternion of zeros, out of range) has its status in `status`, NaN for its numbers
 * and PIR_POSE_BAD for its state; all others are answered. The summary has the first of them.
 *
 * Frame, exactness, numbers and the cost of one answer: those of pair.h.
 *
 * Memory: a pair and a workspace for each thread, which grow to what the hardest pose needs; then no call allocates but
 * those that take the level `whole` and GMP. Arrays are the caller's.
 *
 * Threads: a batch belongs to one thread at a time. With options.threads above 1 it uses others within a call, and
 * calls its allocator and those of the polytopes from them, at once.
 */
#ifndef PIROUETTE_PAIR_BATCH_H
#define PIROUETTE_PAIR_BATCH_H

#include <pirouette/base.h>
#include <pirouette/pair.h>
#include <pirouette/polytope.h>
#include <pirouette/query.h>
#include <pirouette/tasks.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_pair_batch pir_pair_batch;

/** The state of a pose that is bad. */
#define PIR_POSE_BAD UINT8_MAX

typedef struct pir_pair_batch_options {
    size_t size;                    /**< of this struct, which pir_pair_batch_options_default sets (base.h) */
    const pir_allocator *allocator; /**< or NULL: malloc's */
    const pir_tasks *tasks;         /**< or NULL: threads of the batch's own; copied */
    uint32_t threads; /**< how many threads a call uses, that of the caller included; at least 1, at most 64 */
    uint32_t run;     /**< how many poses a thread asks in a row; 0: the library chooses */
} pir_pair_batch_options;

/** malloc's memory, one thread, runs as the library chooses. O(1). */
static inline pir_pair_batch_options pir_pair_batch_options_default(void) {
    const pir_pair_batch_options options = {sizeof(pir_pair_batch_options), NULL, NULL, 1, 0};
    return options;
}

/**
 * A batch of P and Q, to which it takes references. `options` may be NULL.
 *
 * p, q  of any dimension.
 *
 * Cost: that of pir_pair_create, and O(threads).
 *
 * Errors: those of pir_pair_create; PIR_ERR_ARGUMENT (threads out of range, tasks without their functions),
 * PIR_ERR_VERSION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_pair_batch_create(pir_polytope *p, pir_polytope *q, const pir_pair_batch_options *options,
                                         pir_pair_batch **ret_batch);

/** Frees, ends its threads, and gives its references back; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_pair_batch_destroy(pir_pair_batch *batch);

/** Poses as arrays, borrowed for the call. Strides are in bytes, a multiple of 8, 0 where elements touch. */
typedef struct pir_pose_array {
    const double *rotations; /**< four numbers each, x, y, z, w; NULL: none is turned */
    size_t rotation_stride;
    const double *translations; /**< three numbers each; NULL: all are at the origin */
    size_t translation_stride;
    bool is_one; /**< whether the arrays hold one pose, for all of the batch */
} pir_pose_array;

typedef struct pir_pair_batch_input {
    pir_pose_array poses_p, poses_q;
    double radius_p, radius_q; /**< for all poses, this and the next two as in pir_query_input */
    double cutoff, margin;
} pir_pair_batch_input;

/** Both bodies at the origin, not turned; no radii, no cutoff, no margin. O(1). */
PIR_API pir_pair_batch_input pir_pair_batch_input_default(void);

/**
 * Where answers go: arrays of the caller's with an element for each pose, or NULL for what is not wanted. Elements
 * touch.
 */
typedef struct pir_pair_batch_arrays {
    uint8_t *state;       /**< a pir_state, or PIR_POSE_BAD */
    uint8_t *outcome;     /**< a pir_outcome, or PIR_POSE_BAD */
    uint8_t *status;      /**< a pir_status: PIR_OK, or why the pose is bad */
    double *distance;     /**< as in pir_query_result; of pir_pair_batch_overlap 0 */
    double (*normal)[3];  /**< unit, from Q to P; zeros where it is not set */
    double (*point_p)[3]; /**< this and the next: the nearest or deepest points in the world */
    double (*point_q)[3];
    /**
     * The derivative of the distance by the pose of P: by its translation, then by a turn about its own origin along
     * each axis of the world, a length per radian. They are the normal and (point_p − translation) × normal. Zeros
     * where there is no normal. Where the answer's features change, it is the derivative of the one that is told.
     */
    double (*gradient)[6];
    pir_witness *witness;
    pir_contact *contacts;    /**< `contact_capacity` for each pose: the manifold, of pir_pair_batch_signed_distance */
    uint32_t *contact_counts; /**< how many each manifold has, also beyond `contact_capacity` */
    size_t contact_capacity;
} pir_pair_batch_arrays;

/** The bad poses of a batch. */
typedef struct pir_pair_batch_summary {
    size_t bad;              /**< how many poses are bad */
    size_t first_bad;        /**< the first of them; the count of poses where there is none */
    pir_status first_status; /**< and why; PIR_OK where there is none */
} pir_pair_batch_summary;

/* --- the queries of pair.h by the same names; their comments hold here --- */

/**
 * The exact states. A pose that memory ran out at has PIR_ERR_MEMORY for its status, and counts as bad.
 *
 * batch, input  the bodies, and the poses of both.
 * count         how many poses there are.
 * arrays        where answers go.
 * ret_summary   NULL, or how many poses are bad.
 *
 * Cost: `count` queries of a pair.
 *
 * Errors: PIR_ERR_ARGUMENT (NULL, a stride that is no multiple of 8 or shorter than an element, a radius or a margin
 * below 0, contacts without their counts, or of another query than pir_pair_batch_signed_distance),
 * PIR_ERR_NOT_FINITE (radii, cutoff, margin). The arrays are then untouched.
 */
PIR_API pir_status pir_pair_batch_overlap(pir_pair_batch *batch, const pir_pair_batch_input *input, size_t count,
                                          const pir_pair_batch_arrays *arrays, pir_pair_batch_summary *ret_summary);

/**
 * The separations.
 *
 * batch, input, count, arrays, ret_summary  as of pir_pair_batch_overlap.
 *
 * Cost: `count` queries of a pair.
 *
 * Errors: as of pir_pair_batch_overlap.
 */
PIR_API pir_status pir_pair_batch_distance(pir_pair_batch *batch, const pir_pair_batch_input *input, size_t count,
                                           const pir_pair_batch_arrays *arrays, pir_pair_batch_summary *ret_summary);

/**
 * The penetration depths.
 *
 * batch, input, count, arrays, ret_summary  as of pir_pair_batch_overlap.
 *
 * Cost: `count` queries of a pair.
 *
 * Errors: as of pir_pair_batch_overlap.
 */
PIR_API pir_status pir_pair_batch_penetration(pir_pair_batch *batch, const pir_pair_batch_input *input, size_t count,
                                              const pir_pair_batch_arrays *arrays, pir_pair_batch_summary *ret_summary);

/**
 * Separations where separated, penetrations where overlapping; where `contact_counts` is set, manifolds too.
 *
 * batch, input, count, arrays, ret_summary  as of pir_pair_batch_overlap.
 *
 * Cost: `count` queries of a pair, and of a manifold each.
 *
 * Errors: as of pir_pair_batch_overlap.
 */
PIR_API pir_status pir_pair_batch_signed_distance(pir_pair_batch *batch, const pir_pair_batch_input *input,
                                                  size_t count, const pir_pair_batch_arrays *arrays,
                                                  pir_pair_batch_summary *ret_summary);

#ifdef __cplusplus
}
#endif

#endif
