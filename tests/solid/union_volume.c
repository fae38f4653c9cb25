/* SPDX-License-Identifier: MIT */
/*
 * See union_volume.h. Each sum of two pieces is the hull of the sums of their vertices. Of each, what the earlier ones
 * leave is cut off plane by plane, as hulls again, whose volumes add up. Nothing of src/solid but the division into
 * pieces has a part in it.
 */
#include "solid/union_volume.h"

#include <stdlib.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "support/test.h"

#define MOST_BODIES 4096

/* Polytopes with an inside, each with one reference. */
struct bodies {
    pir_polytope *body[MOST_BODIES];
    uint32_t count;
    bool too_long; /* a hull was refused for its numbers, or there are too many bodies */
};

/* Points being collected, to be the vertices of a hull. */
struct points {
    mpq_t *x;
    uint32_t count, room;
};

static void add_point(struct points *points, mpq_t *x) {
    if (points->count == points->room) {
        points->room = 2 * points->room + 16;
        points->x = realloc(points->x, 3 * (size_t)points->room * sizeof *points->x);
        assert_non_null(points->x);
    }
    for (int k = 0; k < 3; k++) {
        mpq_init(points->x[3 * points->count + k]);
        mpq_set(points->x[3 * points->count + k], x[k]);
    }
    points->count++;
}

/* The hull of the points, which are given up: added to the bodies where it has an inside. */
static bool take_hull(struct points *points, struct bodies *bodies) {
    pir_polytope *hull = NULL;
    pir_status status = PIR_OK;
    if (points->count >= 4)
        status = pir_polytope_create_exact((const mpq_t *)points->x, points->count, NULL, &hull);
    for (uint32_t i = 0; i < 3 * points->count; i++)
        mpq_clear(points->x[i]);
    free(points->x);
    *points = (struct points){0};
    const bool has_inside = hull && pir_polytope_dimension(hull) == 3 && bodies->count < MOST_BODIES;
    bodies->too_long = bodies->too_long || status != PIR_OK || bodies->count == MOST_BODIES;
    if (has_inside)
        bodies->body[bodies->count++] = hull;
    else
        pir_polytope_release(hull);
    return has_inside;
}

/* --- cutting --- */

/* a·x + b·y + c·z − d as r; the plane has four numbers. */
static void height_of(mpq_t *plane, mpq_t *x, mpq_t r) {
    mpq_t term;
    mpq_init(term);
    mpq_neg(r, plane[3]);
    for (int k = 0; k < 3; k++) {
        mpq_mul(term, plane[k], x[k]);
        mpq_add(r, r, term);
    }
    mpq_clear(term);
}

/* The plane of a facet, its normal outwards. */
static void plane_of(const pir_polytope *body, uint32_t facet, mpq_t *plane) {
    uint32_t *loop = malloc(pir_polytope_facet_size(body, facet) * sizeof *loop);
    mpq_t v[3][3], term;
    assert_non_null(loop);
    pir_polytope_facet(body, facet, loop);
    mpq_init(term);
    for (int i = 0; i < 3; i++) {
        mpq_inits(v[i][0], v[i][1], v[i][2], NULL);
        pir_polytope_vertex_exact(body, loop[i], v[i]);
        for (int k = 0; k < 3 && i > 0; k++)
            mpq_sub(v[i][k], v[i][k], v[0][k]);
    }
    mpq_set_ui(plane[3], 0, 1);
    for (int k = 0; k < 3; k++) {
        mpq_mul(plane[k], v[1][(k + 1) % 3], v[2][(k + 2) % 3]);
        mpq_mul(term, v[1][(k + 2) % 3], v[2][(k + 1) % 3]);
        mpq_sub(plane[k], plane[k], term);
        mpq_mul(term, plane[k], v[0][k]);
        mpq_add(plane[3], plane[3], term);
    }
    for (int i = 0; i < 3; i++)
        mpq_clears(v[i][0], v[i][1], v[i][2], NULL);
    mpq_clear(term);
    free(loop);
}

/* Adds where an edge of a body passes through a plane, at the heights given. */
static void add_crossing(struct points *points, const pir_polytope *body, const uint32_t ends[2], mpq_t *height) {
    mpq_t p[3], q[3], part;
    mpq_init(part);
    for (int k = 0; k < 3; k++)
        mpq_inits(p[k], q[k], NULL);
    pir_polytope_vertex_exact(body, ends[0], p);
    pir_polytope_vertex_exact(body, ends[1], q);
    mpq_sub(part, height[ends[0]], height[ends[1]]);
    mpq_div(part, height[ends[0]], part);
    for (int k = 0; k < 3; k++) {
        mpq_sub(q[k], q[k], p[k]);
        mpq_mul(q[k], q[k], part);
        mpq_add(q[k], q[k], p[k]);
    }
    add_point(points, q);
    for (int k = 0; k < 3; k++)
        mpq_clears(p[k], q[k], NULL);
    mpq_clear(part);
}

/* Adds the part of a body below a plane, or above it where `keep` is 1, to the bodies; false where it has no inside. */
static bool cut(const pir_polytope *body, mpq_t *plane, int keep, struct bodies *bodies) {
    const uint32_t vertices = pir_polytope_vertex_count(body);
    mpq_t *height = malloc(vertices * sizeof *height), x[3];
    struct points points = {0};
    assert_non_null(height);
    mpq_inits(x[0], x[1], x[2], NULL);
    for (uint32_t v = 0; v < vertices; v++) {
        mpq_init(height[v]);
        pir_polytope_vertex_exact(body, v, x);
        height_of(plane, x, height[v]);
        if (keep * mpq_sgn(height[v]) >= 0)
            add_point(&points, x);
    }
    for (uint32_t e = 0; e < pir_polytope_edge_count(body); e++) {
        uint32_t ends[2];
        pir_polytope_edge(body, e, ends);
        if (mpq_sgn(height[ends[0]]) * mpq_sgn(height[ends[1]]) < 0)
            add_crossing(&points, body, ends, height);
    }
    for (uint32_t v = 0; v < vertices; v++)
        mpq_clear(height[v]);
    free(height);
    mpq_clears(x[0], x[1], x[2], NULL);
    return take_hull(&points, bodies);
}

/* Adds what another body leaves of one: a list of parts, or the whole where their insides do not meet. */
static void subtract(pir_polytope *body, const pir_polytope *other, struct bodies *left) {
    const uint32_t before = left->count;
    struct bodies *rest = calloc(1, sizeof *rest);
    mpq_t plane[4];
    bool meets = true;
    assert_non_null(rest);
    for (int k = 0; k < 4; k++)
        mpq_init(plane[k]);
    rest->body[rest->count++] = pir_polytope_retain(body);
    for (uint32_t f = 0; f < pir_polytope_facet_count(other) && meets; f++) {
        pir_polytope *own = rest->body[--rest->count];
        plane_of(other, f, plane);
        cut(own, plane, 1, left);
        meets = cut(own, plane, -1, rest);
        pir_polytope_release(own);
    }
    left->too_long = left->too_long || rest->too_long;
    if (meets)
        pir_polytope_release(rest->body[0]);
    for (; !meets && left->count > before; left->count--)
        pir_polytope_release(left->body[left->count - 1]);
    if (!meets)
        left->body[left->count++] = pir_polytope_retain(body);
    for (int k = 0; k < 4; k++)
        mpq_clear(plane[k]);
    free(rest);
}

/* --- pairs --- */

/* An entry of M(q) = (2w² − |q|²)·1 + 2·v·vᵀ + 2w·[v]×, for q = (v, w). */
static void matrix_entry(mpq_t *q, mpq_t norm, int i, int k, mpq_t r) {
    mpq_t t;
    mpq_init(t);
    mpq_mul(r, q[i], q[k]);
    mpq_mul(t, q[3], q[i == k ? 3 : 3 - i - k]);
    (i == k || (k - i + 3) % 3 == 2 ? mpq_add : mpq_sub)(r, r, t);
    mpq_add(r, r, r);
    if (i == k)
        mpq_sub(r, r, norm);
    mpq_clear(t);
}

/* A point turned: M(q)·x / |q|². */
static void turn_point(pir_quat turn, mpq_t *x) {
    const double c[4] = {turn.x, turn.y, turn.z, turn.w};
    mpq_t q[4], sum[3], norm, entry;
    mpq_inits(norm, entry, NULL);
    for (int i = 0; i < 4; i++) {
        mpq_init(q[i]);
        mpq_set_d(q[i], c[i]);
        mpq_mul(entry, q[i], q[i]);
        mpq_add(norm, norm, entry);
    }
    for (int i = 0; i < 3; i++) {
        mpq_init(sum[i]);
        for (int k = 0; k < 3; k++) {
            matrix_entry(q, norm, i, k, entry);
            mpq_mul(entry, entry, x[k]);
            mpq_add(sum[i], sum[i], entry);
        }
    }
    for (int i = 0; i < 3; i++) {
        mpq_div(x[i], sum[i], norm);
        mpq_clear(sum[i]);
    }
    for (int i = 0; i < 4; i++)
        mpq_clear(q[i]);
    mpq_clears(norm, entry, NULL);
}

/* The hull of all sums of a vertex of each. */
static void add_pair(const pir_polytope *p, const pir_polytope *q, pir_quat turn, struct bodies *pairs) {
    struct points points = {0};
    mpq_t x[3], y[3];
    for (int k = 0; k < 3; k++)
        mpq_inits(x[k], y[k], NULL);
    for (uint32_t i = 0; i < pir_polytope_vertex_count(p); i++)
        for (uint32_t j = 0; j < pir_polytope_vertex_count(q); j++) {
            pir_polytope_vertex_exact(p, i, x);
            pir_polytope_vertex_exact(q, j, y);
            turn_point(turn, x);
            for (int k = 0; k < 3; k++)
                mpq_add(x[k], x[k], y[k]);
            add_point(&points, x);
        }
    take_hull(&points, pairs);
    for (int k = 0; k < 3; k++)
        mpq_clears(x[k], y[k], NULL);
}

static void add_pairs(const pir_pieces *const pieces[2], pir_quat turn, struct bodies *pairs) {
    for (uint32_t i = 0; i < pir_pieces_count(pieces[0]); i++)
        for (uint32_t j = 0; j < pir_pieces_count(pieces[1]); j++) {
            pir_polytope *a = NULL, *b = NULL;
            if (pir_pieces_polytope(pieces[0], i, &a) == PIR_OK && pir_pieces_polytope(pieces[1], j, &b) == PIR_OK)
                add_pair(a, b, turn, pairs);
            else
                pairs->too_long = true;
            pir_polytope_release(a);
            pir_polytope_release(b);
        }
}

/* --- the union --- */

static void release_all(struct bodies *bodies) {
    for (uint32_t i = 0; i < bodies->count; i++)
        pir_polytope_release(bodies->body[i]);
    bodies->count = 0;
}

static void add_volumes(const struct bodies *bodies, mpq_t sum) {
    mpq_t volume, moment[9];
    mpq_init(volume);
    for (int k = 0; k < 9; k++)
        mpq_init(moment[k]);
    for (uint32_t i = 0; i < bodies->count; i++) {
        assert_int_equal(pir_polytope_mass_exact(bodies->body[i], volume, moment, moment + 3), PIR_OK);
        mpq_add(sum, sum, volume);
    }
    mpq_clear(volume);
    for (int k = 0; k < 9; k++)
        mpq_clear(moment[k]);
}

/* Adds the volume of what of pair k the earlier ones leave. */
static void add_rest(struct bodies *pairs, uint32_t k, mpq_t sum) {
    struct bodies *rest = calloc(1, sizeof *rest), *next = calloc(1, sizeof *next);
    assert_true(rest && next);
    rest->body[rest->count++] = pir_polytope_retain(pairs->body[k]);
    for (uint32_t j = 0; j < k && !pairs->too_long; j++) {
        for (uint32_t i = 0; i < rest->count; i++)
            subtract(rest->body[i], pairs->body[j], next);
        release_all(rest);
        struct bodies *swapped = rest;
        rest = next;
        next = swapped;
        pairs->too_long = pairs->too_long || rest->too_long;
    }
    add_volumes(rest, sum);
    release_all(rest);
    free(rest);
    free(next);
}

bool union_volume(const pir_solid *p, const pir_solid *q, pir_quat turn, uint32_t most, mpq_t ret_volume) {
    pir_pieces *pieces[2] = {NULL, NULL};
    struct bodies *pairs = calloc(1, sizeof *pairs);
    assert_non_null(pairs);
    assert_int_equal(pir_solid_decompose(p, NULL, NULL, &pieces[0]), PIR_OK);
    assert_int_equal(pir_solid_decompose(q, NULL, NULL, &pieces[1]), PIR_OK);
    bool done = pir_pieces_count(pieces[0]) * pir_pieces_count(pieces[1]) <= most;
    mpq_set_ui(ret_volume, 0, 1);
    if (done)
        add_pairs((const pir_pieces *const[]){pieces[0], pieces[1]}, turn, pairs);
    for (uint32_t k = 0; k < pairs->count && !pairs->too_long; k++)
        add_rest(pairs, k, ret_volume);
    done = done && !pairs->too_long;
    release_all(pairs);
    free(pairs);
    pir_pieces_destroy(pieces[0]);
    pir_pieces_destroy(pieces[1]);
    return done;
}
