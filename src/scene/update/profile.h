/* SPDX-License-Identifier: MIT */
/* How long the parts of an update take, by the caller's clock, and what they did. */
#ifndef PIR_SCENE_UPDATE_PROFILE_H
#define PIR_SCENE_UPDATE_PROFILE_H

#include "scene/world/scene.h"

void pir_profile_begin(pir_scene *scene);

/* Fills in all that is counted, once the update has succeeded. */
void pir_profile_end(pir_scene *scene);

/* Ends a part, which began where the last one ended. */
static inline void pir_profile_part(pir_scene *scene, uint64_t *ret_time) {
    if (!scene->clock)
        return;
    const uint64_t now = scene->clock(scene->clock_context);
    *ret_time = now - scene->part_began;
    scene->part_began = now;
}

#endif
