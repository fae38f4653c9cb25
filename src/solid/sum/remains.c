/* SPDX-License-Identifier: MIT */
/*
 * See remains.h. A candidate has the sum below it; it bounds the sum where the points just above it are in no
 * pair's sum. A pair's sum covers the points of a candidate that are inside it, or in its boundary with its inside
 * above: so the rest is exact, in general position or not. The pairs that hold the candidate's middle deepest come
 * first, since one of them often covers all of it.
 *
 * The sum of open solids is the union of the insides of all pairs' sums: the two points of a sum may be moved, one
 * against the other, off the walls between pieces. Whatever the open sum leaves out within the closed one is where the
 * solids only touch. So near some contact they bound each other, and a candidate holds the point, at the least in its
 * boundary: hence polygons are clipped as closed sets there. Or the contact is between two vertices that are not
 * convex, a fin in a groove, whose sums are looked at one by one. What is left of a candidate and has the closed sum
 * above it is two-sided, and left of a candidate that faces the other way as well.
 */
#include "solid/sum/remains.h"

#include <math.h>

#include "base/sort.h"
#include "solid/space/exact.h"
#include "solid/space/places.h"
#include "solid/sum/convolution.h"

/* Whether a plane of the space is that of a half-space, with the same side below. */
static bool is_plane_of(pir_space *space, uint32_t half, uint32_t plane) {
    return pir_planes_are_one(space, half >> 1, plane) &&
           pir_planes_face_one_way(space, half >> 1, plane) == !(half & 1);
}

/* How deep in a pair's sum the middle of a candidate in the plane of `half` is, or −HUGE_VAL when all of the sum is
 * below that plane, or the candidate is outside of the sum. */
static double depth_of(pir_space *space, pir_pair_sum *pair, uint32_t half, const pir_ball *ball) {
    const pir_space_plane *apart = &space->plane[pair->apart];
    double least = HUGE_VAL;
    if (pir_ball_side(ball, apart, pir_ball_depth(ball, apart)) > 0)
        return -HUGE_VAL;
    for (uint32_t k = pair->first; k < pair->first + pair->count; k++) {
        const pir_space_plane *f = &space->plane[k];
        const double depth = pir_ball_depth(ball, f);
        if (pir_ball_side(ball, f, depth) > 0) {
            pair->apart = k;
            return -HUGE_VAL;
        }
        // another plane through the point costs a look, and one that is missed costs one later
        if (fabs(depth) < 0x1p-40 && is_plane_of(space, half, k)) {
            pair->below = half;
            return -HUGE_VAL;
        }
        least = depth < least ? depth : least;
    }
    return least;
}

static bool deeper(void *context, uint32_t a, uint32_t b) {
    const double *depth = context;
    return depth[a] > depth[b];
}

/* The pairs that may cover a candidate, the deepest first, into `order`. */
static uint32_t find_pairs(pir_remains *c, uint32_t polygon) {
    const pir_polygon p = c->polygons.polygon[polygon];
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    const pir_ball ball = pir_polygons_ball(&c->polygons, polygon);
    for (uint32_t i = 0; i < p.count; i++)
        pir_space_box_add(&box, &c->space->point[c->polygons.point[p.first + i]]);
    const uint32_t found = pir_boxes_find(&c->boxes, &box, c->order);
    uint32_t count = 0;
    for (uint32_t i = 0; i < found; i++) {
        const uint32_t pair = c->order[i];
        if (c->pair[pair].below == p.half)
            continue;
        c->depth[pair] = depth_of(c->space, &c->pair[pair], p.half, &ball);
        if (c->depth[pair] > -HUGE_VAL)
            c->order[count++] = pair;
    }
    pir_sort(c->order, count, c->work, deeper, c->depth);
    return count;
}

static bool list_halves(pir_remains *c, const pir_pair_sum *pair) {
    if (!pir_space_grow(c->space, (void **)&c->half, &c->half_room, pair->count, sizeof *c->half))
        return false;
    for (uint32_t k = 0; k < pair->count; k++)
        c->half[k] = pir_half(pair->first + k, false);
    return true;
}

/* Keeps fragments that are left of a candidate, a polygon of `kept`. */
static void keep(pir_remains *c, uint32_t candidate, const pir_fragments *left, bool two_sided) {
    if (left->count == 0 ||
        !pir_space_grow(c->space, (void **)&c->survivor, &c->survivor_room, c->survivor_count, sizeof *c->survivor))
        return;
    const pir_survivor s = {.half = c->kept.polygon[candidate].half,
                            .count = left->count,
                            .two_sided = two_sided,
                            .polygon = candidate,
                            .first = c->kept.count};
    for (uint32_t i = 0; i < left->count; i++)
        pir_polygons_copy(&c->kept, &c->polygons, left->polygon[i]);
    c->survivor[c->survivor_count++] = s;
}

/* Takes the insides of the pairs' sums, `pairs` of them in `order`, from what `touching` holds. */
static void clip_touching(pir_remains *c, uint32_t pairs) {
    pir_touching *t = &c->touching;
    for (uint32_t i = 0; i < pairs && t->fragments.count + t->segment_count + t->point_count > 0; i++) {
        pir_pair_sum *pair = &c->pair[c->order[i]];
        uint32_t apart = pair->apart - pair->first;
        if (c->space->status != PIR_OK || !list_halves(c, pair))
            return;
        pir_touching_subtract(t, c->half, pair->count, &apart);
        pair->apart = pair->first + apart;
    }
    for (uint32_t i = 0; i < t->segment_count; i++)
        pir_touching_add_segment(&c->left, c->space, t->segment[i]);
    for (uint32_t i = 0; i < t->point_count; i++)
        pir_touching_add_point(&c->left, c->space, t->point[i]);
}

/* Clips a candidate, a polygon of `kept`. */
static void clip(pir_remains *c, uint32_t candidate) {
    const uint32_t polygon = pir_polygons_copy(&c->polygons, &c->kept, candidate);
    if (c->space->status != PIR_OK)
        return;
    const uint32_t pairs = find_pairs(c, polygon);
    c->fragments.count = c->covered.count = 0;
    if (c->open) {
        pir_touching_clear(&c->touching);
        pir_fragments_add(&c->touching.fragments, c->space, polygon);
        clip_touching(c, pairs);
        for (uint32_t i = 0; i < c->touching.fragments.count; i++)
            pir_fragments_add(&c->fragments, c->space, c->touching.fragments.polygon[i]);
    } else {
        pir_fragments_add(&c->fragments, c->space, polygon);
    }
    for (uint32_t i = 0; i < pairs && c->fragments.count > 0 && c->space->status == PIR_OK; i++) {
        pir_pair_sum *pair = &c->pair[c->order[i]];
        uint32_t apart = pair->apart - pair->first;
        if (list_halves(c, pair))
            pir_fragments_subtract(&c->fragments, &c->polygons, c->half, pair->count, c->open ? &c->covered : NULL,
                                   &apart);
        pair->apart = pair->first + apart;
    }
    keep(c, candidate, &c->fragments, false);
    keep(c, candidate, &c->covered, true);
    pir_polygons_truncate(&c->polygons, 0);
}

/* --- vertices that are not convex, of open solids --- */

/* Whether each point of a body is on a reflex edge; NULL when out of memory. */
static bool *list_reflex(const pir_shell_body *body) {
    bool *reflex = PIR_ZEROED(&body->space->allocator, bool, body->source.point_count);
    for (uint32_t e = 0; e < body->edge_count && reflex; e++)
        if (body->edge[e].bend == PIR_BEND_REFLEX)
            reflex[body->edge[e].a - body->first_point] = reflex[body->edge[e].b - body->first_point] = true;
    return reflex;
}

static void take_vertices(pir_remains *c, uint32_t p, uint32_t q) {
    const uint32_t point = pir_space_add_sum(c->space, p, q);
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    if (c->space->status != PIR_OK)
        return;
    pir_space_box_add(&box, &c->space->point[point]);
    pir_touching_clear(&c->touching);
    pir_touching_add_point(&c->touching, c->space, point);
    clip_touching(c, pir_boxes_find(&c->boxes, &box, c->order));
}

static void take_reflex_vertices(pir_remains *c, const pir_shell_body body[2]) {
    bool *reflex[2] = {list_reflex(&body[0]), list_reflex(&body[1])};
    if (!reflex[0] || !reflex[1])
        c->space->status = PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < body[0].source.point_count && c->space->status == PIR_OK; i++)
        for (uint32_t j = 0; j < body[1].source.point_count && reflex[0][i]; j++)
            if (reflex[1][j])
                take_vertices(c, body[0].first_point + i, body[1].first_point + j);
    for (int k = 0; k < 2; k++)
        PIR_FREE(&c->space->allocator, reflex[k], body[k].source.point_count);
}

/* --- all --- */

static bool make_pairs(pir_remains *c, pir_convexes convexes[2]) {
    pir_space_begin_stage(c->space, "adding pairs of pieces", (uint64_t)convexes[0].count * convexes[1].count);
    for (uint32_t i = 0; i < convexes[0].count; i++)
        for (uint32_t j = 0; j < convexes[1].count; j++) {
            if (!pir_space_grow(c->space, (void **)&c->pair, &c->pair_room, c->pair_count, sizeof *c->pair))
                return false;
            c->pair[c->pair_count++] = pir_pair_sum_make(&convexes[0], i, &convexes[1], j);
            c->space->stage.done++;
        }
    const pir_allocator *a = &c->space->allocator;
    pir_space_box *box = PIR_NEW(a, pir_space_box, c->pair_count);
    c->depth = PIR_NEW(a, double, c->pair_count);
    c->order = PIR_NEW(a, uint32_t, c->pair_count);
    c->work = PIR_NEW(a, uint32_t, c->pair_count);
    bool done = box && c->depth && c->order && c->work;
    for (uint32_t i = 0; i < c->pair_count && done; i++)
        box[i] = c->pair[i].box;
    done = done && pir_boxes_init(&c->boxes, a, box, c->pair_count);
    PIR_FREE(a, box, c->pair_count);
    if (!done && c->space->status == PIR_OK)
        c->space->status = PIR_ERR_MEMORY;
    return done;
}

/* Counts a candidate, which stays in `kept`. */
static void take(void *context, uint32_t polygon) {
    (void)polygon;
    ((pir_remains *)context)->candidates++;
}

/* Gives all candidates in one plane one half-space. */
static void join_planes(pir_remains *c) {
    pir_places planes;
    pir_places_init(&planes, c->space);
    for (uint32_t i = 0; i < c->kept.count && c->space->status == PIR_OK; i++)
        c->kept.polygon[i].half = pir_places_half(&planes, c->kept.polygon[i].half);
    pir_places_finish(&planes);
}

static bool is_in_earlier_plane(void *context, uint32_t a, uint32_t b) {
    const pir_polygon *polygon = context;
    return polygon[a].half < polygon[b].half;
}

/* Clips the candidates plane by plane, so that a pair which is below a plane is found to be so once. */
static void clip_all(pir_remains *c) {
    const pir_allocator *a = &c->space->allocator;
    const uint32_t count = c->kept.count;
    uint32_t *order = PIR_NEW(a, uint32_t, count), *work = PIR_NEW(a, uint32_t, count);
    pir_space_begin_stage(c->space, "clipping candidates", count);
    if (order && work) {
        for (uint32_t i = 0; i < count; i++)
            order[i] = i;
        pir_sort(order, count, work, is_in_earlier_plane, c->kept.polygon);
        for (uint32_t i = 0; i < count && c->space->status == PIR_OK; i++, c->space->stage.done++)
            clip(c, order[i]);
    } else {
        c->space->status = PIR_ERR_MEMORY;
    }
    PIR_FREE(a, order, count);
    PIR_FREE(a, work, count);
}

void pir_remains_make(pir_remains *remains, const pir_shell_body body[2], pir_convexes convexes[2], bool open) {
    *remains = (pir_remains){.space = body[0].space, .open = open};
    remains->touching.polygons = &remains->polygons;
    pir_polygons_init(&remains->polygons, remains->space);
    pir_polygons_init(&remains->kept, remains->space);
    if (!make_pairs(remains, convexes))
        return;
    pir_space_begin_stage(remains->space, "listing candidates", 0);
    pir_candidates(&body[0], &body[1], &remains->kept, take, remains);
    join_planes(remains);
    clip_all(remains);
    if (open && remains->space->status == PIR_OK)
        take_reflex_vertices(remains, body);
}

void pir_remains_finish(pir_remains *remains) {
    pir_remains *c = remains;
    if (!c->space)
        return;
    const pir_allocator *a = &c->space->allocator;
    pir_boxes_finish(&c->boxes, a);
    PIR_FREE(a, c->depth, c->pair_count);
    PIR_FREE(a, c->order, c->pair_count);
    PIR_FREE(a, c->work, c->pair_count);
    pir_space_shrink(c->space, c->pair, c->pair_room, sizeof *c->pair);
    pir_space_shrink(c->space, c->half, c->half_room, sizeof *c->half);
    pir_space_shrink(c->space, c->survivor, c->survivor_room, sizeof *c->survivor);
    pir_polygons_finish(&c->polygons);
    pir_polygons_finish(&c->kept);
    pir_fragments_finish(&c->fragments, c->space);
    pir_fragments_finish(&c->covered, c->space);
    pir_touching_finish(&c->touching, c->space);
    pir_touching_finish(&c->left, c->space);
    *c = (pir_remains){0};
}
