/* SPDX-License-Identifier: MIT */
/*
 * Symmetries of a plan that change signs of coordinates alone.
 *
 * Let D and E be diagonal matrices of signs with det D = det E, obstacles and bounds be the same under D, and the robot
 * under E. D·(R·x + t) = (D·R·E)·(E·x) + D·t, so at (D·R·E, D·t) the robot is the image under D of what it is
 * at (R, t): one is blocked exactly where the other is. D·R·E is a rotation, of the quaternion d·q·e, where ±D and
 * ±E are the turns of d and e: nothing or half a turn about an axis. So components of q are exchanged, and change
 * signs, which maps boxes of rotations to boxes exactly.
 *
 * Invariants: symmetries are a group, each its own inverse, with numbers such that the product of i and k is i ^ k; 0
 * changes nothing. No other one maps a box of level 1 or more to itself: d·q·e has its component of 1 where q has it
 * only if d = ±e; then signs of two components change, unless D = E = ±1. So D = E = −1 is left out.
 *
 * One thing alone is concluded: where all rotations of a box block translations, those of its image block theirs under
 * D. All boxes of an orbit are in the graph of a plan, each with nodes of its own. So a way to an image of the end is
 * no way to the end, and that there is none to the end says nothing of images.
 */
#ifndef PIR_PLAN_ROTATIONS_SYMMETRIES_H
#define PIR_PLAN_ROTATIONS_SYMMETRIES_H

#include "plan/plan_sums.h"
#include "plan/rotations/rotation_box.h"

#define PIR_MOST_SYMMETRIES 16

/* Signs as bits of x, y, z that are set where they are negative: those of D, and eight times those of E. */
typedef struct pir_symmetries {
    uint8_t signs[PIR_MOST_SYMMETRIES];
    uint32_t count; /* a power of two */
} pir_symmetries;

/*
 * The symmetries of pieces, as sets of corners, and of bounds. Exact: what differs by a rounding is none. Where out of
 * memory there is but one.
 */
pir_symmetries pir_symmetries_of(const pir_plan_pieces *robot, const pir_plan_pieces *obstacles, const double low[3],
                                 const double high[3]);

/* The image of a box. */
pir_rotation_box pir_symmetries_image(const pir_symmetries *symmetries, uint32_t number, pir_rotation_box box);

/* The image of a translation under D, which is its own inverse. */
static inline void pir_symmetries_place(const pir_symmetries *symmetries, uint32_t number, const double x[3],
                                        double ret[3]) {
    for (int k = 0; k < 3; k++)
        ret[k] = symmetries->signs[number] >> k & 1 ? -x[k] : x[k];
}

#endif
