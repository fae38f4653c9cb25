/* SPDX-License-Identifier: MIT */
/*
 * A height field.
 *
 * Invariants
 *   - Samples of cells that are no holes are finite, and at most 2^60 in size, as are their places.
 *   - Level 0 of the pyramid has the least and greatest heights of blocks of 2 × 2 cells, each level above those
 *     of blocks of 2 × 2 of the one below, rounded outward. Blocks of nothing but holes have low > high. The last
 *     level is one block.
 */
#ifndef PIR_MESH_HEIGHT_FIELD_H
#define PIR_MESH_HEIGHT_FIELD_H

#include <stdatomic.h>

#include <pirouette/trimesh.h>

#include "base/memory.h"
#include "mesh/signs/mesh_signs.h"

#define PIR_HEIGHT_LEVELS 16

typedef struct pir_height_range {
    float low, high;
} pir_height_range;

struct pir_height_field {
    pir_allocator allocator;
    atomic_uint references;
    uint32_t columns, rows, triangles;
    double step_x, step_y;
    bool two_sided;
    float *floats; /* the heights, here or in `doubles` */
    double *doubles;
    uint32_t *material; /* NULL where all are 0 */
    uint8_t *hole;      /* a bit a cell, or NULL */
    uint32_t levels, level_columns[PIR_HEIGHT_LEVELS], level_rows[PIR_HEIGHT_LEVELS];
    uint32_t level_start[PIR_HEIGHT_LEVELS + 1];
    pir_height_range *range; /* level by level, row by row */
    pir_vec3 low, high;
};

static inline uint32_t pir_height_cell_columns(const pir_height_field *field) {
    return field->columns - 1;
}

static inline uint32_t pir_height_cells(const pir_height_field *field) {
    return (field->columns - 1) * (field->rows - 1);
}

static inline bool pir_height_is_hole(const pir_height_field *field, uint32_t cell) {
    return field->hole && (field->hole[cell / 8] >> cell % 8 & 1);
}

static inline pir_vec3 pir_height_sample(const pir_height_field *field, uint32_t i, uint32_t j) {
    size_t at = (size_t)j * field->columns + i;
    return (pir_vec3){(double)i * field->step_x, (double)j * field->step_y,
                      field->floats ? (double)field->floats[at] : field->doubles[at]};
}

/* The triangle of this number, which is none of a hole. */
static inline pir_tri pir_height_tri(const pir_height_field *field, uint32_t triangle) {
    uint32_t cell = triangle / 2, i = cell % pir_height_cell_columns(field), j = cell / pir_height_cell_columns(field);
    pir_vec3 across = pir_height_sample(field, i + 1, j + 1), from = pir_height_sample(field, i, j);
    return triangle % 2 == 0 ? (pir_tri){{from, pir_height_sample(field, i + 1, j), across}}
                             : (pir_tri){{from, across, pir_height_sample(field, i, j + 1)}};
}

#endif
