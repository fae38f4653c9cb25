/* SPDX-License-Identifier: MIT */
/* The point of D nearest to x by descent in doubles, as a simplex of vertices of D: see nearest_vertex.c. */
#ifndef PIR_QUERY_FRAME_NEAREST_VERTEX_H
#define PIR_QUERY_FRAME_NEAREST_VERTEX_H

#include "query/frame/frame.h"

/* The bounds meet when they are this close, relative to the placement's reach; 2^-46 is what rounding leaves. */
#define PIR_MEET 0x1p-44

/*
 * A descent finds a new vertex in every step, four to ten in all. This bound ends a descent that rounding leads in a
 * circle.
 */
#define PIR_MOST_STEPS 128

/* Up to three vertices of D whose hull holds the point nearest to x, and its weights. */
typedef struct pir_simplex {
    uint32_t count;
    uint32_t a[4], b[4];
    double weight[4];
    pir_vec3 direction;  /* unit, from D to x */
    double upper, lower; /* bounds on the distance */
    bool certain;        /* the bounds met */
} pir_simplex;

/* Descends from `simplex` (count 0: cold) until the bounds meet, the lower passes `cutoff`, or no step helps. */
void pir_descend_to_point(const pir_frame *frame, const pir_placement *placement, double cutoff, pir_simplex *simplex,
                          uint32_t *steps);

/* Gives a simplex without vertices the vertex farthest towards x. */
void pir_simplex_start(const pir_frame *frame, const pir_placement *placement, pir_simplex *simplex);

#endif
