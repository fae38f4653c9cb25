/* SPDX-License-Identifier: MIT */
/*
 * Halfedges find their twins in the order of their ends. Where the surface touches itself along an edge, more than two
 * have the same ends. Around the edge, material and outside take turns then, facet by facet, and the two facets with
 * material between them are joined: so the surface is that of a body that would come apart there. A facet with a slit
 * walks it both ways and is its own neighbour along it.
 */
#include "solid/body/twins.h"

#include "base/report.h"
#include "base/sort.h"
#include "solid/space/polygons.h"

static void ends_of(const pir_shell_body *body, uint32_t half, uint32_t ends[2]) {
    const uint32_t a = body->origin[half], b = body->origin[body->next[half]];
    ends[0] = a < b ? a : b;
    ends[1] = a < b ? b : a;
}

static bool half_before(void *context, uint32_t a, uint32_t b) {
    uint32_t x[2], y[2];
    ends_of(context, a, x);
    ends_of(context, b, y);
    return x[0] != y[0] ? x[0] < y[0] : x[1] < y[1];
}

/* Refuses the edge of `half`, one of `count` with its ends; `other` is another of them, or the same. */
static pir_status refuse_edge(const pir_shell_body *body, uint32_t half, uint32_t other, uint32_t count) {
    const pir_shell_body_source *source = &body->source;
    char where[PIR_BODY_WHERE], beside[PIR_BODY_WHERE], a[PIR_BODY_WHERE], b[PIR_BODY_WHERE];
    pir_shell_body_where(source, body->facet[half], where);
    pir_shell_body_place(body, body->origin[half], a);
    pir_shell_body_place(body, body->origin[body->next[half]], b);
    if (count == 1)
        return pir_fail(source->report, PIR_ERR_NOT_CLOSED,
                        "%s: the surface is open: the edge from %s to %s is on 1 "
                        "facet",
                        where, a, b);
    pir_shell_body_where(source, body->facet[other], beside);
    if (count == 2)
        return pir_fail(source->report, PIR_ERR_NOT_CLOSED,
                        "%s: this facet and %s walk the edge from %s to %s the same "
                        "way",
                        where, beside, a, b);
    return pir_fail(source->report, PIR_ERR_NOT_CLOSED, "%s: the edge from %s to %s is on %u facets, %s among them",
                    where, a, b, (unsigned)count, beside);
}

static void join_halves(pir_shell_body *body, uint32_t a, uint32_t b) {
    body->twin[a] = b;
    body->twin[b] = a;
    pir_shell_body_edge *edge = &body->edge[body->edge_count++];
    *edge = (pir_shell_body_edge){.half = a < b ? a : b};
    edge->a = body->origin[edge->half];
    edge->b = body->origin[body->next[edge->half]];
    edge->left = body->facet[edge->half];
    edge->right = body->facet[body->twin[edge->half]];
}

/* --- several facets round an edge --- */

/* Half-planes through an edge, counter-clockwise from that of the halfedge `first`. A facet lies left of its halfedges,
 * so its half-plane is a quarter turn behind its normal where they lead along the edge, and behind the reverse of the
 * normal where they lead back. */
struct fan {
    const pir_shell_body *body;
    uint32_t first, along; /* a halfedge; the direction that it leads in */
};

/* 1 where a halfedge leads along the edge, −1 where it leads back. */
static int way_of(const struct fan *fan, uint32_t half) {
    return fan->body->origin[half] == fan->body->origin[fan->first] ? 1 : -1;
}

static uint32_t normal_of(const struct fan *fan, uint32_t half) {
    const pir_shell_body *body = fan->body;
    return body->space->plane[body->plane[body->facet[half]]].direction[0];
}

/* The sign of the turn from the half-plane of a to that of b. */
static int turn_between(const struct fan *fan, uint32_t a, uint32_t b) {
    const int turn = pir_space_det(fan->body->space, normal_of(fan, a), normal_of(fan, b), fan->along);
    return way_of(fan, a) * way_of(fan, b) * turn;
}

/* The half-turn that a half-plane is in: 0 for the first itself, 1 up to its reverse, 2 for that, 3 beyond. */
static int part_of(const struct fan *fan, uint32_t half) {
    const int turn = turn_between(fan, fan->first, half);
    if (turn != 0)
        return turn > 0 ? 1 : 3;
    const int same = pir_space_dot(fan->body->space, normal_of(fan, fan->first), normal_of(fan, half));
    return way_of(fan, half) * same > 0 ? 0 : 2;
}

static bool is_earlier(void *context, uint32_t a, uint32_t b) {
    const struct fan *fan = context;
    const int part_a = part_of(fan, a), part_b = part_of(fan, b);
    return part_a != part_b ? part_a < part_b : turn_between(fan, a, b) > 0;
}

/* Joins the halfedges order[0 .. count), an even number, around the edge that they have in common: each that leads back
 * has material ahead of it. `work` has room for as many. */
static pir_status join_around(pir_shell_body *body, uint32_t *order, uint32_t *work, uint32_t count) {
    struct fan fan = {body, order[0], 0};
    fan.along = pir_polygons_direction(body->space, body->origin[order[0]], body->origin[body->next[order[0]]]);
    pir_sort(order, count, work, is_earlier, &fan);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t next = order[i + 1 < count ? i + 1 : 0];
        if (way_of(&fan, order[i]) == way_of(&fan, next) || (i + 1 < count && !is_earlier(&fan, order[i], next)))
            return refuse_edge(body, order[i], next, count);
    }
    for (uint32_t i = 0; i < count; i++)
        if (way_of(&fan, order[i]) < 0)
            join_halves(body, order[i], order[i + 1 < count ? i + 1 : 0]);
    return body->space->status;
}

/* --- all --- */

/* A side that a facet walks back at once leads to no hole. */
static pir_status refuse_spur(const pir_shell_body *body, uint32_t half) {
    char where[PIR_BODY_WHERE], a[PIR_BODY_WHERE], b[PIR_BODY_WHERE];
    return pir_fail(body->source.report, PIR_ERR_NOT_CLOSED,
                    "%s: this facet walks from %s to %s and back, and no hole is there",
                    pir_shell_body_where(&body->source, body->facet[half], where),
                    pir_shell_body_place(body, body->origin[half], a),
                    pir_shell_body_place(body, body->origin[body->next[half]], b));
}

/* Joins the halfedges order[0 .. count), which have the same ends. */
static pir_status join_group(pir_shell_body *body, uint32_t *order, uint32_t *work, uint32_t count) {
    if (count > 2 && count % 2 == 0)
        return join_around(body, order, work, count);
    if (count != 2 || body->origin[order[0]] == body->origin[order[1]])
        return refuse_edge(body, order[0], order[count > 1], count);
    for (int k = 0; k < 2; k++)
        if (body->next[order[k]] == order[1 - k])
            return refuse_spur(body, order[k]);
    join_halves(body, order[0], order[1]);
    return PIR_OK;
}

pir_status pir_shell_body_find_twins(pir_shell_body *body) {
    const pir_allocator *a = &body->space->allocator;
    const uint32_t count = body->half_count;
    uint32_t *order = PIR_NEW(a, uint32_t, count), *work = PIR_NEW(a, uint32_t, count);
    pir_status status = order && work ? PIR_OK : PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        for (uint32_t h = 0; h < count; h++)
            order[h] = h;
        pir_sort(order, count, work, half_before, body);
    }
    for (uint32_t i = 0, end; i < count && status == PIR_OK; i = end) {
        for (end = i + 1; end < count && !half_before(body, order[i], order[end]); end++)
            ;
        status = join_group(body, order + i, work, end - i);
    }
    PIR_FREE(a, work, count);
    PIR_FREE(a, order, count);
    return status;
}
