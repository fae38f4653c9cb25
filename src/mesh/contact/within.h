/* SPDX-License-Identifier: MIT */
/*
 * Triangles within reach of P: a contact is on those alone, and a triangle that hides it is met where P touches, which
 * is no farther than the contact. So where P meets nothing, what is certainly farther than the margin is left out.
 */
#ifndef PIR_MESH_CONTACT_WITHIN_H
#define PIR_MESH_CONTACT_WITHIN_H

#include "mesh/contact/contact_job.h"

/* Whether two planes tell that P at t is farther than `far` from a triangle: across the triangle's own normal, and
 * across the way from its rim to the middle of P. */
bool pir_contact_is_beyond(const pir_contact_job *job, pir_vec3 t, const pir_near_triangle *s, double far);

/* Leaves the triangles that are within `far` of P, as far as doubles told where it was looked at; in their order. */
void pir_contact_keep_within(pir_contact_job *job, double far);

#endif
