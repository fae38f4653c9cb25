/* SPDX-License-Identifier: MIT */
/* The surfaces of a stage: meshes of triangles as they are, and heights. */
#ifndef PHYSICS_STAGE_SURFACES_H
#define PHYSICS_STAGE_SURFACES_H

#include "fields.h"
#include "world.h"

/* Whether `fields` describes a surface. */
bool stage_is_surface(const struct fields *fields);

/* Makes the shape of it; files are looked for from `folder` on, which ends in / or is empty. */
bool stage_surface(const struct fields *fields, const char *folder, struct world_shape *ret_shape);

#endif
