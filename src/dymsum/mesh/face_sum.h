/* SPDX-License-Identifier: MIT */
/* A facet of the true sum as the sum of two faces. */
#ifndef PIR_DYMSUM_MESH_FACE_SUM_H
#define PIR_DYMSUM_MESH_FACE_SUM_H

#include "dymsum/mesh/edge_pair.h"

/* A vertex of the sum: one of P and one of Q. */
typedef struct pir_sum_corner {
    uint32_t p, q;
} pir_sum_corner;

/* A face of one polytope, counter-clockwise from outside: the halfedges around a facet, or the two of an edge. */
typedef struct pir_face_edges {
    const uint32_t *half;
    uint32_t count;
} pir_face_edges;

static inline pir_face_edges pir_facet_edges(const pir_polytope *of, uint32_t facet) {
    return (pir_face_edges){of->loop + of->loop_start[facet], of->loop_start[facet + 1] - of->loop_start[facet]};
}

/*
 * Writes the corners of the sum of a face of P, rotated, and a face of Q, counter-clockwise from outside and none of
 * them straight, to `corner`, which has room for one for each edge of the two; returns their number. Both faces have
 * the direction of `facet`, which is one of them or has the same normal; one of them is a facet. O(edges).
 */
uint32_t pir_face_sum(const pir_posed *posed, pir_face_edges of_p, pir_face_edges of_q, pir_facet_of facet,
                      pir_sum_corner *corner);

#endif
