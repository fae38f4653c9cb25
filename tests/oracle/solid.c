/* SPDX-License-Identifier: MIT */
/* See solid.h. */
#include "oracle/solid.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/*
 * The filter. With a, b, c, d below 1 and within 2^-52 of the exact ones, differences are below 2 and off by 2^-50.4 at
 * most, the cross product's coordinates below 8 and off by 2^-46, and the volume by less than 2^-43.
 */
#define CERTAIN 0x1p-42

/* --- numbers --- */

/* x = m·2^e with m odd or 0. */
static int64_t odd_part(double x, int *ret_exponent) {
    int e;
    int64_t m = (int64_t)ldexp(frexp(x, &e), 53);
    for (e -= 53; m != 0 && m % 2 == 0; e++)
        m /= 2;
    *ret_exponent = e;
    return m;
}

long oracle_unit(const double *x, size_t count, long most) {
    long unit = most;
    for (size_t i = 0; i < count; i++) {
        int e;
        if (odd_part(x[i], &e) != 0 && e < unit)
            unit = e;
    }
    return unit;
}

void oracle_set_double(mpz_t r, double x, long unit) {
    int e;
    mpz_set_si(r, odd_part(x, &e));
    if (mpz_sgn(r) != 0)
        mpz_mul_2exp(r, r, (mp_bitcnt_t)(e - unit));
}

void oracle_near_at(double ret_near[3], oracle_vec from, long exponent) {
    for (int k = 0; k < 3; k++) {
        long e;
        double m = mpz_get_d_2exp(&e, from[k]);
        ret_near[k] = e - exponent < -1000 ? 0 : ldexp(m, (int)(e - exponent));
    }
}

long oracle_near(double ret_near[3], oracle_vec v) {
    long exponent = LONG_MIN;
    for (int k = 0; k < 3; k++) {
        long e;
        if (mpz_sgn(v[k]) != 0 && (mpz_get_d_2exp(&e, v[k]), e > exponent))
            exponent = e;
    }
    oracle_near_at(ret_near, v, exponent == LONG_MIN ? 0 : exponent);
    return exponent;
}

void *oracle_new(size_t count, size_t size) {
    void *at = calloc(count ? count : 1, size);
    if (!at)
        abort();
    return at;
}

void *oracle_grow(void *at, uint32_t count, uint32_t *room, size_t size) {
    if (count < *room)
        return at;
    *room = 2 * *room + 16;
    at = realloc(at, *room * size);
    if (!at)
        abort();
    return at;
}

int oracle_set_has(const oracle_set *set, uint32_t i) {
    return set[i / 64] >> (i % 64) & 1;
}

void oracle_set_put(oracle_set *set, uint32_t i) {
    set[i / 64] |= (oracle_set)1 << (i % 64);
}

/* --- facets --- */

static void cross_near(double n[3], const double u[3], const double v[3]) {
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
}

/* On which sides of the plane through i, j, k vertices certainly lie: 1 above, 2 below, 3 both. */
static int sides_near(const oracle_solid *s, const uint32_t corner[3]) {
    const double *o = s->near[corner[0]];
    double u[3], v[3], n[3];
    for (int c = 0; c < 3; c++) {
        u[c] = s->near[corner[1]][c] - o[c];
        v[c] = s->near[corner[2]][c] - o[c];
    }
    cross_near(n, u, v);
    int sides = 0;
    for (uint32_t i = 0; i < s->count && sides != 3; i++) {
        const double *x = s->near[i];
        double volume = n[0] * (x[0] - o[0]) + n[1] * (x[1] - o[1]) + n[2] * (x[2] - o[2]);
        sides |= volume > CERTAIN ? 1 : volume < -CERTAIN ? 2 : 0;
    }
    return sides;
}

static void add_facet(oracle_solid *s, oracle_vec n, int sign, const oracle_set *set) {
    uint32_t f = s->facet_count, room = s->facet_room;
    s->normal = oracle_grow(s->normal, f, &s->facet_room, sizeof *s->normal);
    s->facet = oracle_grow(s->facet, f, &room, s->words * sizeof *s->facet);
    oracle_vec_init(s->normal[f]);
    for (int k = 0; k < 3; k++)
        if (sign > 0)
            mpz_set(s->normal[f][k], n[k]);
        else
            mpz_neg(s->normal[f][k], n[k]);
    memcpy(&s->facet[f * s->words], set, s->words * sizeof *set);
    s->facet_count++;
}

/* Adds the facet in the plane of three corners when it supports all vertices, exactly. */
static void try_plane(oracle_solid *s, const uint32_t corner[3]) {
    oracle_vec u, v, n;
    mpz_t volume;
    oracle_set *set = oracle_new(s->words, sizeof *set);
    oracle_vec_init(u);
    oracle_vec_init(v);
    oracle_vec_init(n);
    mpz_init(volume);
    oracle_sub(u, s->at[corner[1]], s->at[corner[0]]);
    oracle_sub(v, s->at[corner[2]], s->at[corner[0]]);
    oracle_cross(n, u, v);
    int sides = oracle_is_zero(n) ? 3 : 0;
    for (uint32_t i = 0; i < s->count && sides != 3; i++) {
        oracle_sub(u, s->at[i], s->at[corner[0]]);
        oracle_dot(volume, n, u);
        int sign = mpz_sgn(volume);
        sides |= sign > 0 ? 1 : sign < 0 ? 2 : 0;
        if (sign == 0)
            oracle_set_put(set, i);
    }
    if (sides == 0 || sides == 2)
        add_facet(s, n, 1, set);
    if (sides == 0 || sides == 1)
        add_facet(s, n, -1, set);
    mpz_clear(volume);
    oracle_vec_clear(n);
    oracle_vec_clear(v);
    oracle_vec_clear(u);
    free(set);
}

static bool is_known(const oracle_solid *s, const uint32_t corner[3]) {
    for (uint32_t f = 0; f < s->facet_count; f++) {
        const oracle_set *set = &s->facet[f * s->words];
        if (oracle_set_has(set, corner[0]) && oracle_set_has(set, corner[1]) && oracle_set_has(set, corner[2]))
            return true;
    }
    return false;
}

static void find_facets(oracle_solid *s) {
    for (uint32_t i = 0; i < s->count; i++)
        for (uint32_t j = i + 1; j < s->count; j++)
            for (uint32_t k = j + 1; k < s->count; k++) {
                const uint32_t corner[3] = {i, j, k};
                if (sides_near(s, corner) != 3 && !is_known(s, corner))
                    try_plane(s, corner);
            }
}

/* --- edges --- */

static void add_edge(oracle_solid *s, uint32_t i, uint32_t j) {
    s->edge = oracle_grow(s->edge, s->edge_count, &s->edge_room, sizeof *s->edge);
    s->edge[s->edge_count][0] = i;
    s->edge[s->edge_count][1] = j;
    s->edge_count++;
}

/* Two facets of a solid meet in a face: an edge when they share two vertices. */
static void find_common_edge(oracle_solid *s, uint32_t f, uint32_t g) {
    uint32_t found[3], count = 0;
    for (uint32_t i = 0; i < s->count && count < 3; i++)
        if (oracle_set_has(&s->facet[f * s->words], i) && oracle_set_has(&s->facet[g * s->words], i))
            found[count++] = i;
    if (count == 2)
        add_edge(s, found[0], found[1]);
}

/* Whether all of a polygon lies on one side of the line through i and j. */
static bool is_side(oracle_solid *s, uint32_t i, uint32_t j) {
    oracle_vec e, m, x;
    mpz_t height;
    int sides = 0;
    oracle_vec_init(e);
    oracle_vec_init(m);
    oracle_vec_init(x);
    mpz_init(height);
    oracle_sub(e, s->at[j], s->at[i]);
    oracle_cross(m, s->normal[0], e);
    for (uint32_t v = 0; v < s->count; v++) {
        oracle_sub(x, s->at[v], s->at[i]);
        oracle_dot(height, m, x);
        sides |= mpz_sgn(height) > 0 ? 1 : mpz_sgn(height) < 0 ? 2 : 0;
    }
    mpz_clear(height);
    oracle_vec_clear(x);
    oracle_vec_clear(m);
    oracle_vec_clear(e);
    return sides != 3;
}

static void find_edges(oracle_solid *s) {
    if (s->dimension == 1)
        add_edge(s, 0, 1);
    for (uint32_t i = 0; s->dimension == 2 && i < s->count; i++)
        for (uint32_t j = i + 1; j < s->count; j++)
            if (is_side(s, i, j))
                add_edge(s, i, j);
    for (uint32_t f = 0; s->dimension == 3 && f < s->facet_count; f++)
        for (uint32_t g = f + 1; g < s->facet_count; g++)
            find_common_edge(s, f, g);
}

/* --- making one --- */

static void take_vertices(oracle_solid *s, const pir_polytope *polytope) {
    double(*x)[3] = oracle_new(s->count, sizeof *x);
    for (uint32_t i = 0; i < s->count; i++) {
        pir_vec3 v = pir_polytope_vertex(polytope, i);
        memcpy(x[i], (double[3]){v.x, v.y, v.z}, sizeof x[i]);
    }
    s->unit = oracle_unit(&x[0][0], 3 * (size_t)s->count, 2000);
    long exponent = LONG_MIN;
    oracle_vec_init(s->first);
    for (uint32_t i = 0; i < s->count; i++) {
        oracle_vec_init(s->at[i]);
        for (int k = 0; k < 3; k++)
            oracle_set_double(s->at[i][k], x[i][k], s->unit);
    }
    for (int k = 0; k < 3; k++)
        mpz_swap(s->first[k], s->at[0][k]);
    for (uint32_t i = 1; i < s->count; i++) {
        oracle_sub(s->at[i], s->at[i], s->first);
        long e = oracle_near(s->near[i], s->at[i]);
        exponent = e > exponent ? e : exponent;
    }
    for (uint32_t i = 0; i < s->count; i++)
        oracle_near_at(s->near[i], s->at[i], exponent == LONG_MIN ? 0 : exponent);
    free(x);
}

oracle_solid *oracle_solid_make(const pir_polytope *polytope) {
    oracle_solid *s = oracle_new(1, sizeof *s);
    s->count = pir_polytope_vertex_count(polytope);
    s->words = (s->count + 63) / 64;
    s->at = oracle_new(s->count, sizeof *s->at);
    s->near = oracle_new(s->count, sizeof *s->near);
    take_vertices(s, polytope);
    find_facets(s);
    s->dimension = s->facet_count > 2 ? 3 : s->facet_count == 2 ? 2 : s->count > 1;
    find_edges(s);
    return s;
}

void oracle_solid_free(oracle_solid *s) {
    for (uint32_t i = 0; i < s->count; i++)
        oracle_vec_clear(s->at[i]);
    for (uint32_t f = 0; f < s->facet_count; f++)
        oracle_vec_clear(s->normal[f]);
    oracle_vec_clear(s->first);
    free(s->at);
    free(s->near);
    free(s->normal);
    free(s->facet);
    free(s->edge);
    free(s);
}

/* --- comparing --- */

int oracle_solid_feature(const oracle_solid *s, const pir_polytope *polytope, pir_feature feature,
                         oracle_set *ret_set) {
    memset(ret_set, 0, s->words * sizeof *ret_set);
    uint32_t i = feature.index;
    if (feature.kind == PIR_FEATURE_VERTEX && i < s->count) {
        oracle_set_put(ret_set, i);
        return 1;
    }
    if (feature.kind == PIR_FEATURE_EDGE && i < pir_polytope_edge_count(polytope)) {
        uint32_t end[2];
        pir_polytope_edge(polytope, i, end);
        oracle_set_put(ret_set, end[0]);
        oracle_set_put(ret_set, end[1]);
        return 1;
    }
    if (feature.kind != PIR_FEATURE_FACET || i >= pir_polytope_facet_count(polytope))
        return 0;
    uint32_t size = pir_polytope_facet_size(polytope, i), *corner = oracle_new(size, sizeof *corner);
    pir_polytope_facet(polytope, i, corner);
    for (uint32_t c = 0; c < size; c++)
        oracle_set_put(ret_set, corner[c]);
    free(corner);
    return 1;
}

static bool is_facet(const oracle_solid *s, const oracle_set *set) {
    for (uint32_t f = 0; f < s->facet_count; f++)
        if (memcmp(&s->facet[f * s->words], set, s->words * sizeof *set) == 0)
            return true;
    return false;
}

static bool is_edge(const oracle_solid *s, const uint32_t end[2]) {
    for (uint32_t e = 0; e < s->edge_count; e++)
        if (s->edge[e][0] == end[0] && s->edge[e][1] == end[1])
            return true;
    return false;
}

const char *oracle_solid_compare(const oracle_solid *s, const pir_polytope *polytope) {
    if (pir_polytope_dimension(polytope) != s->dimension)
        return "dimension";
    if (pir_polytope_facet_count(polytope) != s->facet_count || pir_polytope_edge_count(polytope) != s->edge_count)
        return "number of facets or edges";
    const char *wrong = NULL;
    oracle_set *set = oracle_new(s->words, sizeof *set);
    for (uint32_t f = 0; f < s->facet_count; f++)
        if (!oracle_solid_feature(s, polytope, (pir_feature){PIR_FEATURE_FACET, f}, set) || !is_facet(s, set))
            wrong = "a facet";
    free(set);
    for (uint32_t e = 0; e < s->edge_count; e++) {
        uint32_t end[2];
        pir_polytope_edge(polytope, e, end);
        if (!is_edge(s, end))
            wrong = "an edge";
    }
    return wrong;
}
