/* SPDX-License-Identifier: MIT */
/*
 * Exact points. Source s has its vertices on the scale n_s/d_s and turns by M_s/N_s; with D the product of all N_s d_s
 *
 *     point = (1/D) · sum of (n_s D / (N_s d_s)) · M_s v_s.
 *
 * Without a rotation M_s is the identity and N_s is 1, and both are left out.
 */
#include "cgm/place.h"

/* product *= factor; `work` has room for the product. */
static void multiply(pir_int *product, const pir_int *factor, pir_int *work) {
    pir_int_mul(work, product, factor);
    pir_int_copy(product, work);
}

/* Multiplies by all N_t d_t but those of source `but`. */
static void multiply_denominators(const pir_cgm *cgm, uint32_t but, pir_int *product, pir_int *work) {
    for (uint32_t t = 0; t < cgm->source_count; t++) {
        if (t == but)
            continue;
        multiply(product, &cgm->source[t].polytope->scale.den, work);
        if (cgm->source[t].rotation)
            multiply(product, &cgm->source[t].rotation->integers->norm, work);
    }
}

bool pir_cgm_places_init(struct pir_cgm_places *places, const pir_cgm *cgm) {
    uint32_t k = cgm->source_count, den = 1, factor = 0, longest = 0;
    for (uint32_t s = 0; s < k; s++) {
        const struct pir_cgm_source *source = &cgm->source[s];
        uint32_t n = pir_int_length(&source->polytope->scale.num), v = source->polytope->exact_vertex.stride;
        den += pir_int_length(&source->polytope->scale.den) +
               (source->rotation ? pir_int_length(&source->rotation->integers->norm) : 0);
        factor = n > factor ? n : factor;
        v += source->rotation ? PIR_MATRIX_LIMBS + 1 : 0;
        longest = v > longest ? v : longest;
    }
    /*
     * A factor is a numerator times what is left of the denominator. A sum of k products, none longer than a factor and
     * a turned vertex together, takes one limb more. The scratch holds a turned vertex and one product, each component
     * no longer than `stride`; or, while factors are made, one product no longer than a factor.
     */
    factor += den;
    *places = (struct pir_cgm_places){.cgm = cgm, .stride = factor + longest + 1};
    places->limb_count = den + k * factor + 4 * places->stride + factor;
    places->limbs = PIR_NEW(&cgm->allocator, mp_limb_t, (size_t)places->limb_count + 1);
    places->factor = PIR_NEW(&cgm->allocator, pir_int, k);
    if (!places->limbs || !places->factor) {
        pir_cgm_places_finish(places);
        return false;
    }
    // a number one, the denominator, the factors; the rest is scratch
    pir_limbs room = {places->limbs, 0, places->limb_count + 1};
    pir_int one = pir_limbs_take(&room, 1);
    one.limb[0] = 1;
    one.size = 1;
    places->scale.num = one;
    places->scale.den = pir_limbs_take(&room, den);
    for (uint32_t s = 0; s < k; s++)
        places->factor[s] = pir_limbs_take(&room, factor);
    places->scratch = (pir_limbs){room.base + room.used, 0, room.capacity - room.used};
    pir_int work = {places->scratch.base, 0, places->scratch.capacity};
    pir_int_copy(&places->scale.den, &one);
    multiply_denominators(cgm, PIR_CGM_NONE, &places->scale.den, &work);
    for (uint32_t s = 0; s < k; s++) {
        pir_int_copy(&places->factor[s], &cgm->source[s].polytope->scale.num);
        multiply_denominators(cgm, s, &places->factor[s], &work);
    }
    return true;
}

void pir_cgm_places_finish(struct pir_cgm_places *places) {
    const pir_allocator *a = &places->cgm->allocator;
    PIR_FREE(a, places->limbs, (size_t)places->limb_count + 1);
    PIR_FREE(a, places->factor, places->cgm->source_count);
}

void pir_cgm_place_exact(struct pir_cgm_places *places, uint32_t face, pir_int3 *to) {
    const pir_cgm *cgm = places->cgm;
    pir_limbs *scratch = &places->scratch;
    for (int i = 0; i < 3; i++)
        to->c[i].size = 0;
    for (uint32_t s = 0; s < cgm->source_count; s++) {
        const struct pir_cgm_source *source = &cgm->source[s];
        pir_int3 v = pir_vertex_exact(source->polytope, pir_cgm_source_vertex(cgm, face, s));
        uint32_t mark = scratch->used;
        if (source->rotation) {
            pir_int3 turned = pir_int3_take(scratch, pir_int3_length(&v) + PIR_MATRIX_LIMBS + 1);
            pir_rotation_apply(source->rotation, &turned, &v, scratch);
            v = turned;
        }
        for (int i = 0; i < 3; i++)
            pir_int_add_mul(&to->c[i], &v.c[i], &places->factor[s], scratch);
        scratch->used = mark;
    }
}
