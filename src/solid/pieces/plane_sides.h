/* SPDX-License-Identifier: MIT */
/* On which sides of planes points and polygons are, asked over and over: what is found is kept. */
#ifndef PIR_SOLID_PIECES_PLANE_SIDES_H
#define PIR_SOLID_PIECES_PLANE_SIDES_H

#include "solid/body/solid_body.h"
#include "solid/space/polygons.h"

/* Sides of a plane, as bits. */
enum { PIR_ABOVE = 1, PIR_ON_PLANE = 2, PIR_BELOW = 4 };

/* Where a polygon is, and where what is known of it begins in `known`, or none. */
typedef struct pir_shape {
    pir_ball ball;
    uint32_t known;
} pir_shape;

typedef struct pir_plane_sides {
    pir_space *space;
    const pir_polygons *polygons;
    uint32_t first_plane, planes, first_point, points; /* those of the body's facets, and its own */
    uint8_t *side;                                     /* per plane and point: 0, or the side that it is on */
    pir_shape *shape;                                  /* per polygon */
    uint8_t *known; /* of polygons with many corners: per plane the sides that they are on, or 0 */
    uint32_t side_room, shape_count, shape_room, known_count, known_room;
} pir_plane_sides;

/* Sides of the planes of a body's facets; those of other planes are not kept. */
void pir_plane_sides_init(pir_plane_sides *sides, const pir_shell_body *body, const pir_polygons *polygons);
void pir_plane_sides_finish(pir_plane_sides *sides);

/* Notes a polygon, which may be a part that a cut has left of another, `whole`; else that is none. */
void pir_plane_sides_add(pir_plane_sides *sides, uint32_t polygon, uint32_t whole);

/* On which sides of a plane points are. It does not look further when some are above and some below. */
unsigned pir_plane_sides_of_points(pir_plane_sides *sides, uint32_t plane, const uint32_t *point, uint32_t count);

/* On which sides of a plane a polygon's corners are: whether some are above it, and whether some are below. */
unsigned pir_plane_sides_of_polygon(pir_plane_sides *sides, uint32_t plane, uint32_t polygon);

#endif
