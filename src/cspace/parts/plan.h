/* SPDX-License-Identifier: MIT */
/*
 * All that decides what a file of slices holds: the pieces, the grid, how slices are dealt into units, what is kept of
 * each. Its hash tells two jobs apart.
 *
 * Units are numbered pair by pair: unit u of the pair of robot piece k and obstacle piece l is
 * (k·obstacle_count + l)·units_per_pair + u.
 */
#ifndef PIR_CSPACE_PARTS_PLAN_H
#define PIR_CSPACE_PARTS_PLAN_H

#include <pirouette/cspace.h>

#include "cspace/record/record_bytes.h"

/* Of the file and of parts. */
#define PIR_SLICES_VERSION 3u

/* A piece, as it was given. */
typedef struct pir_plan_piece {
    pir_polytope *polytope; /* held */
    pir_bytes off;          /* exact OFF */
    uint64_t hash;          /* of `off` */
} pir_plan_piece;

typedef struct pir_plan {
    pir_allocator allocator;
    const pir_grid *grid;  /* borrowed */
    pir_plan_piece *piece; /* the robot's, then the obstacles' */
    uint32_t robot_count, obstacle_count;
    uint64_t slices; /* of a pair */
    uint32_t slices_per_unit, slices_per_key;
    bool planes, vertices;
    uint64_t pairs, units_per_pair, units;
    uint64_t hash;
} pir_plan;

/* pir_plan_finish releases whatever is there. Errors as of pir_cspace_job_create, without files. */
pir_status pir_plan_init(pir_plan *plan, const pir_cspace_bodies *bodies, const pir_grid *grid,
                         const pir_cspace_options *options, pir_report *report);
void pir_plan_finish(pir_plan *plan);

/* The pieces of a pair. */
static inline pir_polytope *pir_plan_robot(const pir_plan *plan, uint64_t pair) {
    return plan->piece[pair / plan->obstacle_count].polytope;
}

static inline pir_polytope *pir_plan_obstacle(const pir_plan *plan, uint64_t pair) {
    return plan->piece[plan->robot_count + pair % plan->obstacle_count].polytope;
}

/* The first slice of a unit, and how many it has. */
static inline uint64_t pir_plan_first(const pir_plan *plan, uint64_t unit) {
    return unit % plan->units_per_pair * plan->slices_per_unit;
}

static inline uint32_t pir_plan_count(const pir_plan *plan, uint64_t unit) {
    uint64_t left = plan->slices - pir_plan_first(plan, unit);
    return left < plan->slices_per_unit ? (uint32_t)left : plan->slices_per_unit;
}

#endif
