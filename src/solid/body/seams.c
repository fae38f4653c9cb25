/* SPDX-License-Identifier: MIT */
/*
 * See seams.h. About a seam, its two sheets are half-planes that its line bounds. A part that holds a stretch of it in
 * its inside is two half-planes there, opposite each other; another seam along it, two as well. Two pairs of
 * half-planes can be moved apart where those of one are both on one side of the other pair, and none coincide.
 *
 * The seams within a facet are the diagonals that cut it into parts, where they are within it: one that passes over
 * straight corners may lie along its sides.
 */
#include "solid/body/seams.h"

#include <math.h>

#include "base/report.h"
#include "solid/body/crossing.h"
#include "solid/space/exact.h"
#include "solid/space/polygons.h"

struct seams {
    pir_shell_body *body;
    pir_seam *seam;
    uint32_t count, room;
    uint32_t *place, place_count, place_room; /* scratch: points along a diagonal */
};

pir_status pir_seam_refuse(const pir_shell_body *body, const pir_seam *seam, uint32_t facet) {
    char where[PIR_BODY_WHERE], beside[PIR_BODY_WHERE], a[PIR_BODY_WHERE], b[PIR_BODY_WHERE];
    pir_shell_body_where(&body->source, seam->left, where);
    pir_shell_body_where(&body->source, facet, beside);
    if (!seam->edge)
        return pir_fail(body->source.report, PIR_ERR_FORMAT, "%s: the surface meets itself: this facet meets %s", where,
                        beside);
    return pir_fail(body->source.report, PIR_ERR_FORMAT,
                    "%s: the surface meets itself: the edge from %s to %s of this facet meets %s", where,
                    pir_shell_body_place(body, seam->a, a), pir_shell_body_place(body, seam->b, b), beside);
}

/* --- which there are --- */

static void push(struct seams *seams, pir_seam seam) {
    if (pir_space_grow(seams->body->space, (void **)&seams->seam, &seams->room, seams->count, sizeof *seams->seam))
        seams->seam[seams->count++] = seam;
}

static bool is_on_line(pir_shell_body *body, const pir_seam *seam, uint32_t point) {
    return point == seam->a || point == seam->b ||
           pir_space_turn(body->space, pir_shell_body_half(body, seam->left), seam->a, seam->b, point) == 0;
}

/* Whether a side of the facet covers the stretch of a diagonal from x to y, within which it has no corner. */
static bool is_side(pir_shell_body *body, const pir_seam *seam, uint32_t x, uint32_t y) {
    pir_space *space = body->space;
    const uint32_t first = body->source.start[seam->left], end = body->source.start[seam->left + 1];
    for (uint32_t h = first; h < end; h++) {
        const uint32_t p = body->origin[h], q = body->origin[h + 1 < end ? h + 1 : first];
        if (!is_on_line(body, seam, p) || !is_on_line(body, seam, q))
            continue;
        const bool along = pir_space_order(space, seam->direction, p, q) > 0;
        if (pir_space_order(space, seam->direction, along ? p : q, x) >= 0 &&
            pir_space_order(space, seam->direction, y, along ? q : p) >= 0)
            return true;
    }
    return false;
}

/* The corners of the facet on a diagonal, in their order from a to b, into `place`. */
static void list_places(struct seams *seams, const pir_seam *seam) {
    pir_shell_body *body = seams->body;
    pir_space *space = body->space;
    seams->place_count = 0;
    for (uint32_t h = body->source.start[seam->left]; h < body->source.start[seam->left + 1]; h++) {
        const uint32_t point = body->origin[h];
        if (!is_on_line(body, seam, point) || pir_space_order(space, seam->direction, seam->a, point) < 0 ||
            pir_space_order(space, seam->direction, point, seam->b) < 0 ||
            !pir_space_grow(space, (void **)&seams->place, &seams->place_room, seams->place_count,
                            sizeof *seams->place))
            continue;
        uint32_t at = seams->place_count++;
        for (; at > 0 && pir_space_order(space, seam->direction, point, seams->place[at - 1]) > 0; at--)
            seams->place[at] = seams->place[at - 1];
        seams->place[at] = point;
    }
}

/* Whether other corners of the facet than the ends are on the line of a diagonal. */
static bool passes_over_corners(pir_shell_body *body, const pir_seam *seam) {
    for (uint32_t h = body->source.start[seam->left]; h < body->source.start[seam->left + 1]; h++)
        if (body->origin[h] != seam->a && body->origin[h] != seam->b && is_on_line(body, seam, body->origin[h]))
            return true;
    return false;
}

/* Adds the stretches of a diagonal that are within its facet. */
static void push_diagonal(struct seams *seams, pir_seam seam) {
    pir_shell_body *body = seams->body;
    if (!passes_over_corners(body, &seam)) {
        push(seams, seam);
        return;
    }
    seam.direction = pir_polygons_direction(body->space, seam.a, seam.b);
    list_places(seams, &seam);
    for (uint32_t i = 0; i + 1 < seams->place_count && body->space->status == PIR_OK; i++) {
        pir_seam stretch = seam;
        stretch.a = seams->place[i];
        stretch.b = seams->place[i + 1];
        if (stretch.a != stretch.b && !is_side(body, &seam, stretch.a, stretch.b))
            push(seams, stretch);
    }
}

static void list_seams(struct seams *seams) {
    const pir_shell_body *body = seams->body;
    for (uint32_t e = 0; e < body->edge_count; e++) {
        const pir_shell_body_edge *edge = &body->edge[e];
        push(seams, (pir_seam){edge->a, edge->b, edge->left, edge->right, edge->direction, true});
    }
    for (uint32_t h = body->source.start[body->source.facet_count]; h < body->half_count; h++) {
        const uint32_t a = body->origin[h], b = body->origin[body->twin[h]], facet = body->facet[h];
        if (body->next[h] != PIR_SPACE_NONE && h < body->twin[h] && a != b)
            push_diagonal(seams, (pir_seam){a, b, facet, facet, PIR_SPACE_NONE, false});
    }
}

/* Whether a seam is within the facets of one plane that flat edges join. */
static bool is_inner(const pir_shell_body *body, const pir_seam *seam) {
    return body->group[seam->left] == body->group[seam->right];
}

/* --- half-planes about a seam --- */

static uint32_t normal_of(const pir_shell_body *body, uint32_t facet) {
    return body->space->plane[body->plane[facet]].direction[0];
}

static uint32_t direction_of(pir_shell_body *body, pir_seam *seam) {
    if (seam->direction == PIR_SPACE_NONE)
        seam->direction = pir_polygons_direction(body->space, seam->a, seam->b);
    return seam->direction;
}

/* That of a facet with this normal, which is left of the line, or right of it with the way −1. */
struct sheet {
    uint32_t normal;
    int way;
};

/* The sign of the turn from one to the other about a direction, and where the second is seen from the first: 0 there,
 * 1 up to opposite, 2 there, 3 beyond. */
static int turn_of(pir_shell_body *body, uint32_t along, struct sheet from, struct sheet to) {
    return from.way * to.way * pir_space_det(body->space, from.normal, to.normal, along);
}

static int place_of(pir_shell_body *body, uint32_t along, struct sheet from, struct sheet to) {
    const int turn = turn_of(body, along, from, to);
    if (turn != 0)
        return turn > 0 ? 1 : 3;
    return from.way * to.way * pir_space_dot(body->space, from.normal, to.normal) > 0 ? 0 : 2;
}

/* Whether a sheet is between two others: 1, or beyond them: 0; −1 where it is one of them. */
static int is_between(pir_shell_body *body, uint32_t along, const struct sheet pair[2], struct sheet sheet) {
    const int at = place_of(body, along, pair[0], sheet), last = place_of(body, along, pair[0], pair[1]);
    if (at == 0)
        return -1;
    if (at != last)
        return at < last;
    const int turn = turn_of(body, along, sheet, pair[1]);
    return turn == 0 ? -1 : turn > 0;
}

/* --- a seam and a part --- */

/* Whether a seam in the plane of a part passes through its inside: no side of the part and not the seam itself
 * separates them. */
static bool passes_within(pir_shell_body *body, const pir_seam *seam, uint32_t part) {
    const uint32_t half = pir_shell_body_half(body, body->part_facet[part]);
    const uint32_t first = body->part_start[part], end = body->part_start[part + 1];
    bool left = false, right = false;
    for (uint32_t i = first; i < end; i++) {
        const uint32_t p = body->part_corner[i], q = body->part_corner[i + 1 < end ? i + 1 : first];
        if (pir_space_turn(body->space, half, p, q, seam->a) <= 0 &&
            pir_space_turn(body->space, half, p, q, seam->b) <= 0)
            return false;
        const int side = pir_space_turn(body->space, half, seam->a, seam->b, p);
        left = left || side > 0;
        right = right || side < 0;
    }
    return left && right;
}

/* Whether the sheets of a seam within a part are on both sides of it, or in its plane. */
static bool is_cut(pir_shell_body *body, pir_seam *seam, uint32_t part) {
    const uint32_t along = direction_of(body, seam), normal = normal_of(body, body->part_facet[part]);
    const int left = pir_space_det(body->space, normal, normal_of(body, seam->left), along);
    const int right = -pir_space_det(body->space, normal, normal_of(body, seam->right), along);
    return left * right <= 0;
}

static bool cross_part(pir_shell_body *body, pir_seam *seam, uint32_t part) {
    const uint32_t group = body->group[body->part_facet[part]];
    const bool own = body->group[seam->left] == group || body->group[seam->right] == group;
    if (own && is_inner(body, seam))
        return false;
    return (own || (pir_shell_body_part_side(body, part, seam->a) == 0 &&
                    pir_shell_body_part_side(body, part, seam->b) == 0)) &&
           passes_within(body, seam, part) && is_cut(body, seam, part);
}

/* --- two seams --- */

/*
 * Whether the cross product of u and v, whose coordinates are each wrong by `error` at most, is certainly not zero. Of
 * its two products each is wrong by error · (|u| + |v| + error); both and their difference round by 4 · 2^-53 of
 * |u| · |v|. The bound is twice that.
 */
static bool is_certain(const double u[3], const double v[3], double error) {
    double size[2] = {0, 0};
    for (int k = 0; k < 3; k++) {
        size[0] = fmax(size[0], fabs(u[k]));
        size[1] = fmax(size[1], fabs(v[k]));
    }
    const double bound = 4 * error * (size[0] + size[1] + error) + 0x1p-50 * size[0] * size[1];
    for (int k = 0; k < 3; k++)
        if (fabs(u[k] * v[(k + 1) % 3] - u[(k + 1) % 3] * v[k]) > bound)
            return true;
    return false;
}

/* Whether the other seam is certainly not on the line of the first. */
static bool is_apart(const pir_shell_body *body, const pir_seam *seam, const pir_seam *other) {
    const pir_space_point *point = body->space->point, *a = &point[seam->a], *b = &point[seam->b];
    const pir_space_point *end[2] = {&point[other->a], &point[other->b]};
    // coordinates are at most 1, so differences round by 2^-53
    const double error = 2 * (a->err + b->err + end[0]->err + end[1]->err) + 0x1p-52;
    double u[3], v[2][3];
    for (int k = 0; k < 3; k++) {
        u[k] = b->x[k] - a->x[k];
        v[0][k] = end[0]->x[k] - a->x[k];
        v[1][k] = end[1]->x[k] - a->x[k];
    }
    return is_certain(u, v[0], error) || is_certain(u, v[1], error);
}

/* Whether two seams that begin at one point certainly lead to different sides of it. */
static bool lead_apart(const pir_shell_body *body, const pir_seam *seam, const pir_seam *other) {
    const pir_space_point *point = body->space->point;
    const bool at_a = seam->a == other->a || seam->a == other->b, at_b = seam->b == other->a || seam->b == other->b;
    if (at_a == at_b)
        return false;
    const uint32_t shared = at_a ? seam->a : seam->b;
    const pir_space_point *from = &point[shared], *to = &point[at_a ? seam->b : seam->a];
    const pir_space_point *beside = &point[other->a == shared ? other->b : other->a];
    const double error = 2 * (from->err + to->err + beside->err) + 0x1p-52;
    for (int k = 0; k < 3; k++) {
        const double x = to->x[k] - from->x[k], y = beside->x[k] - from->x[k];
        if (fabs(x) > error && fabs(y) > error && (x > 0) != (y > 0))
            return true;
    }
    return false;
}

static bool is_on_seam_line(pir_shell_body *body, const pir_seam *seam, uint32_t point) {
    pir_space *space = body->space;
    mpz_t *a = space->number + space->point[seam->a].exact, *c = space->number + space->point[point].exact;
    mpz_t *u = space->number + space->direction[seam->direction].exact, *t = space->t;
    for (int k = 0; k < 3; k++)
        mpz_sub(t[3 + k], c[k], a[k]);
    pir_numbers_cross(t, u, t + 3);
    return mpz_sgn(t[0]) == 0 && mpz_sgn(t[1]) == 0 && mpz_sgn(t[2]) == 0;
}

/* Whether two seams share a stretch. */
static bool overlap(pir_shell_body *body, pir_seam *seam, pir_seam *other, int *ret_way) {
    if (lead_apart(body, seam, other) || is_apart(body, seam, other))
        return false;
    pir_space *space = body->space;
    const uint32_t along = direction_of(body, seam);
    if (space->status != PIR_OK || !is_on_seam_line(body, seam, other->a) || !is_on_seam_line(body, seam, other->b))
        return false;
    *ret_way = pir_space_order(space, along, other->a, other->b);
    const uint32_t low = *ret_way > 0 ? other->a : other->b, high = *ret_way > 0 ? other->b : other->a;
    return pir_space_order(space, along, seam->a, high) > 0 && pir_space_order(space, along, low, seam->b) > 0;
}

static bool cross_seam(pir_shell_body *body, pir_seam *seam, pir_seam *other) {
    const bool same_ends = (seam->a == other->a && seam->b == other->b) || (seam->a == other->b && seam->b == other->a);
    int way = 1;
    // round edges with the same ends facets have been put in order
    if ((same_ends && seam->edge && other->edge) || !overlap(body, seam, other, &way))
        return false;
    if (is_inner(body, seam) && is_inner(body, other) && body->group[seam->left] == body->group[other->left])
        return false;
    const struct sheet pair[2] = {{normal_of(body, seam->left), 1}, {normal_of(body, seam->right), -1}};
    const struct sheet left = {normal_of(body, other->left), way}, right = {normal_of(body, other->right), -way};
    const int first = is_between(body, seam->direction, pair, left);
    return first < 0 || first != is_between(body, seam->direction, pair, right);
}

/* --- all --- */

static pir_space_box box_of(const pir_shell_body *body, const pir_seam *seam) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    pir_space_box_add(&box, &body->space->point[seam->a]);
    pir_space_box_add(&box, &body->space->point[seam->b]);
    return box;
}

/* Refuses a seam that crosses what is near it: parts, or seams that come after it. */
static pir_status check(struct seams *seams, const pir_boxes *boxes, bool of_parts, uint32_t *found) {
    pir_shell_body *body = seams->body;
    for (uint32_t s = 0; s < seams->count && body->space->status == PIR_OK; s++) {
        pir_seam *seam = &seams->seam[s];
        const pir_space_box box = box_of(body, seam);
        for (uint32_t i = 0, count = pir_boxes_find(boxes, &box, found); i < count; i++) {
            const uint32_t o = found[i];
            const bool crosses =
                of_parts ? cross_part(body, seam, o) : o > s && cross_seam(body, seam, &seams->seam[o]);
            if (crosses && body->space->status == PIR_OK)
                return pir_seam_refuse(body, seam, of_parts ? body->part_facet[o] : seams->seam[o].left);
        }
    }
    return body->space->status;
}

static pir_status check_pairs(struct seams *seams) {
    const pir_allocator *a = &seams->body->space->allocator;
    pir_space_box *box = PIR_NEW(a, pir_space_box, seams->count);
    uint32_t *found = PIR_NEW(a, uint32_t, seams->count);
    pir_boxes boxes;
    pir_status status = box && found ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t s = 0; s < seams->count && status == PIR_OK; s++)
        box[s] = box_of(seams->body, &seams->seam[s]);
    if (status == PIR_OK && !pir_boxes_init(&boxes, a, box, seams->count))
        status = PIR_ERR_MEMORY;
    else if (status == PIR_OK) {
        status = check(seams, &boxes, false, found);
        pir_boxes_finish(&boxes, a);
    }
    PIR_FREE(a, found, seams->count);
    PIR_FREE(a, box, seams->count);
    return status;
}

pir_status pir_seams_check(pir_shell_body *body, const pir_boxes *boxes, uint32_t *found) {
    struct seams seams = {.body = body};
    list_seams(&seams);
    pir_status status = body->space->status;
    if (status == PIR_OK)
        status = check(&seams, boxes, true, found);
    if (status == PIR_OK)
        status = check_pairs(&seams);
    pir_space_shrink(body->space, seams.seam, seams.room, sizeof *seams.seam);
    pir_space_shrink(body->space, seams.place, seams.place_room, sizeof *seams.place);
    return status;
}
