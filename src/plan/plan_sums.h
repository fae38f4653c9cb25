/* SPDX-License-Identifier: MIT */
/*
 * Where the robot cannot be: the sums S = Q ⊕ (−R·P) of each convex piece P of the robot and Q of the obstacles.
 *
 * Invariants: half-spaces of a sum are those of its facets, one each; each piece has an inside, so each sum has one.
 */
#ifndef PIR_PLAN_PLAN_SUMS_H
#define PIR_PLAN_PLAN_SUMS_H

#include <pirouette/mesh.h>
#include <pirouette/polytope.h>
#include <pirouette/solid.h>

#include "plan/plan_space.h"

/* Convex pieces of bodies. */
typedef struct pir_plan_pieces {
    pir_polytope **at;
    uint32_t *body; /* of which body each is */
    uint32_t count, room, body_room;
} pir_plan_pieces;

typedef struct pir_plan_sum {
    uint32_t half, halves;    /* the first, in the list of all; how many */
    uint32_t corner, corners; /* likewise */
    uint32_t robot, obstacle; /* pieces */
    double low[3], high[3];
} pir_plan_sum;

typedef struct pir_plan_sums {
    pir_plan_sum *sum;
    uint32_t *half, *corner;
    uint32_t count, room, half_count, half_room, corner_count, corner_room;
} pir_plan_sums;

/* Adds the pieces of all solids of a side, called `what`, as those of bodies; PIR_ERR_EMPTY where there is none. */
pir_status pir_plan_pieces_add(pir_plan_space *space, const pir_solid *const *solid, size_t count, const char *what,
                               pir_report *report, pir_plan_pieces *pieces);
void pir_plan_pieces_finish(pir_plan_space *space, pir_plan_pieces *pieces);

/* Makes the sums of all pairs of pieces. */
pir_status pir_plan_sums_make(pir_plan_space *space, const pir_plan_pieces *robot, const pir_plan_pieces *obstacles,
                              pir_quat rotation, pir_plan_sums *sums);
/* Adds a polytope as that of two pieces. */
pir_status pir_plan_sums_add(pir_plan_space *space, const pir_polytope *made, uint32_t robot, uint32_t obstacle,
                             pir_plan_sums *sums);
/* Adds what an exact mesh of a convex sum bounds, likewise. */
pir_status pir_plan_sums_add_mesh(pir_plan_space *space, const pir_mesh *mesh, uint32_t robot, uint32_t obstacle,
                                  pir_plan_sums *sums);
void pir_plan_sums_finish(pir_plan_space *space, pir_plan_sums *sums);

/* The first sum that has a point, in its inside where sums are open; none. */
uint32_t pir_plan_sums_at(pir_plan_space *space, const pir_plan_sums *sums, uint32_t point, bool open);

/* The first sum that a segment meets, likewise. */
uint32_t pir_plan_sums_along(pir_plan_space *space, const pir_plan_sums *sums, uint32_t from, uint32_t to, bool open);

#endif
