/* SPDX-License-Identifier: MIT */
/*
 * Robots, obstacles and grids to classify poses in, without a file. Each pose is also answered by pairs by
 * need with their numbers, and by the difference at its rotation, which no pair has a hand in.
 */
#ifndef PIR_TEST_ANSWER_WORLD_H
#define PIR_TEST_ANSWER_WORLD_H

#include "cspace/answer/pose_motion.h"
#include "support/random.h"

#define WORLD_PIECES 3

typedef struct answer_world {
    pir_polytope *robot[WORLD_PIECES], *obstacle[WORLD_PIECES];
    uint32_t robot_count, obstacle_count;
    pir_grid *grid;
    pir_pair *pair[WORLD_PIECES][WORLD_PIECES];
    pir_workspace *workspace;
    pir_answers answers;
    double size; /* translations beyond it part the bodies */
} answer_world;

/* The worlds: a cube and a cube, two solids, two that are far from their origins, several pieces, flat ones. */
#define WORLD_KINDS 5

/* With a grid of its own, which is destroyed with it. */
void answer_world_init(answer_world *world, int kind, pir_grid *grid);
void answer_world_finish(answer_world *world);

/* Writes the slices of the world to a file, in units of 16. The program ends where that fails. */
void answer_world_write(const answer_world *world, const char *path);

/* A random pose: half of the translations are near the boundary. */
pir_pose answer_world_pose(answer_world *world, test_random *random);

/* The exact state, the most overlapping one over all pairs of pieces. */
pir_state answer_world_state(answer_world *world, const pir_pose *pose);

/* The same by sums made at the pose's rotation. */
pir_state answer_world_sum_state(const answer_world *world, const pir_pose *pose);

#endif
