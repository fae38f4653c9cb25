/* SPDX-License-Identifier: MIT */
/* Motions; the random numbers are those of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014), the same on every machine. */
#include "motion.h"

#include "turn.h"

/* A number between -1 and 1. */
static double random_number(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z ^= z >> 31;
    return (double)(int64_t)(z >> 11) * 0x1p-52 - 1;
}

/* Directions are uniform: points of the cube until one lies in the ball, and not at its centre. */
static pir_vec3 random_axis(uint64_t *state) {
    for (;;) {
        pir_vec3 axis;
        axis.x = random_number(state);
        axis.y = random_number(state);
        axis.z = random_number(state);
        double square = axis.x * axis.x + axis.y * axis.y + axis.z * axis.z;
        if (square <= 1 && square > 0x1p-20)
            return axis;
    }
}

struct motion motion_new(const pir_vec3 *axis, uint64_t steps, uint64_t seed) {
    struct motion motion = {.random = !axis, .steps = steps, .state = seed, .now = {0, 0, 0, 1}};
    motion.axis = axis ? *axis : random_axis(&motion.state);
    return motion;
}

pir_quat motion_before(const struct motion *motion) {
    return turn_about(motion->axis, -1, (double)motion->steps);
}

pir_quat motion_next(struct motion *motion) {
    uint64_t frame = motion->frame++;
    double steps = (double)motion->steps;
    if (!motion->random)
        return turn_about(motion->axis, (double)(frame % motion->steps), steps);
    if (frame > 0) {
        if (frame % MOTION_AXIS_FRAMES == 0)
            motion->axis = random_axis(&motion->state);
        motion->now = turn_after(motion->now, turn_about(motion->axis, 1, steps));
    }
    return motion->now;
}
