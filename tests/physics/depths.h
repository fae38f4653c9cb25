/* SPDX-License-Identifier: MIT */
/* How deep bodies overlap, proven by exact separating axes. */
#ifndef TEST_DEPTHS_H
#define TEST_DEPTHS_H

#include "stage.h"

/* The worst of all pairs of pieces of different bodies, of which one is a moving one. */
struct depths {
    uint32_t pairs;  /* whose spheres meet */
    double depth;    /* no pair is deeper */
    double relative; /* nor deeper than this part of the smaller piece's size */
    uint32_t p, q;   /* the bodies of the latter */
};

/* Looks at all pairs; fails the test where an answer is none. */
struct depths depths_of(const struct stage *stage, const struct world *world);

#endif
