/* SPDX-License-Identifier: MIT */
/* The facets of a true sum as polygons of pairs, and the mesh that they make. */
#ifndef PIR_DYMSUM_MESH_FACET_LIST_H
#define PIR_DYMSUM_MESH_FACET_LIST_H

#include "dymsum/mesh/face_sum.h"
#include "polytope/mesh.h"

#define PIR_NO_FACE UINT32_MAX

/*
 * The face of the other operand in the direction of a facet's normal: `facet` when that is one, else the edge of
 * halfedge `half`, else, when both are PIR_NO_FACE, the vertex that the facet is paired with.
 */
typedef struct pir_sum_face {
    uint32_t facet, half;
} pir_sum_face;

/* For each facet of both operands the face of the other, and, where that is a vertex, which. */
typedef struct pir_sum_faces {
    const pir_posed *posed;
    const pir_sum_face *of_p, *of_q;
    const uint32_t *fv, *vf;
} pir_sum_faces;

/* Begins as zeros. */
typedef struct pir_facet_list {
    uint32_t count, corner_count; /* so far */
    uint32_t facet_room, corner_room;
    uint32_t *start;
    pir_sum_corner *corner;
} pir_facet_list;

/*
 * The facets that are one of P or of Q, or hold one, with room for parallelograms of `crossings` crossings beside them.
 * PIR_ERR_MEMORY, or PIR_ERR_LIMIT beyond 2^32 corners.
 */
pir_status pir_facet_list_begin(pir_facet_list *facets, const pir_allocator *allocator, const pir_sum_faces *faces,
                                uint32_t crossings);

/* The parallelogram of halfedges `half` of P and h of Q, with the outward normal d × e. */
void pir_facet_list_add_crossing(pir_facet_list *facets, const pir_posed *posed, uint32_t half, uint32_t h);

/* The mesh, its vertices placed by the rotation `shown`, whose integers it makes where `precision` is exact. */
pir_status pir_facet_list_mesh(const pir_facet_list *facets, const pir_allocator *allocator, const pir_posed *posed,
                               pir_rotation *shown, pir_precision precision, pir_mesh **ret_mesh);

void pir_facet_list_finish(pir_facet_list *facets, const pir_allocator *allocator);

#endif
