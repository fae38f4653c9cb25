/* SPDX-License-Identifier: MIT */
/* See distance.h. */
#include "oracle/distance.h"

#include <stdlib.h>

#include <pirouette/exact.h>

static void *need(void *memory) {
    if (!memory)
        abort();
    return memory;
}

static void vector_init(mpq_t v[3]) {
    for (int k = 0; k < 3; k++)
        mpq_init(v[k]);
}

static void vector_clear(mpq_t v[3]) {
    for (int k = 0; k < 3; k++)
        mpq_clear(v[k]);
}

static void vector_sub(mpq_t r[3], mpq_t a[3], mpq_t b[3]) {
    for (int k = 0; k < 3; k++)
        mpq_sub(r[k], a[k], b[k]);
}

static void vector_dot(mpq_t r, mpq_t a[3], mpq_t b[3]) {
    mpq_t term;
    mpq_init(term);
    mpq_set_ui(r, 0, 1);
    for (int k = 0; k < 3; k++) {
        mpq_mul(term, a[k], b[k]);
        mpq_add(r, r, term);
    }
    mpq_clear(term);
}

static void vector_cross(mpq_t r[3], mpq_t a[3], mpq_t b[3]) {
    mpq_t term;
    mpq_init(term);
    for (int k = 0; k < 3; k++) {
        mpq_mul(r[k], a[(k + 1) % 3], b[(k + 2) % 3]);
        mpq_mul(term, a[(k + 2) % 3], b[(k + 1) % 3]);
        mpq_sub(r[k], r[k], term);
    }
    mpq_clear(term);
}

void oracle_body_init(oracle_body *body, const pir_polytope *polytope) {
    uint32_t corners = 0;
    *body =
        (oracle_body){.vertices = pir_polytope_vertex_count(polytope), .facets = pir_polytope_facet_count(polytope)};
    body->at = need(malloc(body->vertices * sizeof *body->at));
    body->normal = need(malloc(body->facets * sizeof *body->normal));
    body->start = need(malloc((body->facets + 1) * sizeof *body->start));
    for (uint32_t f = 0; f < body->facets; f++)
        corners += pir_polytope_facet_size(polytope, f);
    body->corner = need(malloc(corners * sizeof *body->corner));
    for (uint32_t v = 0; v < body->vertices; v++) {
        vector_init(body->at[v]);
        pir_polytope_vertex_exact(polytope, v, body->at[v]);
    }
    mpq_t one[3], two[3];
    vector_init(one);
    vector_init(two);
    body->start[0] = 0;
    for (uint32_t f = 0; f < body->facets; f++) {
        uint32_t *corner = body->corner + body->start[f];
        body->start[f + 1] = body->start[f] + pir_polytope_facet_size(polytope, f);
        pir_polytope_facet(polytope, f, corner);
        vector_init(body->normal[f]);
        vector_sub(one, body->at[corner[1]], body->at[corner[0]]);
        vector_sub(two, body->at[corner[2]], body->at[corner[1]]);
        vector_cross(body->normal[f], one, two);
    }
    vector_clear(one);
    vector_clear(two);
}

void oracle_body_clear(oracle_body *body) {
    for (uint32_t v = 0; v < body->vertices; v++)
        vector_clear(body->at[v]);
    for (uint32_t f = 0; f < body->facets; f++)
        vector_clear(body->normal[f]);
    free(body->at);
    free(body->normal);
    free(body->start);
    free(body->corner);
}

/* The height of a point over a facet's plane, times the length of its normal. */
static void height_over(mpq_t r, const oracle_body *body, uint32_t facet, mpq_t point[3]) {
    mpq_t d[3];
    vector_init(d);
    vector_sub(d, point, body->at[body->corner[body->start[facet]]]);
    vector_dot(r, body->normal[facet], d);
    vector_clear(d);
}

const char *oracle_body_is_convex(const oracle_body *body) {
    const char *wrong = NULL;
    mpq_t height;
    mpq_init(height);
    for (uint32_t f = 0; f < body->facets; f++)
        for (uint32_t v = 0; v < body->vertices; v++) {
            height_over(height, body, f, body->at[v]);
            int is_corner = 0;
            for (uint32_t i = body->start[f]; i < body->start[f + 1]; i++)
                is_corner |= body->corner[i] == v;
            if (is_corner && mpq_sgn(height) != 0)
                wrong = "a facet is not planar";
            if (!is_corner && mpq_sgn(height) >= 0)
                wrong = "a vertex is not below a facet that it is no corner of";
        }
    mpq_clear(height);
    return wrong;
}

/* The square of the distance from a point to the segment from a to b. */
static void distance_to_segment(mpq_t r, mpq_t point[3], mpq_t a[3], mpq_t b[3]) {
    mpq_t d[3], p[3], t, length;
    vector_init(d);
    vector_init(p);
    mpq_inits(t, length, NULL);
    vector_sub(d, b, a);
    vector_sub(p, point, a);
    vector_dot(t, p, d);
    vector_dot(length, d, d);
    // the foot at a + t·d, t kept in [0, 1]
    mpq_div(t, t, length);
    if (mpq_sgn(t) < 0)
        mpq_set_ui(t, 0, 1);
    if (mpq_cmp_ui(t, 1, 1) > 0)
        mpq_set_ui(t, 1, 1);
    for (int k = 0; k < 3; k++) {
        mpq_mul(d[k], d[k], t);
        mpq_sub(p[k], p[k], d[k]);
    }
    vector_dot(r, p, p);
    vector_clear(d);
    vector_clear(p);
    mpq_clears(t, length, NULL);
}

/* Whether the point lies inside all sides of a facet, seen along its normal. */
static int is_over_facet(const oracle_body *body, uint32_t facet, mpq_t point[3]) {
    uint32_t n = body->start[facet + 1] - body->start[facet];
    const uint32_t *corner = body->corner + body->start[facet];
    mpq_t side[3], to[3], turn[3], sign;
    vector_init(side);
    vector_init(to);
    vector_init(turn);
    mpq_init(sign);
    int inside = 1;
    for (uint32_t i = 0; i < n && inside; i++) {
        vector_sub(side, body->at[corner[(i + 1) % n]], body->at[corner[i]]);
        vector_sub(to, point, body->at[corner[i]]);
        vector_cross(turn, side, to);
        vector_dot(sign, turn, body->normal[facet]);
        inside = mpq_sgn(sign) >= 0;
    }
    vector_clear(side);
    vector_clear(to);
    vector_clear(turn);
    mpq_clear(sign);
    return inside;
}

void oracle_distance_squared(mpq_t ret_square, const oracle_body *body, mpq_t point[3]) {
    mpq_t height, square, length;
    mpq_inits(height, square, length, NULL);
    int outside = 0;
    mpq_set_ui(ret_square, 0, 1);
    for (uint32_t f = 0; f < body->facets; f++) {
        height_over(height, body, f, point);
        if (mpq_sgn(height) <= 0)
            continue;
        // outside of this facet's plane: the nearest point may be the foot on the facet, or lie on one of its sides
        uint32_t n = body->start[f + 1] - body->start[f];
        if (is_over_facet(body, f, point)) {
            mpq_mul(square, height, height);
            vector_dot(length, body->normal[f], body->normal[f]);
            mpq_div(square, square, length);
            if (!outside || mpq_cmp(square, ret_square) < 0)
                mpq_set(ret_square, square);
            outside = 1;
        }
        for (uint32_t i = 0; i < n; i++) {
            const uint32_t *corner = body->corner + body->start[f];
            distance_to_segment(square, point, body->at[corner[i]], body->at[corner[(i + 1) % n]]);
            if (!outside || mpq_cmp(square, ret_square) < 0)
                mpq_set(ret_square, square);
            outside = 1;
        }
    }
    mpq_clears(height, square, length, NULL);
}

int oracle_is_within(const oracle_body *a, const oracle_body *b, double bound) {
    mpq_t square, most;
    mpq_inits(square, most, NULL);
    mpq_set_d(most, bound);
    mpq_mul(most, most, most);
    int within = 1;
    for (uint32_t v = 0; v < a->vertices && within; v++) {
        oracle_distance_squared(square, b, a->at[v]);
        within = mpq_cmp(square, most) <= 0;
    }
    mpq_clears(square, most, NULL);
    return within;
}
