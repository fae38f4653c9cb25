/* SPDX-License-Identifier: MIT */
/* Where points are in meshes of solids, and how much these hold, by rationals and every facet. */
#ifndef PIR_FUZZ_SOLID_ORACLE_H
#define PIR_FUZZ_SOLID_ORACLE_H

#include <gmp.h>

#include <pirouette/mesh.h>
#include <pirouette/pair.h>

/* The volume within the facets. */
void oracle_volume(const pir_mesh *mesh, mpq_t ret_volume);

/* The state of a point in the open sum that the mesh is of: on a facet, on a segment or at a point of it, which are its
 * boundary; else inside or outside. */
pir_state oracle_state(const pir_mesh *mesh, pir_vec3 point);

#endif
