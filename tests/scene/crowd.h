/* SPDX-License-Identifier: MIT */
/*
 * A crowd of bodies that move at random in a scene, and beside it the same by brute force: every two pieces asked by a
 * pair of their own, made for the question. It knows bodies, poses and contacts, no boxes and no tree.
 */
#ifndef TESTS_SCENE_CROWD_H
#define TESTS_SCENE_CROWD_H

#include <stdbool.h>

#include <pirouette/scene.h>

#include "support/random.h"

#define CROWD_BODIES 48
#define CROWD_PIECES 3
#define CROWD_GONE   1024

typedef struct crowd_body {
    bool used, fresh; /* in the scene; added since the last update */
    pir_body_options options;
    pir_polytope *piece[CROWD_PIECES];
    uint32_t id; /* the scene's */
} crowd_body;

typedef struct crowd {
    test_random random;
    pir_scene_options options;
    pir_scene *scene;
    crowd_body body[CROWD_BODIES];
    uint32_t count;
    uint64_t adds; /* so far */
    double size;   /* of the room that they are in */
    /* by numbers of the scene and of pieces: whether they were in contact */
    bool touching[CROWD_BODIES][CROWD_BODIES][CROWD_PIECES][CROWD_PIECES];
    pir_scene_move move[CROWD_BODIES];
    size_t moves;
    pir_scene_event gone[CROWD_GONE]; /* that bodies which were removed or changed leave to the next update */
    size_t gone_count;
    uint64_t contacts; /* that brute force has found so far */
} crowd;

/* A crowd of `count` bodies: of all kinds, some of several pieces, rounded, sensors, filtered. */
void crowd_init(crowd *c, uint64_t number, uint32_t count, const pir_scene_options *options);
void crowd_finish(crowd *c);

/* Adds a body to the scene and removes one, where there is room for it. */
void crowd_add(crowd *c);
void crowd_remove(crowd *c, uint32_t index);

/* Changes what a body meets, whether it is a sensor, or whether it is disabled. */
void crowd_change(crowd *c, uint32_t index);

/* The body with that number, or number of that id, in the scene; NULL where it has none. */
const crowd_body *crowd_body_of(const crowd *c, uint32_t id);

/* New poses for about this part of the bodies: near the old ones, now and then far. */
void crowd_move(crowd *c, double part);

/* The update, and by brute force; ends the test with `number` where they differ. */
void crowd_update_and_check(crowd *c, uint64_t number);

/* FNV-1a over the scene's events, on from `hash`. */
uint64_t crowd_hash_events(uint64_t hash, const pir_scene *scene);

#endif
