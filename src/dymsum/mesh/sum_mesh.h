/* SPDX-License-Identifier: MIT */
/* Shared by the ways to the mesh of a sum. */
#ifndef PIR_DYMSUM_MESH_SUM_MESH_H
#define PIR_DYMSUM_MESH_SUM_MESH_H

#include <pirouette/sum.h>

#include "exact/rotation.h"
#include "polytope/mesh.h"
#include "polytope/polytope.h"

/* Sets each facet's kind from the pairs at its corners: which operand's vertex changes around it. */
void pir_mesh_set_kinds(pir_mesh *mesh);

/* The hull of all pairwise sums of vertices of P, rotated, and Q. */
pir_status pir_hull_mesh(const pir_polytope *p, const pir_polytope *q, pir_rotation *rotation,
                         const pir_allocator *allocator, pir_precision precision, pir_mesh **ret_mesh);

#endif
