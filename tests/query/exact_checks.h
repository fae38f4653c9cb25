/* SPDX-License-Identifier: MIT */
/* Every placement query at one pose, against the oracle of placements. */
#ifndef PIR_TEST_EXACT_CHECKS_H
#define PIR_TEST_EXACT_CHECKS_H

#include <pirouette/query.h>

#include "oracle/place.h"
#include "support/random.h"

/* Two bodies at a rotation. */
typedef struct exact_pair {
    pir_polytope *p, *q;
    oracle_solid *solid_p, *solid_q;
    oracle_place *place;
    pir_query *query; /* of the scene: it has seen other rotations */
    pir_query *fresh; /* made at this rotation */
    pir_query_cache cache;
    double size;  /* of both bodies */
    double reach; /* the largest coordinate of either */
} exact_pair;

/* What was asked and answered at a pose. */
typedef struct exact_pose {
    pir_vec3 t, direction;
    pir_query_input input;
    pir_state state;
    double should; /* the signed distance */
    pir_query_result answer;
    int limit; /* refused: too far for its size */
} exact_pose;

/* State, numbers, witness: from single queries with and without caches. */
void exact_check_pose(exact_pair *pair, test_random *random, exact_pose *pose);

/* Along pose->direction: directional depth and distance, the cast. */
void exact_check_directions(exact_pair *pair, const exact_pose *pose);

/* Escapes, the largest distance, radii, cutoff, the manifold. */
void exact_check_others(exact_pair *pair, test_random *random, const exact_pose *pose);

/* --- what these share --- */

/*
 * Where bodies meet, exactly: at the point of the difference that is nearest to t, at the foot of t on a plane, or
 * along the direction at one.
 */
typedef enum exact_way {
    EXACT_NEAREST = 0,
    EXACT_TO_PLANE,
    EXACT_ALONG,
} exact_way;

typedef struct exact_contact {
    exact_way way;
    uint32_t plane;
    pir_vec3 t, direction; /* the pose */
    pir_vec3 there;        /* where P then is: t, or moved along the direction, rounded */
} exact_contact;

/*
 * Whether a feature of an operand holds a point of contact: the distance is at most `tolerance`. And that it is a least
 * face that does: where the point lies exactly on a lesser one, bodies cannot meet there, exactly: then it was rounding
 * that moved it.
 */
void exact_check_holds(exact_pair *pair, pir_operand operand, pir_feature feature, pir_vec3 point,
                       const exact_contact *contact, double tolerance);

/* All of two answers but their steps. */
int exact_same_bits(const pir_query_result *a, const pir_query_result *b);

double exact_length(pir_vec3 v);
pir_vec3 exact_add(pir_vec3 a, pir_vec3 b, double s);

/* The largest coordinate. */
double exact_largest(pir_vec3 v);

#endif
