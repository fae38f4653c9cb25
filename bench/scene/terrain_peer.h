/* SPDX-License-Identifier: MIT */
/* An engine beside which terrain is timed: a height field with hulls on it, in the frame of the height field. */
#ifndef BENCH_TERRAIN_PEER_H
#define BENCH_TERRAIN_PEER_H

#include <pirouette/scene_query.h>

/* Square, of steps of 1, row by row; `low` and `high` around all heights. */
struct terrain_ground {
    const float *heights;
    int side;
    float low, high;
};

struct terrain_peer;

const char *terrain_peer_name(void);
struct terrain_peer *terrain_peer_make(const struct terrain_ground *ground, pir_polytope *const *hulls,
                                       const pir_scene_move *poses, size_t count);
void terrain_peer_free(struct terrain_peer *peer);

/* The time of the first hit of a segment, and of a capsule about the z axis, of a half-length and a radius; 1: none. */
double terrain_peer_ray(struct terrain_peer *peer, pir_vec3 origin, pir_vec3 way);
double terrain_peer_capsule(struct terrain_peer *peer, double half, double radius, pir_vec3 origin, pir_vec3 way);

/* Brings the first bodies to poses and finds pairs and contacts; ret_collision has the nanoseconds of the latter. */
void terrain_peer_update(struct terrain_peer *peer, const pir_scene_move *poses, size_t count, double *ret_collision);

#endif
