/* SPDX-License-Identifier: MIT */
/* Items shared out to tasks: each task takes a run of them at a time from a common counter. */
#ifndef PIR_SCENE_ANSWER_SHARE_H
#define PIR_SCENE_ANSWER_SHARE_H

#include "scene/world/scene.h"

/* The most items that a task takes at a time. */
#define PIR_SHARE_RUN 16

/* The work of the task with that number on the items from `begin` up to `end`. */
typedef void pir_share_items(pir_scene *scene, uint32_t task, uint32_t begin, uint32_t end);

/*
 * Does it with items 0 to count − 1, each once, in one task or, where each gets at least `worth` of them, in up to
 * scene->threads at a time. Which task gets which item is not determined.
 */
void pir_scene_share(pir_scene *scene, uint32_t count, uint32_t worth, pir_share_items *items);

#endif
