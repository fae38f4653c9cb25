/* SPDX-License-Identifier: MIT */
/*
 * The box of translations divided for what is blocked at all rotations of a box.
 *
 * Inner sums are made and added one by one. While the translations of the two ends are connected there is a way
 * between them, and the next is the inner sum that has the way's deepest point. Then those are added that have most
 * points near these deepest ones, until none is left: boxes that share rotations are to block the same. So a box in
 * which few pieces part the ends has few sums. Where no sum is left that has a point of the way the box is too
 * large, and nothing more is added; where a sum has an end, all are.
 *
 * Boxes that share rotations may still leave ways through each other. Then one is asked to block translations that both
 * leave. Pairs that block most of them are added, and sums that lack one that their pair blocks get it as a corner, for
 * a sum has but few corners of all that a pair blocks. Sums never get smaller by it. All that is listed then divides
 * the box at once.
 */
#ifndef PIR_PLAN_RIGID_INNER_DIVISION_H
#define PIR_PLAN_RIGID_INNER_DIVISION_H

#include "plan/rigid/box_parts.h"
#include "plan/turn_bodies.h"

/* A point that makes the sum of a pair wider. */
typedef struct pir_inner_point {
    pir_vec3 at;
    uint32_t pair;
} pir_inner_point;

/* The sums of a box: pairs of pieces, in order, and points that make sums wider. Arrays are from malloc. */
typedef struct pir_inner_list {
    uint32_t *pair, pairs;
    pir_inner_point *point;
    uint32_t points;
    uint32_t rounds; /* how often it was added to, after pairs were chosen */
} pir_inner_list;

/*
 * Makes sums and divides by them: of a list of no rounds those that are chosen, which it gets; else those of the list,
 * and what is added to it for translations that none of them blocks. Sums and division are to be freed, also where it
 * fails. `body` of a sum is its pair of pieces.
 */
pir_status pir_inner_division_make(const pir_rigid_question *question, const pir_plan_turns *turns,
                                   const double (*x)[3], uint32_t count, pir_inner_list *list,
                                   pir_plan_pieces *ret_sums, pir_box_division *ret_division);

/* Sums and division of a list that was made, again: they are the same. */
pir_status pir_inner_division_again(const pir_rigid_question *question, const pir_plan_turns *turns,
                                    const pir_inner_list *list, pir_plan_pieces *ret_sums,
                                    pir_box_division *ret_division);

/* A copy of a list; false when out of memory. */
bool pir_inner_list_copy(const pir_inner_list *list, pir_inner_list *ret_list);
void pir_inner_list_finish(pir_inner_list *list);

/* The bytes that a list takes. */
size_t pir_inner_list_size(const pir_inner_list *list);

/* Appends a list as bytes; false when out of memory. */
bool pir_inner_list_pack(const pir_inner_list *list, pir_bytes *bytes);

/* Makes a list of bytes, of which it takes the first; false where they are none, or when out of memory. */
bool pir_inner_list_unpack(pir_bytes *bytes, uint32_t pairs, pir_inner_list *ret_list);

#endif
