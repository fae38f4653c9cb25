/* SPDX-License-Identifier: MIT */
/*
 * Solids of our own making, by name, for tests and benchmarks: their facets are planar exactly as doubles.
 *
 *     cube, ball128          convex: the unit cube; an octahedron split four times a side, on the unit sphere
 *     star5, gear8 … gear64  prisms over a star with five points and over toothed wheels
 *     stella                 the stella octangula
 *     clamp, frame, case     a C with a slot 2 wide, a square ring round a hole, a box round a cavity: 1 thick
 *     mushroom, cup, spoon   a cap on a stem and a bowl on a foot, of rings; a shallow bowl on a handle, of sections
 *     mushroom6              the same of six sides instead of 32, or as many as it says
 */
#ifndef PIR_TEST_SOLID_MODELS_H
#define PIR_TEST_SOLID_MODELS_H

#include <pirouette/solid.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SOLID_MODEL_POINTS 4096
#define SOLID_MODEL_FACETS 2048

/* Facets, each with points of its own: facet f has those from start[f] up to start[f + 1]. */
typedef struct solid_model {
    pir_vec3 point[SOLID_MODEL_POINTS];
    uint32_t start[SOLID_MODEL_FACETS + 1], corner[SOLID_MODEL_POINTS];
    uint32_t points, facets;
} solid_model;

/* The facets of the solid of that name with its coordinates divided by `divisor`, a power of two unless all facets are
 * triangles or parallel to the axes. On the heap, for free(); NULL for an unknown name. */
solid_model *solid_model_facets(const char *name, double divisor);

/* The solid itself; NULL for an unknown name or when it is refused. */
pir_solid *solid_model_new(const char *name, double divisor);

#ifdef __cplusplus
}
#endif

#endif
