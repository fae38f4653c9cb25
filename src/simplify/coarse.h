/* SPDX-License-Identifier: MIT */
/*
 * Coarse bodies from within: inner polytopes, and two balls about one centre, all in the frame of the polytope.
 *
 * No point of the polytope is farther from the centre than `around`. One is no farther than −`inside`, and where
 * `inside` is above 0 the ball of that radius is in the polytope. So for any direction the polytope reaches at least
 * `inside` and at most `around` beyond the centre.
 */
#ifndef PIR_SIMPLIFY_COARSE_H
#define PIR_SIMPLIFY_COARSE_H

#include <stdatomic.h>

#include <pirouette/simplify.h>

/* Coarse bodies at most, the polytope included: 8 · 4^12 vertices are as many as there can be. */
#define PIR_COARSE_MOST 14

struct pir_coarse {
    atomic_uint references;
    uint32_t count;
    pir_coarse_body body[PIR_COARSE_MOST]; /* a reference to each */
    pir_vec3 centre;
    double inside, around;
};

#endif
