/* SPDX-License-Identifier: MIT */
/*
 * A probe: a shape in a place, or a piece of a body, that is held against pieces of a scene, one after the other, by a
 * pir_pair of the scene's that is none of its pairs.
 */
#ifndef PIR_SCENE_QUERY_PROBE_H
#define PIR_SCENE_QUERY_PROBE_H

#include <pirouette/scene_query.h>

#include "scene/world/scene.h"

typedef struct pir_probe {
    pir_scene *scene;
    pir_extent extent;
    pir_pose pose;
    double radius;
    uint32_t body;                  /* of the scene, whose rules hold then; or PIR_SCENE_NONE */
    uint32_t mask, except;          /* the latter a number, or PIR_SCENE_NONE */
    uint64_t piece_user;            /* of the piece */
    const pir_query_filter *filter; /* the caller's, or NULL */
    pir_box box;
} pir_probe;

/* Checks a shape. Errors as of a query of a scene. */
pir_status pir_probe_of_shape(pir_scene *scene, const pir_scene_shape *shape, pir_probe *ret_probe);

/* A piece of a body; of a triangle one that has its polytope. */
pir_probe pir_probe_of_piece(pir_scene *scene, const pir_scene_piece *piece);

/* Gives an impact the id of the body that is met and its user, in place of its number. */
void pir_name_impact(const pir_scene *scene, pir_impact *impact);

/* Whether the probe may meet a body of the scene. */
bool pir_probe_meets(const pir_probe *probe, uint32_t body);

/* The box, wider by a distance on each side. */
pir_box pir_probe_wider(const pir_probe *probe, double distance);

/* The pair of the probe's polytope and a piece, at their poses. A triangle gets its polytope. Errors as
   pir_pair_create. */
pir_status pir_probe_pair(const pir_probe *probe, pir_scene_piece *piece, pir_pair **ret_pair,
                          pir_pair_input *ret_input);

#endif
