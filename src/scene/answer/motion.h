/* SPDX-License-Identifier: MIT */
/* Bodies to new places, and back to where they were. */
#ifndef PIR_SCENE_ANSWER_MOTION_H
#define PIR_SCENE_ANSWER_MOTION_H

#include "scene/world/scene.h"

/*
 * Checks the poses in scene->lists.moved, and makes the places and the boxes of all pieces, in its order and that of
 * each body's list, in tasks. Makes room for what pir_scene_move_bodies lists. The error of the first body that has
 * one: PIR_ERR_NOT_FINITE, PIR_ERR_ZERO_QUATERNION, PIR_ERR_LIMIT; PIR_ERR_MEMORY.
 *
 * call    begins the text of the report.
 * report  NULL, or filled on failure.
 */
pir_status pir_scene_make_boxes(pir_scene *scene, const char *call, pir_report *report);

/* Brings these bodies to their places. Pieces that got a new box in the tree go to scene->lists.replaced. */
void pir_scene_move_bodies(pir_scene *scene);

/* Back to the poses and boxes from before pir_scene_move_bodies. */
void pir_scene_move_back(pir_scene *scene);

#endif
