/* SPDX-License-Identifier: MIT */
/* The boundary of a convex piece as a surface of triangles, so that pieces side by side are asked as one union. */
#ifndef PIR_SCENE_WORLD_PIECE_FACETS_H
#define PIR_SCENE_WORLD_PIECE_FACETS_H

#include "scene/world/bodies.h"

/* Makes the facets of a convex piece of dimension 3, where it has none yet. PIR_ERR_MEMORY. */
pir_status pir_piece_facets(pir_scene_piece *piece, const pir_allocator *allocator);

#endif
