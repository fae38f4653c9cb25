/* SPDX-License-Identifier: MIT */
/* The triangles of a body's surface that a box of the world may meet, asked of the surface's own tree. */
#ifndef PIR_SCENE_WORLD_NEAR_TRIANGLES_H
#define PIR_SCENE_WORLD_NEAR_TRIANGLES_H

#include "mesh/query/mesh_walk.h"
#include "scene/world/scene.h"

/* A box along the axes of a body's frame that holds one of the world's. */
pir_walk_box pir_place_sees(const pir_place *place, const pir_box *box);

/* Lists the triangles whose own boxes meet it in scene->lists.triangle. PIR_ERR_MEMORY, PIR_ERR_LIMIT. */
pir_status pir_scene_list_triangles(pir_scene *scene, const pir_scene_body *body, const pir_place *place,
                                    const pir_box *box, uint32_t *ret_count);

#endif
