/* SPDX-License-Identifier: MIT */
/*
 * Closed convex polytopes of dimension 0 to 3, by their vertices and by half-spaces.
 *
 * Invariants: a cell is the intersection of its half-spaces, and the hull of its points, which are its vertices, each
 * once. `tight` has a row of bits a vertex: on which planes of half-spaces it lies. So two vertices are the ends of an
 * edge where no third one lies on all planes that both lie on. An empty cell has no points and nothing else.
 */
#ifndef PIR_PLAN_PLAN_CELL_H
#define PIR_PLAN_PLAN_CELL_H

#include "plan/plan_space.h"

typedef struct pir_plan_cell {
    uint32_t *point, *half;
    uint64_t *tight; /* points · words */
    uint32_t points, halves, words;
    int dimension; /* −1 where it is empty */
    double low[3], high[3];
} pir_plan_cell;

/* Scratch of cuts: the sides of a cell's points, and those of children. */
typedef struct pir_plan_cutter {
    pir_plan_space *space;
    int8_t *side;
    uint32_t *from, *kept; /* of a child: old points, then new ones; which half-spaces stay */
    uint64_t *row;         /* tight bits of new points */
    uint32_t side_room, from_room, kept_room, row_room;
    uint32_t *fresh; /* new points, by the ends of the edges that they are on */
    uint32_t fresh_room, fresh_count;
} pir_plan_cutter;

void pir_plan_cutter_finish(pir_plan_cutter *cutter);

/* A box. */
void pir_plan_cell_box(pir_plan_cutter *cutter, const double low[3], const double high[3], pir_plan_cell *ret_cell);

void pir_plan_cell_free(pir_plan_space *space, pir_plan_cell *cell);

/* The sides of all points of a cell in cutter->side: least and greatest of them. */
void pir_plan_cell_sides(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t half, int *ret_least,
                         int *ret_most);

/* Cuts a cell by a plane that has points of it on both sides, strictly: what is within the half-space, and the rest. */
void pir_plan_cell_split(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t half, pir_plan_cell *ret_within,
                         pir_plan_cell *ret_beyond);

/* A cell's part within a half-space, which is the cell anew where nothing is cut off. */
void pir_plan_cell_clip(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t half, pir_plan_cell *ret_cell);

/* A cell's face on a plane that has no point of it beyond. */
void pir_plan_cell_face(pir_plan_cutter *cutter, const pir_plan_cell *cell, uint32_t half, pir_plan_cell *ret_face);

/* The points that two cells have in common. */
void pir_plan_cell_common(pir_plan_cutter *cutter, const pir_plan_cell *a, const pir_plan_cell *b,
                          pir_plan_cell *ret_cell);

/* Whether a point lies in a cell. */
bool pir_plan_cell_has(pir_plan_space *space, const pir_plan_cell *cell, uint32_t point);

/* Whether boxes meet; as doubles have them, widened. */
static inline bool pir_plan_boxes_meet(const double low_a[3], const double high_a[3], const double low_b[3],
                                       const double high_b[3]) {
    for (int k = 0; k < 3; k++)
        if (low_a[k] > high_b[k] || low_b[k] > high_a[k])
            return false;
    return true;
}

/* Widens a box to hold a point. */
void pir_plan_box_add(const pir_plan_space *space, uint32_t point, double low[3], double high[3]);

#endif
