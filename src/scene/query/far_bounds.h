/* SPDX-License-Identifier: MIT */
/*
 * Bounds on how far apart two bodies are, without a pair: by the boxes around them, by balls, and by the supports of
 * their coarse bodies. Each kind only ever narrows what is known.
 */
#ifndef PIR_SCENE_QUERY_FAR_BOUNDS_H
#define PIR_SCENE_QUERY_FAR_BOUNDS_H

#include "scene/query/probe.h"

/* The distance is between these; `slack` is what a distance in doubles may be off. */
typedef struct pir_far_bounds {
    double least, most, slack;
} pir_far_bounds;

/* A body in a place, with its coarse bodies; none may be missing. */
typedef struct pir_placed {
    const pir_coarse *coarse;
    pir_mat3 r;
    pir_vec3 t, centre; /* of the balls, in the world */
    double radius;      /* the rounding radius */
} pir_placed;

/* `unit` is the pose's rotation, of length 1. */
pir_placed pir_placed_of(const pir_coarse *coarse, pir_quat unit, pir_vec3 translation, double radius);

/* From nothing: each body is in its box, and has a point in it. */
pir_far_bounds pir_far_bounds_of_boxes(const pir_box *p, const pir_box *q, double slack);

void pir_far_bounds_by_balls(pir_far_bounds *bounds, const pir_placed *p, const pir_placed *q);

/* Supports along a few directions, of the coarsest bodies that are within `error` of theirs, until the bounds are so
   near to each other. */
void pir_far_bounds_by_supports(pir_far_bounds *bounds, const pir_placed *p, const pir_placed *q, double error);

#endif
