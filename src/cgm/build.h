/* SPDX-License-Identifier: MIT */
/*
 * Shared by the two ways to make a map, from a polytope and from two maps: memory, rings, faces, copies, flags.
 */
#ifndef PIR_CGM_BUILD_H
#define PIR_CGM_BUILD_H

#include "cgm/cgm.h"

/* The sources of a map, each copied from `from` (one of them may be NULL), and the table of lines.
   NULL when out of memory. */
pir_cgm *pir_cgm_new(const pir_allocator *allocator, const pir_cgm *first, const pir_cgm *second);

/* A new map of one polytope; `rotation` may be NULL and is copied. */
pir_cgm *pir_cgm_new_from(const pir_allocator *allocator, pir_polytope *polytope, const pir_rotation *rotation);

/* Room for `extra` more vertices or edges beyond `count`; false when out of memory. */
bool pir_cgm_reserve_vertices(pir_cgm *cgm, uint32_t count, uint32_t extra);
bool pir_cgm_reserve_edges(pir_cgm *cgm, uint32_t count, uint32_t extra);

/* Grows a block of *capacity elements to hold `need`, at least doubling it; false when out of memory. */
bool pir_cgm_grow(const pir_allocator *allocator, void **block, uint32_t *capacity, uint32_t need, size_t size);

/* Links the halfedges that leave one vertex, given one by one counter-clockwise. */
struct pir_cgm_ring {
    uint32_t first, last;
};

static inline void pir_ring_add(pir_cgm *cgm, struct pir_cgm_ring *ring, uint32_t half) {
    if (ring->first == PIR_CGM_NONE)
        ring->first = half;
    else
        cgm->half[half ^ 1].next = ring->last;
    ring->last = half;
}

static inline void pir_ring_close(pir_cgm *cgm, const struct pir_cgm_ring *ring) {
    cgm->half[ring->first ^ 1].next = ring->last;
}

/* Walks the faces of map `map`, whose edges are there and linked, and numbers them from face_start[map] on;
   false when out of memory. */
bool pir_cgm_trace_faces(pir_cgm *cgm, uint32_t map);

/* When all maps are there: copies, and room for what sources contribute, all PIR_CGM_NONE. False when out of memory. */
bool pir_cgm_connect(pir_cgm *cgm);

/* Whether v is the normal of a facet of the sum of `count` sources from `first` on: at least three
   of its cells meet there. */
bool pir_cgm_is_facet_of(const pir_cgm *cgm, uint32_t v, uint32_t first, uint32_t count);

/* When all is there but the vertices' flags: sets them. */
void pir_cgm_flag_vertices(pir_cgm *cgm);

/* Gives back memory that a finished map does not need. */
void pir_cgm_trim(pir_cgm *cgm);

/* For a side seen from inside its square: the opposite one in the map beyond. */
static inline uint32_t pir_cgm_beyond(const pir_cgm *cgm, uint32_t half) {
    // it ends in the copy of where `half` starts
    uint32_t end = cgm->vertex[cgm->half[half].origin].copy, map = cgm->vertex[end].map;
    uint32_t i = end - cgm->vertex_start[map];
    return 2 * (cgm->edge_start[map] + (i == 0 ? cgm->rim[map] : i) - 1);
}

/* Whether halfedge `half` of map `map` is a side seen from inside its square. */
static inline bool pir_cgm_is_side(const pir_cgm *cgm, uint32_t half, uint32_t map) {
    return !(half & 1) && (half >> 1) - cgm->edge_start[map] < cgm->rim[map];
}

#endif
