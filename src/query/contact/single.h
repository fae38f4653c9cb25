/* SPDX-License-Identifier: MIT */
/*
 * Patches that are one vertex, one edge or one facet: almost all, on bodies without split facets. They are found
 * without growing, and are what pir_patch_grow and pir_patch_extend would find.
 */
#ifndef PIR_QUERY_CONTACT_SINGLE_H
#define PIR_QUERY_CONTACT_SINGLE_H

#include "query/contact/patch.h"

/* A facet that is the whole patch. */
typedef struct pir_single {
    uint32_t facet;
    uint32_t half; /* of a vertex: the facet lies between this halfedge from it and the next; else UINT32_MAX */
    double cosine; /* of its normal and `out` */
} pir_single;

/* The halfedge before which the facet lies that faces a direction most; UINT32_MAX for none. */
typedef struct pir_foremost {
    uint32_t half;
    double cosine; /* of the facet's normal */
} pir_foremost;

/* The loops around vertices and facets. All versions give the same bits. */
struct pir_single_version {
    /* Whether all edges that leave a vertex or an edge of the body fall or rise along m by more than a sine. */
    bool (*is_sharp)(const pir_polytope *p, pir_feature feature, pir_vec3 m, double sine);
    /* At such a vertex, of facets at a cosine above PIR_LEAST_COSINE; `out` is unit. Else none. */
    pir_foremost (*foremost)(const pir_polytope *p, uint32_t v, pir_vec3 out, double sine);
    /*
     * Sets outlines and planes of the single facets of both patches, and places their corners as pir_clip_place does,
     * which says what it returns.
     */
    bool (*place)(pir_patch *p, const pir_single *of_p, pir_patch *q, const pir_single *of_q, const pir_vec3 axis[3],
                  pir_clip_places *ret_places);
};

/* A facet at a smaller cosine with the contact normal is not taken: heights on its plane would lose digits. */
#define PIR_LEAST_COSINE 0x1p-4

extern const pir_single_version pir_single_plain, pir_single_avx2;

/* Whether the patch of a vertex or an edge is that feature alone. */
bool pir_patch_is_sharp(const pir_patch *patch, pir_feature feature);

/*
 * Finds the facet that is the whole patch, where the other body's patch has an area: the feature itself, or the facet
 * that a sharp vertex or edge grows by. Hulls and slimming would leave its outline as it is. False where the patch is
 * more than that, where the facet is steep, or where rounding might matter.
 */
bool pir_patch_single(pir_patch *patch, pir_feature feature, pir_single *ret_single);

/*
 * The most that a facet's normal may differ from a direction that is taken for it, and the cosine of that: half its
 * square below 1. All that falls from a single facet's plane does so by far more.
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

/* How far the plane of a single facet is along axis[2] over a point of the contact plane. */
static inline double pir_patch_height(const pir_patch *patch, const pir_corner *at) {
    return patch->height + patch->along_u * at->u + patch->along_v * at->v;
}

/* A vertex on its carrier, in the frame. */
typedef struct pir_lone_place {
    pir_vec3 at;   /* the point of the carrier under the vertex */
    double coarse; /* more than it may be off by */
    double height; /* of what counts over the carrier, at most */
} pir_lone_place;

/*
 * Whether all of a vertex's facet that rises from the vertex by at most `height`, along the carrier's normal, is over
 * the carrier and no corner but the vertex is among it.
 */
bool pir_patch_is_lone(const pir_patch *vertex, const pir_single *of, const pir_patch *carrier, const pir_single *by,
                       const pir_lone_place *place);

#endif
