/* SPDX-License-Identifier: MIT */
/*
 * Two bodies at a rotation, and their features in the oracle's terms: sets of vertices, facets in the order of the
 * tie rule.
 */
#ifndef PIR_TEST_EXACT_PAIR_H
#define PIR_TEST_EXACT_PAIR_H

#include <pirouette/query.h>

#include "oracle/place.h"

/* A polytope and its features, by its own numbers. */
typedef struct exact_body {
    pir_polytope *polytope;
    oracle_solid *solid;
    uint32_t edges, facets;
    oracle_set *edge, *facet; /* solid->words for each */
} exact_body;

/* The rank of a facet of the difference in the tie rule: a facet of P lies on it, or one of Q, or else two edges do. */
typedef struct exact_rank {
    uint32_t kind, first, second;
} exact_rank;

typedef struct exact_pair {
    exact_body body[2]; /* by pir_operand */
    double size;        /* of both bodies together; the scene's scale where both are points */
    double reach;       /* the largest coordinate of either */
    pir_query *query;   /* the scene's: it has seen other rotations */
    pir_query *fresh;   /* made at this rotation */
    pir_query_cache cache;
    oracle_place *place;
    exact_rank *rank; /* of each plane */
    uint32_t *order;  /* planes by rising rank */
} exact_pair;

/* Makes a pair and takes over the polytopes. The size is `scale` where both are points. */
exact_pair exact_pair_make(pir_polytope *p, pir_polytope *q, double scale);
void exact_pair_free(exact_pair *pair);

/* Sets place, rank and order at a rotation; exact_pair_leave frees them. */
void exact_pair_turn(exact_pair *pair, pir_quat rotation);
void exact_pair_leave(exact_pair *pair);

/* Writes the vertices of a feature into `set`. 0 when the body has no such feature. */
int exact_feature_set(const exact_body *body, pir_feature feature, oracle_set *set);

/* The face of a body that lies in a plane of the difference, as a feature. `set` is the plane's set of vertices. */
pir_feature exact_feature_of(const exact_body *body, const oracle_set *set);

/* Whether two features are the same. A polygon's two facets are. */
int exact_same_feature(const exact_body *body, pir_feature a, pir_feature b);

/* The distance between a plane's unit normal and another vector: the error of a direction. */
double exact_turn_from(const oracle_plane *plane, pir_vec3 normal);

double exact_length(pir_vec3 v);
pir_vec3 exact_add(pir_vec3 a, pir_vec3 b, double s);

/* The largest coordinate. */
double exact_largest(pir_vec3 v);

#endif
