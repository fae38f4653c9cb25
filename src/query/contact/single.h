/* SPDX-License-Identifier: MIT */
/*
 * Patches that are one vertex, one edge or one facet: almost all, on bodies without split facets. They are found
 * without growing, and are what pir_patch_grow and pir_patch_extend would find.
 */
#ifndef PIR_QUERY_CONTACT_SINGLE_H
#define PIR_QUERY_CONTACT_SINGLE_H

#include "query/contact/patch.h"

/* Whether the patch of a vertex or an edge is that feature alone. */
bool pir_patch_is_sharp(const pir_patch *patch, pir_feature feature);

/* A facet that is the whole patch. */
typedef struct pir_single {
    uint32_t facet;
    uint32_t half; /* of a vertex: the facet lies between this halfedge from it and the next; else UINT32_MAX */
    double cosine; /* of its normal and `out` */
} pir_single;

/*
 * Finds the facet that is the whole patch, where the other body's patch has an area: the feature itself, or the facet
 * that a sharp vertex or edge grows by. Hulls and slimming would leave its outline as it is. False where the patch is
 * more than that, where the facet is steep, or where rounding might matter.
 */
bool pir_patch_single(pir_patch *patch, pir_feature feature, pir_single *ret_single);

/* Sets outline and plane of a single facet. axis[2] = axis[0] × axis[1] is the normal from Q to P. */
void pir_patch_set_single(pir_patch *patch, const pir_single *single, const pir_vec3 axis[3]);

/* How far the plane of a single facet is along axis[2] over a point of the contact plane. */
static inline double pir_patch_height(const pir_patch *patch, const pir_corner *at) {
    return patch->height + patch->along_u * at->u + patch->along_v * at->v;
}

/*
 * Whether all of a vertex's facet that rises from the vertex by at most `room`, along the carrier's normal, is over the
 * carrier and no corner but the vertex is among it. `at` is the point of the carrier under the vertex; `coarse` is more
 * than it may be off by. All are in the frame.
 */
bool pir_patch_is_lone(const pir_patch *vertex, const pir_single *of, const pir_patch *carrier, const pir_single *by,
                       pir_vec3 at, double room, double coarse);

#endif
