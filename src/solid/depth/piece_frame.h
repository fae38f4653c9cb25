/* SPDX-License-Identifier: MIT */
/*
 * Two bodies in pieces in one frame: Q's, where the sum of A' = −R·P and B = Q is what P may not be moved by.
 *
 * Doubles are in units of the frame: 2^exponent of a length, so chosen that the sum of both bodies reaches no farther
 * than 1/8 from the origin. Vertices are within 2^-49 of the exact ones, normals and directions of edges, unit
 * vectors, within 2^-47, heights of planes within 2^-49. Exact numbers are made from the polytopes when they are asked
 * for, in lengths.
 *
 * Invariant: of an edge, left × right of the normals of its facets is a positive multiple of `along`; so in A' too.
 */
#ifndef PIR_SOLID_DEPTH_PIECE_FRAME_H
#define PIR_SOLID_DEPTH_PIECE_FRAME_H

#include <gmp.h>

#include <pirouette/pair.h>

#include "exact/rotation.h"
#include "solid/depth/shared_features.h"

/* An edge of a piece: its facets, its ends and its line, by their numbers in the body. */
typedef struct pir_framed_edge {
    uint32_t left, right, origin, target, line;
    bool inner; /* see shared_features.h */
} pir_framed_edge;

/* A body where it is: vertices and faces in the order of its compound, edges likewise. */
typedef struct pir_framed_body {
    const pir_compound *of;
    uint32_t *edge_start;
    pir_framed_edge *edge;
    double (*vertex)[3], (*normal)[3], (*along)[3], *height; /* of this pose */
    double (*own_along)[3];                                  /* in the frame of the body */
    pir_shared_features shared;
    uint32_t (*line)[2], lines; /* the shared planes that meet in each line of edges */
    pir_space_box *box, whole;  /* of each piece, rounded outwards, and of all */
} pir_framed_body;

typedef struct pir_piece_frame {
    pir_framed_body body[2]; /* A' and B */
    int exponent;
    pir_rotation rotation, rotation_q; /* of P as Q sees it; of Q */
    pir_rotation_integers integers[2];
    pir_vec3 translation[2]; /* of P and of Q */
    double t[3];             /* what P is moved by, as Q sees it; within 2^-47 */
} pir_piece_frame;

/* Whether a shared vertex lies on a line of edges. */
static inline bool pir_framed_on_line(const pir_framed_body *body, uint32_t line, uint32_t vertex) {
    return pir_shared_features_on(&body->shared, body->line[line][0], vertex) &&
           pir_shared_features_on(&body->shared, body->line[line][1], vertex);
}

/* False when out of memory. Both compounds outlive it. */
bool pir_piece_frame_init(pir_piece_frame *frame, const pir_compound *p, const pir_compound *q,
                          const pir_allocator *allocator);
void pir_piece_frame_finish(pir_piece_frame *frame, const pir_allocator *allocator);

/* Takes the poses of both. Errors as of pir_rotation_set_relative. */
pir_status pir_piece_frame_set(pir_piece_frame *frame, const pir_pair_input *input);

/* --- exact numbers; `side` is 0 for A', 1 for B --- */

/* Vertex v of piece i: X, Y, Z and W > 0. */
void pir_piece_frame_vertex(pir_piece_frame *frame, int side, uint32_t i, uint32_t v, mpz_t ret[4]);

/* The outward normal of a face of piece i and the direction of an edge, both of any length. */
void pir_piece_frame_normal(pir_piece_frame *frame, int side, uint32_t i, uint32_t face, mpz_t ret[3]);
void pir_piece_frame_along(pir_piece_frame *frame, int side, uint32_t i, uint32_t edge, mpz_t ret[3]);

/* P's translation, and a vector of the world, as Q sees them. */
void pir_piece_frame_translation(pir_piece_frame *frame, mpz_t ret[4]);
void pir_piece_frame_turn_back(pir_piece_frame *frame, pir_vec3 way, mpz_t ret[4]);

/* A vector of Q's frame in units of the frame as one of the world, a length. */
pir_vec3 pir_piece_frame_to_world(const pir_piece_frame *frame, const double x[3]);

#endif
