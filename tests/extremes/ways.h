/* SPDX-License-Identifier: MIT */
/*
 * The ways to answer at a rotation of a situation, each held against the oracle: sums, pairs, scenes, slices. Queries
 * are held against it by the exact checks (query/exact_checks.h). Each function returns NULL, or what does not hold.
 */
#ifndef PIR_TEST_WAYS_H
#define PIR_TEST_WAYS_H

#include <pirouette/scene.h>

#include "extremes/situations.h"
#include "query/exact_checks.h"

/*
 * Brings `sum` to a rotation by update, and holds it against a sum made there by walk and one by CGM: the same pairing;
 * its mesh is proven facet by facet. The greatest error of a coordinate of the mesh as doubles goes to *worst, where it
 * is more, relative to the size of both bodies and to the coordinates.
 */
const char *way_sum(pir_sum *sum, pir_quat rotation, double size, double *worst);

/* Pairs and a scene of two bodies, which live as long as the situation. */
typedef struct way_objects {
    pir_workspace *workspace;
    pir_pair *pair;
    pir_scene *scene;
    uint32_t body_p, body_q;
    int touching; /* at the last update of the scene */
    int refused;  /* the scene takes no coordinates beyond 2^60 */
} way_objects;

const char *way_objects_make(way_objects *o, pir_polytope *p, pir_polytope *q);
void way_objects_free(way_objects *o);

/* A lasting pair and a new one answer as the query did, bit for bit; with both bodies turned half about z, within
   1e-12. The error of that goes to *worst where it is more. */
const char *way_pair(way_objects *o, const exact_pair *bodies, pir_quat rotation, const exact_pose *pose,
                     double *worst);

/* The scene has a contact exactly where the state is not outside, an event to tell of it, and the query's distance. */
const char *way_scene(way_objects *o, pir_quat rotation, const exact_pose *pose);

#endif
