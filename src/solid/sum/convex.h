/* SPDX-License-Identifier: MIT */
/*
 * Pieces as operands of pair sums, in flat arrays: vertices, faces with directions for normals, edges. And the sums of
 * pairs of them, each a run of planes with a box: the half-spaces whose common points it is.
 */
#ifndef PIR_SOLID_SUM_CONVEX_H
#define PIR_SOLID_SUM_CONVEX_H

#include "solid/pieces/decompose.h"
#include "solid/space/boxes.h"

typedef struct pir_convex_edge {
    uint32_t point, end, direction; /* its ends; a direction along it */
    uint32_t normal[2];             /* of its faces: left × right is along `direction` */
    uint32_t face[2];               /* those, counted from the piece's first */
} pir_convex_edge;

typedef struct pir_convex {
    uint32_t vertex, vertex_count; /* in the list's arrays */
    uint32_t face, face_count;
    uint32_t edge, edge_count;
    pir_space_box box;
} pir_convex;

typedef struct pir_convex_face {
    uint32_t point, normal; /* a corner, the outward normal's direction */
} pir_convex_face;

typedef struct pir_convexes {
    pir_space *space;
    uint32_t count, room, vertex_count, vertex_room, face_count, face_room, edge_count, edge_room;
    pir_convex *convex;
    uint32_t *vertex; /* points */
    pir_convex_face *face;
    pir_convex_edge *edge;
    uint32_t *normal_of; /* per half-space: its normal's direction, or none */
    uint32_t normal_room;
    int8_t *side; /* scratch, as long as any piece has faces */
    uint32_t side_room;
} pir_convexes;

/* The pieces of a decomposition, whose points and planes have one number each. The status is the space's. */
void pir_convexes_make(pir_convexes *convexes, const pir_cells *cells, const pir_piece_list *pieces);
/* Sets the boxes of pieces whose points have moved. */
void pir_convexes_set_boxes(pir_convexes *convexes);
void pir_convexes_finish(pir_convexes *convexes);

typedef struct pir_pair_sum {
    uint32_t first, count; /* planes of the space */
    uint32_t below;        /* a half-space of a candidate that the sum is below, or 0 */
    uint32_t apart;        /* the plane of its own that a candidate was last found above */
    pir_space_box box;
} pir_pair_sum;

/* The sum of one piece of p and one of q, whose scratch it uses. */
pir_pair_sum pir_pair_sum_make(const pir_convexes *p, uint32_t i, pir_convexes *q, uint32_t j);

#endif
