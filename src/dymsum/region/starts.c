/* SPDX-License-Identifier: MIT */
/*
 * A descent to the cell of a facet may start in any cell, and is short from one near its normal. A grid over the sphere
 * names one for each square: the sphere is projected to an octahedron, and that unfolded to a square of side 2, as in
 * Praun and Hoppe, Spherical parametrization and remeshing, ACM Transactions on Graphics 22 (2003). Floats will do.
 */
#include "dymsum/region/starts.h"

#include "base/layout.h"

/* A grid has about so many squares for a vertex. */
#define SQUARES 4

/* Squares that are filled in at a time. */
#define FILLED 32

static pir_layout layout_of(pir_starts *starts) {
    return (pir_layout){{PIR_ROW(starts->cell, starts->side * starts->side)}};
}

void pir_starts_finish(pir_starts *starts, const pir_allocator *allocator) {
    pir_layout layout = layout_of(starts);
    pir_layout_free(allocator, &layout);
    *starts = (pir_starts){0};
}

/* The direction of a square's middle, no longer than 1: the lower half was unfolded around the upper one. */
static void middle_of(const pir_starts *starts, uint32_t square, float ret_normal[4]) {
    float step = 2 / (float)starts->side, x = ((float)(square % starts->side) + 0.5f) * step - 1,
          y = ((float)(square / starts->side) + 0.5f) * step - 1, z = 1 - fabsf(x) - fabsf(y), below = z < 0 ? -z : 0;
    ret_normal[0] = x - copysignf(below, x);
    ret_normal[1] = y - copysignf(below, y);
    ret_normal[2] = z;
    ret_normal[3] = 0;
}

/* Fills in squares from `first` on, at most FILLED, each from the one beside it in the row before. */
static void fill(pir_starts *starts, const pir_kernels *kernels, const pir_facets *facets, uint32_t first,
                 uint32_t count) {
    float normal[FILLED][4];
    uint32_t which[FILLED], from[FILLED], unsure[FILLED];
    uint64_t unused = 0;
    pir_facets middles = *facets;
    middles.normal = normal[0];
    middles.cell = starts->cell + first;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 8; i++)
            middles.turn[k][i] = i == k;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t before = first + i >= starts->side ? first + i - starts->side : 0;
        middle_of(starts, first + i, normal[i]);
        which[i] = i;
        from[i] = starts->cell[before < first ? before : 0];
    }
    kernels->descend(&middles, which, from, count, unsure, &unused);
}

bool pir_starts_init(pir_starts *starts, const pir_kernels *kernels, const pir_facets *facets, uint32_t vertices,
                     const pir_allocator *allocator) {
    *starts = (pir_starts){.side = (uint32_t)sqrt(SQUARES * (double)vertices) + 1};
    pir_layout layout = layout_of(starts);
    if (!pir_layout_new(allocator, &layout))
        return false;
    uint32_t squares = starts->side * starts->side;
    for (uint32_t i = 0; i < squares; i += FILLED)
        fill(starts, kernels, facets, i, squares - i < FILLED ? squares - i : FILLED);
    return true;
}
