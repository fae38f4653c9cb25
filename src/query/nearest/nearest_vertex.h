/* SPDX-License-Identifier: MIT */
/* The point of D nearest to x by descent in doubles, as a simplex of vertices of D: see nearest_vertex.c. */
#ifndef PIR_QUERY_NEAREST_NEAREST_VERTEX_H
#define PIR_QUERY_NEAREST_NEAREST_VERTEX_H

#include "query/decide/piece.h"

/*
 * The bounds on the distance meet when they are this close, relative to the placement's reach. Rounding leaves 2^-46.
 */
#define PIR_MEET 0x1p-44

/*
 * The bound on the steps of a descent. In practice there are four to ten, each to a new vertex; rounding might lead
 * in a circle.
 */
#define PIR_MOST_STEPS 128

/* Up to three vertices of D whose hull holds the point nearest to x, and the weights of that point. */
typedef struct pir_simplex {
    uint32_t count;
    uint32_t a[4], b[4];
    double weight[4];
    pir_vec3 direction;  /* unit, from D to x */
    double upper, lower; /* bounds on the distance */
    bool certain;        /* the bounds met */
    uint32_t tried;      /* vertices at the end, those past the count being new; four where x may be in their hull */
} pir_simplex;

/*
 * Descends from `simplex`, which has no vertices on a cold start. Ends when the bounds meet, when the lower bound
 * passes `cutoff`, or when a step brings nothing.
 */
void pir_descend_to_point(const pir_frame *frame, const pir_placement *placement, double cutoff, pir_simplex *simplex,
                          uint32_t *steps);

/* Gives a simplex without vertices the vertex farthest towards x. */
void pir_simplex_start(const pir_frame *frame, const pir_placement *placement, pir_simplex *simplex);

/* Sets the count and the vertices of a simplex: three vertices of D at a piece, far apart. */
void pir_facet_simplex(const pir_frame *frame, pir_piece piece, pir_simplex *simplex);

#endif
