/* SPDX-License-Identifier: MIT */
/*
 * The pieces of a scene, and the triangles of a surface, whose boxes a moving box may meet: about in the order in which
 * it comes to them, until a time that may fall.
 */
#ifndef PIR_SCENE_QUERY_SWEPT_PIECES_H
#define PIR_SCENE_QUERY_SWEPT_PIECES_H

#include "mesh/query/swept_boxes.h"
#include "scene/query/probe.h"

/* Looks at pieces of the scene, a surface as a whole, that a probe may meet by its rules, until a look fails. */
typedef struct pir_swept_search {
    const pir_probe *probe;
    const pir_swept_box *swept; /* in the world */
    const double *until;        /* below 0: nothing more is looked at */
    pir_status (*look)(void *context, pir_scene_piece *piece);
    void *context;
} pir_swept_search;

pir_status pir_swept_pieces(const pir_swept_search *search);

/* Looks at triangles of the surface of a body, until a look is false; the box is in the frame of the body. */
typedef struct pir_swept_walk {
    pir_swept_box swept;
    const double *until;
    bool (*look)(void *context, const pir_met_triangle *met);
    void *context;
} pir_swept_walk;

void pir_swept_triangles(const pir_scene_body *body, pir_swept_walk *walk);

#endif
