/* SPDX-License-Identifier: MIT */
/*
 * Which directions of a body are parallel: normals among each other, and edges.
 *
 * Bodies with a centre of symmetry, boxes and prisms have many, and then signs have their roots together. Two signs of
 * parallel vectors have the same roots, which this tells without comparing quadratics. Parallels that are not found
 * cost time alone.
 */
#ifndef PIR_MOTION_PARALLELS_H
#define PIR_MOTION_PARALLELS_H

#include "polytope/polytope.h"

/* Per direction: twice the number of the first one parallel to it, and 1 more where the two are opposite. */
typedef struct pir_parallels {
    uint32_t *normal; /* per facet */
    uint32_t *edge;   /* per edge, of the direction of its edge_half */
} pir_parallels;

/* False when out of memory; there is nothing to finish then. */
bool pir_parallels_init(pir_parallels *parallels, const pir_polytope *p, const pir_allocator *allocator);
void pir_parallels_finish(pir_parallels *parallels, const pir_polytope *p, const pir_allocator *allocator);

#endif
