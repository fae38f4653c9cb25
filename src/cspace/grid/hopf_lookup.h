/* SPDX-License-Identifier: MIT */
/* Tables that tell the nearest rotation of the Hopf grid without a search, where no other is about as near. */
#ifndef PIR_CSPACE_GRID_HOPF_LOOKUP_H
#define PIR_CSPACE_GRID_HOPF_LOOKUP_H

#include "cspace/grid/angle.h"
#include "cspace/grid/hopf.h"

/* Grids beyond have no tables, which would take 8 MB and more, and pixels more than 16 bits. */
#define PIR_LOOKUP_LEVEL_MAX 5

/* A circle of rotations: cos θ/2, and sin θ/2·e^{iφ}. */
typedef struct pir_looked_circle {
    double upper;
    pir_circle_point lower;
} pir_looked_circle;

/* The most circles of a cell, of which none needs more than six: a cell is sixteen bytes, and fetched once. */
#define PIR_LOOKED_MOST 7

/* The places of a cell's circles; none where there are too many. */
typedef struct pir_looked_cell {
    uint16_t count, place[PIR_LOOKED_MOST];
} pir_looked_cell;

typedef struct pir_hopf_lookup {
    uint32_t side;             /* cells along an octant's edge; 0: there are no tables */
    uint32_t buckets;          /* of directions in the upper half-plane */
    pir_circle_point step;     /* of the ψ/2 between two rotations of a circle */
    double half_step;          /* the tangent of half of that */
    pir_looked_circle *circle; /* by place: face·4^level + i·2^level + j of the pixel */
    uint32_t *rank;            /* of the pixel on the path, by place */
    pir_circle_point *turn;    /* of ψ/2, by number on the circle, and past the last once more */
    uint16_t *bucket;          /* the number nearest to where a bucket begins */
    pir_looked_cell *cell;     /* of the two octants with x, y ≥ 0, side² of each, that of the north first */
} pir_hopf_lookup;

/* Makes the tables of a grid; false when out of memory. */
bool pir_hopf_lookup_init(pir_hopf_lookup *lookup, const pir_hopf *hopf, const pir_allocator *allocator);
void pir_hopf_lookup_finish(pir_hopf_lookup *lookup, const pir_hopf *hopf, const pir_allocator *allocator);

/*
 * The nearest rotation to a unit quaternion, off by 8u at most: its number in the order of visiting, and itself as a
 * unit quaternion, off by 8u. False where there are no tables or another one is nearly as near.
 */
bool pir_hopf_look_up(const pir_hopf_lookup *lookup, const pir_hopf *hopf, pir_quat unit, uint64_t *ret_number,
                      pir_quat *ret_nearest);

#endif
