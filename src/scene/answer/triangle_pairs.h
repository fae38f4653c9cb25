/* SPDX-License-Identifier: MIT */
/* Pairs of pieces with each other, and with the triangles of a surface that their boxes meet. */
#ifndef PIR_SCENE_ANSWER_TRIANGLE_PAIRS_H
#define PIR_SCENE_ANSWER_TRIANGLE_PAIRS_H

#include "scene/world/scene.h"

/* Begins a visit, and marks a piece's partners with it. */
void pir_scene_mark_partners(pir_scene *scene, uint32_t piece);

/* A pair of two pieces, P being of the body with the lower number. False when out of memory. */
bool pir_scene_add_pair(pir_scene *scene, uint32_t a, uint32_t b);

/* Makes the pairs that a piece whose partners are marked lacks with the triangles of a surface. PIR_ERR_MEMORY,
   PIR_ERR_LIMIT. */
pir_status pir_scene_find_triangles(pir_scene *scene, uint32_t piece, uint32_t surface);

/* The box that a triangle's tight box may be in before pairs of its surface are looked for again. */
pir_box pir_scene_wide_triangle(const pir_scene *scene, const pir_scene_piece *triangle);

#endif
