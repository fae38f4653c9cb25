/* SPDX-License-Identifier: MIT */
/* All that a scene has to know of a body's surface: its bounds, its content in one number, its triangles. */
#ifndef PIR_SCENE_WORLD_SURFACES_H
#define PIR_SCENE_WORLD_SURFACES_H

#include <pirouette/trimesh.h>

#include "base/vec.h"

/* The eight corners of a box around all, in the frame of the surface; their number. */
uint32_t pir_surface_corners(pir_surface_ref surface, pir_vec3 ret_point[8]);

/* The corners of a triangle; their number. */
uint32_t pir_surface_triangle(pir_surface_ref surface, uint32_t triangle, pir_vec3 ret_point[3]);

/* No point is farther from the origin. */
double pir_surface_farthest(pir_surface_ref surface);

/* A part of the usual size of a triangle. */
double pir_surface_skin(pir_surface_ref surface);

bool pir_surface_is_two_sided(pir_surface_ref surface);

/* A number that two surfaces share where triangles and sides are the same bits, and hardly otherwise. O(triangles). */
uint64_t pir_surface_hash(pir_surface_ref surface);

#endif
