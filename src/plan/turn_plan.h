/* SPDX-License-Identifier: MIT */
/*
 * Whether a body can be moved between two poses by translations and turns about one axis, between closed bodies.
 *
 * The full turn is divided into equal arcs, 8 of them, then twice as many, until the question is decided. In each arc
 * the box of translations is divided for inner pieces (turn_bodies.h): what they block is blocked at every angle. Free
 * cells of successive arcs are joined where they share a point. Where the ends are not connected, there is no path.
 * Likewise for outer pieces: what they leave is free at every angle, cells of successive arcs are joined at a point
 * that is free in both, and a path is a list of points, each with the arc in which the motion from the one before
 * stays; the turn itself is at the point. Between arcs there are single angles, at which translations are exact but
 * for the growth of outer pieces. Points are rounded, and then each motion is held against the outer sums.
 *
 * The proof is JSON: the question, sine and cosine of half the angles where arcs begin and end, and for each arc its
 * inner pieces and the tree of its division, as docs/plan.md has it; or a path. check/turns.py checks them.
 *
 * So PATH and NO_PATH are both proven, and cannot both be. UNKNOWN is said where arcs, parts or memory end first.
 */
#ifndef PIR_PLAN_TURN_PLAN_H
#define PIR_PLAN_TURN_PLAN_H

#include <stdio.h>

#include <pirouette/plan.h>

#include "plan/divide.h"

typedef struct pir_turn_question {
    const pir_plan_pieces *robot, *obstacles;
    double axis[3];            /* unit */
    double low[3], high[3];    /* bounds of translations */
    double from[3], to[3];     /* translations */
    double from_turn, to_turn; /* parts of a full turn, from 0 to below 1 */
    uint32_t most_arcs;        /* a power of two, at least 8 */
    uint32_t most_parts;       /* of the boxes of one division */
    size_t memory;
    FILE *proof; /* NULL, or for the path, or the proof that there is none */
} pir_turn_question;

typedef struct pir_turn_step {
    double at[3];
    double low, high; /* angles, in radians: the motion to here is free at each, and so is staying */
} pir_turn_step;

typedef struct pir_turn_result {
    pir_turn_plan_answer answer;
    pir_plan_end end;
    uint32_t arcs;       /* that it was decided with, or the last ones */
    uint32_t parts;      /* of all boxes, in the last division */
    pir_turn_step *step; /* of a path; from malloc */
    uint32_t steps;
} pir_turn_result;

/* Decides; ret_result->step is to be freed. */
pir_status pir_plan_turn(const pir_turn_question *question, pir_turn_result *ret_result);

#endif
