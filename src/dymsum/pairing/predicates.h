/* SPDX-License-Identifier: MIT */
/*
 * The predicate s(n, e) of one feature of P and one of Q at the rotation of a pairing: doubles first, exact integers
 * where those are not certain, the symbolic perturbation where they tie.
 */
#ifndef PIR_DYMSUM_PAIRING_PREDICATES_H
#define PIR_DYMSUM_PAIRING_PREDICATES_H

#include "dymsum/pairing/pairing.h"

/* The sign of a value by doubles where the filter is certain of it, which is counted; else 0. */
static inline int pir_filtered(pir_pairing *pairing, double value) {
    int sign = pir_filter_sign(value);
    pairing->signs.by_filter += sign != 0;
    return sign;
}

/* s of facet f of P, its normal rotated to `rotated`, and halfedge h of Q: the value by doubles, the sign exact. */
static inline int pir_sign_facet_half(pir_pairing *pairing, uint32_t f, pir_vec3 rotated, uint32_t h,
                                      double *ret_value) {
    *ret_value = pir_vec_dot(rotated, pairing->q->direction[h]);
    int sign = pir_filtered(pairing, *ret_value);
    if (sign != 0)
        return sign;
    pir_int3 n = pir_normal_exact(pairing->p, f), d = pir_half_exact(pairing->q, h);
    return pir_sign_perturbed(&pairing->signs, &n, &d);
}

/* s of halfedge h of P and facet g of Q, whose value by doubles is known: exact. */
static inline int pir_sign_half_facet_by(pir_pairing *pairing, uint32_t h, uint32_t g, double value) {
    int sign = pir_filtered(pairing, value);
    if (sign != 0)
        return sign;
    pir_int3 e = pir_half_exact(pairing->p, h), n = pir_normal_exact(pairing->q, g);
    return pir_sign_perturbed(&pairing->signs, &e, &n);
}

/* The sign with its value; the halfedge's direction, rotated, is `rotated`. */
static inline int pir_sign_half_facet(pir_pairing *pairing, uint32_t h, pir_vec3 rotated, uint32_t g,
                                      double *ret_value) {
    *ret_value = pir_vec_dot(rotated, pairing->q->normal[g]);
    return pir_sign_half_facet_by(pairing, h, g, *ret_value);
}

/* The sign with its value; the facet's normal, turned back into P's frame, is `turned_back`. */
static inline int pir_sign_facet_half_back(pir_pairing *pairing, uint32_t g, pir_vec3 turned_back, uint32_t h,
                                           double *ret_value) {
    *ret_value = pir_vec_dot(turned_back, pairing->p->direction[h]);
    return pir_sign_half_facet_by(pairing, h, g, *ret_value);
}

static inline uint64_t pir_signs_asked(const pir_signs *signs) {
    return signs->by_filter + signs->by_exact + signs->by_perturbation;
}

/* A facet or edge of P rotated, a facet normal of Q rotated back into P's frame. */
static inline pir_vec3 pir_rotated_normal(const pir_pairing *pairing, uint32_t f) {
    return pir_mat_apply(&pairing->signs.rotation.r, pairing->p->normal[f]);
}

static inline pir_vec3 pir_rotated_direction(const pir_pairing *pairing, uint32_t h) {
    return pir_mat_apply(&pairing->signs.rotation.r, pairing->p->direction[h]);
}

static inline pir_vec3 pir_turned_back_normal(const pir_pairing *pairing, uint32_t g) {
    return pir_mat_apply_transposed(&pairing->signs.rotation.r, pairing->q->normal[g]);
}

#endif
