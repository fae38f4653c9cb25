/* SPDX-License-Identifier: MIT */
/*
 * Exact numbers of P and triangles at their poses. A point is integers over a positive weight: P's vertices over |q|²
 * and the denominator of the polytope's scale, corners over |q|² of their surface. Vectors below are right in
 * direction; their positive factors do not matter.
 *
 * All lie on the job's stack. Whoever calls notes job->limbs.used before and sets it back.
 */
#ifndef PIR_MESH_CONTACT_CONTACT_EXACT_H
#define PIR_MESH_CONTACT_CONTACT_EXACT_H

#include "mesh/contact/contact_job.h"

/* A further translation, exactly: over / under, under > 0. */
typedef struct pir_exact_move {
    pir_int3 over;
    pir_int under;
} pir_exact_move;

/* Where P is: at t, and from there moved on; `at` is where that is in doubles. */
typedef struct pir_contact_place {
    pir_vec3 t, at;
    const pir_exact_move *move; /* NULL: not moved on */
} pir_contact_place;

static inline pir_contact_place pir_place_at(pir_vec3 t) {
    return (pir_contact_place){t, t, NULL};
}

/* Room for the exact numbers of what was gathered. PIR_ERR_MEMORY. */
pir_status pir_contact_exact_reserve(pir_contact_job *job);

/* The double next to x of which the exact numbers know: a multiple of their unit. */
double pir_contact_on_grid(const pir_contact_job *job, double x);

/*
 * The simplex of P's difference with a triangle that holds the point nearest to 0 in its relative interior; true where
 * that is 0, so that they meet. Begins with *simplex, which may be empty.
 */
bool pir_exact_nearest(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                       pir_contact_simplex *simplex);

/* The direction from the triangle to P at such a simplex, where they do not meet, and the move that brings the nearest
 * points together. */
pir_int3 pir_exact_direction(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                             const pir_contact_simplex *simplex, pir_exact_move *ret_move);

/* The weights of the nearest point of such a simplex, on one scale, all above 0. */
void pir_exact_weights(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                       const pir_contact_simplex *simplex, pir_int ret_weight[3]);

/* The direction and the way of a simplex, from exact numbers: within 2^-48 of themselves. */
void pir_exact_way(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                   const pir_contact_simplex *simplex, pir_vec3 *ret_unit, pir_vec3 *ret_way);

/* Directions: of the front, of a facet of P, across the side k of the triangle and an edge of P. */
pir_int3 pir_exact_front(pir_contact_job *job, const pir_near_triangle *s);
pir_int3 pir_exact_facet(pir_contact_job *job, uint32_t facet);
pir_int3 pir_exact_across(pir_contact_job *job, const pir_near_triangle *s, uint32_t k, uint32_t edge);

/* The sign of the least n · d over the difference: not negative where n separates P from the triangle. */
int pir_exact_least(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                    const pir_int3 *n);

/* The sign of n · (corner b of t − corner a of s). */
int pir_exact_rise(pir_contact_job *job, const pir_int3 *n, const pir_near_triangle *s, uint32_t a,
                   const pir_near_triangle *t, uint32_t b);

#endif
