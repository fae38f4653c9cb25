/* SPDX-License-Identifier: MIT */
/* The nearest two triangles, from pose to pose. */
#ifndef PIR_MESH_PAIR_NEAREST_PAIR_H
#define PIR_MESH_PAIR_NEAREST_PAIR_H

#include "mesh/pair/trimesh_pair.h"

/*
 * Makes pair->best the nearest two triangles at the frame's pose; those of lowest numbers unless they meet, which it
 * then only tells. PIR_ERR_MEMORY: the pair begins anew with the next call.
 */
pir_status pir_nearest_pair_update(pir_trimesh_pair *pair);

#endif
