/* SPDX-License-Identifier: MIT */
/* The points of a contact: where the part of P that faces a triangle lies over it along a normal. */
#ifndef PIR_MESH_CONTACT_PATCH_POINTS_H
#define PIR_MESH_CONTACT_PATCH_POINTS_H

#include "mesh/contact/contact_job.h"

/* Corners of the part of P that faces against a normal, of which more are left out. */
#define PIR_PATCH_MOST 32
/* Points of a patch over a triangle, at most. */
#define PIR_PATCH_POINTS (PIR_PATCH_MOST + 6)

/* A flat part of a body: a point, a segment, or a convex polygon, seen along a normal. */
typedef struct pir_contact_patch {
    uint32_t count;
    double at[PIR_PATCH_MOST][2]; /* across the normal */
    double height[PIR_PATCH_MOST];
    uint32_t id[PIR_PATCH_MOST];
} pir_contact_patch;

/* Features that meet: a vertex of P twice, both ends of an edge in order, or UINT32_MAX twice for a facet; corners of a
 * triangle as bits. */
typedef struct pir_contact_feature {
    uint32_t p[2], corners;
} pir_contact_feature;

typedef struct pir_patch_point {
    double at[2], height_p, height_q;
    pir_contact_feature feature;
} pir_patch_point;

/* Directions across a unit normal. */
typedef struct pir_patch_frame {
    pir_vec3 n, u, v;
} pir_patch_frame;

pir_patch_frame pir_patch_frame_of(pir_vec3 n);

/* The part of P at a translation that faces against the normal, along which its vertex `lowest` is the first of the
 * lowest, and of a triangle along it. */
void pir_patch_of_body(const pir_contact_job *job, const pir_patch_frame *frame, pir_vec3 t, uint32_t lowest,
                       pir_contact_patch *ret_patch);
void pir_patch_of_triangle(const pir_patch_frame *frame, const pir_near_triangle *s, pir_contact_patch *ret_patch);

/* Corners of what both have in common across the normal. */
uint32_t pir_patch_meet(const pir_contact_patch *p, const pir_contact_patch *q,
                        pir_patch_point ret_points[PIR_PATCH_POINTS]);

#endif
