/* SPDX-License-Identifier: MIT */
/* Random axes are uniform: points of the cube until one lies in the ball, and not at its centre. */
#include "spin.h"

#include <math.h>

#define TURN 6.28318530717958647692

double spin_random(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z ^= z >> 31;
    return (double)(int64_t)(z >> 11) * 0x1p-52 - 1;
}

static pir_vec3 random_axis(uint64_t *state) {
    for (;;) {
        double x = spin_random(state), y = spin_random(state), z = spin_random(state), square = x * x + y * y + z * z;
        if (square <= 1 && square > 0x1p-20)
            return (pir_vec3){x / sqrt(square), y / sqrt(square), z / sqrt(square)};
    }
}

struct spin spin_new(double steps, uint64_t seed, int from_identity) {
    struct spin spin = {.steps = steps, .state = seed, .now = {0, 0, 0, 1}};
    for (int i = 0; i < 3 && !from_identity; i++) {
        pir_vec3 axis = random_axis(&spin.state);
        spin.now = spin_turn(spin.now, axis, TURN / 2 * spin_random(&spin.state));
    }
    return spin;
}

pir_quat spin_turn(pir_quat b, pir_vec3 axis, double angle) {
    double s = sin(angle / 2), w = cos(angle / 2), x = axis.x * s, y = axis.y * s, z = axis.z * s;
    pir_quat q = {w * b.x + x * b.w + y * b.z - z * b.y, w * b.y - x * b.z + y * b.w + z * b.x,
                  w * b.z + x * b.y - y * b.x + z * b.w, w * b.w - x * b.x - y * b.y - z * b.z};
    double length = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return (pir_quat){q.x / length, q.y / length, q.z / length, q.w / length};
}

pir_quat spin_next(struct spin *spin) {
    if (spin->frame++ % SPIN_AXIS_FRAMES == 0)
        spin->axis = random_axis(&spin->state);
    spin->now = spin_turn(spin->now, spin->axis, TURN / spin->steps);
    return spin->now;
}
