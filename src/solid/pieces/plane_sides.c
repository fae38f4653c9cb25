/* SPDX-License-Identifier: MIT */
/*
 * See plane_sides.h. The ball round a polygon tells most sides by one scalar product. Sides of the body's own points
 * are in a table. Polygons with many corners know what they were found to be; what is on one side alone is so in every
 * part.
 */
#include "solid/pieces/plane_sides.h"

#include <string.h>

/* Numbers of sides that are kept of each kind; what is beyond is asked anew each time. */
#define MOST_SIDES (1u << 20)

/* Polygons of so many corners are asked anew each time. */
#define FEW_CORNERS 8

void pir_plane_sides_init(pir_plane_sides *sides, const pir_shell_body *body, const pir_polygons *polygons) {
    *sides = (pir_plane_sides){.space = body->space, .polygons = polygons, .first_point = body->first_point};
    uint32_t first = PIR_SPACE_NONE, last = 0;
    for (uint32_t f = 0; f < body->source.facet_count; f++) {
        first = body->plane[f] < first ? body->plane[f] : first;
        last = body->plane[f] > last ? body->plane[f] : last;
    }
    const uint64_t count = (uint64_t)(last - first + 1) * body->source.point_count;
    if (count > MOST_SIDES ||
        !pir_space_grow(sides->space, (void **)&sides->side, &sides->side_room, count, sizeof *sides->side))
        return;
    memset(sides->side, 0, sides->side_room);
    sides->first_plane = first;
    sides->planes = last - first + 1;
    sides->points = body->source.point_count;
}

void pir_plane_sides_finish(pir_plane_sides *sides) {
    pir_space_shrink(sides->space, sides->side, sides->side_room, sizeof *sides->side);
    pir_space_shrink(sides->space, sides->shape, sides->shape_room, sizeof *sides->shape);
    pir_space_shrink(sides->space, sides->known, sides->known_room, sizeof *sides->known);
    *sides = (pir_plane_sides){0};
}

void pir_plane_sides_add(pir_plane_sides *sides, uint32_t polygon, uint32_t whole) {
    pir_plane_sides *s = sides;
    if (!pir_space_grow(s->space, (void **)&s->shape, &s->shape_room, polygon, sizeof *s->shape))
        return;
    for (; s->shape_count <= polygon; s->shape_count++)
        s->shape[s->shape_count] = (pir_shape){pir_polygons_ball(s->polygons, s->shape_count), PIR_SPACE_NONE};
    if (s->planes == 0 || s->polygons->polygon[polygon].count <= FEW_CORNERS ||
        s->known_count > MOST_SIDES - s->planes ||
        !pir_space_grow(s->space, (void **)&s->known, &s->known_room, s->known_count + s->planes, sizeof *s->known))
        return;
    const uint32_t from = whole == PIR_SPACE_NONE ? whole : s->shape[whole].known;
    for (uint32_t k = 0; k < s->planes; k++) {
        const uint8_t seen = from == PIR_SPACE_NONE ? 0 : s->known[from + k];
        s->known[s->known_count + k] = (seen & PIR_ABOVE) && (seen & PIR_BELOW) ? 0 : seen;
    }
    s->shape[polygon].known = s->known_count;
    s->known_count += s->planes;
}

static unsigned ask_side(pir_space *space, uint32_t plane, uint32_t point) {
    return 1u << (1 - pir_space_side(space, pir_half(plane, false), point));
}

unsigned pir_plane_sides_of_points(pir_plane_sides *sides, uint32_t plane, const uint32_t *point, uint32_t count) {
    const uint32_t row = plane - sides->first_plane, first = sides->first_point;
    const uint32_t points = row < sides->planes ? sides->points : 0;
    uint8_t *kept = points > 0 ? sides->side + (size_t)row * points : NULL;
    unsigned seen = 0;
    for (uint32_t i = 0; i < count && (seen & (PIR_ABOVE | PIR_BELOW)) != (PIR_ABOVE | PIR_BELOW); i++) {
        const uint32_t column = point[i] - first;
        unsigned side = column < points ? kept[column] : 0;
        if (side == 0) {
            side = ask_side(sides->space, plane, point[i]);
            if (column < points)
                kept[column] = (uint8_t)side;
        }
        seen |= side;
    }
    return seen;
}

unsigned pir_plane_sides_of_polygon(pir_plane_sides *sides, uint32_t plane, uint32_t polygon) {
    const pir_polygon p = sides->polygons->polygon[polygon];
    const pir_shape *shape = &sides->shape[polygon];
    const pir_space_plane *f = &sides->space->plane[plane];
    const int all = pir_ball_side(&shape->ball, f, pir_ball_depth(&shape->ball, f));
    const uint32_t row = plane - sides->first_plane;
    if (all != 0)
        return 1u << (1 - all);
    uint8_t *known = shape->known == PIR_SPACE_NONE || row >= sides->planes ? NULL : &sides->known[shape->known + row];
    if (known && *known)
        return *known;
    const unsigned seen = pir_plane_sides_of_points(sides, plane, sides->polygons->point + p.first, p.count);
    if (known)
        *known = (uint8_t)seen;
    return seen;
}
