/* SPDX-License-Identifier: MIT */
/* Heaps of bodies that tremble on grounds of all kinds, to be put into one scene or more and moved there alike. */
#ifndef TESTS_SCENE_REUSE_HEAP_H
#define TESTS_SCENE_REUSE_HEAP_H

#include <stdbool.h>

#include <pirouette/scene.h>

#include "support/random.h"

#define HEAP_BODIES 64 /* the ground among them */
#define HEAP_PIECES 6

typedef enum heap_ground {
    HEAP_NO_GROUND = 0,
    HEAP_SLAB,
    HEAP_TILES, /* boxes side by side */
    HEAP_LIFT,  /* a slab that moves */
    HEAP_FIELD,
    HEAP_MESH,
    HEAP_GROUNDS,
} heap_ground;

typedef struct heap_body {
    pir_body_options options;
    pir_polytope *piece[HEAP_PIECES];
} heap_body;

typedef struct heap {
    test_random random;
    heap_ground ground;
    heap_body body[HEAP_BODIES]; /* in the order of their numbers; the ground is the first, or the last */
    uint32_t count, ground_at;
    pir_height_field *field;
    pir_trimesh *mesh;
    double tremble; /* of the next moves */
    pir_scene_move move[HEAP_BODIES];
    size_t moves;
} heap;

/* Case `number`, of so many bodies. */
void heap_init(heap *h, uint64_t number, uint32_t count);
void heap_finish(heap *h);

/* A scene with all bodies where they are now. */
pir_scene *heap_scene(const heap *h, const pir_scene_options *options);

/* New poses: all bodies tremble, or some do, and now and then one jumps. */
void heap_move(heap *h);

/* Whether the events of two scenes are the same in every bit that is told. */
bool heap_same_events(const pir_scene *a, const pir_scene *b);

#endif
