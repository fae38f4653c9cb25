/* SPDX-License-Identifier: MIT */
/*
 * The relative pose of two meshes: x_Q = r·x_P + t. In doubles each coordinate in Q's frame is within `error`;
 * exactly it is Mq^T·(Mp·x + (tp − tq)·np), and a vertex of Q itself times np·nq, all on one power of two.
 */
#ifndef PIR_MESH_PAIR_MESH_FRAME_H
#define PIR_MESH_PAIR_MESH_FRAME_H

#include <pirouette/pose.h>

#include "exact/rotation.h"
#include "mesh/signs/exact_distance.h"
#include "mesh/trimesh.h"

typedef struct pir_mesh_frame {
    const pir_trimesh *mesh[2]; /* P and Q */
    double reach[2];            /* how far vertices are from their mesh's origin */
    pir_pose pose[2];
    pir_rotation rotation[2];
    pir_mat3 r;
    pir_vec3 t;
    double size;  /* the sum of all lengths that a coordinate is made of */
    double error; /* of a coordinate */
    pir_rotation_integers integers[2];
    int exponent;        /* of the coordinates as integers */
    bool has_integers;   /* whether those of this pose are made */
    pir_limbs limbs;     /* the stack of exact numbers */
    uint32_t coordinate; /* limbs that it is for */
} pir_mesh_frame;

/* Takes two poses, and makes room for their exact numbers and those of `length`. Nothing changes on failure. */
pir_status pir_mesh_frame_set(pir_mesh_frame *frame, const pir_allocator *allocator, pir_pose pose_p, pir_pose pose_q,
                              double length);
void pir_mesh_frame_finish(pir_mesh_frame *frame, const pir_allocator *allocator);

/* A vertex of P in Q's frame. */
static inline pir_vec3 pir_mesh_frame_apply(const pir_mesh_frame *frame, pir_vec3 x) {
    return pir_vec_add(pir_mat_apply(&frame->r, x), frame->t);
}

/* A point in Q's frame as it stands in the world. */
pir_vec3 pir_mesh_frame_world(const pir_mesh_frame *frame, pir_vec3 x);

/* Exact coordinates on the stack, whose owner sets it back: of a vertex of P (0) or Q (1). */
pir_int3 pir_mesh_frame_exact(pir_mesh_frame *frame, int side, uint32_t vertex);

/* A length, with the scale of the exact coordinates. */
pir_int pir_mesh_frame_exact_length(pir_mesh_frame *frame, double length);

/* The exact square of the distance of two triangles. */
void pir_mesh_frame_square(pir_mesh_frame *frame, uint32_t p, uint32_t q, pir_exact_square *ret_square);

#endif
