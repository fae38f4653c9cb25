/* SPDX-License-Identifier: MIT */
/*
 * Bodies and poses to test with: point sets of many kinds, quaternions of many kinds, and situations that put two
 * bodies and a rotation together. More than half of the situations are degenerate: what real scenes are made of.
 */
#ifndef PIR_TEST_BODIES_H
#define PIR_TEST_BODIES_H

#include <stdbool.h>

#include <pirouette/polytope.h>

#include "support/random.h"

#define TEST_POINTS_MAX 512

typedef struct test_points {
    size_t count;
    pir_vec3 at[TEST_POINTS_MAX];
} test_points;

typedef enum test_body {
    TEST_SPHERE = 0, /* random points of the unit sphere: in general position */
    TEST_BALL,       /* random points of a ball, some inside the hull */
    TEST_GRID,       /* random points of a small integer grid, with duplicates */
    TEST_BOX,        /* the eight corners of an axis-parallel box of integers */
    TEST_OCTAHEDRON, /* six points on the axes */
    TEST_PRISM,      /* a grid polygon, twice */
    TEST_NEEDLE,     /* a grid body stretched by 1 : 1 : 1e-6 */
    TEST_FAR,        /* a grid body of tenths, 1e7 away */
    TEST_SCALED,     /* a body times a power of two, axis by axis */
    TEST_POLYGON,    /* points of a plane: dimension at most 2 */
    TEST_SEGMENT,    /* points of a line: dimension at most 1 */
    TEST_POINT,      /* one point, perhaps several times */
    TEST_BODY_COUNT,
} test_body;

/* A body of up to `most` points (eight or six for the boxes and octahedra); most >= 1. */
void test_body_points(test_random *random, test_body body, size_t most, test_points *ret_points);

/* Puts the points in random order. */
void test_shuffle(test_random *random, test_points *points);

/* Turns the points by the rotation of q in doubles, rounding as programs that make models do. */
void test_bake(test_points *points, pir_quat q);

/* The hull of points that must have one; ends the program with a message when they have not. */
pir_polytope *test_polytope(const test_points *points);

/* The hull of `count` points, likewise. */
pir_polytope *test_hull(const pir_vec3 *points, size_t count);

/* The box of half sides x, y, z about the origin, and about a point. */
pir_polytope *test_box(double x, double y, double z);
pir_polytope *test_box_at(double x, double y, double z, pir_vec3 at);

/*
 * A prism with many narrow sides towards +x, upright along z or y. Two of them cross most of their edges' arcs, or
 * hardly any.
 */
pir_polytope *test_fluted_prism(bool upright_along_z);

/* The longest side of a polytope's bounds. */
double test_size_of(const pir_polytope *polytope);

/* `count` random points of the unit sphere as a polytope. */
pir_polytope *test_sphere(test_random *random, size_t count);

/* A polytope of the body made with `most` points. */
pir_polytope *test_random_polytope(test_random *random, test_body body, size_t most);

/* Quaternions that are hard: half turns, third turns, tiny, huge, denormal, of mixed magnitude. */
#define TEST_HARD_ROTATIONS 16
pir_quat test_hard_rotation(uint32_t index);

/* A rotation by a quaternion of small integers: aligns grids. */
pir_quat test_integer_rotation(test_random *random);

/* A random rotation, of random length. */
pir_quat test_general_rotation(test_random *random);

/* One of the three kinds above. */
pir_quat test_rotation(test_random *random);

/* b after a, scaled to length 1 when `normalise`. */
pir_quat test_compose(pir_quat b, pir_quat a, int normalise);

/* Two bodies and where they stand. */
typedef struct test_pose {
    const char *situation;
    test_points p, q;
    pir_quat rotation;
} test_pose;

/* A random pose of bodies of up to `most` points. */
void test_random_pose(test_random *random, size_t most, test_pose *ret_pose);

#endif
