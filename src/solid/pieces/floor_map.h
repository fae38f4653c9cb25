/* SPDX-License-Identifier: MIT */
/*
 * The floors of a body, which are the facets that have it above them, as a map of convex faces seen from above. Walls
 * are drawn into it: vertical planes through the body that stand on closed sides.
 *
 * Invariants: a face is in one floor, counter-clockwise from above, and may have straight corners. A side has at most
 * one twin, which has its ends, so that points are corners of all faces that they touch. Sides without a twin are
 * closed: beyond them there is no floor, or one that no floor leads to. A side and its twin are both closed or both
 * open. The face is below the wall of its side, a vertical half-space. Every point is a corner of the body or where a
 * floor, the wall of a side and one more vertical plane meet, and vertical planes hold edges of the body or their ends,
 * so that no construction rests on another.
 */
#ifndef PIR_SOLID_PIECES_FLOOR_MAP_H
#define PIR_SOLID_PIECES_FLOOR_MAP_H

#include "solid/body/solid_body.h"

typedef struct pir_floor_side {
    uint32_t origin; /* a point */
    uint32_t wall;   /* a half-space */
    uint32_t next, prev, twin, face;
    bool closed;
} pir_floor_side;

typedef struct pir_floor_face {
    uint32_t half; /* of the floor, which has the body above it: the half-space that holds the body */
    uint32_t side; /* one of its sides */
    uint32_t part; /* the number of the face that it is a part of; that of the first faces is their own */
    uint32_t link; /* the next face of its part, or none */
} pir_floor_face;

typedef struct pir_floor_map {
    pir_space *space;
    uint32_t up; /* the direction of the z axis */
    pir_floor_side *side;
    pir_floor_face *face;
    uint32_t side_count, side_room, face_count, face_room;
    uint32_t closings; /* how many sides that were open have been closed */
} pir_floor_map;

/* The sign of the z component of a facet's normal: below 0 for floors, above 0 for ceilings. */
int pir_facet_rise(const pir_shell_body *body, uint32_t facet);

/* The vertical half-space through a and b whose points are left of the way from a to b, seen from above. */
uint32_t pir_floor_wall(pir_floor_map *map, uint32_t a, uint32_t b);

/* The floors of a body; sides of reflex edges are closed. */
void pir_floor_map_init(pir_floor_map *map, const pir_shell_body *body);
void pir_floor_map_finish(pir_floor_map *map);

/* Closes the line in the first face `part` along `wall`, whose left side is below it, from where the vertical plane
 * ends[0] meets it to ends[1]. */
void pir_floor_map_draw(pir_floor_map *map, uint32_t part, uint32_t wall, const uint32_t ends[2]);

/* Where faces that open sides join have more than 180 degrees between a closed side and the next one round its origin,
 * draws on beyond the origin, up to what is closed. */
void pir_floor_map_extend(pir_floor_map *map, uint32_t side);

#endif
