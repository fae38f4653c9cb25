/* SPDX-License-Identifier: MIT */
/*
 * The Gaussian map of a polytope cut by the cube: which points lie where, and the pieces that it cuts arcs into.
 *
 * A site is a direction that becomes a vertex: sites 0 to 7 are the corners of the cube, then come the facets' normals
 * that are not at corners, then the points where arcs cross cube edges. A piece is a part of an arc between two sites
 * within one map, or along a cube edge. The pieces of one arc follow each other.
 */
#ifndef PIR_CGM_ARCS_H
#define PIR_CGM_ARCS_H

#include "cgm/build.h"
#include "cgm/sides.h"

/* The map of a piece along a cube edge. */
#define PIR_ALONG_EDGE 6

struct pir_site {
    struct pir_cgm_point point;
    uint32_t facet;     /* or PIR_CGM_NONE */
    uint8_t place, map; /* pir_cgm_place; a map that contains it */
    uint8_t cube_edge;  /* where place is PIR_CGM_EDGE */
};

struct pir_arc_piece {
    uint32_t from, to, edge; /* sites; the polytope's edge */
    uint8_t map, cube_edge;  /* cube_edge: where map is PIR_ALONG_EDGE */
    uint8_t forward;         /* along a cube edge: whether in its direction */
};

struct pir_cgm_arcs {
    pir_allocator allocator;
    const pir_cgm *cgm; /* of the polytope alone: its sources and lines are there */
    const pir_polytope *polytope;
    struct pir_cgm_sides sides;
    uint8_t cube_edge[6][4]; /* the number of each side of each map among cube edges */
    uint8_t edge_map[PIR_CUBE_EDGES], edge_side[PIR_CUBE_EDGES]; /* a cube edge has the direction of this side */
    uint32_t site_count, site_capacity, piece_count, piece_capacity;
    struct pir_site *site;
    struct pir_arc_piece *piece;
    uint32_t *facet_site;                    /* per facet */
    int8_t (*facet_planes)[PIR_CUBE_PLANES]; /* per facet: on which side of each of the cube's planes */
    uint32_t *piece_start;                   /* per edge, and the end; a segment's are all listed under edge 0 */
};

/* False when out of memory, with everything released. */
bool pir_arcs_init(struct pir_cgm_arcs *arcs, const pir_cgm *cgm);
void pir_arcs_finish(struct pir_cgm_arcs *arcs);

#endif
