/* SPDX-License-Identifier: MIT */
/*
 * A stage that is played: its world, the characters that walk in it, its rollbacks. Frames are of 1/STAGE_RATE s. The
 * same stage gives the same bits, frame by frame.
 */
#ifndef PHYSICS_PLAY_H
#define PHYSICS_PLAY_H

#include "stage.h"

struct play;

/* The stage outlives it. `watch`, where it is not NULL, is called after each step of the world. */
pir_status play_begin(const struct stage *stage, void (*watch)(void *context, struct world *world), void *context,
                      struct play **ret_play);

/* NULL is accepted. */
void play_end(struct play *play);

struct world *play_world(struct play *play);

/* Goes on for a frame, and where the stage says so back to an earlier one; fails as world_step does. */
pir_status play_frame(struct play *play);

/* How many steps a frame has. */
uint32_t play_steps(const struct play *play);

#endif
