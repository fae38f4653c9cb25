/* SPDX-License-Identifier: MIT */
/* Pairs of triangles, and the best of those that were looked at. */
#ifndef PIR_MESH_PAIR_LEAF_PAIR_H
#define PIR_MESH_PAIR_LEAF_PAIR_H

#include <pirouette/trimesh_pair.h>

#include "mesh/pair/mesh_frame.h"
#include "mesh/signs/triangle_span.h"

/* The nearest two triangles so far, exactly: no pair that was considered is nearer, or as near with lower numbers. */
typedef struct pir_best_pair {
    uint32_t p, q; /* PIR_TRIANGLE_NONE: none yet */
    pir_span span;
    bool has_square;   /* whether `square` is that of its distance */
    bool meets;        /* exactly: the distance is 0 */
    bool has_compared; /* whether `compared` was compared with this pair exactly, and is `order` of it */
    int order;
    pir_span compared;
    pir_exact_square square, other; /* the other is for whom it is compared with */
    mp_limb_t *limbs;               /* of both */
    uint32_t room;                  /* of each part */
} pir_best_pair;

/* Room for the squares of a frame. False when out of memory. */
bool pir_best_pair_reserve(pir_best_pair *best, const pir_allocator *allocator, uint32_t coordinate);
void pir_best_pair_finish(pir_best_pair *best, const pir_allocator *allocator);

/* Forgets the pair, or begins with one at the frame's pose. */
void pir_best_pair_clear(pir_best_pair *best);
void pir_best_pair_begin(pir_best_pair *best, pir_mesh_frame *frame, uint32_t p, uint32_t q,
                         pir_trimesh_pair_statistics *counts);

/* Corners of a triangle in Q's frame. */
pir_corners pir_frame_corners(const pir_mesh_frame *frame, int side, uint32_t triangle);

/* Considers a pair of triangles whose span is known. */
void pir_best_pair_consider(pir_best_pair *best, pir_mesh_frame *frame, uint32_t p, uint32_t q, const pir_span *span,
                            pir_trimesh_pair_statistics *counts);

/*
 * Considers all triangles of two leaves, after a direction that may take them apart. Returns a lower bound on the
 * distance of all of them. *n becomes the direction between the nearest of them, and *ret_gap what that takes all of
 * them apart by.
 */
double pir_leaf_pair_consider(pir_best_pair *best, pir_mesh_frame *frame, const uint32_t leaf[2], pir_vec3 *n,
                              double *ret_gap, pir_trimesh_pair_statistics *counts);

/* Looks at a pair of triangles. */
typedef void pir_near_triangles(void *context, uint32_t p, uint32_t q, const pir_corners *const corners[2]);

/* Visits the pairs of triangles of two leaves that no direction tried takes apart by more than a distance. */
void pir_leaf_pair_visit(const pir_mesh_frame *frame, const uint32_t leaf[2], pir_vec3 n, double distance,
                         pir_near_triangles *visit, void *context);

#endif
