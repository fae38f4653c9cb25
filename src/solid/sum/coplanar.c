/* SPDX-License-Identifier: MIT */
/*
 * See coplanar.h. A point of a side bounds the union where no polygon covers what is just beyond the side. So every
 * side is cut by the others' walls along its own line, and polygons are never cut into parts. Where sides of two
 * polygons share a part of a line, both go when the polygons are on opposite sides of it; else the earlier one keeps
 * it. The largest polygons come first: most sides are within one of them.
 */
#include "solid/sum/coplanar.h"

#include <math.h>

#include "base/sort.h"
#include "solid/space/boxes.h"

/* A wall of a polygon as doubles, and how far off them its truth may be. */
struct wall {
    double n[3], d, err;
    uint32_t half;
};

struct plane_union {
    pir_space *space;
    const pir_polygons *polygons;
    const uint32_t *polygon;
    uint32_t count;
    double *area;
    pir_space_box *box;
    uint32_t *order, *work;
    pir_segment *left; /* of the sides of the polygon at hand */
    uint32_t left_count, left_room;
    struct wall *wall; /* of a polygon that may cover something of them */
    uint32_t wall_count, wall_room;
    uint32_t *near; /* of these, the ones that the segment at hand is not certainly below */
    uint32_t near_count, near_room;
    pir_segment *edge; /* the boundary of the union */
    uint32_t edge_count, edge_room;
};

static double area_of(const pir_polygons *polygons, pir_polygon p) {
    double sum[3] = {0};
    for (uint32_t i = 0; i < p.count; i++) {
        const double *a = polygons->space->point[polygons->point[p.first + i]].x;
        const double *b = polygons->space->point[polygons->point[p.first + (i + 1 < p.count ? i + 1 : 0)]].x;
        for (int k = 0; k < 3; k++)
            sum[k] += a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
    return sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
}

static bool is_larger(void *context, uint32_t a, uint32_t b) {
    const double *area = context;
    return area[a] > area[b];
}

static void measure(struct plane_union *plane) {
    for (uint32_t i = 0; i < plane->count; i++) {
        const pir_polygon p = plane->polygons->polygon[plane->polygon[i]];
        plane->area[i] = area_of(plane->polygons, p);
        plane->box[i] = PIR_SPACE_BOX_EMPTY;
        for (uint32_t k = 0; k < p.count; k++)
            pir_space_box_add(&plane->box[i], &plane->space->point[plane->polygons->point[p.first + k]]);
        plane->order[i] = i;
    }
    pir_sort(plane->order, plane->count, plane->work, is_larger, plane->area);
}

static void push(pir_space *space, pir_segment **list, uint32_t *room, uint32_t *count, pir_segment segment) {
    if (pir_space_grow(space, (void **)list, room, *count, sizeof **list))
        (*list)[(*count)++] = segment;
}

/* Whether a wall through a side of `own` has that polygon above it. */
static bool is_beyond(struct plane_union *plane, pir_polygon own, uint32_t wall) {
    int side = 0;
    for (uint32_t i = 0; i < own.count && side == 0; i++)
        side = pir_space_side(plane->space, wall, plane->polygons->point[own.first + i]);
    return side > 0;
}

/* Lists the walls that a segment may not be wholly below: others neither cut it nor keep it from being covered. */
static void list_near(struct plane_union *plane, pir_segment segment) {
    const pir_space_point *a = &plane->space->point[segment.a], *b = &plane->space->point[segment.b];
    pir_ball ball = {{0}, 0};
    double square = 0;
    for (int k = 0; k < 3; k++) {
        ball.x[k] = (a->x[k] + b->x[k]) / 2;
        square += (a->x[k] - b->x[k]) * (a->x[k] - b->x[k]);
    }
    ball.radius = sqrt(square) / 2 + 2 * (a->err + b->err);
    plane->near_count = 0;
    if (!pir_space_grow(plane->space, (void **)&plane->near, &plane->near_room, plane->wall_count, sizeof *plane->near))
        return;
    for (uint32_t i = 0; i < plane->wall_count; i++) {
        const struct wall *wall = &plane->wall[i];
        const double depth = wall->d - (wall->n[0] * ball.x[0] + wall->n[1] * ball.x[1] + wall->n[2] * ball.x[2]);
        plane->near[plane->near_count] = wall->half;
        plane->near_count += depth <= ball.radius + wall->err;
    }
}

/* Whether the polygon at hand covers a part of a segment of a side of `own`; where they share a side and face one way,
 * only an `earlier` one does. */
static bool covers(struct plane_union *plane, pir_segment segment, pir_polygon own, bool earlier) {
    list_near(plane, segment);
    for (uint32_t i = 0; i < plane->near_count; i++) {
        const uint32_t wall = plane->near[i];
        const int a = pir_space_side(plane->space, wall, segment.a);
        const int b = a < 0 ? -1 : pir_space_side(plane->space, wall, segment.b);
        if (b < 0)
            continue;
        if (a > 0 || b > 0 || (!earlier && !is_beyond(plane, own, wall)))
            return false;
    }
    return true;
}

/* Takes from a segment what the polygon at hand covers, whose walls near it are listed; what is left is added to
 * `left`. */
static void cut(struct plane_union *plane, pir_segment rest) {
    pir_space *space = plane->space;
    const uint32_t before = plane->left_count;
    const pir_segment whole = rest;
    for (uint32_t i = 0; i < plane->near_count && space->status == PIR_OK; i++) {
        const uint32_t wall = plane->near[i];
        const int a = pir_space_side(space, wall, rest.a), b = pir_space_side(space, wall, rest.b);
        if (a <= 0 && b <= 0)
            continue;
        if (a >= 0 && b >= 0) {
            // what is left is beside the polygon
            plane->left_count = before;
            push(space, &plane->left, &plane->left_room, &plane->left_count, whole);
            return;
        }
        const uint32_t point = pir_space_add_meet(space, rest.plane[0], rest.plane[1], wall >> 1);
        pir_segment above = rest;
        *(a > 0 ? &above.b : &above.a) = point;
        *(a > 0 ? &rest.a : &rest.b) = point;
        push(space, &plane->left, &plane->left_room, &plane->left_count, above);
    }
}

static pir_space_box box_of_left(const struct plane_union *plane) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    for (uint32_t i = 0; i < plane->left_count; i++) {
        pir_space_box_add(&box, &plane->space->point[plane->left[i].a]);
        pir_space_box_add(&box, &plane->space->point[plane->left[i].b]);
    }
    return box;
}

/* Lists the walls of a polygon that a box is not wholly below. Whether it is above none. */
static bool list_walls(struct plane_union *plane, const pir_space_box *box, pir_polygon by) {
    plane->wall_count = 0;
    if (!pir_space_grow(plane->space, (void **)&plane->wall, &plane->wall_room, by.count, sizeof *plane->wall))
        return false;
    double middle[3], half[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = (box->low[k] + box->high[k]) / 2;
        half[k] = (box->high[k] - box->low[k]) / 2;
    }
    for (uint32_t i = 0; i < by.count; i++) {
        const uint32_t wall = plane->polygons->wall[by.first + i];
        const pir_space_plane *f = &plane->space->plane[wall >> 1];
        double above = -f->d, reach = f->err + 0x1p-44; // rounding is worth less than 2^-48
        for (int k = 0; k < 3; k++) {
            above += f->n[k] * middle[k];
            reach += fabs(f->n[k]) * half[k];
        }
        const double turn = wall & 1 ? -1 : 1;
        if (turn * above > reach)
            return false;
        if (turn * above >= -reach)
            plane->wall[plane->wall_count++] =
                (struct wall){{turn * f->n[0], turn * f->n[1], turn * f->n[2]}, turn * f->d, f->err + 0x1p-44, wall};
    }
    return true;
}

/* Takes from what is left of the sides of `own` what the polygon at hand covers; whether that is anything. */
static bool cut_left(struct plane_union *plane, pir_polygon own, bool earlier) {
    bool changed = false;
    uint32_t kept = 0;
    const uint32_t count = plane->left_count;
    for (uint32_t i = 0; i < count && plane->space->status == PIR_OK; i++) {
        const pir_segment segment = plane->left[i];
        if (covers(plane, segment, own, earlier)) {
            cut(plane, segment);
            changed = true;
        } else {
            plane->left[kept++] = segment;
        }
    }
    for (uint32_t i = count; i < plane->left_count && changed; i++)
        plane->left[kept++] = plane->left[i];
    plane->left_count = kept;
    return changed;
}

/* Adds what of a polygon's sides bounds the union. */
static void add_polygon(struct plane_union *plane, uint32_t rank) {
    const pir_polygon own = plane->polygons->polygon[plane->polygon[plane->order[rank]]];
    const uint32_t *point = plane->polygons->point + own.first, *wall = plane->polygons->wall + own.first;
    plane->left_count = 0;
    for (uint32_t i = 0; i < own.count; i++)
        push(plane->space, &plane->left, &plane->left_room, &plane->left_count,
             (pir_segment){{own.half >> 1, wall[i] >> 1}, point[i], point[i + 1 < own.count ? i + 1 : 0]});
    pir_space_box box = plane->box[plane->order[rank]];
    for (uint32_t j = 0; j < plane->count && plane->left_count > 0 && plane->space->status == PIR_OK; j++) {
        const uint32_t by = plane->order[j];
        if (j != rank && pir_space_box_meets(&plane->box[by], &box) &&
            list_walls(plane, &box, plane->polygons->polygon[plane->polygon[by]]) && cut_left(plane, own, j < rank))
            box = box_of_left(plane);
    }
    for (uint32_t i = 0; i < plane->left_count; i++)
        push(plane->space, &plane->edge, &plane->edge_room, &plane->edge_count, plane->left[i]);
}

void pir_coplanar_outline(pir_union_outline *outline, uint32_t group, const pir_polygons *polygons,
                          const uint32_t *polygon, uint32_t count) {
    pir_space *space = polygons->space;
    const pir_allocator *a = &space->allocator;
    struct plane_union plane = {.space = space, .polygons = polygons, .polygon = polygon, .count = count};
    plane.area = PIR_NEW(a, double, count);
    plane.box = PIR_NEW(a, pir_space_box, count);
    plane.order = PIR_NEW(a, uint32_t, count);
    plane.work = PIR_NEW(a, uint32_t, count);
    if (plane.area && plane.box && plane.order && plane.work) {
        measure(&plane);
        for (uint32_t rank = 0; rank < count; rank++)
            add_polygon(&plane, rank);
        pir_union_outline_add(outline, group, polygons->polygon[polygon[0]].half, plane.edge, plane.edge_count);
    } else {
        space->status = PIR_ERR_MEMORY;
    }
    pir_space_shrink(space, plane.left, plane.left_room, sizeof *plane.left);
    pir_space_shrink(space, plane.wall, plane.wall_room, sizeof *plane.wall);
    pir_space_shrink(space, plane.near, plane.near_room, sizeof *plane.near);
    pir_space_shrink(space, plane.edge, plane.edge_room, sizeof *plane.edge);
    PIR_FREE(a, plane.area, count);
    PIR_FREE(a, plane.box, count);
    PIR_FREE(a, plane.order, count);
    PIR_FREE(a, plane.work, count);
}
