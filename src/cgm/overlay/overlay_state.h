/* SPDX-License-Identifier: MIT */
/*
 * The state of one overlay of maps a and b, shared by its three stages: rims (overlay.c), walking the edges of a
 * through the faces of b (overlay_walk.c), and putting the result together (overlay_join.c).
 *
 * Every vertex of the result is a vertex of a, a point within an edge of a, or within a face of a; and the same for b.
 * These are the ten cases of Fogel and Halperin: vertex and vertex (1), vertex on edge (2, 3), vertex in face (4, 5),
 * edge and edge crossing (6) or overlapping (7), edge in face (8, 9), face and face (10).
 */
#ifndef PIR_CGM_OVERLAY_OVERLAY_STATE_H
#define PIR_CGM_OVERLAY_OVERLAY_STATE_H

#include "cgm/build.h"
#include "cgm/sides.h"

/* Where in b a vertex of a is; `index` is a vertex, a halfedge (either of the edge's two) or a face. */
enum pir_kind { PIR_UNKNOWN = 0, PIR_AT_VERTEX, PIR_ON_EDGE, PIR_IN_FACE };

struct pir_location {
    uint8_t kind;
    uint32_t index;
};

/* A vertex of the result, by where it lies in a and in b; PIR_CGM_NONE where a member does not apply. */
struct pir_joint {
    uint32_t a, b; /* the vertices that are here */
    /* Within an edge of a: the result's halfedge onwards in the direction in which that edge was walked. The halfedge
       back has the number before it. */
    uint32_t a_mid;
    uint32_t b_mid;  /* within an edge of b: the number of its piece onwards among `piece` */
    uint32_t record; /* within an edge of b: its record */
};

/* Where an edge of the result lies: on halfedges of a and b along its halfedge 2e; in the face of b where
   it is on no edge of b. */
struct pir_overlay_seam {
    uint32_t a, b, cell;
};

/* A point within an edge of b. */
struct pir_record {
    uint32_t vertex, next; /* the result's vertex; the next record of the same edge */
    uint32_t cover;        /* the result's halfedge from here onwards along b's halfedge 2e, when a has an edge there */
};

/* The edges of the result on one edge of a, in the order that they were walked. */
struct pir_overlay_run {
    uint32_t first, last; /* first > last: not walked yet */
    uint32_t half;        /* the halfedge of a that was walked along */
};

struct pir_overlay {
    const pir_cgm *a, *b;
    pir_cgm *result;
    pir_allocator allocator;
    struct pir_cgm_sides sides;
    uint32_t vertices, edges; /* of the result so far */
    uint32_t joint_capacity, seam_capacity, record_count, record_capacity, piece_count, piece_capacity;
    struct pir_joint *joint;       /* per vertex of the result */
    struct pir_overlay_seam *seam; /* per edge of the result */
    struct pir_record *record;
    uint32_t *piece; /* the result's halfedges along halfedge 2e of b's edges, edge by edge */
    /* of a */
    struct pir_location *where;  /* per vertex */
    uint32_t *a_vertex;          /* per vertex: the result's */
    struct pir_overlay_run *run; /* per edge */
    uint32_t *queue;             /* vertices located, to be walked from */
    /* of b */
    uint32_t *b_vertex;      /* per vertex: the result's, or PIR_CGM_NONE */
    uint32_t *first_record;  /* per edge */
    uint32_t *first_cover;   /* per edge: the cover from its halfedge 2e's origin on */
    uint32_t *piece_start;   /* per edge, and the end: where its pieces begin */
    uint32_t *half_position; /* per halfedge: its place in the ring being merged */
    uint32_t *face_position; /* per face: the place of the ring's halfedge whose right it is */
    uint32_t *list;          /* work: rings, records */
};

/* Sets up the overlay of `a` and `b`, with the sources of both in its result; false when out of memory. Release what
   was made with pir_overlay_finish, whatever the outcome. */
bool pir_overlay_init(struct pir_overlay *overlay, const pir_cgm *a, const pir_cgm *b);

/* Releases all but the result. */
void pir_overlay_finish(struct pir_overlay *overlay);

/* A line of b among the result's, a direction of b in them. */
static inline uint32_t pir_overlay_line(const struct pir_overlay *overlay, uint32_t line) {
    return line < 2 * PIR_CUBE_PLANES ? line : line + 2 * (overlay->a->line_count - PIR_CUBE_PLANES);
}

/* Adds a vertex of the result: what it is in a or b is set by the caller in its joint.
   PIR_CGM_NONE when out of memory. */
uint32_t pir_overlay_add_vertex(struct pir_overlay *overlay, uint32_t map, const struct pir_cgm_point *point,
                                uint8_t place);

/* The result's vertex at vertex w of b, made if it is not there yet. */
uint32_t pir_overlay_vertex_of_b(struct pir_overlay *overlay, uint32_t w);

/* Adds an edge of the result; its number, or PIR_CGM_NONE when out of memory. */
uint32_t pir_overlay_add_edge(struct pir_overlay *overlay, uint32_t from, uint32_t to, uint32_t line,
                              struct pir_overlay_seam seam);

/* Notes that vertex v of the result is within edge e of b; false when out of memory. */
bool pir_overlay_add_record(struct pir_overlay *overlay, uint32_t v, uint32_t e);

#endif
