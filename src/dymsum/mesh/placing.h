/* SPDX-License-Identifier: MIT */
/*
 * Points of the sum: R·p + q for a vertex p of P and q of Q, as doubles and exactly, all exact ones on one scale.
 */
#ifndef PIR_DYMSUM_MESH_PLACING_H
#define PIR_DYMSUM_MESH_PLACING_H

#include "base/vec.h"
#include "exact/rotation.h"
#include "polytope/mesh.h"
#include "polytope/polytope.h"

typedef struct pir_placing {
    const pir_polytope *p, *q;
    pir_rotation *rotation;
    pir_int p_factor, q_factor; /* a point is p_factor·M·p + q_factor·q, times scale */
    pir_scale scale;
    uint32_t stride; /* limbs of a component */
    pir_limbs scratch;
    mp_limb_t *limbs; /* of the factors, and of the scale */
    uint32_t limb_count;
    mp_limb_t one;
} pir_placing;

/* Borrows all three, and makes the rotation's integers; PIR_ERR_MEMORY. */
pir_status pir_placing_init(pir_placing *placing, const pir_allocator *allocator, const pir_polytope *p,
                            const pir_polytope *q, pir_rotation *rotation);
void pir_placing_finish(pir_placing *placing, const pir_allocator *allocator);

/* The exact point into place `index` of `points`, whose stride is at least placing->stride. */
void pir_placing_set(pir_placing *placing, uint32_t p, uint32_t q, pir_vectors *points, uint32_t index);

/* The point by doubles. */
static inline pir_vec3 pir_place(const pir_mat3 *r, const pir_polytope *p, const pir_polytope *q, uint32_t vp,
                                 uint32_t vq) {
    return pir_vec_add(pir_mat_apply(r, p->vertex[vp]), q->vertex[vq]);
}

/* Gives a mesh whose pairs are set exact coordinates; false when out of memory. */
bool pir_placing_fill(pir_placing *placing, pir_mesh *mesh);

#endif
