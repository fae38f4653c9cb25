/* SPDX-License-Identifier: MIT */
/*
 * Triangulated solids some of whose coordinates are moved by next to nothing, so that facets are nearly coplanar and
 * planes nearly parallel.
 */
#ifndef PIR_TEST_SOLID_JITTERED_H
#define PIR_TEST_SOLID_JITTERED_H

#include <pirouette/solid.h>

#include "support/random.h"

#define JITTERED_POINTS    512
#define JITTERED_TRIANGLES 1024

/* Triangles over points that are all different. */
typedef struct jittered {
    const char *name;
    pir_vec3 point[JITTERED_POINTS];
    uint32_t corner[3 * JITTERED_TRIANGLES];
    uint32_t points, triangles;
} jittered;

enum { JITTERED_CUBE, JITTERED_L, JITTERED_STELLA, JITTERED_FRAME, JITTERED_STAR, JITTERED_GEAR, JITTERED_MUSHROOM };
#define JITTERED_BODIES 7

void jittered_make(jittered *body, int which);

/* Moves one to three coordinates by 2^-10 to 2^-52, or by one ulp. */
void jittered_move(jittered *body, test_random *random);

/* The solid; NULL where what was moved made it none. */
pir_solid *jittered_solid(const jittered *body);

#endif
