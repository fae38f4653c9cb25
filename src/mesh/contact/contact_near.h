/* SPDX-License-Identifier: MIT */
/* The nearest points of P and one triangle, and whether the triangle counts where P is. */
#ifndef PIR_MESH_CONTACT_CONTACT_NEAR_H
#define PIR_MESH_CONTACT_CONTACT_NEAR_H

#include "mesh/contact/contact_exact.h"

/* The nearest points by doubles, where these prove that P is apart or meets; else exactly. */
void pir_contact_look_near(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                           pir_contact_near *ret_near);

/* The nearest points, exactly. */
void pir_contact_nearest(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s,
                         pir_contact_near *ret_near);

/* Whether P has a point of the world certainly inside, at a place that is off by at most `error`. */
bool pir_contact_holds_point(pir_contact_job *job, pir_vec3 at, pir_vec3 x, double error);

/* A point that P at t shares with a triangle that it only touches: `near` is of there. */
pir_vec3 pir_contact_touch_point(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s);

/* Doubles' verdict on P at a place that is off by at most `error`. */
typedef enum pir_contact_told {
    PIR_TOLD_NO = 0,
    PIR_TOLD_YES,
    PIR_TOLD_NOTHING,
} pir_contact_told;

/* Whether P meets the triangle; *ret_simplex is where integers are to begin. */
pir_contact_told pir_contact_told_meets(const pir_contact_job *job, pir_vec3 at, const pir_near_triangle *s,
                                        double error, pir_contact_simplex *ret_simplex);

/* Whether a triangle is one-sided and has P, grown by a ball of radius `grow`, wholly behind it or in its plane. What
 * doubles leave open about a ball is PIR_TOLD_NO. */
pir_contact_told pir_contact_told_behind(const pir_contact_job *job, pir_vec3 at, const pir_near_triangle *s,
                                         double error, double grow);

/* Likewise, exactly; of P without a ball. */
bool pir_contact_meets(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s);
bool pir_contact_is_behind(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s);
/* By integers alone. */
bool pir_exact_is_behind(pir_contact_job *job, const pir_contact_place *place, const pir_near_triangle *s);

/*
 * Triangles within reach of P: a contact is on those alone, and a triangle that hides it is met where P touches, which
 * is no farther than the contact. So where P meets nothing, what is certainly farther than the margin is left out.
 */

/* Whether two planes tell that P at t is farther than `far` from a triangle: across the triangle's own normal, and
 * across the way from its rim to the middle of P. */
bool pir_contact_is_beyond(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, double far);

/* Leaves the triangles that are within `far` of P, as far as doubles told where it was looked at; in their order. */
void pir_contact_keep_within(pir_contact_job *job, double far);

#endif
