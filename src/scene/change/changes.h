/* SPDX-License-Identifier: MIT */
/* Bodies that are removed or changed between updates, and the contacts that end thereby. */
#ifndef PIR_SCENE_CHANGE_CHANGES_H
#define PIR_SCENE_CHANGE_CHANGES_H

#include "scene/world/scene.h"

/* The body with an id, by its number; PIR_ERR_ARGUMENT, told in the name of a call. */
pir_status pir_scene_find_body(const pir_scene *scene, const char *call, uint32_t id, uint32_t *ret_body);

/* Drops a pair that is in no contact; a triangle that is in no other goes as well. */
void pir_scene_drop_pair(pir_scene *scene, uint32_t pair);

/* The numbers by which the contacts of a pair are in order. */
pir_scene_key pir_scene_key_of(const pir_scene *scene, uint32_t pair);

/* All that the end of a pair's contact tells. */
pir_scene_gone pir_scene_name_contact(const pir_scene *scene, uint32_t pair);

/* Drops the pairs of a body with those that it does not meet, or all; where they were contacts, these are gone. */
void pir_scene_end_pairs(pir_scene *scene, uint32_t body, bool all);

/* Takes a body out of the scene; its contacts are gone. */
void pir_scene_take_out(pir_scene *scene, uint32_t body);

/*
 * Drops the pairs of a body with those that it does not meet any more; where they were contacts, these are gone. The
 * body is fresh from now on, for which there is room.
 */
void pir_scene_reconsider(pir_scene *scene, uint32_t body);

#endif
