/* SPDX-License-Identifier: MIT */
/* Every placement query at one pose, against the oracle of placements. */
#ifndef PIR_TEST_EXACT_CHECKS_H
#define PIR_TEST_EXACT_CHECKS_H

#include "query/exact_pair.h"
#include "support/random.h"

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
 * Where bodies meet, exactly: at the nearest point of the difference, the foot on a plane, or along the direction at
 * one.
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
 * Whether the witness is that of the points which the rule of pir_witness asks for, exactly, and its features hold the
 * points: at most `tolerance` away. The oracle is left at the contact's pose.
 */
void exact_check_witness(exact_pair *pair, const exact_contact *contact, const pir_witness *witness, pir_vec3 point_p,
                         pir_vec3 point_q, double tolerance);

/*
 * How far a point is, at most, from a part of an operand, P standing at `translation`; NULL for all of it. Exact beyond
 * `tolerance`.
 */
double exact_distance_from(exact_pair *pair, pir_operand operand, const oracle_set *part, pir_vec3 point,
                           pir_vec3 translation, double tolerance);

/* Whether a feature of an operand holds a point: that distance is at most `tolerance`. */
void exact_check_holds(exact_pair *pair, pir_operand operand, pir_feature feature, pir_vec3 point, pir_vec3 translation,
                       double tolerance);

/* All of two answers but their steps. */
int exact_same_bits(const pir_query_result *a, const pir_query_result *b);

#endif
