/* SPDX-License-Identifier: MIT */
/* All facets of a difference or a sum, exactly, and which of them decide about the origin. */
#ifndef PIR_CERTIFICATE_SUM_FACETS_H
#define PIR_CERTIFICATE_SUM_FACETS_H

#include <pirouette/mesh.h>

#include "certificate/nearest_pairs.h"

/* The mesh of the sum; a flat one has two facets, one without an area none. */
typedef struct pir_boundary {
    const pir_stance *bodies;
    pir_mesh *mesh;
} pir_boundary;

/* PIR_ERR_MEMORY, PIR_ERR_LIMIT. */
pir_status pir_boundary_make(pir_boundary *boundary, const pir_stance *bodies, pir_sum *sum);
void pir_boundary_finish(pir_boundary *boundary);

/* The corner that vertex `vertex` of the mesh is. */
pir_vertex_pair pir_boundary_corner(const pir_boundary *boundary, uint32_t vertex);

/* Lists all vertices that the mesh's corners have. */
void pir_boundary_list(const pir_boundary *boundary, pir_stance *bodies);

/* The outward normal of a facet, divided by what its components have in common. */
void pir_boundary_normal(const pir_boundary *boundary, uint32_t facet, pir_triple *normal);

/*
 * The first facet of least slack, that is how far the origin is within its plane: the root of slack² / |normal|². It
 * is 0 where the origin is on the plane. The mesh has facets, and the origin is not outside.
 */
uint32_t pir_boundary_least(const pir_boundary *boundary, mpz_t ret_slack, pir_triple *ret_normal);

/*
 * Corners that do not lie in one plane, with positive weights and the origin for their point. The origin is inside, so
 * the mesh has four such corners: from their middle the line through the origin leaves by a facet.
 */
void pir_boundary_around(const pir_boundary *boundary, pir_mix *mix);

#endif
