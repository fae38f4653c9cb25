/* SPDX-License-Identifier: MIT */
/*
 * Where a ray first meets a posed polytope, by trying every facet, side and corner: in rationals without a rounding
 * radius, in long doubles with one. It knows no half-spaces, no cylinders and no scene.
 */
#ifndef TESTS_SCENE_RAY_ORACLE_H
#define TESTS_SCENE_RAY_ORACLE_H

#include <pirouette/polytope.h>
#include <pirouette/pose.h>

typedef struct ray_oracle ray_oracle;

ray_oracle *ray_oracle_new(const pir_polytope *polytope, pir_pose pose, double radius);
void ray_oracle_free(ray_oracle *oracle);

typedef struct ray_verdict {
    int hits;    /* 1, 0, or −1 where long doubles cannot tell */
    double time; /* where it hits: the first */
} ray_verdict;

/* `way` is not 0. */
ray_verdict ray_oracle_ask(const ray_oracle *oracle, pir_vec3 origin, pir_vec3 way);

/* How far a point is from the surface of the rounded body, below 0 within the radius. */
double ray_oracle_height(const ray_oracle *oracle, pir_vec3 point);

#endif
