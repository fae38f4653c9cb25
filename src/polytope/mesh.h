/* SPDX-License-Identifier: MIT */
/*
 * The inside of a mesh. Vertices stand by rising pair (vertex of P, vertex of Q); facets in the canonical order of
 * loops.h.
 */
#ifndef PIR_POLYTOPE_MESH_H
#define PIR_POLYTOPE_MESH_H

#include <pirouette/mesh.h>

#include "exact/vectors.h"
#include "polytope/hull/loops.h"

struct pir_mesh {
    pir_allocator allocator;
    uint32_t vertex_count, edge_count, corners;
    pir_vec3 *vertex;
    uint32_t (*pair)[2];
    pir_loops facets;
    uint8_t *kind; /* per facet: pir_facet_kind */
    bool of_solid; /* facets need not be convex, and slits lead to their holes */
    uint32_t segment_count, point_count;
    uint32_t *segment, *point; /* two vertices a segment; vertices of points on their own */
    bool exact;                /* whether the next two are set */
    pir_vectors where;         /* exact coordinates, times scale */
    pir_vectors weight; /* when it is not empty: per vertex, in its first component, what those are to be divided by */
    pir_scale scale;
};

/* An empty mesh with room for so much: vertices, pairs, loops and kinds to be filled. NULL when out of memory. */
pir_mesh *pir_mesh_new(const pir_allocator *allocator, uint32_t vertices, uint32_t facets, uint32_t corners);

#endif
