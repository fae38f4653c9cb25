/* SPDX-License-Identifier: MIT */
/*
 * See touching.h. Of a closed polygon that meets the set, the part on or above each plane in turn stays, with its
 * boundary. Where the polygon is below a plane but for a side or a corner in it, that side or corner stays. What is
 * left in the end is within the set. Segments are cut likewise.
 */
#include "solid/sum/touching.h"

void pir_touching_finish(pir_touching *touching, pir_space *space) {
    pir_fragments_finish(&touching->fragments, space);
    pir_space_shrink(space, touching->segment, touching->segment_room, sizeof *touching->segment);
    pir_space_shrink(space, touching->point, touching->point_room, sizeof *touching->point);
    *touching = (pir_touching){0};
}

void pir_touching_clear(pir_touching *touching) {
    touching->fragments.count = touching->segment_count = touching->point_count = 0;
}

void pir_touching_add_segment(pir_touching *touching, pir_space *space, pir_segment segment) {
    pir_touching *t = touching;
    if (pir_space_grow(space, (void **)&t->segment, &t->segment_room, t->segment_count, sizeof *t->segment))
        t->segment[t->segment_count++] = segment;
}

void pir_touching_add_point(pir_touching *touching, pir_space *space, uint32_t point) {
    pir_touching *t = touching;
    if (pir_space_grow(space, (void **)&t->point, &t->point_room, t->point_count, sizeof *t->point))
        t->point[t->point_count++] = point;
}

/* --- polygons --- */

/* The side or corner of a polygon in a plane that it is below, whose signs pir_polygons_sides has left. */
static void add_contact(pir_touching *t, uint32_t polygon) {
    const pir_polygons *polygons = t->polygons;
    const pir_polygon p = polygons->polygon[polygon];
    uint32_t corner = PIR_SPACE_NONE;
    for (uint32_t i = 0; i < p.count; i++) {
        const uint32_t next = i + 1 < p.count ? i + 1 : 0;
        if (polygons->sign[i] == 0 && polygons->sign[next] == 0) {
            pir_touching_add_segment(t, polygons->space,
                                     (pir_segment){{p.half >> 1, polygons->wall[p.first + i] >> 1},
                                                   polygons->point[p.first + i],
                                                   polygons->point[p.first + next]});
            return;
        }
        corner = polygons->sign[i] == 0 ? i : corner;
    }
    if (corner != PIR_SPACE_NONE)
        pir_touching_add_point(t, polygons->space, polygons->point[p.first + corner]);
}

static bool touches(const pir_polygons *polygons, uint32_t polygon) {
    for (uint32_t i = 0; i < polygons->polygon[polygon].count; i++)
        if (polygons->sign[i] == 0)
            return true;
    return false;
}

/* Puts the planes that cut a polygon, then those that it touches, into the fragments' scratch; false when the polygon
 * is not met. */
static bool find_planes(pir_touching *t, uint32_t polygon, const uint32_t *half, uint32_t count,
                        uint32_t ret_counts[2]) {
    pir_polygons *polygons = t->polygons;
    uint32_t *spare = t->fragments.spare;
    ret_counts[0] = ret_counts[1] = 0;
    for (uint32_t h = 0; h < count; h++) {
        const unsigned sides = pir_polygons_sides(polygons, polygon, half[h]);
        if (sides == 2 || sides == 0)
            return false;
        if (sides == 3)
            spare[ret_counts[0]++] = half[h];
        else if (touches(polygons, polygon))
            spare[count - ++ret_counts[1]] = half[h];
    }
    return true;
}

/* Whether the polygon meets the set, which is then taken from it; otherwise nothing has changed. */
static bool subtract_polygon(pir_touching *t, uint32_t polygon, const uint32_t *half, uint32_t count, uint32_t *apart) {
    pir_polygons *polygons = t->polygons;
    pir_space *space = polygons->space;
    uint32_t counts[2], rest = polygon;
    if (pir_polygon_is_apart(polygons, polygon, half, count, apart) ||
        !pir_space_grow(space, (void **)&t->fragments.spare, &t->fragments.spare_room, count,
                        sizeof *t->fragments.spare) ||
        !find_planes(t, polygon, half, count, counts))
        return false;
    const uint32_t before = t->fragments.count, polygon_count = polygons->count;
    for (uint32_t h = 0; h < counts[0] && space->status == PIR_OK; h++) {
        const unsigned sides = pir_polygons_sides(polygons, rest, t->fragments.spare[h]);
        if (sides == 2) {
            t->fragments.count = before;
            pir_polygons_truncate(polygons, polygon_count);
            return false;
        }
        if (sides != 3)
            continue;
        uint32_t parts[2] = {0};
        pir_polygons_cut(polygons, rest, t->fragments.spare[h], parts);
        pir_fragments_add(&t->fragments, space, parts[1]);
        rest = parts[0];
    }
    for (uint32_t h = count - counts[1]; h < count && space->status == PIR_OK; h++)
        if (pir_polygons_sides(polygons, rest, t->fragments.spare[h]) == 1)
            add_contact(t, rest);
    return true;
}

/* --- segments and points --- */

static bool subtract_segment(pir_touching *t, pir_segment rest, const uint32_t *half, uint32_t count) {
    pir_space *space = t->polygons->space;
    const uint32_t segments = t->segment_count, points = t->point_count;
    for (uint32_t h = 0; h < count && space->status == PIR_OK; h++) {
        const int a = pir_space_side(space, half[h], rest.a), b = pir_space_side(space, half[h], rest.b);
        if (a >= 0 && b >= 0) {
            t->segment_count = segments;
            t->point_count = points;
            return false;
        }
        if (a > 0 || b > 0) {
            const uint32_t point = pir_space_add_meet(space, rest.plane[0], rest.plane[1], half[h] >> 1);
            pir_segment above = rest;
            *(a > 0 ? &above.b : &above.a) = point;
            *(a > 0 ? &rest.a : &rest.b) = point;
            pir_touching_add_segment(t, space, above);
        } else if (a == 0 || b == 0) {
            pir_touching_add_point(t, space, a == 0 ? rest.a : rest.b);
        }
    }
    return true;
}

static bool holds_inside(pir_space *space, uint32_t point, const uint32_t *half, uint32_t count) {
    for (uint32_t h = 0; h < count; h++)
        if (pir_space_side(space, half[h], point) >= 0)
            return false;
    return true;
}

/* --- all --- */

void pir_touching_subtract(pir_touching *touching, const uint32_t *half, uint32_t count, uint32_t *apart) {
    pir_touching *t = touching;
    pir_space *space = t->polygons->space;
    // what is added by one kind to another comes behind what is looked at, and is outside of the set
    const uint32_t fragments = t->fragments.count, segments = t->segment_count, points = t->point_count;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < points; i++)
        if (!holds_inside(space, t->point[i], half, count))
            t->point[kept++] = t->point[i];
    t->point_count = kept;
    kept = 0;
    for (uint32_t i = 0; i < segments && space->status == PIR_OK; i++)
        if (!subtract_segment(t, t->segment[i], half, count))
            t->segment[kept++] = t->segment[i];
    for (uint32_t i = segments; i < t->segment_count; i++)
        t->segment[kept++] = t->segment[i];
    t->segment_count = kept;
    kept = 0;
    for (uint32_t i = 0; i < fragments && space->status == PIR_OK; i++)
        if (!subtract_polygon(t, t->fragments.polygon[i], half, count, apart))
            t->fragments.polygon[kept++] = t->fragments.polygon[i];
    for (uint32_t i = fragments; i < t->fragments.count; i++)
        t->fragments.polygon[kept++] = t->fragments.polygon[i];
    t->fragments.count = kept;
}
