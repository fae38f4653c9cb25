/* SPDX-License-Identifier: MIT */
/* Every placement query at one pose, against the oracle of placements. */
#ifndef PIR_TEST_EXACT_CHECKS_H
#define PIR_TEST_EXACT_CHECKS_H

#include "query/exact_pair.h"
#include "support/random.h"

/* A pose, what was asked there, and the exact answers. */
typedef struct exact_pose {
    pir_vec3 t, direction;
    pir_query_input input;
    pir_state state;
    double should; /* the signed distance */
    pir_query_result answer;
    int limit; /* must be refused: too far away for the size */
} exact_pose;

/* Checks state, numbers and witness of single queries with and without caches. */
void exact_check_pose(exact_pair *pair, test_random *random, exact_pose *pose);

/* Checks directional depth, directional distance and cast along pose->direction. */
void exact_check_directions(exact_pair *pair, const exact_pose *pose);

/* Checks escapes, the largest distance, radii, cutoff and the manifold. */
void exact_check_others(exact_pair *pair, test_random *random, const exact_pose *pose);

/* --- what these share --- */

/*
 * A contact: where the bodies meet, exactly. That is at the nearest point of the difference, at the foot on a plane,
 * or at a plane along the direction.
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
    pir_vec3 there;        /* the translation of P at the contact, rounded: t, or t moved along the direction */
} exact_contact;

/*
 * Whether the witness is exactly the one that the rule of pir_witness asks for, and its features hold the points
 * within `tolerance`. The oracle is left at the contact's pose.
 */
void exact_check_witness(exact_pair *pair, const exact_contact *contact, const pir_witness *witness, pir_vec3 point_p,
                         pir_vec3 point_q, double tolerance);

/*
 * An upper bound on the distance of a point from a part of an operand, P standing at `translation`. NULL for the
 * whole operand. Exact beyond `tolerance`.
 */
double exact_distance_from(exact_pair *pair, pir_operand operand, const oracle_set *part, pir_vec3 point,
                           pir_vec3 translation, double tolerance);

/* Whether a feature of an operand holds a point: the distance above is at most `tolerance`. */
void exact_check_holds(exact_pair *pair, pir_operand operand, pir_feature feature, pir_vec3 point, pir_vec3 translation,
                       double tolerance);

/* Whether two answers are the same but for their steps. */
int exact_same_bits(const pir_query_result *a, const pir_query_result *b);

#endif
