/* SPDX-License-Identifier: MIT */
/*
 * See outer.h. The first planes are those of a tetrahedron around the body. In each round the corners that are farthest
 * from the body are cut off, one at first, then an eighth of those that are there. A corner is cut by the plane of a
 * facet at the feature that is nearest to it: the one that it is farthest beyond. Distance from a convex body is
 * greatest at a corner, so theirs bound the error.
 *
 * That the polytope holds the body is proven at the end, vertex by vertex and exactly. Where rounding has moved a
 * corner inwards, all are moved outwards more and measured again.
 *
 * Where doubles have no such polytope, a tetrahedron around the body's box is one: a poor one, but of few vertices.
 */
#include "simplify/outer.h"

#include "simplify/farthest.h"
#include "simplify/half_spaces.h"

/* By how much corners are moved outwards at first, and at most. */
#define PUSH      0x1p-46
#define PUSH_MOST 2.0

/* The planes that there are before any facet's. */
#define FIRST_PLANES 4

struct cutting {
    pir_measure *measure;
    pir_polytope *body;
    pir_half_spaces spaces;
    bool *used;         /* per facet of the body */
    pir_far_point *far; /* corners and their distances */
    uint32_t *nearest;  /* per corner the facet that cuts it off, PIR_NO_FACET where none does */
    uint32_t room, far_count;
    double push;
    pir_polytope *outer;
    double error;
};

#define NO_FACET UINT32_MAX

/* A corner of a facet. */
static pir_vec3 on_facet(const pir_polytope *body, uint32_t facet) {
    return body->vertex[body->origin[body->loop[body->loop_start[facet]]]];
}

/* Takes the facet where the point is farther beyond it than beyond the best one. */
static void try_facet(const struct cutting *c, uint32_t facet, pir_vec3 point, uint32_t *best, double *most) {
    if (c->used[facet])
        return;
    double beyond = pir_half_spaces_beyond(&c->spaces, c->body->normal[facet], on_facet(c->body, facet), point);
    if (beyond > *most) {
        *most = beyond;
        *best = facet;
    }
}

/* The facet at a feature of the body that cuts off the point. */
static uint32_t facet_at(const struct cutting *c, pir_feature feature, pir_vec3 point) {
    const pir_polytope *b = c->body;
    uint32_t best = NO_FACET;
    double most = 0;
    if (feature.kind == PIR_FEATURE_FACET)
        try_facet(c, feature.index, point, &best, &most);
    if (feature.kind == PIR_FEATURE_EDGE) {
        uint32_t half = b->edge_half[feature.index];
        try_facet(c, b->left[half], point, &best, &most);
        try_facet(c, pir_right(b, half), point, &best, &most);
    }
    if (feature.kind == PIR_FEATURE_VERTEX)
        for (uint32_t h = b->ring_start[feature.index]; h < b->ring_start[feature.index + 1]; h++)
            try_facet(c, b->left[h], point, &best, &most);
    return best;
}

/* How far the corners of a polytope are from the body, and which facets cut them off. */
static pir_status measure_all(struct cutting *c, const pir_polytope *outer) {
    c->error = 0;
    c->far_count = 0;
    for (uint32_t v = 0; v < outer->vertex_count; v++) {
        pir_measured measured;
        pir_status status = pir_measure_point(c->measure, outer->vertex[v], &measured);
        if (status != PIR_OK)
            return status;
        c->error = fmax(c->error, measured.distance);
        c->nearest[v] = facet_at(c, measured.nearest, outer->vertex[v]);
        if (c->nearest[v] != NO_FACET)
            c->far[c->far_count++] = (pir_far_point){outer->vertex[v], measured.distance, v};
    }
    return PIR_OK;
}

/* Makes the polytope of the planes. *ret_fits is false, and nothing else changes, where it has too many corners. */
static pir_status rebuild(struct cutting *c, bool *ret_fits) {
    pir_polytope *outer = NULL;
    pir_status status = pir_half_spaces_polytope(&c->spaces, c->push, &c->body->allocator, &outer);
    *ret_fits = status == PIR_OK && outer->vertex_count <= c->room;
    if (*ret_fits) {
        pir_polytope_release(c->outer);
        c->outer = pir_polytope_retain(outer);
        status = measure_all(c, outer);
    }
    pir_polytope_release(outer);
    return status;
}

/* Adds the planes that cut off up to `most` of the farthest corners. Returns how many. */
static uint32_t cut(struct cutting *c, uint32_t most) {
    uint32_t taken = pir_farthest_first(c->far, c->far_count, most), added = 0;
    for (uint32_t i = 0; i < taken; i++) {
        uint32_t facet = c->nearest[c->far[i].index];
        if (c->used[facet] || !pir_half_spaces_add(&c->spaces, c->body->normal[facet], on_facet(c->body, facet)))
            continue;
        c->used[facet] = true;
        added++;
    }
    return added;
}

/* Cuts until the error is met, no corner can be cut, or there is no room for one more. */
static pir_status cut_all(struct cutting *c, double error) {
    bool fits;
    uint32_t batch = 1;
    pir_status status = rebuild(c, &fits);
    while (status == PIR_OK && c->error > error) {
        uint32_t before = c->spaces.count, added = cut(c, batch);
        if (added == 0)
            break;
        status = rebuild(c, &fits);
        batch = c->outer->vertex_count / 8 > 1 ? c->outer->vertex_count / 8 : 1;
        if (fits || status != PIR_OK)
            continue;
        // too many corners: fewer planes, or the end. A plane that did not fit is not tried again.
        c->spaces.count = before;
        batch = added / 2;
        if (batch == 0)
            break;
    }
    return status;
}

/* Whether the polytope holds the body, exactly. */
static pir_status ask_holds(struct cutting *c, bool *ret_holds) {
    pir_status status = PIR_OK;
    *ret_holds = true;
    for (uint32_t v = 0; v < c->body->vertex_count && status == PIR_OK && *ret_holds; v++)
        status = pir_measure_holds(c->measure, c->outer, c->body, v, ret_holds);
    return status == PIR_OK ? pir_measure_aim(c->measure, c->body) : status;
}

/* Moves corners outwards until the polytope holds the body. Where too many come apart, it stays as it is. */
static pir_status prove(struct cutting *c) {
    bool holds, fits;
    pir_status status = ask_holds(c, &holds);
    while (status == PIR_OK && !holds) {
        c->push *= 4;
        status = c->push > PUSH_MOST ? PIR_ERR_EMPTY : rebuild(c, &fits);
        if (status == PIR_OK)
            status = ask_holds(c, &holds);
    }
    return status;
}

/* --- a tetrahedron --- */

/* The least corner of a tetrahedron around a box along one axis, and how long its side is there. */
struct box_side {
    double from, length;
};

static struct box_side side_around(double low, double high) {
    // a point of the box is less than a quarter of each side beyond the corner, so the parts add up to less than 1
    double apart = high - low, reach = fmax(fabs(low), fabs(high));
    double more = apart * 0x1p-8 + reach * 0x1p-50 + 0x1p-1070;
    return (struct box_side){low - more, 4 * (apart + 2 * more)};
}

/* A tetrahedron around the body's box. PIR_ERR_LIMIT where its corners are beyond the doubles. */
static pir_status surround(struct cutting *c) {

    const pir_polytope_options options = {.size = sizeof options, .allocator = &c->body->allocator};
    pir_vec3 low, high, corner[4];
    pir_polytope_bounds(c->body, &low, &high);
    struct box_side x = side_around(low.x, high.x), y = side_around(low.y, high.y), z = side_around(low.z, high.z);
    for (int i = 0; i < 4; i++) {
        corner[i] = (pir_vec3){x.from + (i == 1 ? x.length : 0), y.from + (i == 2 ? y.length : 0),
                               z.from + (i == 3 ? z.length : 0)};
        if (!pir_vec_is_finite(corner[i]))
            return PIR_ERR_LIMIT;
    }
    pir_polytope_release(c->outer);
    c->outer = NULL;
    bool holds = false;
    pir_status status = pir_polytope_create(corner, 4, &options, &c->outer);
    if (status == PIR_OK)
        status = ask_holds(c, &holds);
    if (status == PIR_OK)
        status = holds ? measure_all(c, c->outer) : PIR_ERR_LIMIT;
    return status;
}

/* --- the call --- */

/* The planes of a tetrahedron around the body. */
static bool begin(struct cutting *c) {
    static const pir_vec3 normals[FIRST_PLANES] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (int i = 0; i < FIRST_PLANES; i++) {
        // in units of the body's box, so that the tetrahedron is as flat as the body
        pir_vec3 u = c->spaces.unit, n = {normals[i].x / u.x, normals[i].y / u.y, normals[i].z / u.z};
        uint32_t farthest = 0;
        for (uint32_t v = 1; v < c->body->vertex_count; v++)
            if (pir_half_spaces_beyond(&c->spaces, n, c->body->vertex[farthest], c->body->vertex[v]) > 0)
                farthest = v;
        if (!pir_half_spaces_add(&c->spaces, n, c->body->vertex[farthest]))
            return false;
    }
    return true;
}

static pir_status run(struct cutting *c, double error) {
    pir_status status = begin(c) ? pir_measure_aim(c->measure, c->body) : PIR_ERR_EMPTY;
    if (status == PIR_OK)
        status = cut_all(c, error);
    return status == PIR_OK ? prove(c) : status;
}

pir_status pir_simplify_outer(pir_measure *measure, pir_polytope *body, uint32_t most, double error,
                              pir_polytope **ret_outer, double *ret_error) {
    const pir_allocator *a = &body->allocator;
    struct cutting c = {.measure = measure, .body = body, .room = most, .push = PUSH};
    // where corners are not bounded: all facets, and the four planes of the beginning, have fewer corners than this
    uint32_t corners = 2 * (body->facet_count + FIRST_PLANES);
    c.room = c.room < corners ? c.room : corners;
    bool made = pir_half_spaces_init(&c.spaces, body, body->facet_count + FIRST_PLANES),
         fits = body->vertex_count <= most;
    c.used = PIR_ZEROED(a, bool, body->facet_count);
    c.far = PIR_NEW(a, pir_far_point, c.room);
    c.nearest = PIR_NEW(a, uint32_t, c.room);
    pir_status status = made && c.used && c.far && c.nearest ? run(&c, error) : PIR_ERR_MEMORY;
    if (status == PIR_ERR_EMPTY && !fits)
        status = surround(&c);
    // where doubles have no such polytope, or none of fewer vertices, the body itself is one
    bool itself = fits && (status == PIR_ERR_EMPTY ||
                           (status == PIR_OK && (c.error > error || c.outer->vertex_count >= body->vertex_count)));
    if (itself || status == PIR_OK) {
        *ret_outer = pir_polytope_retain(itself ? body : c.outer);
        *ret_error = itself ? 0 : c.error;
        status = PIR_OK;
    }
    pir_polytope_release(c.outer);
    PIR_FREE(a, c.nearest, c.room);
    PIR_FREE(a, c.far, c.room);
    PIR_FREE(a, c.used, body->facet_count);
    pir_half_spaces_finish(&c.spaces, body);
    return status;
}
