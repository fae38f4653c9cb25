/* SPDX-License-Identifier: MIT */
/* State that classifying keeps between calls: the pieces' balls, and pairs of pieces with what they know. */
#ifndef PIR_CSPACE_ANSWER_POSE_ANSWERS_H
#define PIR_CSPACE_ANSWER_POSE_ANSWERS_H

#include <pirouette/cspace.h>

#include "cspace/answer/piece_ball.h"

/* A grid, and the pieces. All of it is borrowed. */
typedef struct pir_answered_bodies {
    const pir_grid *grid;
    pir_polytope *const *robot, *const *obstacle;
    uint32_t robot_count, obstacle_count;
} pir_answered_bodies;

typedef struct pir_answers {
    pir_allocator allocator;
    pir_answered_bodies bodies;
    pir_piece_ball *robot, *obstacle;
    bool is_list; /* the grid */
    pir_workspace *workspace;
    pir_pair_input input;       /* the obstacles at rest; of the robot's pose what was asked last */
    struct pir_kept_pair *pair; /* pose_answers.c */
    uint32_t pair_count;
} pir_answers;

/* Wishes beside the verdict. */
typedef enum pir_answer_wish {
    PIR_WISH_VERDICT, /* and the pair of pieces that it rests on; nothing of the grid is set */
    PIR_WISH_PLACE,   /* all of the configuration */
    PIR_WISH_GAP,     /* that, and the gap */
} pir_answer_wish;

/* PIR_ERR_MEMORY; pir_answers_finish frees whatever there is. */
pir_status pir_answers_init(pir_answers *answers, const pir_answered_bodies *bodies, const pir_allocator *allocator);
void pir_answers_finish(pir_answers *answers);

/*
 * Whether a pose is free, over all pairs of pieces. The verdict also holds for every pose in which each point of the
 * robot is within *ret_gap of its place in this one; without PIR_WISH_GAP that is 0. Errors: PIR_ERR_NOT_FINITE,
 * PIR_ERR_ZERO_QUATERNION, those of pairs.
 */
pir_status pir_answers_classify(pir_answers *answers, const pir_pose *pose, pir_answer_wish wish, pir_report *report,
                                pir_configuration *ret_configuration, double *ret_gap);

#endif
