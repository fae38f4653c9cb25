/* SPDX-License-Identifier: MIT */
/* Vectors of three doubles, and matrices of three rows. */
#ifndef PHYSICS_VEC_H
#define PHYSICS_VEC_H

#include <math.h>

#include <pirouette/base.h>

static inline pir_vec3 vec_add(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline pir_vec3 vec_less(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline pir_vec3 vec_times(double s, pir_vec3 a) {
    return (pir_vec3){s * a.x, s * a.y, s * a.z};
}

static inline double vec_dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline pir_vec3 vec_cross(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double vec_length(pir_vec3 a) {
    return sqrt(vec_dot(a, a));
}

struct mat3 {
    pir_vec3 row[3];
};

static inline pir_vec3 mat_times(const struct mat3 *m, pir_vec3 a) {
    return (pir_vec3){vec_dot(m->row[0], a), vec_dot(m->row[1], a), vec_dot(m->row[2], a)};
}

/* The inverse; not finite where there is none. */
static inline struct mat3 mat_inverse(const struct mat3 *m) {
    pir_vec3 a = vec_cross(m->row[1], m->row[2]), b = vec_cross(m->row[2], m->row[0]),
             c = vec_cross(m->row[0], m->row[1]);
    double s = 1 / vec_dot(m->row[0], a);
    return (struct mat3){{vec_times(s, (pir_vec3){a.x, b.x, c.x}), vec_times(s, (pir_vec3){a.y, b.y, c.y}),
                          vec_times(s, (pir_vec3){a.z, b.z, c.z})}};
}

#endif
