/* SPDX-License-Identifier: MIT */
/*
 * A character that walks: an upright capsule that asks a scene what it would meet, and slides along that. It goes up
 * stairs as high as CHARACTER_STEP and slopes of 50 degrees, is held by what is steeper, and rides what it stands on.
 *
 * It stays about CHARACTER_SKIN away from what it meets, so that casts begin clear of everything and it does not jitter
 * where its way is barred. Up is z; metres and seconds.
 */
#ifndef CHARACTER_H
#define CHARACTER_H

#include <pirouette/pirouette.h>

#define CHARACTER_STEP 0.3
#define CHARACTER_SKIN 0.01

struct character {
    pir_polytope *spine; /* a segment along z about the origin; the caller's */
    double radius;
    uint32_t body; /* of the scene, which is the character's own and is not met; or PIR_SCENE_NONE */
    pir_vec3 at;   /* the middle */
    double rise;   /* metres a second, below 0 in a fall; to jump, set it */
    bool stands;   /* on `ground`, which was at `stood` then */
    uint32_t ground;
    pir_pose stood;
    pir_status status; /* of the first query that failed; from then on it stays where it is */
};

/* The capsule where it is, for queries. */
pir_scene_shape character_shape(const struct character *character);

/* Goes on for a time, after the update of the scene: with its ground, out of what came into it, along `velocity`, which
   is level, and down. */
void character_move(struct character *character, pir_scene *scene, pir_vec3 velocity, double time);

#endif
