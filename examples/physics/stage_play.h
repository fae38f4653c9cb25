/* SPDX-License-Identifier: MIT */
/*
 * Parts of a scene that change a run from outside of the world: bodies that walk, and rollbacks. See stage.h.
 */
#ifndef PHYSICS_STAGE_PLAY_H
#define PHYSICS_STAGE_PLAY_H

#include "fields.h"
#include "stage.h"

/* Reads how a body of the stage walks, if it does; the body has its shape and its kind. */
bool stage_play_walk(const struct fields *body, struct stage *stage, uint32_t number);

/* Reads the rollbacks of the scene, if there are any; the stage has its bodies. */
bool stage_play_backs(const struct fields *all, struct stage *stage);

#endif
