/* SPDX-License-Identifier: MIT */
/*
 * Convex polyhedra, cells, in flat arrays: a cell is a run of faces, a face a half-space and a run of corners.
 *
 * Invariants of a cell: it has an inside; each face has an area and no straight corner; corners are counter-clockwise
 * seen from above the face's half-space; faces that share an edge have the same numbers for its ends.
 */
#ifndef PIR_SOLID_PIECES_CELLS_H
#define PIR_SOLID_PIECES_CELLS_H

#include "solid/space/space.h"

typedef struct pir_face {
    uint32_t half, first, count; /* corners */
} pir_face;

typedef struct pir_cell {
    uint32_t first, count; /* faces */
} pir_cell;

typedef struct pir_cells {
    pir_space *space;
    pir_cell *cell;
    pir_face *face;
    uint32_t *corner; /* points */
    uint32_t count, face_count, corner_count;
    uint32_t cell_room, face_room, corner_room;
    struct pir_cell_cut {
        uint32_t a, b, point;
    } * cut; /* scratch: where edges of the cell at hand meet a plane */
    struct pir_cell_side {
        uint32_t from, to;
    } * side; /* scratch: sides of the new face */
    uint32_t cut_count, cut_room, side_count, side_room;
} pir_cells;

void pir_cells_init(pir_cells *cells, pir_space *space);
void pir_cells_finish(pir_cells *cells);

/* Building a cell: begin, then for each face begin and its corners. */
uint32_t pir_cells_begin(pir_cells *cells);
void pir_cells_begin_face(pir_cells *cells, uint32_t half);
void pir_cells_add_corner(pir_cells *cells, uint32_t point);

/* A box that all points of the space are within, for planes to cut. */
uint32_t pir_cells_add_box(pir_cells *cells);

/*
 * Cuts a cell by the plane of a half-space. ret_parts gets what lies in the half-space and what lies above it, each
 * PIR_SPACE_NONE where that has no inside. Where all of the cell is on one side, that is the cell itself.
 */
void pir_cells_cut(pir_cells *cells, uint32_t cell, uint32_t half, uint32_t ret_parts[2]);

#endif
