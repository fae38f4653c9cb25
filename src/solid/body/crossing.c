/* SPDX-License-Identifier: MIT */
/*
 * Two facets that meet where they should not have an edge of one in the other. So each edge is held against the
 * parts whose boxes it meets. An edge may end in a corner of a facet; it may lie along the boundary of a part of
 * its plane, and not in its interior, unless it is a flat edge between facets that the part covers. Everything is
 * decided by signs of determinants.
 */
#include "solid/body/crossing.h"

#include "base/report.h"
#include "solid/space/boxes.h"

static uint32_t corner_count(const pir_body *body, uint32_t part) {
    return body->part_start[part + 1] - body->part_start[part];
}

static uint32_t corner(const pir_body *body, uint32_t part, uint32_t i) {
    const uint32_t count = corner_count(body, part);
    return body->part_corner[body->part_start[part] + (i < count ? i : i - count)];
}

bool pir_body_part_holds(pir_body *body, uint32_t part, uint32_t point) {
    const uint32_t half = pir_body_half(body, body->part_facet[part]);
    for (uint32_t i = 0; i < corner_count(body, part); i++)
        if (pir_space_turn(body->space, half, corner(body, part, i), corner(body, part, i + 1), point) < 0)
            return false;
    return true;
}

/* Whether the point is a corner of a facet in the part's group. */
static bool is_corner(const pir_body *body, uint32_t part, uint32_t point) {
    for (uint32_t i = 0; i < corner_count(body, part); i++)
        if (corner(body, part, i) == point)
            return true;
    const uint32_t group = body->group[body->part_facet[part]];
    for (uint32_t h = 0; h < body->source.start[body->source.facet_count]; h++)
        if (body->origin[h] == point && body->group[body->facet[h]] == group)
            return true;
    return false;
}

/* Whether an edge in the plane of the part passes through its interior: no side of the part and not the edge itself
 * separates them. */
static bool passes_within(pir_body *body, const pir_body_edge *edge, uint32_t part) {
    const uint32_t half = pir_body_half(body, body->part_facet[part]);
    bool left = false, right = false;
    for (uint32_t i = 0; i < corner_count(body, part); i++) {
        const uint32_t p = corner(body, part, i), q = corner(body, part, i + 1);
        if (pir_space_turn(body->space, half, p, q, edge->a) <= 0 &&
            pir_space_turn(body->space, half, p, q, edge->b) <= 0)
            return false;
        const int side = pir_space_turn(body->space, half, edge->a, edge->b, p);
        left = left || side > 0;
        right = right || side < 0;
    }
    return left && right;
}

/* Whether an edge whose ends are on either side of the part's plane passes through it, its boundary included. */
static bool passes_through(pir_body *body, const pir_body_edge *edge, uint32_t part) {
    bool left = false, right = false;
    for (uint32_t i = 0; i < corner_count(body, part) && !(left && right); i++) {
        const int side =
            pir_space_orient(body->space, edge->a, edge->b, corner(body, part, i), corner(body, part, i + 1));
        left = left || side > 0;
        right = right || side < 0;
    }
    return !(left && right);
}

static bool touches(pir_body *body, uint32_t point, uint32_t part) {
    return !is_corner(body, part, point) && pir_body_part_holds(body, part, point);
}

static bool meet_badly(pir_body *body, const pir_body_edge *edge, uint32_t part) {
    const uint32_t half = pir_body_half(body, body->part_facet[part]);
    if (edge->bend == PIR_BEND_FLAT && body->group[edge->left] == body->group[body->part_facet[part]])
        return false;
    const int a = pir_space_side(body->space, half, edge->a), b = pir_space_side(body->space, half, edge->b);
    if (a == 0 && b == 0 && passes_within(body, edge, part))
        return true;
    if ((a == 0 && touches(body, edge->a, part)) || (b == 0 && touches(body, edge->b, part)))
        return true;
    return a * b < 0 && passes_through(body, edge, part);
}

static pir_status refuse(const pir_body *body, const pir_body_edge *edge, uint32_t part) {
    char where[PIR_BODY_WHERE], beside[PIR_BODY_WHERE], a[PIR_BODY_WHERE], b[PIR_BODY_WHERE];
    return pir_fail(body->source.report, PIR_ERR_FORMAT,
                    "%s: the surface meets itself: the edge from %s to %s of this facet meets %s",
                    pir_body_where(&body->source, edge->left, where), pir_body_place(body, edge->a, a),
                    pir_body_place(body, edge->b, b), pir_body_where(&body->source, body->part_facet[part], beside));
}

static pir_status check(pir_body *body, const pir_boxes *boxes, uint32_t *found) {
    for (uint32_t e = 0; e < body->edge_count && body->space->status == PIR_OK; e++) {
        const pir_body_edge *edge = &body->edge[e];
        pir_box box = PIR_BOX_EMPTY;
        pir_box_add(&box, &body->space->point[edge->a]);
        pir_box_add(&box, &body->space->point[edge->b]);
        for (uint32_t i = 0, count = pir_boxes_find(boxes, &box, found); i < count; i++)
            if (meet_badly(body, edge, found[i]) && body->space->status == PIR_OK)
                return refuse(body, edge, found[i]);
    }
    return body->space->status;
}

pir_status pir_body_check_crossing(pir_body *body) {
    const pir_allocator *a = &body->space->allocator;
    pir_box *box = PIR_NEW(a, pir_box, body->part_count);
    uint32_t *found = PIR_NEW(a, uint32_t, body->part_count);
    pir_status status = box && found ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t p = 0; p < body->part_count && status == PIR_OK; p++) {
        box[p] = PIR_BOX_EMPTY;
        for (uint32_t i = 0; i < corner_count(body, p); i++)
            pir_box_add(&box[p], &body->space->point[corner(body, p, i)]);
    }
    pir_boxes boxes;
    if (status == PIR_OK && !pir_boxes_init(&boxes, a, box, body->part_count))
        status = PIR_ERR_MEMORY;
    else if (status == PIR_OK) {
        status = check(body, &boxes, found);
        pir_boxes_finish(&boxes, a);
    }
    PIR_FREE(a, found, body->part_count);
    PIR_FREE(a, box, body->part_count);
    return status == PIR_OK ? body->space->status : status;
}
