/* SPDX-License-Identifier: MIT */
/* The first meetings of fast bodies on their way in an update. */
#ifndef PIR_SCENE_UPDATE_FAST_BODIES_H
#define PIR_SCENE_UPDATE_FAST_BODIES_H

#include "scene/world/scene.h"

/* Lists them in scene->impact, once all bodies stand where the update brings them. Errors: told. */
pir_status pir_scene_find_impacts(pir_scene *scene);

#endif
