/* SPDX-License-Identifier: MIT */
/*
 * Convex polygons that planes cut: each in the plane of a half-space, with a wall through each side, a half-space that
 * holds the polygon and cuts its plane along that side. So a corner that a cut makes is where the polygon's plane, a
 * wall and the cutting plane meet, and no construction rests on another.
 */
#ifndef PIR_SOLID_SPACE_POLYGONS_H
#define PIR_SOLID_SPACE_POLYGONS_H

#include "solid/space/space.h"

typedef struct pir_polygon {
    uint32_t half, first, count;
} pir_polygon;

typedef struct pir_polygons {
    pir_space *space;
    uint32_t count, room, corner_count, point_room, wall_room, sign_room;
    pir_polygon *polygon;
    uint32_t *point;                                         /* corners, counter-clockwise from above */
    uint32_t *wall;                                          /* per corner: of the side that begins there */
    int8_t *sign;                                            /* scratch, per corner of the polygon at hand */
    uint32_t *corner, *direction, made_room, direction_room; /* likewise, of one that is to be added */
} pir_polygons;

/* A ball that holds a polygon. */
typedef struct pir_ball {
    double x[3], radius;
} pir_ball;

pir_ball pir_polygons_ball(const pir_polygons *polygons, uint32_t polygon);

/* How far below a plane the middle of a ball is, by doubles. */
static inline double pir_ball_depth(const pir_ball *ball, const pir_space_plane *f) {
    return f->d - (f->n[0] * ball->x[0] + f->n[1] * ball->x[1] + f->n[2] * ball->x[2]);
}

/* The side of a plane that all of a ball is on, by the depth of its middle: 1 above, −1 below; 0 when doubles do not
 * tell. Depths and radii are within 2^-46 of what they are for doubles without rounding. */
static inline int pir_ball_side(const pir_ball *ball, const pir_space_plane *f, double depth) {
    const double reach = ball->radius + f->err + 0x1p-44;
    return depth < -reach ? 1 : depth > reach ? -1 : 0;
}

void pir_polygons_init(pir_polygons *polygons, pir_space *space);
void pir_polygons_finish(pir_polygons *polygons);

/* A polygon of points in the plane of `half`, and walls through its sides, which have these directions; `reversed`, per
 * side, says which have the opposite ones, and is NULL where none has. */
uint32_t pir_polygons_add(pir_polygons *polygons, uint32_t half, const uint32_t *point, const uint32_t *direction,
                          const bool *reversed, uint32_t count);

/* A copy of a polygon of another list in the same space. */
uint32_t pir_polygons_copy(pir_polygons *polygons, const pir_polygons *from, uint32_t polygon);

/* Takes back all polygons from `count` on, and their corners. */
void pir_polygons_truncate(pir_polygons *polygons, uint32_t count);

/* The direction from a to b. */
uint32_t pir_polygons_direction(pir_space *space, uint32_t a, uint32_t b);

/* Which sides of a half-space the corners of a polygon are on: bit 0 below, bit 1 above; 0 when all are in its plane.
 * Leaves them in `sign`. */
unsigned pir_polygons_sides(pir_polygons *polygons, uint32_t polygon, uint32_t half);

/* Cuts a polygon with corners on both sides, whose signs pir_polygons_sides has left. The parts below and above. */
void pir_polygons_cut(pir_polygons *polygons, uint32_t polygon, uint32_t half, uint32_t ret_parts[2]);

#endif
