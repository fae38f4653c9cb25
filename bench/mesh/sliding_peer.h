/* SPDX-License-Identifier: MIT */
/* A frictionless body that slides over a floor, in an engine's own world. */
#ifndef BENCH_MESH_SLIDING_PEER_H
#define BENCH_MESH_SLIDING_PEER_H

#include <math.h>

#ifdef __cplusplus
extern "C" {
#endif

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
    uint64_t off;      /* of these, off the floor's normal by more than 1e-9 */
    uint64_t ghosts;   /* of these, by more than 1e-3 */
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

/* Counts contacts that pushed along one normal, of which x and y are given. */
static inline void slide_count(slide_result *result, double x, double y, uint64_t contacts) {
    const double off = sqrt(x * x + y * y);
    result->contacts += contacts;
    result->off += off > 1e-9 ? contacts : 0;
    result->ghosts += off > 1e-3 ? contacts : 0;
}

/* The velocity at the end of a frame, and the height over the place of rest. */
static inline void slide_note(slide_result *result, double vx, double vy, double speed, double height) {
    result->lost = fmax(result->lost, fmax(fabs(vx - speed), fabs(vy - 0.05 * speed)) / speed);
    result->hop = fmax(result->hop, height);
}

/* Slides a body, which has its place, at a speed for so many frames of 1/60 s. */
typedef void slide_run(const slide_floor *floor, const slider *body, double speed, uint32_t frames,
                       slide_result *ret_result);

slide_run box3d_slide, bullet_slide, jolt_slide;

#ifdef __cplusplus
}
#endif

#endif
