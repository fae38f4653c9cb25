/* SPDX-License-Identifier: MIT */
/* The events of an update, in order. */
#ifndef PIR_SCENE_ANSWER_EVENTS_H
#define PIR_SCENE_ANSWER_EVENTS_H

#include "scene/world/scene.h"

/*
 * Makes the events from what the workers found and from the pairs that are ended, and marks each pair that was looked
 * at with whether it is in contact. PIR_ERR_MEMORY; then no pair has changed.
 */
pir_status pir_scene_make_events(pir_scene *scene);

/* Sorts by keys; `work` has room for as many. */
void pir_scene_sort_items(pir_scene_item *item, pir_scene_item *work, uint32_t count);

#endif
