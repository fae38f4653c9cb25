/* SPDX-License-Identifier: MIT */
/*
 * Points of the polytope or sum that a map stands for: the vertices that a face carries, rotated and added up; as
 * doubles and exactly.
 */
#ifndef PIR_CGM_PLACE_H
#define PIR_CGM_PLACE_H

#include "cgm/cgm.h"

/* Exact points on one scale: point = sum of factor[s] · M_s · v_s, times scale. */
struct pir_cgm_places {
    const pir_cgm *cgm;
    pir_int *factor; /* per source */
    pir_scale scale;
    uint32_t stride; /* limbs of a component */
    pir_limbs scratch;
    mp_limb_t *limbs;
    uint32_t limb_count;
};

/* False when out of memory. */
bool pir_cgm_places_init(struct pir_cgm_places *places, const pir_cgm *cgm);
void pir_cgm_places_finish(struct pir_cgm_places *places);

/* The point of a face, not an outer one, into `to`, whose components have room for `stride` limbs. */
void pir_cgm_place_exact(struct pir_cgm_places *places, uint32_t face, pir_int3 *to);

/* A face's vertex of the sum by doubles, sources added in order. */
static inline pir_vec3 pir_cgm_place_near(const pir_cgm *cgm, uint32_t face) {
    pir_vec3 sum = {0, 0, 0};
    for (uint32_t s = 0; s < cgm->source_count; s++) {
        const struct pir_cgm_source *source = &cgm->source[s];
        pir_vec3 v = source->polytope->vertex[pir_cgm_source_vertex(cgm, face, s)];
        v = source->rotation ? pir_mat_apply(&source->rotation->r, v) : v;
        sum = s == 0 ? v : pir_vec_add(sum, v);
    }
    return sum;
}

#endif
