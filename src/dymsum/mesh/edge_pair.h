/* SPDX-License-Identifier: MIT */
/* An edge of P, rotated, and an edge of Q: whether they are parallel, and to which side one turns from the other. */
#ifndef PIR_DYMSUM_MESH_EDGE_PAIR_H
#define PIR_DYMSUM_MESH_EDGE_PAIR_H

#include "exact/sign.h"
#include "polytope/polytope.h"

/* Both operands at one rotation: for a sum, the one that its pairing is exact at. */
typedef struct pir_posed {
    const pir_polytope *p, *q;
    pir_signs *signs; /* at that rotation */
    pir_vec3 *normal; /* of the facets of P, rotated */
} pir_posed;

/* Borrows all but the normals; PIR_ERR_MEMORY. */
pir_status pir_posed_init(pir_posed *posed, const pir_allocator *allocator, const pir_polytope *p,
                          const pir_polytope *q, pir_signs *signs);
void pir_posed_finish(pir_posed *posed, const pir_allocator *allocator);

/* The unit vector of halfedge h of P, rotated. */
static inline pir_vec3 pir_posed_direction(const pir_posed *posed, uint32_t h) {
    return pir_mat_apply(&posed->signs->rotation.r, posed->p->direction[h]);
}

typedef struct pir_edge_pair {
    uint32_t half, h; /* the halfedges of P and Q */
    pir_vec3 e, d;    /* their unit vectors, P's rotated */
} pir_edge_pair;

/* A facet of P, or of Q. */
typedef struct pir_facet_of {
    bool of_p;
    uint32_t facet;
} pir_facet_of;

bool pir_edges_are_parallel(const pir_posed *posed, const pir_edge_pair *pair);

/*
 * Whether d × e, which is parallel to the facet's normal and not zero, points along that normal rather than against
 * it.
 */
bool pir_edges_point_along(const pir_posed *posed, const pir_edge_pair *pair, pir_facet_of facet);

/*
 * The sign of the turn from e to d about the outward normal of a facet in whose plane both lie: 1 when d is left of e
 * seen from outside, −1 when it is right of it, 0 when the two are parallel.
 */
int pir_edges_turn(const pir_posed *posed, const pir_edge_pair *pair, pir_facet_of facet);

#endif
