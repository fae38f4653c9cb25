/* SPDX-License-Identifier: MIT */
/*
 * The facets of D = T ⊕ −P where P meets T: those of T's two sides, of P's facets, and of a side of T with an edge
 * of P. P leaves T by moving along a facet's normal by its depth.
 */
#ifndef PIR_MESH_CONTACT_CONTACT_FACETS_H
#define PIR_MESH_CONTACT_CONTACT_FACETS_H

#include "mesh/contact/contact_exact.h"

typedef enum pir_contact_facet_kind {
    PIR_CONTACT_FRONT = 0, /* `first`: 0 the front, 1 the back */
    PIR_CONTACT_FACET,     /* of P, `first` */
    PIR_CONTACT_ACROSS,    /* the side `first` of T, the edge `second` of P */
} pir_contact_facet_kind;

typedef struct pir_contact_facet {
    pir_contact_facet_kind kind;
    uint32_t first, second;
    pir_vec3 n;        /* unit, along which P leaves */
    double depth, off; /* along n, which may be off so that the depth is by `off` */
} pir_contact_facet;

/* Is told of one facet after another. */
typedef void pir_contact_facet_visitor(void *context, const pir_contact_facet *facet);

void pir_contact_each_facet(pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s,
                            pir_contact_facet_visitor *visit, void *context);

/* Tells of the facets across the triangle's plane alone: of the front, and of the back of a two-sided one. */
void pir_contact_plane_facets(pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s,
                              pir_contact_facet_visitor *visit, void *context);

/*
 * Whether P, moved along a facet's normal by its depth, may touch the triangle there: false where it certainly is
 * beside the facet, so that a shorter way leaves this triangle.
 */
bool pir_contact_may_touch(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s,
                           const pir_contact_facet *facet);

/* Whether interior points meet: P, which meets the triangle, overlaps it. By doubles alone: if it surely does. */
bool pir_contact_overlaps(pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, bool exactly);

#endif
