/* SPDX-License-Identifier: MIT */
/* The first hit of a body of a scene that moves. */
#ifndef PIR_SCENE_QUERY_SCENE_CAST_H
#define PIR_SCENE_QUERY_SCENE_CAST_H

#include "scene/query/probe.h"

/*
 * Of a body, by its number, on a motion that has been checked; from another pose than its own where `from` is not NULL,
 * which a body with a surface must not have. The impact has an id. Errors as of pir_scene_cast, told.
 */
pir_status pir_scene_fly_body(pir_scene *scene, uint32_t body, const pir_pose *from, const pir_motion *motion,
                              double tolerance, pir_impact *ret_impact);

#endif
