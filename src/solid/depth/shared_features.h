/* SPDX-License-Identifier: MIT */
/*
 * Vertices and planes that the pieces of a body share, under one number each, and which vertices lie in which planes:
 * found exactly, once. So what holds at every pose is told without a sign: two sums that share a vertex of each body
 * touch there, and those of neighbours in whole planes.
 */
#ifndef PIR_SOLID_DEPTH_SHARED_FEATURES_H
#define PIR_SOLID_DEPTH_SHARED_FEATURES_H

#include "solid/pieces/compound.h"

typedef struct pir_shared_features {
    uint32_t vertices, planes; /* different ones */
    uint32_t *vertex,
        *plane;         /* per vertex and face of the compound: its number here; a plane's whichever way it faces */
    uint64_t *on;       /* bit v of row p: vertex v lies in plane p */
    uint32_t words;     /* of a row */
    bool *inner_face;   /* per face of the compound */
    bool *outer_plane;  /* per plane: it has a face that is not inner */
    bool *inner_vertex; /* per vertex here */
} pir_shared_features;

/* False when out of memory; pir_shared_features_finish then frees what is there. */
bool pir_shared_features_init(pir_shared_features *shared, const pir_compound *compound,
                              const pir_allocator *allocator);
void pir_shared_features_finish(pir_shared_features *shared, const pir_compound *compound,
                                const pir_allocator *allocator);

/* Whether an edge between two vertices is inner, by their numbers here. */
bool pir_shared_features_inner_edge(const pir_shared_features *shared, uint32_t a, uint32_t b);

/* Whether a vertex lies in a plane, by their numbers here. */
static inline bool pir_shared_features_on(const pir_shared_features *shared, uint32_t plane, uint32_t vertex) {
    return (shared->on[(size_t)plane * shared->words + vertex / 64] >> vertex % 64 & 1) != 0;
}

#endif
