/* SPDX-License-Identifier: MIT */
/* The motion that benchmarks turn P by: equal steps about a random axis, a new one every 50 frames.
   Repeats from its seed. */
#ifndef BENCH_SPIN_H
#define BENCH_SPIN_H

#include <stdint.h>

#include <pirouette/base.h>

/* Frames that an axis is kept for. */
#define SPIN_AXIS_FRAMES 50

struct spin {
    double steps;   /* to a full turn */
    uint64_t frame; /* how many have been taken */
    uint64_t state; /* of the random numbers */
    pir_vec3 axis;  /* unit */
    pir_quat now;
};

/* From a random rotation, or from the identity. */
struct spin spin_new(double steps, uint64_t seed, int from_identity);

/* Takes a step and returns the rotation that it leads to. */
pir_quat spin_next(struct spin *spin);

/* A random number from −1 to 1 (SplitMix64: Steele, Lea and Flood, OOPSLA 2014). */
double spin_random(uint64_t *state);

/* The rotation by `angle` about `axis` (unit) after the rotation `before`, of length 1. */
pir_quat spin_turn(pir_quat before, pir_vec3 axis, double angle);

#endif
