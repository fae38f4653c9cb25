/* SPDX-License-Identifier: MIT */
/* A soup of contact_soups.h with a body: as surfaces for the library, and in integers. */
#ifndef PIR_TEST_CONTACT_STAGE_H
#define PIR_TEST_CONTACT_STAGE_H

#include "mesh/contact_soups.h"
#include "oracle/contacts.h"

/* A soup as surfaces, and in integers. */
typedef struct stage {
    contact_soup soup;
    pir_trimesh *mesh[2];
    pir_posed_surface surface[2];
    uint32_t surfaces;
    pir_polytope *body;
    pir_vec3 vertex[8];
    uint32_t vertices;
    pir_quat rotation;
    oracle_scene *truth;
} stage;

/* Of the kinds that a number tells. */
void stage_make(stage *s, test_random *random, uint64_t number);
void stage_clear(stage *s);

/* A place at which the body's lowest vertex is at, over or under the plane z = 0 or a slope. */
pir_vec3 some_place(test_random *random, const stage *s);

pir_surface_contact_input input_of(const stage *s, pir_vec3 t, double margin);

/* The greatest difference of a coordinate. */
double apart(pir_vec3 a, pir_vec3 b);

#endif
