/* SPDX-License-Identifier: MIT */
/*
 * The box of translations divided for what is blocked at all rotations of a box.
 *
 * Inner sums are made and added one by one. While the translations of the two ends are connected there is a way
 * between them, and the next is the inner sum that has the way's deepest point. Then those are added that have most
 * points near these deepest ones, until none is left: boxes that share rotations are to block the same. So a box in
 * which few pieces part the ends has few sums. Where no sum is left that has a point of the way the box is too
 * large, and nothing more is added; where a sum has an end, all are. A thick box has all at once.
 */
#ifndef PIR_PLAN_RIGID_INNER_DIVISION_H
#define PIR_PLAN_RIGID_INNER_DIVISION_H

#include "plan/rigid/box_parts.h"
#include "plan/turn_bodies.h"

/* Makes sums and divides by them; both are to be freed, also where it fails. `body` of a sum is its pair of pieces. */
pir_status pir_inner_division_make(const pir_rigid_question *question, const pir_plan_turns *turns, bool is_thick,
                                   pir_plan_pieces *ret_sums, pir_box_division *ret_division);

#endif
