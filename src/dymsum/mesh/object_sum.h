/* SPDX-License-Identifier: MIT */
/* The check that ends the object-space method. */
#ifndef PIR_DYMSUM_MESH_OBJECT_SUM_H
#define PIR_DYMSUM_MESH_OBJECT_SUM_H

#include "polytope/mesh.h"

/* Euler's condition: whether vertices and facets are two more than edges, each of which has two facets. */
bool pir_mesh_is_whole(const pir_mesh *mesh);

#endif
