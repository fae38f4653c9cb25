/* SPDX-License-Identifier: MIT */
/*
 * Two scenes with the same bodies, but that the ground of one is a surface, and that of the other a body whose pieces
 * are the triangles as flat polytopes, under their own numbers. All that they are asked has to agree.
 */
#ifndef TESTS_SCENE_TWIN_SCENES_H
#define TESTS_SCENE_TWIN_SCENES_H

#include <stdbool.h>

#include <pirouette/scene_query.h>

#include "support/random.h"

#define TWIN_BODIES 24

typedef enum twin_ground {
    TWIN_SOUP = 0, /* triangles with whole numbers, some without an area */
    TWIN_SPHERE,   /* bumpy */
    TWIN_PLANE,    /* flat, of squares of whole numbers */
    TWIN_FIELD,    /* heights, some whole, with holes */
    TWIN_GROUNDS,
} twin_ground;

typedef struct twin_scenes {
    test_random random;
    pir_scene *with, *without; /* the surface */
    pir_trimesh *mesh;         /* one of these */
    pir_height_field *field;
    bool two_sided, ground_moves;
    uint32_t triangles;
    pir_polytope **flat;              /* of them; one far away where there is none */
    pir_polytope *shape[TWIN_BODIES]; /* of the other bodies */
    uint32_t ground, body[TWIN_BODIES];
    double size; /* of the ground, about the origin */
    pir_scene_move move[TWIN_BODIES + 1];
    size_t moves;
    uint64_t events; /* compared so far */
} twin_scenes;

typedef struct twin_options {
    pir_scene_options scene;
    twin_ground ground;
    pir_body_kind kind; /* of the ground */
    double radius;      /* of the ground */
    bool ground_first;  /* whether its number is the lowest, or the highest */
    uint32_t threads;   /* of the scene with the surface */
} twin_options;

/* Case `number`. Nothing has been updated yet. */
void twin_init(twin_scenes *t, uint64_t number, const twin_options *options);
void twin_finish(twin_scenes *t);

/* New poses for about a part of the bodies, and for a ground that is kinematic. */
void twin_move(twin_scenes *t, double part);

/* Updates both, and ends the test with `number` where events differ in any bit. */
void twin_update_and_compare(twin_scenes *t, uint64_t number);

/* Whether two events are the same in every bit that is told. */
bool twin_same_event(const pir_scene_event *a, const pir_scene_event *b);

/* A shape near the ground, often one that ties; the caller releases its polytope. */
pir_scene_shape twin_shape(twin_scenes *t);

#endif
