/* SPDX-License-Identifier: MIT */
/*
 * Numbers of contacts: hashes of what meets there. A contact is a feature of P over a feature of a triangle along a
 * normal, and each of the three is named so that the name stays while P moves a little:
 *
 * - a feature of P by its vertex, the two of its edge, or as a facet;
 * - a triangle by its number, but its edges and corners by the numbers of corners, which triangles that meet there
 *   share;
 * - the normal of a plane of a triangle by its direction in the frame of the surface, that of a facet of P by its
 *   number, and one of an edge or a vertex of P on one of a triangle by the vertices and by the numbers of the corners.
 */
#ifndef PIR_MESH_CONTACT_CONTACT_ID_H
#define PIR_MESH_CONTACT_CONTACT_ID_H

#include "mesh/contact/patch_points.h"
#include "mesh/contact/standing.h"

/* The features of a pair of nearest points. */
pir_contact_feature pir_contact_feature_of(const pir_contact_simplex *simplex);

/* A normal by the thing that it belongs to. */
typedef struct pir_normal_name {
    bool of_plane;
    uint64_t name; /* unless it is of a plane */
} pir_normal_name;

/* `body`: P's patch along the normal. */
pir_normal_name pir_contact_normal_name(const pir_contact_job *job, const pir_standing *standing,
                                        const pir_contact_patch *body);

/* The number of a contact on a triangle along a normal. */
uint64_t pir_contact_id(const pir_contact_job *job, const pir_near_triangle *s, const pir_contact_feature *feature,
                        pir_vec3 normal, pir_normal_name of);

#endif
