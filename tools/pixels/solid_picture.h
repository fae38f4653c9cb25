/* SPDX-License-Identifier: MIT */
/* Solids, or their pieces, as a viewer sees them: what is nearer hides what is behind. */
#ifndef TOOLS_PIXELS_SOLID_PICTURE_H
#define TOOLS_PIXELS_SOLID_PICTURE_H

#include <stdint.h>

#include <pirouette/mesh.h>

#include "file.h"

/*
 * Draws meshes, seen from azimuth and elevation 35° and 25°, to the open file as a PNG, and commits it. One has the
 * colour of solids, of several each its own. False after a complaint.
 */
bool solid_picture_write(struct output_file *file, pir_mesh *const *meshes, uint32_t count);

#endif
