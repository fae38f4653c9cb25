/* SPDX-License-Identifier: MIT */
/* Distances of triangles that are kept: see kept_lows.h. */
#include "pair/surface/kept_lows.h"

/* Where more triangles than this may be near, the whole surface is placed about as fast. */
#define MOST_NEAR 12

/* Surfaces that are not kept after that: about round bodies as many are near at the next placements. */
#define LOWS_REST 31

/* Surfaces that are not kept after a way longer than a slack, as in fast motions. */
#define SHORT_REST 4

/* Below 1 by more than a float rounds. */
#define FLOATED (1 - 0x1p-22)

/* A length as a float, not above it. */
static inline float lowered(double length) {
    return length > 0 ? (float)(length * FLOATED) : 0;
}

static inline void keep_placement(pir_surface_lows *lows, const pir_frame *frame, const pir_placement *placement,
                                  double taken) {
    lows->taken = taken;
    lows->x = placement->x;
    lows->unit = frame->unit;
}

void pir_surface_keep(pir_surface *surface, const pir_frame *frame, const pir_placement *placement,
                      const pir_surface_room *room) {
    pir_surface_lows *lows = &surface->lows;
    if (lows->rest > 0) {
        lows->rest--;
        return;
    }
    for (uint32_t t = 0; t < surface->count; t++)
        lows->low[t] = lowered(room->plane.low[t]);
    keep_placement(lows, frame, placement, 0);
    lows->faces.p.kind = PIR_FEATURE_NONE;
    lows->is_known = true;
}

/* How far corners have come at most since the last placement, and that they are off by. */
static inline double way_of_corners(const pir_surface_lows *lows, const pir_frame *frame,
                                    const pir_placement *placement) {
    const pir_vec3 way = pir_vec_sub(placement->x, lows->x);
    const double turn = pir_rotation_angle_bound(lows->unit, frame->unit);
    return sqrt(pir_vec_dot(way, way)) + turn * frame->p.size + 0x1p-40 * placement->reach + 4 * placement->error;
}

bool pir_surface_approach(pir_surface *surface, const pir_surface_room *room, pir_surface_step *step,
                          uint64_t *ret_near) {
    pir_surface_lows *lows = &surface->lows;
    step->way = way_of_corners(lows, step->frame, step->placement);
    step->taken = lows->taken + step->way;
    // triangles of the facet are as far as that; about a long way floats tell little
    if (!(step->least > step->way) || !(step->taken < step->placement->reach)) {
        lows->rest = SHORT_REST;
        return false;
    }
    *ret_near = room->loops->near(surface, (float)((step->most + step->taken) / FLOATED));
    return true;
}

bool pir_surface_stays(pir_surface *surface, const pir_surface_step *step, uint64_t near, pir_surface_room *room) {
    const pir_placement *placement = step->placement;
    pir_surface_lows *lows = &surface->lows;
    uint8_t triangle[MOST_NEAR + PIR_SURFACE_LANES] = {0};
    double low[MOST_NEAR + PIR_SURFACE_LANES];
    uint32_t count = 0;
    for (; near && count < MOST_NEAR; near &= near - 1)
        triangle[count++] = (uint8_t)__builtin_ctzll(near);
    if (near) {
        lows->rest = LOWS_REST;
        return false;
    }
    pir_surface_set_centre(placement->x, placement->error, placement->reach, room);
    room->loops->lows(surface, triangle, count, step->frame, room, low);
    for (uint32_t i = 0; i < count; i++)
        if (!(low[i] > step->most))
            return false;
    for (uint32_t i = 0; i < count; i++)
        lows->low[triangle[i]] = lowered(low[i] + step->taken);
    keep_placement(lows, step->frame, placement, step->taken);
    return true;
}
