/* SPDX-License-Identifier: MIT */
/* Situations at the limits of doubles: two bodies, the rotations to take them through, and where P is moved to. */
#ifndef PIR_TEST_SITUATIONS_H
#define PIR_TEST_SITUATIONS_H

#include "support/bodies.h"

#define SITUATION_TURNS 8

/* How translations are chosen. */
typedef enum situation_move {
    SITUATION_ANY = 0, /* far, near and deep, on features of the difference and an ulp beside them */
    SITUATION_STEPS,   /* by a few of the least denormals */
    SITUATION_SLIDE,   /* P on top of Q, its lower face in the plane of Q's upper face, or an ulp off it */
} situation_move;

typedef struct situation {
    const char *name;
    test_points p, q;
    uint32_t turns;
    pir_quat turn[SITUATION_TURNS];
    situation_move move;
    double scale;      /* of the bodies, for those that are points */
    const char *kinds; /* the checks of queries that apply, or NULL for all: exact_report_only */
} situation;

uint32_t situation_count(void);

/* Situation `index`; the same for the same seed. */
void situation_make(uint32_t index, situation *ret_situation);

/* Points within an ulp of the unit sphere: directions, normalised, each coordinate up to an ulp off. */
pir_vec3 situation_near_sphere(test_random *random);

#endif
