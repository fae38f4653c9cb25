/* SPDX-License-Identifier: MIT */
/**
 * Two meshes of triangles, both posed in the world: whether they meet, how near and how far they are, and which
 * triangles are within a distance.
 *
 * A pair is persistent. It keeps the front of the tree of pairs of nodes: pairs that together hold all pairs of
 * triangles, each with a lower bound on its distance and with the motion, |Δt| + r·|ΔR|, that the bound can bear
 * before it says nothing about the nearest triangles. A call looks at those that can bear no more. (Lin and Canny,
 * ICRA 1991, and Ehmann and Lin, IROS 2000, keep features and fronts of convex bodies; the bounds here are of any
 * triangles.)
 *
 * Which state it is, which two triangles are the nearest or the farthest, and which are within a distance is exact for
 * the doubles given, whatever was asked before: doubles within proven bounds decide most, integers the rest. Of pairs
 * that are equal the one of the lowest triangle of P is told, and of these the one of the lowest of Q. Distances and
 * points are doubles with the same bits whatever was asked before.
 *
 * Frame: points are in the world. Threads: a pair belongs to one thread at a time; meshes may be shared.
 *
 * Memory: 56 bytes for each pair of nodes of the front, of which there are some thousands for smooth meshes that are
 * near, and room for exact numbers, 20 to 100 kB. It grows to what was needed; afterwards no call allocates.
 *
 * Errors of a call on a pair: PIR_ERR_ARGUMENT, PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT (a
 * translation beyond 2^60), PIR_ERR_MEMORY.
 */
#ifndef PIROUETTE_TRIMESH_PAIR_H
#define PIROUETTE_TRIMESH_PAIR_H

#include <pirouette/base.h>
#include <pirouette/pose.h>
#include <pirouette/trimesh.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pir_trimesh_pair pir_trimesh_pair;

typedef struct pir_trimesh_pair_options {
    size_t size;                    /**< of this struct, which pir_trimesh_pair_options_default sets (base.h) */
    const pir_allocator *allocator; /**< or NULL: malloc's; copied, its context must outlive the pair */
} pir_trimesh_pair_options;

/** malloc's memory. O(1). */
static inline pir_trimesh_pair_options pir_trimesh_pair_options_default(void) {
    const pir_trimesh_pair_options options = {sizeof(pir_trimesh_pair_options), NULL};
    return options;
}

/**
 * A pair of P and Q, to which it takes references; they may be one mesh.
 *
 * p, q      may be open.
 * options   NULL for the defaults.
 * ret_pair  to be freed with pir_trimesh_pair_destroy.
 *
 * Cost: O(n) once. Errors: PIR_ERR_ARGUMENT, PIR_ERR_MEMORY.
 */
PIR_API pir_status pir_trimesh_pair_create(pir_trimesh *p, pir_trimesh *q, const pir_trimesh_pair_options *options,
                                           pir_trimesh_pair **ret_pair);

/** Frees, and gives its references back; NULL is accepted. Cost: the time to free it. */
PIR_API void pir_trimesh_pair_destroy(pir_trimesh_pair *pair);

/** How two surfaces stand. */
typedef enum pir_trimesh_state {
    PIR_TRIMESH_APART = 0, /**< they share no point, and none is within the other */
    PIR_TRIMESH_MEET,      /**< they share a point */
    PIR_TRIMESH_P_INSIDE,  /**< they share no point; both are closed, and a part of P is within Q */
    PIR_TRIMESH_Q_INSIDE,  /**< likewise: a part of Q is within P, and none of P within Q */
} pir_trimesh_state;

/** Two triangles and points of theirs. */
typedef struct pir_trimesh_distance {
    pir_trimesh_state state; /**< PIR_TRIMESH_APART for the farthest */
    double distance;         /**< of the points; 0 where the surfaces meet */
    uint32_t triangle_p, triangle_q;
    pir_vec3 point_p, point_q; /**< in the world; within 2^-42 of the sizes and coordinates */
} pir_trimesh_distance;

/**
 * State, least distance, and where it is.
 *
 * pose_p, pose_q  where the meshes stand.
 *
 * Cost: O(k) for k pairs of nodes of the front whose bounds can bear no more motion, and a look along the whole
 * front; O(log n) levels of pairs for the first call, and where motion was too much for most. Where they meet,
 * O(m) for m pairs of nodes that are not apart and may have lower numbers than those found. To tell what is
 * inside: O(log n) a part.
 *
 * Errors: those of a call on a pair.
 */
PIR_API pir_status pir_trimesh_pair_nearest(pir_trimesh_pair *pair, pir_pose pose_p, pir_pose pose_q,
                                            pir_trimesh_distance *ret_distance);

/**
 * The greatest distance of any two points, which is one of vertices.
 *
 * pose_p, pose_q  where the meshes stand.
 *
 * Cost: O(log n) levels of pairs of nodes that may be as far. Errors: those of a call on a pair.
 */
PIR_API pir_status pir_trimesh_pair_farthest(pir_trimesh_pair *pair, pir_pose pose_p, pir_pose pose_q,
                                             pir_trimesh_distance *ret_distance);

/** A triangle of P and one of Q. */
typedef struct pir_triangle_pair {
    uint32_t p, q;
} pir_triangle_pair;

/** The input of pir_trimesh_pair_within. */
typedef struct pir_within_input {
    pir_pose pose_p, pose_q;
    double distance; /**< 0 or more; 0 asks which triangles share a point */
} pir_within_input;

/** Both at the origin, not turned; a distance of 0. O(1). */
PIR_API pir_within_input pir_within_input_default(void);

/**
 * All pairs of triangles whose distance is at most that of `input`, in rising order where all fit.
 *
 * capacity, ret_pairs  room for how many, and that room.
 * ret_count            how many there are, also beyond the capacity.
 *
 * Cost: O(k log k) for k pairs whose boxes are as near. Errors: those of a call on a pair.
 */
PIR_API pir_status pir_trimesh_pair_within(pir_trimesh_pair *pair, const pir_within_input *input, size_t capacity,
                                           pir_triangle_pair *ret_pairs, size_t *ret_count);

/** The work of a pair since it was made. */
typedef struct pir_trimesh_pair_statistics {
    uint64_t calls;
    uint64_t rebuilt;   /**< fronts made from the roots */
    uint64_t expired;   /**< pairs of nodes whose bounds could bear no more */
    uint64_t bounds;    /**< pairs of nodes looked at */
    uint64_t triangles; /**< pairs of triangles whose distance was computed */
    uint64_t exact;     /**< pairs of triangles whose distance was computed exactly */
    uint64_t front;     /**< pairs of nodes in the front now */
    size_t bytes;       /**< of the pair with its front */
} pir_trimesh_pair_statistics;

/** The counters of `pair`. O(1). */
PIR_API pir_trimesh_pair_statistics pir_trimesh_pair_get_statistics(const pir_trimesh_pair *pair);

#ifdef __cplusplus
}
#endif

#endif
