/* SPDX-License-Identifier: MIT */
/*
 * A surface may touch itself: then it could be moved apart by as little as one likes. It crosses itself where the
 * insides of two facets share a segment, or an area; or where sheets of it that meet in a segment (seams.h) have each
 * other's on both sides. What shares single points beside that is apart once those are.
 *
 * So each two convex parts in different planes are held against each other. Both are on both sides of the other's
 * plane, or what they share is in the boundary of one, and seams tell. An edge through the inside of a part is looked
 * for first, since it is the plainer thing to report. Everything is decided by signs of determinants.
 */
#include "solid/body/crossing.h"

#include "base/report.h"
#include "solid/body/seams.h"
#include "solid/space/boxes.h"

static uint32_t corner_count(const pir_shell_body *body, uint32_t part) {
    return body->part_start[part + 1] - body->part_start[part];
}

static uint32_t corner(const pir_shell_body *body, uint32_t part, uint32_t i) {
    const uint32_t count = corner_count(body, part);
    return body->part_corner[body->part_start[part] + (i < count ? i : i - count)];
}

bool pir_shell_body_part_holds(pir_shell_body *body, uint32_t part, uint32_t point) {
    const uint32_t half = pir_shell_body_half(body, body->part_facet[part]);
    for (uint32_t i = 0; i < corner_count(body, part); i++)
        if (pir_space_turn(body->space, half, corner(body, part, i), corner(body, part, i + 1), point) < 0)
            return false;
    return true;
}

bool pir_shell_body_part_has(const pir_shell_body *body, uint32_t part, uint32_t point) {
    for (uint32_t i = body->part_start[part]; i < body->part_start[part + 1]; i++)
        if (body->part_corner[i] == point)
            return true;
    return false;
}

int pir_shell_body_part_side(pir_shell_body *body, uint32_t part, uint32_t point) {
    return pir_shell_body_part_has(body, part, point)
               ? 0
               : pir_space_side(body->space, pir_shell_body_half(body, body->part_facet[part]), point);
}

/* --- edges --- */

/* Whether an edge passes through the inside of a part. */
static bool passes_through(pir_shell_body *body, const pir_shell_body_edge *edge, uint32_t part) {
    const int a = pir_shell_body_part_side(body, part, edge->a);
    if (a == 0 || a * pir_shell_body_part_side(body, part, edge->b) >= 0)
        return false;
    for (uint32_t i = 0; i < corner_count(body, part); i++)
        if (a * pir_space_orient(body->space, edge->a, edge->b, corner(body, part, i), corner(body, part, i + 1)) >= 0)
            return false;
    return true;
}

static pir_status check_edges(pir_shell_body *body, const pir_boxes *boxes, uint32_t *found) {
    for (uint32_t e = 0; e < body->edge_count && body->space->status == PIR_OK; e++) {
        const pir_shell_body_edge *edge = &body->edge[e];
        const pir_seam seam = {edge->a, edge->b, edge->left, edge->right, edge->direction, true};
        pir_space_box box = PIR_SPACE_BOX_EMPTY;
        pir_space_box_add(&box, &body->space->point[edge->a]);
        pir_space_box_add(&box, &body->space->point[edge->b]);
        for (uint32_t i = 0, count = pir_boxes_find(boxes, &box, found); i < count; i++)
            if (passes_through(body, edge, found[i]) && body->space->status == PIR_OK)
                return pir_seam_refuse(body, &seam, body->part_facet[found[i]]);
    }
    return body->space->status;
}

/* --- parts --- */

/* Where the line of two planes leaves what of a part is above the other's plane, and where it comes to it: sides of the
 * part, each from a corner above to one that is not. */
struct passage {
    uint32_t leave[2], enter[2];
};

/* False where the part is not on both sides of the plane of `other`. */
static bool find_passage(pir_shell_body *body, uint32_t part, uint32_t other, struct passage *ret_passage) {
    const uint32_t count = corner_count(body, part);
    const int first = pir_shell_body_part_side(body, other, corner(body, part, 0));
    bool above = false, below = false;
    int from = first;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t p = corner(body, part, i), q = corner(body, part, i + 1);
        const int to = i + 1 < count ? pir_shell_body_part_side(body, other, q) : first;
        if (from > 0 && to <= 0) {
            ret_passage->leave[0] = p;
            ret_passage->leave[1] = q;
        } else if (from <= 0 && to > 0) {
            ret_passage->enter[0] = q;
            ret_passage->enter[1] = p;
        }
        above = above || from > 0;
        below = below || from < 0;
        from = to;
    }
    return above && below;
}

/*
 * Whether the insides of two parts share a segment. Let n and m be the normals of p and q, and the line of their
 * planes lead along n × m. What of q is above p is left of the line, so q is on it from `leave` to `enter`; and p from
 * `enter` to `leave`. The determinant of two of these sides is negative where the one of p is farther along the line.
 */
static bool cross(pir_shell_body *body, uint32_t p, uint32_t q) {
    struct passage of_p = {{0}, {0}}, of_q = {{0}, {0}};
    if (!find_passage(body, q, p, &of_q) || !find_passage(body, p, q, &of_p))
        return false;
    return pir_space_orient(body->space, of_q.leave[0], of_q.leave[1], of_p.leave[0], of_p.leave[1]) < 0 &&
           pir_space_orient(body->space, of_q.enter[0], of_q.enter[1], of_p.enter[0], of_p.enter[1]) > 0;
}

static pir_status refuse_facets(const pir_shell_body *body, uint32_t facet, uint32_t other) {
    char where[PIR_BODY_WHERE], beside[PIR_BODY_WHERE];
    return pir_fail(body->source.report, PIR_ERR_FORMAT, "%s: the surface meets itself: this facet crosses %s",
                    pir_shell_body_where(&body->source, facet, where),
                    pir_shell_body_where(&body->source, other, beside));
}

static pir_status check_parts(pir_shell_body *body, const pir_boxes *boxes, const pir_space_box *box, uint32_t *found) {
    for (uint32_t p = 0; p < body->part_count && body->space->status == PIR_OK; p++) {
        const uint32_t facet = body->part_facet[p];
        for (uint32_t i = 0, count = pir_boxes_find(boxes, &box[p], found); i < count; i++) {
            const uint32_t q = found[i], other = body->part_facet[q];
            if (q > p && body->half[facet] >> 1 != body->half[other] >> 1 && cross(body, p, q) &&
                body->space->status == PIR_OK)
                return refuse_facets(body, facet, other);
        }
    }
    return body->space->status;
}

/* --- all --- */

pir_status pir_shell_body_check_crossing(pir_shell_body *body) {
    const pir_allocator *a = &body->space->allocator;
    pir_space_box *box = PIR_NEW(a, pir_space_box, body->part_count);
    uint32_t *found = PIR_NEW(a, uint32_t, body->part_count);
    pir_status status = box && found ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t p = 0; p < body->part_count && status == PIR_OK; p++) {
        box[p] = PIR_SPACE_BOX_EMPTY;
        for (uint32_t i = 0; i < corner_count(body, p); i++)
            pir_space_box_add(&box[p], &body->space->point[corner(body, p, i)]);
    }
    pir_boxes boxes;
    if (status == PIR_OK && !pir_boxes_init(&boxes, a, box, body->part_count))
        status = PIR_ERR_MEMORY;
    else if (status == PIR_OK) {
        status = check_edges(body, &boxes, found);
        if (status == PIR_OK)
            status = pir_seams_check(body, &boxes, found);
        if (status == PIR_OK)
            status = check_parts(body, &boxes, box, found);
        pir_boxes_finish(&boxes, a);
    }
    PIR_FREE(a, found, body->part_count);
    PIR_FREE(a, box, body->part_count);
    return status == PIR_OK ? body->space->status : status;
}
