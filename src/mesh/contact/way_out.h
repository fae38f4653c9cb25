/* SPDX-License-Identifier: MIT */
/* A place near P's where P meets no triangle. */
#ifndef PIR_MESH_CONTACT_WAY_OUT_H
#define PIR_MESH_CONTACT_WAY_OUT_H

#include "mesh/contact/contact_near.h"

typedef struct pir_way_out {
    pir_vec3 t;   /* the place */
    pir_vec3 way; /* there from the input's */
    double depth; /* its length; of one through one facet without the step off the triangle */
    bool is_out, is_shortest;
} pir_way_out;

/*
 * Finds near-contacts at t: sets `counts`, `near` and `passed` of every triangle. Whether P without its radius meets
 * any that counts, or has passed any.
 */
bool pir_contact_look(pir_contact_job *job, pir_vec3 t);
/* Likewise where the input has P; what is certainly beyond the margin does not count, at a distance of HUGE_VAL. */
bool pir_contact_look_first(pir_contact_job *job);
/*
 * Likewise at a place as far from one where a triangle was within the radius: that one is within the radius and the
 * way, so the nearest one counts, with all that share its nearest point.
 */
bool pir_contact_look_from(pir_contact_job *job, pir_vec3 t, double way);

/* The place that the input's translation plus a vector of doubles gives, as it rounds: about `by` from there. */
pir_vec3 pir_contact_place_by(const pir_contact_job *job, pir_vec3 by);

/* How far P is taken off a triangle. */
double pir_contact_step(const pir_contact_job *job);
/* Where another triangle is near: a part of it. */
#define PIR_CONTACT_PART_STEP 0x1p-16

/* The nearest triangle that counts and is not met, at the place t that was looked at; NULL for none. */
const pir_near_triangle *pir_contact_nearest_of(const pir_contact_job *job);
/* Makes sure that the nearest points at t, which was looked at, of all that count and are not met are proven: doubles
 * that prove nothing may be far off in distance, and by a root in direction. */
void pir_contact_prove_all(pir_contact_job *job, pir_vec3 t);

/*
 * Ends a way, whose end was looked at, a step off the triangles grown by `radius`: P goes back towards the nearest one.
 * All others are as far, so it meets none on that way either, unless there are one-sided ones that it is behind where
 * it is, and not there: then it stays. It stays as well where that would make its way longer. The end is looked at.
 */
void pir_contact_pull_back(pir_contact_job *job, double radius, pir_way_out *out);

/*
 * The way out for P, which meets triangles where it is and was looked at there. Gathers more triangles where it needs
 * them. The end of a way that is found is looked at.
 */
pir_status pir_contact_find_way_out(pir_contact_job *job, pir_way_out *ret_out);

#endif
