/* SPDX-License-Identifier: MIT */
/* Bodies to new places, and back to where they were. */
#ifndef PIR_SCENE_ANSWER_MOTION_H
#define PIR_SCENE_ANSWER_MOTION_H

#include "scene/world/scene.h"

/*
 * Makes the boxes of all pieces at the places in scene->lists.moved, in its order and that of each body's list, and
 * room for what pir_scene_move_bodies lists. PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
pir_status pir_scene_make_boxes(pir_scene *scene);

/* Brings these bodies to their places. Pieces that got a new box in the tree go to scene->lists.replaced. */
void pir_scene_move_bodies(pir_scene *scene);

/* Back to the poses and boxes from before pir_scene_move_bodies. */
void pir_scene_move_back(pir_scene *scene);

#endif
