/* SPDX-License-Identifier: MIT */
/* Solids to test with: unions of unit cubes, and prisms over polygons; and exact volumes of meshes. */
#ifndef PIR_TEST_SOLID_BODIES_H
#define PIR_TEST_SOLID_BODIES_H

#include <stdbool.h>

#include <gmp.h>

#include <pirouette/solid.h>

#include "support/random.h"

#define SOLID_POINTS 4096
#define SOLID_FACETS 2048

/* Facets being put together; points may repeat. */
typedef struct solid_facets {
    pir_vec3 point[SOLID_POINTS];
    uint32_t start[SOLID_FACETS + 1], corner[4 * SOLID_POINTS];
    uint32_t points, facets;
} solid_facets;

/* Adds a facet with these corners. */
void solid_add_facet(solid_facets *facets, const pir_vec3 *corner, uint32_t count);

/* The facets of a prism over a counter-clockwise polygon of the plane, from z = 0 to `height`. */
void solid_add_prism(solid_facets *facets, const double (*corner)[2], uint32_t count, double height);

/* A solid of `facets`, or the status of the refusal. */
pir_status solid_make(const solid_facets *facets, const pir_solid_options *options, pir_report *report,
                      pir_solid **ret_solid);

/* The solid that facets make; the test fails where they make none. */
pir_solid *solid_of_facets(const solid_facets *facets);

/* What pir_solid_describe tells of a solid, which is released. */
pir_solid_info solid_info_of(pir_solid *solid);

/* A cube of this many cells a side, each a unit cube or empty. */
#define CELLS 4
typedef struct cells {
    bool full[CELLS][CELLS][CELLS];
} cells;

/* Whether a cell is full; those outside are not. */
bool cells_full(const cells *of, int x, int y, int z);

/* Whether no cells touch along an edge or at a corner alone. */
bool cells_are_solid(const cells *of);

/* Cells that are connected through their sides, none of which touch along an edge or at a corner alone: a solid. */
cells cells_random(test_random *random, uint32_t count);

/* The faces between full and empty cells. */
void solid_add_cells(solid_facets *facets, const cells *of);

/* A solid of cells that make one; the test fails where they do not. */
pir_solid *solid_of_cells(const cells *of);

/* Reads a mesh, written in exact OFF, as a solid. */
pir_status solid_try_again(const pir_mesh *mesh, pir_report *report, pir_solid **ret_solid);

/* The same; the test fails where it is none. */
pir_solid *solid_read_again(const pir_mesh *mesh);

/* How many cases a test tries: what PIR_TEST_CASES says, or `usual`. */
uint64_t solid_cases(uint64_t usual);

/* Six times the volume within the facets of a mesh with exact coordinates, over 6. */
void mesh_volume(const pir_mesh *mesh, mpq_t ret_volume);

/* The exact volumes of pieces, added up. */
void pieces_volume(const pir_pieces *pieces, mpq_t ret_volume);

/* The volume of a solid is this, and its pieces have it too; the number is that of a case. */
void solid_check_volume(const pir_solid *solid, const mpq_t right, uint64_t number);

#endif
