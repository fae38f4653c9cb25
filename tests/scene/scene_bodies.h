/* SPDX-License-Identifier: MIT */
/* Cubes in a scene. */
#ifndef PIR_TEST_SCENE_BODIES_H
#define PIR_TEST_SCENE_BODIES_H

#include <pirouette/scene.h>

/* A cube with sides of 2 `half` about the origin. */
pir_polytope *scene_cube(double half);

/* The pose that only moves. */
pir_pose scene_at(double x, double y, double z);

/* Adds a body of one piece, which a scene must take; its number. */
uint32_t scene_add(pir_scene *scene, pir_polytope *piece, pir_pose pose, pir_body_kind kind);

#endif
