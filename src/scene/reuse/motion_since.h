/* SPDX-License-Identifier: MIT */
/*
 * How far the bodies of a pair have moved relative to each other.
 *
 * One body is seen from the other: its rotation and its place in the other's frame. Of two views the difference bounds
 * the way of all points of a piece: that of the body's origin, and the angle times how far the piece reaches from it.
 * Normals move with the body that the other one is seen from, so that they stand still in that view.
 */
#ifndef PIR_SCENE_REUSE_MOTION_SINCE_H
#define PIR_SCENE_REUSE_MOTION_SINCE_H

#include "scene/world/scene.h"

/* The side whose piece, with its radius, reaches less far from its body's origin: it is seen from the other. */
typedef struct pir_seen_side {
    int side;
    double reach;
} pir_seen_side;

pir_seen_side pir_seen_side_of(const pir_scene *scene, uint32_t pair);

/* That body where it stands now. */
pir_seen pir_see(const pir_scene *scene, uint32_t pair);

/* A bound on the way of any point of a piece between two views, the piece reaching so far. */
static inline double pir_motion_between(const pir_seen *a, const pir_seen *b, double reach) {
    // each rotation is off by 24u, and their chord by 5u: 53u in all, with u = 2^-53
    const double angle = pir_rotation_angle_bound_within(a->rotation, b->rotation, 0x1p-46);
    const double way = pir_vec_length(pir_vec_sub(a->translation, b->translation));
    return (way + angle * reach) * (1 + 0x1p-40) + a->error + b->error;
}

#endif
