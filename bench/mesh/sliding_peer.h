/* SPDX-License-Identifier: MIT */
/* A frictionless body that slides over a floor, in an engine's own world. */
#ifndef BENCH_MESH_SLIDING_PEER_H
#define BENCH_MESH_SLIDING_PEER_H

#include "mesh/sliding_floors.h"

/* The triangles of a body of the floor. */
typedef struct slide_part {
    pir_vec3 (*corner)[3];
    uint32_t count;
} slide_part;

typedef struct slide_floor {
    slide_part *part;
    uint32_t count;
    bool hulls; /* each part is convex, and is taken as its hull */
} slide_floor;

typedef struct slide_result {
    uint64_t contacts; /* that pushed */
    uint64_t ghosts;   /* of these, off the floor's normal by more than 1e-3 */
    double lost;       /* the greatest part of its speed that the body lost or gained */
    double hop;        /* the highest that it was over its place of rest */
} slide_result;

/* Where a body goes on when it comes to the end of the floor. */
static inline bool slide_goes_round(pir_vec3 *at) {
    const bool round = at->x > FLOOR_LENGTH / 2 - 2, across = at->y > 3;
    at->x -= round ? FLOOR_LENGTH - 2 * FLOOR_STEP : 0;
    at->y -= across ? 6 : 0;
    return round || across;
}

/* Slides a body, which has its place, at a speed for so many frames of 1/60 s. */
void box3d_slide(const slide_floor *floor, const slider *body, double speed, uint32_t frames, slide_result *ret_result);

#endif
