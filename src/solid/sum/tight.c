/* SPDX-License-Identifier: MIT */
/*
 * See tight.h. Of segments, what closed facets hold is taken away, and what is left is united along each line; of
 * points, those go that facets or such segments hold. A two-sided facet crosses another one where a polygon of it
 * meets the other's plane, within a polygon of that.
 */
#include "solid/sum/tight.h"

#include "solid/glue/cut_runs.h"

struct tight {
    pir_space *space;
    pir_union_outline *outline;
    const pir_facet_polygons *facets;
    pir_boxes boxes;
    uint32_t *found;   /* scratch: facets' polygons whose boxes meet another */
    pir_touching rest; /* scratch: what is left of the segment at hand */
    pir_touching lone, crossing;
};

static pir_polygon polygon_of(const struct tight *t, uint32_t i) {
    return t->facets->polygons->polygon[t->facets->polygon[i]];
}

static pir_space_box box_of(const struct tight *t, const uint32_t *point, uint32_t count) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    for (uint32_t i = 0; i < count; i++)
        pir_space_box_add(&box, &t->space->point[point[i]]);
    return box;
}

static uint32_t find(struct tight *t, const uint32_t *point, uint32_t count) {
    const pir_space_box box = box_of(t, point, count);
    return pir_boxes_find(&t->boxes, &box, t->found);
}

/* Whether a closed polygon holds a point. */
static bool holds(const struct tight *t, pir_polygon p, uint32_t point) {
    if (pir_space_side(t->space, p.half, point) != 0)
        return false;
    for (uint32_t i = 0; i < p.count; i++)
        if (pir_space_side(t->space, t->facets->polygons->wall[p.first + i], point) > 0)
            return false;
    return true;
}

/* --- segments on their own --- */

/* Takes a closed polygon from the segments of `rest`. */
static void subtract(struct tight *t, pir_polygon p) {
    const uint32_t count = t->rest.segment_count;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count && t->space->status == PIR_OK; i++) {
        const pir_segment whole = t->rest.segment[i];
        pir_segment part = whole;
        if (pir_space_side(t->space, p.half, whole.a) != 0 || pir_space_side(t->space, p.half, whole.b) != 0 ||
            !pir_segment_clip(t->space, &part, t->facets->polygons->wall + p.first, p.count)) {
            t->rest.segment[kept++] = whole;
            continue;
        }
        if (part.a != whole.a)
            pir_touching_add_segment(&t->rest, t->space,
                                     (pir_segment){{whole.plane[0], whole.plane[1]}, whole.a, part.a});
        if (part.b != whole.b)
            pir_touching_add_segment(&t->rest, t->space,
                                     (pir_segment){{whole.plane[0], whole.plane[1]}, part.b, whole.b});
    }
    for (uint32_t i = count; i < t->rest.segment_count; i++)
        t->rest.segment[kept++] = t->rest.segment[i];
    t->rest.segment_count = kept;
}

static void add_lone(struct tight *t, const pir_segment *segment) {
    pir_touching_clear(&t->rest);
    pir_touching_add_segment(&t->rest, t->space, *segment);
    const uint32_t found = find(t, (const uint32_t[]){segment->a, segment->b}, 2);
    for (uint32_t i = 0; i < found && t->rest.segment_count > 0 && t->space->status == PIR_OK; i++)
        subtract(t, polygon_of(t, t->found[i]));
    for (uint32_t i = 0; i < t->rest.segment_count; i++)
        pir_touching_add_segment(&t->lone, t->space, t->rest.segment[i]);
}

/* Notes the points at which a segment on its own passes through facets. */
static void touch_facets(struct tight *t, const pir_segment *segment) {
    const uint32_t line = pir_union_outline_line(t->outline, segment->plane[0], segment->plane[1]);
    const uint32_t found = find(t, (const uint32_t[]){segment->a, segment->b}, 2);
    for (uint32_t i = 0; i < found && t->space->status == PIR_OK; i++) {
        const pir_polygon p = polygon_of(t, t->found[i]);
        const int a = pir_space_side(t->space, p.half, segment->a), b = pir_space_side(t->space, p.half, segment->b);
        if ((a | b) == 0 || a * b > 0)
            continue;
        const uint32_t point = a == 0 ? segment->a
                               : b == 0
                                   ? segment->b
                                   : pir_space_add_meet(t->space, segment->plane[0], segment->plane[1], p.half >> 1);
        if (holds(t, p, point))
            pir_union_outline_touch(t->outline, line, pir_places_point(&t->outline->points, point));
    }
}

/* --- where two-sided facets cross others --- */

/* The side of a polygon in a plane, or the segment in which the plane cuts it. */
static bool meet_plane(struct tight *t, pir_polygon p, uint32_t plane, pir_segment *ret_segment) {
    const uint32_t *point = t->facets->polygons->point + p.first, *wall = t->facets->polygons->wall + p.first;
    uint32_t end[2], count = 0;
    for (uint32_t i = 0; i < p.count && count < 2; i++) {
        const uint32_t j = i + 1 < p.count ? i + 1 : 0;
        const int a = pir_space_side(t->space, pir_half(plane, false), point[i]);
        const int b = pir_space_side(t->space, pir_half(plane, false), point[j]);
        if (a == 0)
            end[count++] = point[i];
        else if (a * b < 0)
            end[count++] = pir_space_add_meet(t->space, p.half >> 1, wall[i] >> 1, plane);
    }
    if (count == 2)
        *ret_segment = (pir_segment){{p.half >> 1, plane}, end[0], end[1]};
    return count == 2;
}

static void add_crossings(struct tight *t, uint32_t two_sided) {
    const pir_polygon p = polygon_of(t, two_sided);
    const uint32_t found = find(t, t->facets->polygons->point + p.first, p.count);
    for (uint32_t i = 0; i < found && t->space->status == PIR_OK; i++) {
        const pir_polygon other = polygon_of(t, t->found[i]);
        pir_segment segment;
        if (other.half >> 1 != p.half >> 1 && meet_plane(t, p, other.half >> 1, &segment) &&
            pir_segment_clip(t->space, &segment, t->facets->polygons->wall + other.first, other.count))
            pir_touching_add_segment(&t->crossing, t->space, segment);
    }
}

/* --- points on their own --- */

static bool on_lone(struct tight *t, uint32_t point) {
    for (uint32_t r = 0; r < t->outline->run_count; r++) {
        const pir_run *run = &t->outline->run[r];
        if (run->group != PIR_GROUP_LONE)
            continue;
        const uint32_t *plane = t->outline->line_plane[run->line], along = t->outline->line_direction[run->line];
        if (pir_space_side(t->space, pir_half(plane[0], false), point) == 0 &&
            pir_space_side(t->space, pir_half(plane[1], false), point) == 0 &&
            pir_space_order(t->space, along, run->a, point) >= 0 &&
            pir_space_order(t->space, along, point, run->b) >= 0)
            return true;
    }
    return false;
}

static void add_point(struct tight *t, uint32_t point, pir_touching *points) {
    const uint32_t found = find(t, &point, 1);
    for (uint32_t i = 0; i < found; i++)
        if (holds(t, polygon_of(t, t->found[i]), point))
            return;
    const uint32_t known = pir_places_point(&t->outline->points, point);
    for (uint32_t i = 0; i < points->point_count; i++)
        if (points->point[i] == known)
            return;
    if (!on_lone(t, point))
        pir_touching_add_point(points, t->space, known);
}

/* --- all --- */

static bool init(struct tight *t) {
    const pir_allocator *a = &t->space->allocator;
    const uint32_t count = t->facets->count;
    pir_space_box *box = PIR_NEW(a, pir_space_box, count);
    t->found = PIR_NEW(a, uint32_t, count);
    for (uint32_t i = 0; i < count && box; i++) {
        const pir_polygon p = polygon_of(t, i);
        box[i] = box_of(t, t->facets->polygons->point + p.first, p.count);
    }
    const bool done = box && t->found && pir_boxes_init(&t->boxes, a, box, count);
    PIR_FREE(a, box, count);
    if (!done && t->space->status == PIR_OK)
        t->space->status = PIR_ERR_MEMORY;
    return done;
}

static void finish(struct tight *t) {
    pir_boxes_finish(&t->boxes, &t->space->allocator);
    PIR_FREE(&t->space->allocator, t->found, t->facets->count);
    pir_touching_finish(&t->rest, t->space);
    pir_touching_finish(&t->lone, t->space);
    pir_touching_finish(&t->crossing, t->space);
}

void pir_tight_add(pir_union_outline *outline, const pir_facet_polygons *facets, const pir_touching *left,
                   pir_touching *ret_points) {
    struct tight t = {.space = outline->space, .outline = outline, .facets = facets};
    if (init(&t)) {
        for (uint32_t i = 0; i < left->segment_count && t.space->status == PIR_OK; i++)
            add_lone(&t, &left->segment[i]);
        for (uint32_t i = facets->two_sided; i < facets->count && t.space->status == PIR_OK; i++)
            add_crossings(&t, i);
        pir_union_outline_add_segments(outline, PIR_GROUP_CROSSING, t.crossing.segment, t.crossing.segment_count);
        pir_union_outline_add_segments(outline, PIR_GROUP_LONE, t.lone.segment, t.lone.segment_count);
        for (uint32_t i = 0; i < t.lone.segment_count && t.space->status == PIR_OK; i++)
            touch_facets(&t, &t.lone.segment[i]);
        for (uint32_t i = 0; i < left->point_count && t.space->status == PIR_OK; i++)
            add_point(&t, left->point[i], ret_points);
    }
    finish(&t);
}
