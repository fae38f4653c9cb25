/* SPDX-License-Identifier: MIT */
/*
 * A run of a world as poses of convex bodies, 60 frames a second, for programs that replay it without a solver. Little
 * endian, packed:
 *
 *     "SCENE01\0"; u32 shapes, bodies, statics, frames; f32 dt
 *     per shape:           u32 vertices, triangles; f32 vertex[vertices][3]; u32 triangle[triangles][3]
 *     per static box:      f32 half[3], position[3], quaternion[4]
 *     u32 shape[bodies]
 *     per frame and body:  f32 position[3], quaternion[4] (x, y, z, w)
 *
 * A body's origin is its centre of mass. A static body that is no box is one that never moves. Functions that return
 * false have complained; whether what was written arrived is the caller's to see.
 */
#ifndef TOOLS_SIMULATE_RECORDING_H
#define TOOLS_SIMULATE_RECORDING_H

#include <stdbool.h>
#include <stdio.h>

#include <stage.h>

/* Whether all bodies are convex, as those of a recording are; surfaces are not. */
bool recording_check(const struct stage *stage);

/* All but the frames, of which so many will follow. */
bool recording_begin(FILE *file, const struct stage *stage, uint32_t frames);

/* Where the bodies are. */
void recording_add(FILE *file, const struct stage *stage, const struct world *world);

#endif
