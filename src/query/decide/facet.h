/* SPDX-License-Identifier: MIT */
/*
 * True facets of D: faces of P and Q that one direction exposes.
 *
 * A direction n exposes one face of P and one of Q, those farthest along n. Here P is the rotated and reflected P
 * that D is a sum with. The sum of the two faces is the face of D that n exposes. Pieces that are exactly coplanar
 * belong to one true facet, and the two faces name it: a facet of P with any face of Q, a facet of Q with an edge or
 * a vertex of P, or two edges that are not parallel. So an answer that names a true facet depends neither on the
 * perturbation that cut it into pieces nor on the piece that a search met.
 *
 * Exact signs decide which edges are across n: a filter on unit vectors first, then integers.
 */
#ifndef PIR_QUERY_DECIDE_FACET_H
#define PIR_QUERY_DECIDE_FACET_H

#include <pirouette/query.h>

#include "query/decide/piece_plane.h"

/*
 * The error of a slope. With u = 2^-53, a unit normal is off by at most 64u·err, and by 41u more once rotated back
 * into P's frame; a unit edge vector is off by 6u; their dot product rounds by 4u. Together that is below 118u·err,
 * and the bound is 128u·err (tests/proofs/directions.g).
 */
#define PIR_SLOPE_BOUND 0x1p-46

/*
 * Slacks below this, relative to the placement's reach, come from integers. Doubles know them to 2^-46 only, less
 * than the 12 digits that an answer promises.
 */
#define PIR_NEXT_TO_NOTHING 0x1p-30

/* A direction as doubles, and exactly: as the normal of a piece or as integers. */
typedef struct pir_normal {
    pir_vec3 unit;
    double err; /* unit is off by at most 64·2^-53 times this */
    pir_piece piece;
    /* where it is not NULL it is the direction, and the piece does not count; it lies in the scratch */
    const pir_int3 *exact;
} pir_normal;

typedef struct pir_facet {
    pir_witness faces; /* of the reflected P, and of Q */
    pir_piece piece;   /* that the order of ties goes by: FV where P has a facet there, else VF, else EE */
    uint32_t a, b;     /* a corner of it */
    pir_vec3 n;        /* its plane */
    double h, err;     /* as in pir_plane; err is at most 1 / PIR_SIN_REFINED */
} pir_facet;

/* The facet that a search has found, if any. */
typedef struct pir_least {
    bool found;
    pir_facet facet;
} pir_least;

/* The direction as integers, in the scratch. */
pir_int3 pir_normal_integers(pir_exact *exact, const pir_normal *normal);

/* A direction in the frame of one body's own vertices. */
typedef struct pir_view {
    const pir_polytope *body;
    bool of_q;
    pir_vec3 unit;
} pir_view;

pir_view pir_view_of(const pir_frame *frame, const pir_normal *normal, bool of_q);

/* The exact sign of n·e for a halfedge of the body. */
int pir_slope(pir_exact *exact, const pir_normal *normal, const pir_view *view, uint32_t half);

/* The face of the body that n exposes, given a vertex of it. */
pir_feature pir_exposed(pir_exact *exact, const pir_normal *normal, const pir_view *view, uint32_t vertex);

/* The vertex of a face with the lowest number. */
uint32_t pir_face_lowest(const pir_polytope *p, pir_feature face);

/* The true facet of a piece. False where the piece's plane holds no more than an edge of D. */
bool pir_facet_of(pir_exact *exact, pir_piece piece, pir_facet *ret_facet);

/*
 * The true facet of a piece of which nothing is known: proves that its corner is exposed by its normal, which makes it
 * one of D. False where it is not.
 */
bool pir_facet_prove(pir_exact *exact, pir_piece piece, pir_facet *ret_facet);

/* The true facet of two faces that a direction exposes. False as above. */
bool pir_facet_of_faces(pir_exact *exact, const pir_normal *normal, pir_witness faces, pir_facet *ret_facet);

static inline bool pir_facet_same(const pir_facet *a, const pir_facet *b) {
    const pir_witness f = a->faces, g = b->faces;
    return f.p.kind == g.p.kind && f.p.index == g.p.index && f.q.kind == g.q.kind && f.q.index == g.q.index;
}

/* Whether a comes before b in the order that settles ties. */
bool pir_facet_before(const pir_facet *a, const pir_facet *b);

/*
 * The slack. It is negative where the facet separates. It is the same number however the facet was found. Where it is
 * near 0 it comes from integers.
 */
double pir_facet_slack(pir_exact *exact, const pir_placement *placement, const pir_facet *facet);

/* The exact sign of the slack. */
int pir_facet_side(pir_exact *exact, const pir_placement *placement, const pir_facet *facet);

/* Both at once, which is less work where they come from integers. Returns the sign. */
int pir_facet_measure(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double *ret_slack);

/* The exact sign of a's slack minus b's. */
int pir_facet_compare(pir_exact *exact, const pir_placement *placement, const pir_facet *a, const pir_facet *b);

/*
 * Compares the true facet of a piece with `least` and keeps the one of less slack, or the first in order where they
 * tie.
 */
void pir_least_offer(pir_exact *exact, const pir_placement *placement, pir_least *least, pir_piece piece);

/* Compares a true facet with `least`, and keeps one as pir_least_offer does. */
void pir_least_offer_facet(pir_exact *exact, const pir_placement *placement, pir_least *least, const pir_facet *facet);

static inline pir_normal pir_facet_normal(const pir_facet *facet) {
    return (pir_normal){facet->n, facet->err, facet->piece, NULL};
}

#endif
