/* SPDX-License-Identifier: MIT */
/* Vectors for tests, apart from those of the library. */
#ifndef PIR_TEST_VECTORS_H
#define PIR_TEST_VECTORS_H

#include <math.h>

#include <pirouette/base.h>

static const pir_vec3 test_zero = {0, 0, 0};

/* a + s·b */
static inline pir_vec3 test_add(pir_vec3 a, pir_vec3 b, double s) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline double test_dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline double test_length(pir_vec3 a) {
    return sqrt(test_dot(a, a));
}

static inline pir_vec3 test_cross(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* v turned by q, of any length, or, with sign −1, by its inverse; by the quaternion alone. */
static inline pir_vec3 test_turn(pir_quat q, pir_vec3 v, double sign) {
    pir_vec3 u = {sign * q.x, sign * q.y, sign * q.z};
    double n = test_dot(u, u) + q.w * q.w;
    pir_vec3 c = test_add(test_cross(u, v), v, q.w);
    return test_add(v, test_cross(u, c), 2 / n);
}

#endif
