/* SPDX-License-Identifier: MIT */
/*
 * A pair of meshes.
 *
 * Invariants, where the front is not empty
 *   - Every pair of triangles is below one pair of items of the front.
 *   - No pair of triangles below a pair of items is nearer than key − (travel.path + reach · travel.turn).
 */
#ifndef PIR_MESH_PAIR_TRIMESH_PAIR_H
#define PIR_MESH_PAIR_TRIMESH_PAIR_H

#include <pirouette/trimesh_pair.h>

#include "mesh/pair/leaf_pair.h"
#include "mesh/pair/mesh_front.h"
#include "mesh/pair/tie_sides.h"

struct pir_trimesh_pair {
    pir_allocator allocator;
    pir_trimesh *mesh[2];
    pir_mesh_frame frame;
    pir_float_frame floats;
    pir_vec3 about; /* the middle of P */
    pir_best_pair best;
    pir_mesh_front front;
    pir_tie_sides sides;
    uint32_t looks;                  /* pairs of leaves looked at in this call, since sides were last found out */
    uint32_t farthest_p, farthest_q; /* of the last answer; PIR_TRIANGLE_NONE before */
    pir_trimesh_pair_statistics counts;
};

/* Brings the pair to two poses, so that `length` has exact numbers too. */
pir_status pir_trimesh_pair_place(pir_trimesh_pair *pair, pir_pose pose_p, pir_pose pose_q, double length);

#endif
