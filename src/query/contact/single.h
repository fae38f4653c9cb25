/* SPDX-License-Identifier: MIT */
/*
 * Patches that are one vertex, one edge or one facet: almost all, on bodies without split facets. They are found
 * without growing, and are what pir_patch_grow and pir_patch_extend would find.
 */
#ifndef PIR_QUERY_CONTACT_SINGLE_H
#define PIR_QUERY_CONTACT_SINGLE_H

#include "query/contact/patch.h"

/*
 * How far things may move while what is said of them here still holds: directions of one body as seen by the other by
 * `turn`, an angle or a chord, points by `way`. 0 for this placement alone.
 */
typedef struct pir_leeway {
    double turn, way;
} pir_leeway;

/* Whether the patch of a vertex or an edge is that feature alone, `out` turning by the leeway. */
bool pir_patch_is_sharp(const pir_patch *patch, pir_feature feature, double turn);

/* A facet that is the whole patch. */
struct pir_single {
    uint32_t facet;
    uint32_t half; /* of a vertex: the facet lies between this halfedge from it and the next; else UINT32_MAX */
    double cosine; /* of its normal and `out` */
};

/*
 * Finds the facet that is the whole patch, where the other body's patch has an area: the feature itself, or the facet
 * that a sharp vertex or edge grows by. Hulls and slimming would leave its outline as it is. False where the patch is
 * more than that, where the facet is steep, or where rounding might matter. With a turn above 0: where it is the same
 * facet within that. `out` is then the normal of a facet of one of the two bodies.
 */
bool pir_patch_single(pir_patch *patch, pir_feature feature, double turn, pir_single *ret_single);

/*
 * What a facet's normal may be off by from a direction that is taken for it, and the cosine of that: half its square
 * below 1. All that falls from a single facet's plane does so by far more.
 */
#define PIR_LEVEL        0x1p-20
#define PIR_LEVEL_COSINE (1 - 0x1p-45)

/*
 * The facet that is the whole patch as pir_patch_grow finds it, where that faces `out` by more than PIR_LEVEL_COSINE:
 * the feature itself, or one that a vertex or an edge has. PIR_NO_FACET where there is none.
 */
uint32_t pir_patch_flat(pir_patch *patch, pir_feature feature);

/* Sets that facet, and the outline to the bits of pir_patch_set_outline. `room` is for its corners. */
void pir_patch_set_flat(pir_patch *patch, uint32_t facet, const pir_vec3 axis[2], pir_corner *room);

/* Sets outline and plane of a single facet. axis[2] = axis[0] × axis[1] is the normal from Q to P. */
void pir_patch_set_single(pir_patch *patch, const pir_single *single, const pir_vec3 axis[3]);

/*
 * A version of pir_singles_place, all of which give the same bits: the plain one first; NULL past those that this
 * machine can run.
 */
pir_singles_place *pir_singles_place_version(unsigned index);

/* The last of them. */
pir_singles_place *pir_singles_place_best(void);

/* How far the plane of a single facet is along axis[2] over a point of the contact plane. */
static inline double pir_patch_height(const pir_patch *patch, const pir_corner *at) {
    return patch->height + patch->along_u * at->u + patch->along_v * at->v;
}

/* A vertex on its carrier, in the frame. */
typedef struct pir_lone_place {
    pir_vec3 at;   /* the point of the carrier under the vertex */
    double coarse; /* more than it may be off by */
    double room;
    pir_leeway leeway; /* `room` may grow by the way */
} pir_lone_place;

/*
 * Whether all of a vertex's facet that rises from the vertex by at most `room`, along the carrier's normal, is over the
 * carrier and no corner but the vertex is among it.
 */
bool pir_patch_is_lone(const pir_patch *vertex, const pir_single *of, const pir_patch *carrier, const pir_single *by,
                       const pir_lone_place *place);

#endif
