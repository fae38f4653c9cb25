/* SPDX-License-Identifier: MIT */
/*
 * The pieces of a scene, and the triangles of its surfaces, that are near something. A triangle is a piece only while
 * it is looked at, unless a pair has it anyway.
 */
#ifndef PIR_SCENE_QUERY_NEAR_PIECES_H
#define PIR_SCENE_QUERY_NEAR_PIECES_H

#include "scene/query/probe.h"

/* How near a triangle is: a number that grows with how late it has to be looked at. */
typedef enum pir_nearness {
    PIR_NEAR_BOX,      /* 0 where its box meets `box` */
    PIR_NEAR_DISTANCE, /* of its box from `from` */
    PIR_NEAR_TIME,     /* when `from` meets its box on `way` */
} pir_nearness;

typedef struct pir_near_search {
    const pir_probe *probe; /* whose rules hold */
    pir_box box;            /* all that is looked at meets it */
    pir_nearness by;
    pir_box from;
    pir_vec3 way;
    const double *most; /* triangles that are not as near as this are left out; it may become less */
    /* Looks at a piece, whose polytope pir_probe_pair makes where it is a triangle. */
    pir_status (*look)(void *context, pir_scene_piece *piece);
    void *context;
} pir_near_search;

/* Looks at pieces and triangles, these the nearest first, until a look fails. */
pir_status pir_near_pieces(const pir_near_search *near);

/* Looks at triangles of one surface. */
pir_status pir_near_triangles(const pir_near_search *near, const pir_scene_body *body);

#endif
