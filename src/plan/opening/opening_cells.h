/* SPDX-License-Identifier: MIT */
/*
 * Whether a body can pass a plane with its sections in a disc of a given radius, by division of all planes into cells.
 *
 * Planes that the body has wholly below are the start's region, wholly above the goal's. Cells are leaves of a tree of
 * halvings for each of six charts, and touch where they share a plane, across charts too. Invariants: a leaf may have
 * a block that holds in rationals; else it is labelled. Leaves that may meet a region are known by doubles with a
 * proven bound, so the others do not meet it.
 *
 * From both regions labels spread, cell by cell, first those whose planes all have small circles, blocks excepted.
 * Where labels meet, the cell with the larger circles is to be blocked; one that cannot be is halved, and all is
 * labelled anew. Where no labels meet the body cannot pass. Where they meet, and all circles on the way are small
 * enough, it is likely to pass. Where cells become too many it is not decided.
 */
#ifndef PIR_PLAN_OPENING_OPENING_CELLS_H
#define PIR_PLAN_OPENING_OPENING_CELLS_H

#include "plan/opening/opening_block.h"

#define PIR_OPENING_CHARTS 6
#define PIR_OPENING_NONE   UINT32_MAX
#define PIR_OPENING_LEVELS 24 /* of halvings along one axis */

typedef struct pir_opening_cell {
    uint32_t child;      /* the first of two; none of a leaf */
    uint32_t block;      /* or none */
    uint32_t rival;      /* of a cell that is due: another where labels meet */
    int8_t halved;       /* along which axis; −1 of a leaf */
    int8_t chart, label; /* −1, 0 the start's, 1 the goal's */
    bool meets[2];       /* whether it may meet the start's region, the goal's */
    bool is_due;         /* whether it is to be blocked or halved */
    uint8_t level[3];
    double low[3], high[3]; /* of a, b, s */
    double most;            /* of it, and all others of its planes, about: the order in which labels spread */
    double square;          /* of the radius of the circle at its middle */
} pir_opening_cell;

typedef struct pir_opening_cells {
    const pir_opening_body *body;
    double square; /* of the radius */
    mpq_srcptr exact_square;
    pir_status status;
    pir_opening_cell *cell; /* the roots first */
    uint32_t count, room;
    double level; /* the most of the cells that have spread their labels */
    bool is_passable;
    pir_opening_block *block;
    uint32_t blocks, block_room;
    uint32_t *queue, queued, queue_room; /* a heap */
    uint32_t *due, dues, due_room;
} pir_opening_cells;

typedef enum pir_opening_verdict { PIR_OPENING_UNKNOWN, PIR_OPENING_CLOSED, PIR_OPENING_PASSABLE } pir_opening_verdict;

/* How many cells there may be; told before each round, and ends it with PIR_ERR_LIMIT where it says false. */
typedef struct pir_opening_budget {
    uint32_t cells;
    bool (*goes_on)(void *context);
    void *context;
} pir_opening_budget;

/* Decides, unless that takes too much. `square`, which is borrowed, is a double. */
pir_status pir_opening_cells_decide(const pir_opening_body *body, mpq_srcptr square, const pir_opening_budget *how,
                                    pir_opening_cells *ret_cells, pir_opening_verdict *ret_verdict);
void pir_opening_cells_finish(pir_opening_cells *cells);

void pir_opening_range_of(const pir_opening_cell *cell, pir_opening_range *ret_range);

#endif
