/* SPDX-License-Identifier: MIT */
/*
 * The inside of a polytope: a halfedge structure laid out by rings, exact vectors, and unit vectors in double.
 *
 * Halfedges are numbered vertex by vertex: those that leave vertex v are ring_start[v] .. ring_start[v+1] − 1,
 * counter-clockwise from outside, the facet left of each lying between it and the next. So a vertex's neighbourhood is
 * a contiguous slice, and in the Gaussian map that slice is the boundary of v's cell: corner left[h], then side h + 1
 * (cyclically), and so on.
 *
 * Invariants
 *   - twin is an involution without fixed points; left[twin[h]] is the facet right of h; target[h] is the origin of
 *     twin[h].
 *   - edges are numbered by (smaller vertex, larger vertex); edge_half[e] is the halfedge that leaves the smaller.
 *   - the arc of e in the Gaussian map leads from the facet left of edge_half[e] to the one right of it, and turns
 *     counter-clockwise about the edge's vector: n_left × n_right is a positive multiple of it.
 *   - exact vectors: vertices on the common scale `scale`; edge vectors and facet normals along the true direction, of
 *     any length.
 *
 * Lower dimensions keep the same form, so that other parts need no cases for them: a polygon has its two sides as
 * facets; a segment has two facets with opposite normals across it and two edges, all its two corners at a time
 * (`artificial`: no area, hidden from callers); a point has a vertex and nothing else.
 */
#ifndef PIR_POLYTOPE_POLYTOPE_H
#define PIR_POLYTOPE_POLYTOPE_H

#include <stdatomic.h>

#include <pirouette/polytope.h>

#include "exact/vectors.h"
#include "polytope/hull/loops.h"

/* How many directions of a ring stand together. */
#define PIR_LANES 8

typedef struct pir_attachment pir_attachment;

/* The neighbour of a facet across one of its sides. */
typedef struct pir_across {
    uint32_t facet;
    uint32_t edge : 31;
    uint32_t leaves : 1; /* the edge's arc leads from the facet that has the side to this one */
} pir_across;

/* The facets that an edge's arc leads from and to. */
typedef struct pir_arc_ends {
    uint32_t from, to;
} pir_arc_ends;

/* An edge's arc as walks read it, one after another: half a line of a cache. */
typedef struct pir_edge_arc {
    float x, y, z; /* the direction of its halfedge */
    uint32_t half; /* edge_half */
    pir_arc_ends ends;
    uint32_t origin, target; /* of the halfedge */
} pir_edge_arc;

/*
 * Directions of a vertex's ring, for vector loops, as floats, and where they lead: two lines of a cache, all that is
 * read of a cell to go on to the next.
 */
typedef struct pir_ring {
    float x[PIR_LANES], y[PIR_LANES], z[PIR_LANES];
    uint32_t target[PIR_LANES];
} pir_ring;

/* A facet, and one beside it that is visited before it: itself for the first. */
typedef struct pir_visit {
    uint32_t facet, beside;
} pir_visit;

struct pir_polytope {
    atomic_uint references;
    pir_allocator allocator;
    int dimension;
    double merge_bound; /* how far it may be from the hull of the points it was made from, a length */
    bool artificial;    /* the two facets and the second edge of a segment */
    uint32_t vertex_count, edge_count, facet_count, half_count;

    uint32_t *ring_start;             /* vertex_count + 1 */
    uint32_t *origin, *target, *twin; /* per halfedge */
    uint32_t *left, *edge;            /* per halfedge: facet, edge */
    uint32_t *edge_half;              /* per edge */
    uint32_t *loop_start, *loop;      /* per facet: its halfedges counter-clockwise */
    pir_across *across;               /* per entry of `loop`: read in place of left[twin[]] and edge[] */
    pir_arc_ends *arc_ends;           /* per edge: left of edge_half, and right of it */
    pir_edge_arc *edge_arc;           /* per edge */
    pir_visit *visit;                 /* every facet once, in the order of facet_order.c */
    uint32_t *beside;                 /* per facet: as in its visit */
    uint32_t *source;                 /* per vertex: index of the input point */

    pir_vec3 *vertex;    /* nearest doubles */
    pir_vec3 *direction; /* per halfedge: unit vector from origin to target */
    pir_vec3 *normal;    /* per facet: outward unit normal */

    /*
     * Each vertex's ring again: from block ring_block[v] up to ring_block[v + 1]. The last block is filled up with the
     * ring's first direction, which changes no minimum or maximum.
     */
    uint32_t *ring_block;
    pir_ring *ring;
    unsigned char *ring_memory; /* what ring is in */
    float *normal4;             /* the normals too, each with a fourth float of 0 */

    pir_vectors exact_vertex; /* times scale */
    pir_vectors exact_edge;   /* per edge, along edge_half */
    pir_vectors exact_normal; /* per facet */
    pir_scale scale;

    pir_attachment *_Atomic attachments; /* of other parts: see attachment.h */
};

/* The parts that a polytope is built from; everything is copied. */
typedef struct pir_polytope_parts {
    const pir_vectors *points; /* exact, on `scale` */
    const pir_scale *scale;
    const pir_vec3 *doubles; /* the points themselves where they are doubles; NULL: the nearest are worked out */
    int dimension;
    const uint32_t *vertices; /* which points, rising */
    uint32_t vertex_count;
    const pir_loops *facets; /* loops of point indices; the facets keep this order */
} pir_polytope_parts;

pir_status pir_polytope_build(const pir_polytope_parts *parts, const pir_allocator *allocator,
                              pir_polytope **ret_polytope);

/* Builds the hull of the points of `parts`, whose last four members are ignored. */
pir_status pir_polytope_build_hull(const pir_polytope_parts *parts, const pir_allocator *allocator,
                                   pir_polytope **ret_polytope);

static inline uint32_t pir_right(const pir_polytope *p, uint32_t half) {
    return p->left[p->twin[half]];
}

/* The halfedge after `half` in its vertex's ring. */
static inline uint32_t pir_ring_next(const pir_polytope *p, uint32_t half) {
    uint32_t v = p->origin[half];
    return half + 1 == p->ring_start[v + 1] ? p->ring_start[v] : half + 1;
}

/* The exact vector from origin to target, up to a positive factor; borrows the polytope's limbs. */
static inline pir_int3 pir_half_exact(const pir_polytope *p, uint32_t half) {
    uint32_t e = p->edge[half];
    pir_int3 v = pir_vectors_at(&p->exact_edge, e);
    if (p->edge_half[e] != half)
        for (int k = 0; k < 3; k++)
            pir_int_negate(&v.c[k]);
    return v;
}

static inline pir_int3 pir_normal_exact(const pir_polytope *p, uint32_t facet) {
    return pir_vectors_at(&p->exact_normal, facet);
}

static inline pir_int3 pir_vertex_exact(const pir_polytope *p, uint32_t vertex) {
    return pir_vectors_at(&p->exact_vertex, vertex);
}

/* Whether component k of a vertex is its double exactly, which is told of doubles that are no smaller than 2^-900. */
bool pir_vertex_is_double(const pir_polytope *p, uint32_t vertex, int k);

#endif
