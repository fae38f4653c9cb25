/* SPDX-License-Identifier: MIT */
/* Which faces of two operands the facets of their sum come from, found among all normals that these can have. */
#ifndef PIR_DYMSUM_MESH_OBJECT_SEARCH_H
#define PIR_DYMSUM_MESH_OBJECT_SEARCH_H

#include "dymsum/mesh/facet_list.h"

/* Halfedges of P and Q whose parallelogram is a facet of the sum, with the outward normal d × e. */
typedef struct pir_swept {
    uint32_t half, h;
} pir_swept;

typedef struct pir_object_search {
    const pir_allocator *allocator;
    const pir_posed *posed;
    pir_vec3 *at_p, *at_q;     /* the vertices, about the first of each, P's turned */
    double bound_p, bound_q;   /* on the error of a product of a difference of two of these with a unit normal */
    pir_sum_face *of_p, *of_q; /* see pir_sum_faces */
    uint32_t *fv, *vf;
    uint32_t *farthest;   /* the vertices that are farthest along the normal in hand */
    uint8_t *is_farthest; /* per vertex of the operand in hand, all 0 between normals */
    pir_swept *swept;
    uint32_t swept_count, swept_room;
} pir_object_search;

/* Limbs of the vectors that a search asks signs of: of P's side and of Q's. */
uint32_t pir_object_limbs(const pir_polytope *operand);

/*
 * Finds all. The signs of `posed` must have room for pir_object_limbs of both. PIR_ERR_MEMORY, or PIR_ERR_INTERNAL
 * where operands contradict themselves; either leaves something to finish.
 */
pir_status pir_object_search_run(pir_object_search *search, const pir_posed *posed, const pir_allocator *allocator);
void pir_object_search_finish(pir_object_search *search);

#endif
