/* SPDX-License-Identifier: MIT */
/* Vertices by where they are: a grid over their box, with about two in a cell. O(n) to make. */
#ifndef PIR_SOLID_KEPT_VERTEX_GRID_H
#define PIR_SOLID_KEPT_VERTEX_GRID_H

#include "solid/space/boxes.h"
#include "solid/space/record.h"

typedef struct pir_vertex_grid {
    double low[3], scale[3]; /* cells per length */
    uint32_t side;           /* cells along each axis */
    uint32_t *start, start_room, *vertex, vertex_room, *cell, cell_room;
} pir_vertex_grid;

/* Takes the vertices listed; point[v] is where v is. The status is the space's. */
void pir_vertex_grid_make(pir_vertex_grid *grid, pir_space *space, const uint32_t *point,
                          const pir_number_list *vertices);
void pir_vertex_grid_finish(pir_vertex_grid *grid, pir_space *space);

static inline bool pir_vertex_is_in(const pir_space_box *box, const double x[3]) {
    for (int k = 0; k < 3; k++)
        if (x[k] < box->low[k] || x[k] > box->high[k])
            return false;
    return true;
}

/* Lists the vertices that may be in a box. */
void pir_vertex_grid_find(const pir_vertex_grid *grid, pir_space *space, const uint32_t *point, pir_space_box box,
                          pir_number_list *ret_found);

#endif
