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

/* Finds near-contacts at t: sets `counts` and `near` of every triangle. Whether P meets any that counts. */
bool pir_contact_look(pir_contact_job *job, pir_vec3 t);

/* The way out for P, which meets triangles where it is; gathers more triangles where it needs them. */
pir_status pir_contact_find_way_out(pir_contact_job *job, pir_way_out *ret_out);

#endif
