/* SPDX-License-Identifier: MIT */
/**
 * Batches of meshes: many poses of two meshes of triangles in one call, from arrays into arrays.
 *
 * An answer is that of trimesh_pair.h, bit for bit, whatever comes before it and on however many threads. Poses, bad
 * ones, threads and memory are as in pair_batch.h, whose options these calls take; a pair stands for each thread.
 */
#ifndef PIROUETTE_TRIMESH_BATCH_H
#define PIROUETTE_TRIMESH_BATCH_H

#include <pirouette/base.h>
#include <pirouette/pair_batch.h>
#include <pirouette/trimesh.h>
#include <pirouette/trimesh_pair.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_trimesh_pair_batch pir_trimesh_pair_batch;

/**
 * A batch of P and Q, to which it takes references; they may be one mesh. `options` may be NULL.
 *
 * p, q       may be open.
 * options    as of pir_pair_batch_create.
 * ret_batch  to be freed with pir_trimesh_pair_batch_destroy.
 *
 * Cost: that of pir_trimesh_pair_create for each thread.
 *
 * Errors: those of pir_trimesh_pair_create; PIR_ERR_ARGUMENT (threads out of range, tasks without their functions),
 * PIR_ERR_VERSION, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_trimesh_pair_batch_create(pir_trimesh *p, pir_trimesh *q, const pir_pair_batch_options *options,
                                                 pir_trimesh_pair_batch **ret_batch);

/** Frees, ends its threads, and gives its references back; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_trimesh_pair_batch_destroy(pir_trimesh_pair_batch *batch);

/** The poses of both meshes. */
typedef struct pir_trimesh_pair_batch_input {
    pir_pose_array poses_p, poses_q;
} pir_trimesh_pair_batch_input;

/**
 * Where answers go: arrays of the caller's with an element for each pose, or NULL for what is not wanted. Elements
 * touch. Of a bad pose numbers are NaN and triangles 0.
 */
typedef struct pir_trimesh_pair_batch_arrays {
    uint8_t *state;                    /**< a pir_trimesh_state, or PIR_POSE_BAD */
    uint8_t *status;                   /**< a pir_status: PIR_OK, or why the pose is bad */
    double *distance;                  /**< of the points */
    uint32_t *triangle_p, *triangle_q; /**< the two triangles */
    double (*point_p)[3];              /**< this and the next: the points in the world */
    double (*point_q)[3];
} pir_trimesh_pair_batch_arrays;

/**
 * The states, and the nearest triangles.
 *
 * batch, input  the meshes, and the poses of both.
 * count         how many poses there are.
 * arrays        where answers go.
 * ret_summary   NULL, or how many poses are bad.
 *
 * Cost: `count` calls of pir_trimesh_pair_nearest; in order of a motion less than at random.
 *
 * Errors: PIR_ERR_ARGUMENT (NULL, a stride that is no multiple of 8 or shorter than an element). The arrays are then
 * untouched.
 */
PIR_API pir_status pir_trimesh_pair_batch_nearest(pir_trimesh_pair_batch *batch,
                                                  const pir_trimesh_pair_batch_input *input, size_t count,
                                                  const pir_trimesh_pair_batch_arrays *arrays,
                                                  pir_pair_batch_summary *ret_summary);

/**
 * The farthest triangles.
 *
 * batch, input, count, arrays, ret_summary  as of pir_trimesh_pair_batch_nearest.
 *
 * Cost: `count` calls of pir_trimesh_pair_farthest.
 *
 * Errors: as of pir_trimesh_pair_batch_nearest.
 */
PIR_API pir_status pir_trimesh_pair_batch_farthest(pir_trimesh_pair_batch *batch,
                                                   const pir_trimesh_pair_batch_input *input, size_t count,
                                                   const pir_trimesh_pair_batch_arrays *arrays,
                                                   pir_pair_batch_summary *ret_summary);

#ifdef __cplusplus
}
#endif

#endif
