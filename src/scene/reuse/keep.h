/* SPDX-License-Identifier: MIT */
/* The records of pairs brought up to date with an update. */
#ifndef PIR_SCENE_REUSE_KEEP_H
#define PIR_SCENE_REUSE_KEEP_H

#include "scene/world/scene.h"

/* Makes room in records for all that workers found. PIR_ERR_MEMORY: nothing has changed. */
pir_status pir_reserve_records(pir_scene *scene);

/* Writes it there, once the update cannot fail any more. */
void pir_keep_found(pir_scene *scene);

#endif
