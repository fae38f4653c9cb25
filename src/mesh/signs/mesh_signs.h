/* SPDX-License-Identifier: MIT */
/*
 * Signs that queries on surfaces rest on, exact for the doubles given, which are at most 2^60 in size: doubles within a
 * proven bound on their error decide most, integers the rest. Nothing allocates.
 */
#ifndef PIR_MESH_SIGNS_MESH_SIGNS_H
#define PIR_MESH_SIGNS_MESH_SIGNS_H

#include "base/vec.h"

/* A triangle where it stands. */
typedef struct pir_tri {
    pir_vec3 p[3];
} pir_tri;

/* A segment from `origin` to `origin` + `way`. */
typedef struct pir_mesh_segment {
    pir_vec3 origin, way;
} pir_mesh_segment;

/* The sign of (b − a) × (c − a) in the plane: positive where a, b, c turn counter-clockwise. */
int pir_sign_turn(const double a[2], const double b[2], const double c[2]);

/* The sign of ((b − a) × (c − a)) · (d − a): positive where d is in front of the triangle a, b, c. */
int pir_sign_side(const pir_tri *tri, pir_vec3 d);

/* The sign of way · ((p − origin) × (q − origin)). It reverses exactly when p and q change places. */
int pir_sign_around(const pir_mesh_segment *segment, pir_vec3 p, pir_vec3 q);

/* Whether the triangle has no area. */
bool pir_tri_is_degenerate(const pir_tri *tri);

/*
 * When a segment meets the plane of a triangle, which it is not in, as a fraction of its way: whether that is from 0 to
 * 1, the sign of the times of two triangles less each other, and the time as a double, off by at most *ret_error.
 */
bool pir_time_is_within(const pir_mesh_segment *segment, const pir_tri *tri);
int pir_sign_time_order(const pir_mesh_segment *segment, const pir_tri *first, const pir_tri *second);
double pir_time_of(const pir_mesh_segment *segment, const pir_tri *tri, double *ret_error);

#endif
