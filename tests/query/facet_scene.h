/* SPDX-License-Identifier: MIT */
/* A difference of two random bodies in its frame, pieces that may be facets of it, and places about those. */
#ifndef PIR_TEST_FACET_SCENE_H
#define PIR_TEST_FACET_SCENE_H

#include "query/decide/piece.h"
#include "support/random.h"

typedef struct facet_scene {
    pir_polytope *p, *q, *reflected;
    pir_frame frame;
} facet_scene;

void facet_scene_make(test_random *random, facet_scene *scene);
void facet_scene_free(facet_scene *scene);

/* A piece that may be a facet of D, a point in it and its normal. */
pir_piece facet_scene_piece(test_random *random, const pir_frame *frame, pir_vec3 *ret_in, pir_vec3 *ret_normal);

/* A place of x over the point along the normal, or beside that. */
pir_placement facet_scene_place(test_random *random, const pir_frame *frame, pir_vec3 in, pir_vec3 normal);

#endif
