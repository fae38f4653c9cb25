/* SPDX-License-Identifier: MIT */
/* Proofs by slices about one pair of pieces at a pose. */
#ifndef PIR_CSPACE_ANSWER_PAIR_PROOF_H
#define PIR_CSPACE_ANSWER_PAIR_PROOF_H

#include "cspace/answer/carry.h"
#include "cspace/answer/held.h"

/* A pair of pieces, and the memory of slices. */
typedef struct pir_asked_pair {
    const pir_slice_source *source;
    pir_held *held;
    const pir_piece_ball *p, *q;
    uint32_t robot, obstacle;
    pir_report *report;
} pir_asked_pair;

/* Whether the balls around the pieces prove them apart, without a slice. */
bool pir_balls_apart(const pir_asked_pair *pair, const pir_rotation *pose, pir_vec3 translation, pir_proof *proof);

/* The exact state at the rotation of a slice: free or blocked, one of them. */
pir_status pir_pair_at_slice(const pir_asked_pair *pair, uint64_t slice, pir_vec3 translation, pir_state *ret_state,
                             pir_proof *proof);

/*
 * The proofs of one slice, in this order: by its distance or depth and the bound δ on what moves; by the features
 * there, carried to the pose; by those that the ray from the middle of the difference through the translation meets.
 */
pir_status pir_pair_by_slice(const pir_asked_pair *pair, const pir_rotation *pose, pir_vec3 translation, uint64_t slice,
                             pir_proof *proof);

#endif
