/* SPDX-License-Identifier: MIT */
/* Small vectors of doubles, beside cglm's floats. No fused operations: the bits are the same on every machine. */
#ifndef PIR_BASE_VEC_H
#define PIR_BASE_VEC_H

#include <math.h>
#include <stdbool.h>

#include <pirouette/base.h>

static inline pir_vec3 pir_vec_add(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline pir_vec3 pir_vec_sub(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline pir_vec3 pir_vec_scale(pir_vec3 a, double s) {
    return (pir_vec3){a.x * s, a.y * s, a.z * s};
}

/* a + s·b. */
static inline pir_vec3 pir_vec_along(pir_vec3 a, double s, pir_vec3 b) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline double pir_vec_dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline pir_vec3 pir_vec_cross(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double pir_vec_length(pir_vec3 a) {
    return sqrt(pir_vec_dot(a, a));
}

/* |x| + |y| + |z|, which is no less than the length. */
static inline double pir_vec_taxicab(pir_vec3 a) {
    return fabs(a.x) + fabs(a.y) + fabs(a.z);
}

/* Coordinate k. */
static inline double pir_vec_component(pir_vec3 a, int k) {
    return k == 0 ? a.x : k == 1 ? a.y : a.z;
}

static inline bool pir_vec_is_finite(pir_vec3 a) {
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

/* Of numbers that are no NaN, without a call. */
static inline double pir_lesser(double a, double b) {
    return a < b ? a : b;
}

static inline double pir_greater(double a, double b) {
    return a > b ? a : b;
}

/* The sum of the sizes of the coordinates. */
static inline double pir_vec_size(pir_vec3 a) {
    return fabs(a.x) + fabs(a.y) + fabs(a.z);
}

/* A 3×3 matrix by rows. */
typedef struct pir_mat3 {
    double m[3][3];
} pir_mat3;

static inline pir_vec3 pir_mat_apply(const pir_mat3 *r, pir_vec3 v) {
    return (pir_vec3){r->m[0][0] * v.x + r->m[0][1] * v.y + r->m[0][2] * v.z,
                      r->m[1][0] * v.x + r->m[1][1] * v.y + r->m[1][2] * v.z,
                      r->m[2][0] * v.x + r->m[2][1] * v.y + r->m[2][2] * v.z};
}

/* The transpose times v: the inverse rotation. */
static inline pir_vec3 pir_mat_apply_transposed(const pir_mat3 *r, pir_vec3 v) {
    return (pir_vec3){r->m[0][0] * v.x + r->m[1][0] * v.y + r->m[2][0] * v.z,
                      r->m[0][1] * v.x + r->m[1][1] * v.y + r->m[2][1] * v.z,
                      r->m[0][2] * v.x + r->m[1][2] * v.y + r->m[2][2] * v.z};
}

#endif
