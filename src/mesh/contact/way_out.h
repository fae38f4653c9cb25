/* SPDX-License-Identifier: MIT */
/* A place near P's where P meets no triangle. */
#ifndef PIR_MESH_CONTACT_WAY_OUT_H
#define PIR_MESH_CONTACT_WAY_OUT_H

#include "mesh/contact/contact_near.h"

typedef struct pir_way_out {
    pir_vec3 t;   /* the place */
    pir_vec3 way; /* there from the input's */
    double depth; /* its length; of the shortest without the step off the triangle */
    bool is_out, is_shortest;
} pir_way_out;

/*
 * Finds near-contacts at t: sets `counts`, `near` and `passed` of every triangle. Whether P without its radius meets
 * any that counts, or has passed any.
 */
bool pir_contact_look(pir_contact_job *job, pir_vec3 t);

/* The place that the input's translation plus a vector of doubles gives, as it rounds: about `by` from there. */
pir_vec3 pir_contact_place_by(const pir_contact_job *job, pir_vec3 by);

/* How far P is taken off a triangle. */
double pir_contact_step(const pir_contact_job *job);
/* Where another triangle is near: a part of it. */
#define PIR_CONTACT_PART_STEP 0x1p-16

/* The way out for P, which meets triangles where it is; gathers more triangles where it needs them. */
pir_status pir_contact_find_way_out(pir_contact_job *job, pir_way_out *ret_out);

#endif
