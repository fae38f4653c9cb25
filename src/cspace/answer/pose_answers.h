/* SPDX-License-Identifier: MIT */
/* State that classifying keeps between calls: the pieces' balls, the slices asked last. */
#ifndef PIR_CSPACE_ANSWER_POSE_ANSWERS_H
#define PIR_CSPACE_ANSWER_POSE_ANSWERS_H

#include "cspace/answer/pair_proof.h"

typedef struct pir_answers {
    pir_allocator allocator;
    pir_slice_source source;
    pir_piece_ball *robot, *obstacle;
    pir_held held;
} pir_answers;

/* Borrows all of `source`. PIR_ERR_MEMORY; pir_answers_finish frees whatever there is. */
pir_status pir_answers_init(pir_answers *answers, const pir_slice_source *source, const pir_allocator *allocator);
void pir_answers_finish(pir_answers *answers);

/*
 * Proves by the slices whether a pose is free, over all pairs of pieces. The proof also holds for every pose in which
 * each point of the robot is within *ret_gap of its place in this one. Errors: PIR_ERR_NOT_FINITE,
 * PIR_ERR_ZERO_QUATERNION, those of queries, of reading slices.
 */
pir_status pir_answers_classify(pir_answers *answers, const pir_pose *pose, pir_report *report,
                                pir_configuration *ret_configuration, double *ret_gap);

#endif
