/* SPDX-License-Identifier: MIT */
/*
 * A box divided by planes of sums until every part is free or blocked.
 *
 * With closed sums a part counts where it has an inside, and it is blocked where one sum contains it, free where its
 * inside meets none. With open sums a part is a closed set of any dimension, free where it meets no open sum. It is
 * blocked where one sum contains it and has points of it inside; faces of it that lie on the sum's planes may be free
 * again, so they are parts of their own, the children of the blocked one. So, with open sums, the union of free parts
 * is all that the sums leave of the box: each part is split into two closed halves, and what a blocked one has outside
 * of the open sum is on its planes. Each split is by a plane of a sum whose inside meets the part, which has points on
 * both sides: so it ends.
 *
 * Parts are nodes of a tree; children of a node have greater numbers. Cells of free parts are kept.
 */
#ifndef PIR_PLAN_DIVIDE_H
#define PIR_PLAN_DIVIDE_H

#include "plan/plan_cell.h"
#include "plan/plan_sums.h"

enum pir_plan_part { PIR_PLAN_OPEN, PIR_PLAN_SPLIT, PIR_PLAN_FREE, PIR_PLAN_BLOCKED };

typedef struct pir_plan_node {
    enum pir_plan_part part;
    uint32_t by;       /* a half-space that splits; the number of the free cell; the sum that blocks */
    uint32_t child[2]; /* within, beyond; of a blocked one the first of its faces, or none, and how many */
    uint32_t face;     /* which of the sum's half-spaces a face is on */
} pir_plan_node;

typedef struct pir_plan_tree {
    pir_plan_node *node;
    pir_plan_cell *cell; /* free ones */
    uint32_t node_count, node_room, cell_count, cell_room;
    double low[3], high[3]; /* the box that is divided, exactly */
    bool open;              /* whether sums are */
} pir_plan_tree;

/* Divides the box of a tree. Failures are in the space's status; PIR_PLAN_ERR_PARTS where more than `most` nodes would
 * be needed. */
void pir_plan_divide(pir_plan_cutter *cutter, const pir_plan_sums *sums, uint32_t most, pir_plan_tree *tree);

/* Divides free parts by sums from one on, which are new. */
void pir_plan_divide_more(pir_plan_cutter *cutter, const pir_plan_sums *sums, uint32_t first, uint32_t most,
                          pir_plan_tree *tree);

void pir_plan_tree_finish(pir_plan_space *space, pir_plan_tree *tree);

#endif
