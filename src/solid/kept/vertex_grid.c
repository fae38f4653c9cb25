/* SPDX-License-Identifier: MIT */
/* See vertex_grid.h. A vertex is in the cell of its doubles, so a box is widened by what those may be off. */
#include "solid/kept/vertex_grid.h"

#include <string.h>

#define SIDE_MOST 32

/* The cell along an axis, the first or last one for what is outside. */
static uint32_t cell_along(const pir_vertex_grid *grid, int k, double x) {
    const double at = (x - grid->low[k]) * grid->scale[k], last = grid->side - 1;
    return at > 0 ? (uint32_t)(at < last ? at : last) : 0;
}

static void set_cells(pir_vertex_grid *grid, const pir_space *space, const uint32_t *point,
                      const pir_number_list *vertices) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    for (uint32_t i = 0; i < vertices->count; i++)
        pir_space_box_add(&box, &space->point[point[vertices->number[i]]]);
    grid->side = 1;
    while (grid->side < SIDE_MOST && 2 * grid->side * grid->side * grid->side < vertices->count)
        grid->side++;
    for (int k = 0; k < 3; k++) {
        const double extent = box.high[k] - box.low[k];
        grid->low[k] = box.low[k];
        grid->scale[k] = extent > 0 ? grid->side / extent : 0;
    }
}

void pir_vertex_grid_make(pir_vertex_grid *grid, pir_space *space, const uint32_t *point,
                          const pir_number_list *vertices) {
    set_cells(grid, space, point, vertices);
    const uint32_t side = grid->side, cells = side * side * side;
    if (!pir_space_grow(space, (void **)&grid->start, &grid->start_room, cells + 1, sizeof *grid->start) ||
        !pir_space_grow(space, (void **)&grid->vertex, &grid->vertex_room, vertices->count, sizeof *grid->vertex) ||
        !pir_space_grow(space, (void **)&grid->cell, &grid->cell_room, vertices->count, sizeof *grid->cell))
        return;
    memset(grid->start, 0, (cells + 2) * sizeof *grid->start);
    for (uint32_t i = 0; i < vertices->count; i++) {
        const double *x = space->point[point[vertices->number[i]]].x;
        grid->cell[i] =
            (cell_along(grid, 0, x[0]) * side + cell_along(grid, 1, x[1])) * side + cell_along(grid, 2, x[2]);
        grid->start[grid->cell[i] + 2]++;
    }
    for (uint32_t c = 0; c < cells; c++)
        grid->start[c + 2] += grid->start[c + 1];
    for (uint32_t i = 0; i < vertices->count; i++)
        grid->vertex[grid->start[grid->cell[i] + 1]++] = vertices->number[i];
}

void pir_vertex_grid_finish(pir_vertex_grid *grid, pir_space *space) {
    pir_space_shrink(space, grid->start, grid->start_room, sizeof *grid->start);
    pir_space_shrink(space, grid->vertex, grid->vertex_room, sizeof *grid->vertex);
    pir_space_shrink(space, grid->cell, grid->cell_room, sizeof *grid->cell);
    *grid = (pir_vertex_grid){0};
}

void pir_vertex_grid_find(const pir_vertex_grid *grid, pir_space *space, const uint32_t *point, pir_space_box box,
                          pir_number_list *ret_found) {
    const uint32_t side = grid->side;
    uint32_t low[3], high[3];
    ret_found->count = 0;
    for (int k = 0; k < 3; k++) {
        box.low[k] -= 2 * PIR_SPACE_ERROR;
        box.high[k] += 2 * PIR_SPACE_ERROR;
        low[k] = cell_along(grid, k, box.low[k]);
        high[k] = cell_along(grid, k, box.high[k]);
    }
    for (uint32_t i = low[0]; i <= high[0]; i++)
        for (uint32_t j = low[1]; j <= high[1]; j++) {
            // the cells along the last axis are in a row
            const uint32_t row = (i * side + j) * side;
            for (uint32_t at = grid->start[row + low[2]]; at < grid->start[row + high[2] + 1]; at++)
                if (pir_vertex_is_in(&box, space->point[point[grid->vertex[at]]].x))
                    pir_number_list_add(ret_found, space, grid->vertex[at]);
        }
}
