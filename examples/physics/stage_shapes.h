/* SPDX-License-Identifier: MIT */
/* The shapes of a stage. */
#ifndef PHYSICS_STAGE_SHAPES_H
#define PHYSICS_STAGE_SHAPES_H

#include "fields.h"
#include "world.h"

/* Makes the shape that `fields` describes; files are looked for from `folder` on, which ends in / or is empty. */
bool stage_shape(const struct fields *fields, const char *folder, struct world_shape *ret_shape);

#endif
