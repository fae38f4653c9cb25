/* SPDX-License-Identifier: MIT */
/*
 * The inside of a cubical Gaussian map (Fogel and Halperin, "Exact and Efficient Construction of Minkowski Sums of
 * Convex Polyhedra with Applications", 2006): six planar maps, each a doubly connected edge list, in shared arrays.
 *
 * Sources. A map is that of one polytope, rotated or not, or an overlay of maps, that is of a sum. The polytopes it
 * comes from are its sources; every feature carries what each source contributes: a vertex the facet, a halfedge the
 * polytope's halfedge, a face the vertex, or PIR_CGM_NONE.
 *
 * Coordinates. A point of a map is a direction, and a line of a map is a plane through the origin. A direction is held
 * by what defines it, a facet's normal or the ray in which two lines meet, and computed exactly only when the filter
 * cannot decide. A line is an edge vector of a source or one of the cube's planes. So no number grows with the depth of
 * overlays: a line has the length of an edge vector, a direction at most that of the product of two.
 *
 * Lines are numbered: the cube's six planes first, then the edges of source 0, of source 1, and so on. A signed line is
 * 2·line + reversed. The signed line of a halfedge is positive to its left. Facets of all sources are numbered in the
 * same way, from 0.
 *
 * Invariants
 *   - the vertices, edges and faces of map m are a slice each, [start[m], start[m + 1]); halfedges 2e and 2e + 1 are
 *     twins.
 *   - a map's vertices begin with the `rim[m]` ones on its square, counter-clockwise from corner 0, and its edges with
 *     as many sides: halfedge 2(edge_start[m] + i) leads from rim vertex i to the next, with the square on its left and
 *     the outer face, face_start[m], on its right.
 *   - next is a permutation; following it walks a face's boundary with the face on the left. Every face but the outer
 *     one is convex.
 *   - no vertex off the rim has an angle of 180° or more: all edges that meet there span the plane. No two
 *     neighbouring edges at a vertex are collinear, but for those of the rim.
 *   - `copy` leads from a rim vertex to the same direction in the map beyond the side that it starts, the next one
 *     clockwise about it: pairs on cube edges, cyclic triplets at corners; from any other vertex to itself. Two maps
 *     have the same points on their common side.
 *   - an edge is real when a source has an edge there; faces on both sides of one that is not have equal vertices.
 *   - a vertex is real when at least three cells meet there: it stands for a facet of the polytope.
 */
#ifndef PIR_CGM_CGM_H
#define PIR_CGM_CGM_H

#include <stdatomic.h>

#include <pirouette/cgm.h>

#include "base/memory.h"
#include "base/vec.h"
#include "cgm/cube.h"
#include "exact/rotation.h"
#include "polytope/polytope.h"

/* Bounds on the unit vectors of a source, as they are and rotated; derived at the head of sides.c. */
#define PIR_CGM_UNIT_ERROR   (8 * 0x1p-53)
#define PIR_CGM_TURNED_ERROR (45 * 0x1p-53)

/* A rotation with integers of its own. */
struct pir_cgm_turn {
    pir_rotation rotation;
    pir_rotation_integers integers;
};

struct pir_cgm_source {
    pir_polytope *polytope;
    struct pir_cgm_turn *turn; /* NULL when not rotated; shared by no one */
    pir_rotation *rotation;    /* its rotation, or NULL */
    uint32_t line_start;       /* the number of its edge 0 among lines */
    uint32_t normal_start;     /* the number of its facet 0 among facets */
};

/* A direction: the normal of facet `a` when b is PIR_CGM_NONE, else the ray (signed line a) × (signed line b). */
struct pir_cgm_point {
    uint32_t a, b;
    pir_vec3 unit; /* within `error` of the true unit vector, in Euclidean length */
    double error;
};

struct pir_cgm_vertex {
    struct pir_cgm_point point;
    uint32_t out; /* a halfedge that leaves it; on the rim, the side counter-clockwise */
    uint32_t copy;
    uint8_t place, real, map;
};

struct pir_cgm_half {
    uint32_t origin, next, face;
};

struct pir_cgm {
    pir_allocator allocator;
    atomic_uint references; /* the caller's, and those of locators */
    uint32_t source_count;
    struct pir_cgm_source *source;
    uint32_t line_count, normal_count;
    struct pir_cgm_line *line;         /* line_count */
    uint32_t line_limbs, normal_limbs; /* the longest components of lines and normals */

    uint32_t vertex_start[7], edge_start[7], face_start[7];
    uint32_t rim[6];
    uint32_t corner[6][4];                                                 /* the vertex at each corner of each map */
    uint32_t vertex_capacity, half_capacity, line_capacity, face_capacity; /* half_capacity: in pairs */
    struct pir_cgm_vertex *vertex;
    struct pir_cgm_half *half;    /* two an edge */
    uint32_t *edge_line;          /* the signed line of halfedge 2e */
    uint32_t *face_half;          /* a halfedge that has the face on its left */
    uint32_t *vertex_facet;       /* per vertex and source */
    uint32_t *edge_half;          /* per edge and source: the polytope's halfedge whose arc halfedge 2e follows */
    uint32_t *face_vertex;        /* per face and source */
    uint64_t by_filter, by_exact; /* signs asked for while it was made */
};

/* A line by doubles: within `error` of the unit vector along the exact one. */
struct pir_cgm_line {
    pir_vec3 unit;
    double error;
};

static inline uint32_t pir_cgm_vertices(const pir_cgm *cgm) {
    return cgm->vertex_start[6];
}

static inline uint32_t pir_cgm_edges(const pir_cgm *cgm) {
    return cgm->edge_start[6];
}

static inline uint32_t pir_cgm_faces(const pir_cgm *cgm) {
    return cgm->face_start[6];
}

static inline uint32_t pir_cgm_target(const pir_cgm *cgm, uint32_t half) {
    return cgm->half[half ^ 1].origin;
}

static inline uint32_t pir_cgm_half_line(const pir_cgm *cgm, uint32_t half) {
    return cgm->edge_line[half >> 1] ^ (half & 1);
}

/* The halfedge after `half` clockwise around its origin. */
static inline uint32_t pir_cgm_clockwise(const pir_cgm *cgm, uint32_t half) {
    return cgm->half[half ^ 1].next;
}

static inline bool pir_cgm_is_outer(const pir_cgm *cgm, uint32_t face, uint32_t map) {
    return face == cgm->face_start[map];
}

/* The polytope's halfedge of `source` whose arc `half` follows, or PIR_CGM_NONE. */
static inline uint32_t pir_cgm_source_half(const pir_cgm *cgm, uint32_t half, uint32_t source) {
    uint32_t h = cgm->edge_half[(size_t)(half >> 1) * cgm->source_count + source];
    return h == PIR_CGM_NONE || !(half & 1) ? h : cgm->source[source].polytope->twin[h];
}

static inline uint32_t pir_cgm_source_vertex(const pir_cgm *cgm, uint32_t face, uint32_t source) {
    return cgm->face_vertex[(size_t)face * cgm->source_count + source];
}

/* Whether both faces carry the same vertex of every source. */
static inline bool pir_cgm_same_cell(const pir_cgm *cgm, uint32_t f, uint32_t g) {
    for (uint32_t s = 0; s < cgm->source_count; s++)
        if (pir_cgm_source_vertex(cgm, f, s) != pir_cgm_source_vertex(cgm, g, s))
            return false;
    return true;
}

static inline bool pir_cgm_edge_is_real(const pir_cgm *cgm, uint32_t edge) {
    for (uint32_t s = 0; s < cgm->source_count; s++)
        if (cgm->edge_half[(size_t)edge * cgm->source_count + s] != PIR_CGM_NONE)
            return true;
    return false;
}

/* An iterator over the halfedges that leave a direction, clockwise, through the maps that share it. It leaves out those
   with the outer face on their left. */
struct pir_cgm_around {
    uint32_t vertex, start, half;
};

static inline uint32_t pir_cgm_around_first(const pir_cgm *cgm, uint32_t v) {
    uint32_t h = pir_cgm_clockwise(cgm, cgm->vertex[v].out);
    return cgm->vertex[v].place == PIR_CGM_INTERIOR ? h : pir_cgm_clockwise(cgm, h);
}

static inline struct pir_cgm_around pir_cgm_around_new(const pir_cgm *cgm, uint32_t v) {
    return (struct pir_cgm_around){v, v, pir_cgm_around_first(cgm, v)};
}

/* On to the next halfedge; false when all were there. */
static inline bool pir_cgm_around_next(const pir_cgm *cgm, struct pir_cgm_around *around) {
    if (around->half != cgm->vertex[around->vertex].out) {
        around->half = pir_cgm_clockwise(cgm, around->half);
        return true;
    }
    around->vertex = cgm->vertex[around->vertex].copy;
    around->half = pir_cgm_around_first(cgm, around->vertex);
    return around->vertex != around->start;
}

#endif
