/* SPDX-License-Identifier: MIT */
/*
 * Triangles of surfaces as pieces of a scene, by need: a triangle is a piece while it is in a pair. It gets a polytope,
 * flat, with three vertices, when a pair with it has to be asked. A table finds the piece of a triangle.
 */
#ifndef PIR_SCENE_WORLD_TRIANGLES_H
#define PIR_SCENE_WORLD_TRIANGLES_H

#include "scene/world/bodies.h"

/* The piece of a triangle, or PIR_PIECE_NONE. */
uint32_t pir_triangles_find(const pir_bodies *bodies, uint32_t body, uint32_t triangle);

/* A triangle as a piece without a box, in no table. */
pir_scene_piece pir_triangle_piece(const pir_bodies *bodies, uint32_t body, uint32_t triangle);

/* Puts one in that is not there; PIR_ERR_MEMORY, PIR_ERR_LIMIT. */
pir_status pir_triangles_add(pir_bodies *bodies, const pir_allocator *allocator, const pir_scene_piece *piece,
                             uint32_t *ret_piece);

/* Takes out one that is in no pair. */
void pir_triangles_remove(pir_bodies *bodies, uint32_t piece);

/* How many polytopes of triangles queries leave for the next ones. */
#define PIR_TRIANGLES_KEPT 256

/* The polytope that a query left of a triangle, a reference, or NULL. */
pir_polytope *pir_triangles_recall(const pir_bodies *bodies, uint32_t body, uint32_t triangle);

/* Takes over what a triangle's piece has for a polytope, in place of another; without memory it is released. */
void pir_triangles_keep(pir_bodies *bodies, const pir_allocator *allocator, const pir_scene_piece *piece);

/* Releases what was left of the triangles of a body. */
void pir_triangles_forget(pir_bodies *bodies, uint32_t body);

/* Makes the polytope of a triangle's piece, where there is none; no other piece lacks it. PIR_ERR_MEMORY. */
pir_status pir_piece_ready(const pir_scene_body *body, const pir_allocator *allocator, pir_scene_piece *piece);

#endif
