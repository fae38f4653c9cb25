/* SPDX-License-Identifier: MIT */
/* See place_oracle.h. */
#include "place_oracle.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/exact.h>

typedef mpq_t vec[3];

struct place_oracle {
    pir_mesh *mesh;
    uint32_t vertices, facets;
    vec *vertex;
    vec *normal;
    vec t, a, b, c, d;
    mpq_t x, y, z, best;
};

static void vec_init(mpq_t *v) {
    mpq_inits(v[0], v[1], v[2], NULL);
}

static void vec_clear(mpq_t *v) {
    mpq_clears(v[0], v[1], v[2], NULL);
}

static void vec_sub(mpq_t *r, mpq_t *a, mpq_t *b) {
    for (int k = 0; k < 3; k++)
        mpq_sub(r[k], a[k], b[k]);
}

static void vec_dot(mpq_t r, mpq_t *a, mpq_t *b) {
    mpq_t part;
    mpq_init(part);
    mpq_mul(r, a[0], b[0]);
    for (int k = 1; k < 3; k++) {
        mpq_mul(part, a[k], b[k]);
        mpq_add(r, r, part);
    }
    mpq_clear(part);
}

static void vec_cross(mpq_t *r, mpq_t *a, mpq_t *b) {
    mpq_t part;
    mpq_init(part);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        mpq_mul(r[k], a[i], b[j]);
        mpq_mul(part, a[j], b[i]);
        mpq_sub(r[k], r[k], part);
    }
    mpq_clear(part);
}

static void die(const char *what) {
    fprintf(stderr, "place oracle: %s\n", what);
    exit(1);
}

place_oracle *place_oracle_make(pir_polytope *p, pir_polytope *q, pir_quat rotation) {
    place_oracle *o = calloc(1, sizeof *o);
    pir_sum_options options = pir_sum_options_default();
    options.difference = 1;
    if (!o || pir_hull_sum(p, q, rotation, &options, PIR_EXACT, &o->mesh) != PIR_OK)
        die("no hull");
    o->vertices = pir_mesh_vertex_count(o->mesh);
    o->facets = pir_mesh_facet_count(o->mesh);
    o->vertex = calloc(o->vertices, sizeof *o->vertex);
    o->normal = calloc(o->facets + 1, sizeof *o->normal);
    if (!o->vertex || !o->normal)
        die("no memory");
    vec *work[5] = {&o->t, &o->a, &o->b, &o->c, &o->d};
    for (int i = 0; i < 5; i++)
        vec_init(*work[i]);
    mpq_inits(o->x, o->y, o->z, o->best, NULL);
    for (uint32_t v = 0; v < o->vertices; v++) {
        vec_init(o->vertex[v]);
        pir_mesh_vertex_exact(o->mesh, v, o->vertex[v]);
    }
    for (uint32_t f = 0; f < o->facets; f++) {
        uint32_t n;
        const uint32_t *loop = pir_mesh_facet(o->mesh, f, &n);
        vec_init(o->normal[f]);
        vec_sub(o->a, o->vertex[loop[1]], o->vertex[loop[0]]);
        vec_sub(o->b, o->vertex[loop[2]], o->vertex[loop[1]]);
        vec_cross(o->normal[f], o->a, o->b);
    }
    return o;
}

void place_oracle_free(place_oracle *o) {
    for (uint32_t v = 0; v < o->vertices; v++)
        vec_clear(o->vertex[v]);
    for (uint32_t f = 0; f < o->facets; f++)
        vec_clear(o->normal[f]);
    vec *work[5] = {&o->t, &o->a, &o->b, &o->c, &o->d};
    for (int i = 0; i < 5; i++)
        vec_clear(*work[i]);
    mpq_clears(o->x, o->y, o->z, o->best, NULL);
    pir_mesh_destroy(o->mesh);
    free(o->vertex);
    free(o->normal);
    free(o);
}

/* sqrt of a rational, in 256 bits, rounded. */
static double root(mpq_t square) {
    mpf_t f;
    mpf_init2(f, 256);
    mpf_set_q(f, square);
    mpf_sqrt(f, f);
    double r = mpf_get_d(f);
    mpf_clear(f);
    return r;
}

static void set_t(place_oracle *o, pir_vec3 t) {
    mpq_set_d(o->t[0], t.x);
    mpq_set_d(o->t[1], t.y);
    mpq_set_d(o->t[2], t.z);
}

/* The slack n·(v − t) of facet f into o->x. */
static void slack(place_oracle *o, uint32_t f) {
    uint32_t n;
    const uint32_t *loop = pir_mesh_facet(o->mesh, f, &n);
    vec_sub(o->a, o->vertex[loop[0]], o->t);
    vec_dot(o->x, o->normal[f], o->a);
}

static void take_square(place_oracle *o, mpq_t square) {
    if (mpq_sgn(o->best) < 0 || mpq_cmp(square, o->best) < 0)
        mpq_set(o->best, square);
}

/* The squared distance from t to the segment u–v. */
static void take_segment(place_oracle *o, uint32_t u, uint32_t v) {
    vec_sub(o->a, o->vertex[v], o->vertex[u]);
    vec_sub(o->b, o->t, o->vertex[u]);
    vec_dot(o->x, o->a, o->b);
    vec_dot(o->y, o->a, o->a);
    vec_dot(o->z, o->b, o->b);
    if (mpq_sgn(o->x) <= 0 || mpq_cmp(o->x, o->y) >= 0)
        return;
    mpq_mul(o->x, o->x, o->x);
    mpq_div(o->x, o->x, o->y);
    mpq_sub(o->z, o->z, o->x);
    take_square(o, o->z);
}

/* The squared distance from t to facet f, when the foot is in it. */
static void take_facet(place_oracle *o, uint32_t f) {
    uint32_t n;
    const uint32_t *loop = pir_mesh_facet(o->mesh, f, &n);
    for (uint32_t i = 0; i < n; i++) {
        vec_sub(o->a, o->vertex[loop[(i + 1) % n]], o->vertex[loop[i]]);
        vec_sub(o->b, o->t, o->vertex[loop[i]]);
        vec_cross(o->c, o->normal[f], o->a);
        vec_dot(o->x, o->c, o->b);
        if (mpq_sgn(o->x) < 0)
            return;
    }
    slack(o, f);
    mpq_mul(o->x, o->x, o->x);
    vec_dot(o->y, o->normal[f], o->normal[f]);
    mpq_div(o->x, o->x, o->y);
    take_square(o, o->x);
}

static void find_square(place_oracle *o) {
    mpq_set_si(o->best, -1, 1);
    for (uint32_t v = 0; v < o->vertices; v++) {
        vec_sub(o->a, o->t, o->vertex[v]);
        vec_dot(o->x, o->a, o->a);
        take_square(o, o->x);
    }
    if (o->facets == 0 && o->vertices == 2)
        take_segment(o, 0, 1);
    for (uint32_t f = 0; f < o->facets; f++) {
        uint32_t n;
        const uint32_t *loop = pir_mesh_facet(o->mesh, f, &n);
        for (uint32_t i = 0; i < n; i++)
            if (loop[i] < loop[(i + 1) % n])
                take_segment(o, loop[i], loop[(i + 1) % n]);
        take_facet(o, f);
    }
}

place_answer place_oracle_ask(place_oracle *o, pir_vec3 translation) {
    place_answer answer = {PIR_INSIDE, 0, HUGE_VAL};
    set_t(o, translation);
    bool outside = false, touches = o->facets < 4;
    for (uint32_t f = 0; f < o->facets; f++) {
        slack(o, f);
        outside |= mpq_sgn(o->x) < 0;
        touches |= mpq_sgn(o->x) == 0;
        vec_dot(o->y, o->normal[f], o->normal[f]);
        mpq_mul(o->x, o->x, o->x);
        mpq_div(o->x, o->x, o->y);
        double depth = root(o->x);
        answer.depth = depth < answer.depth ? depth : answer.depth;
    }
    if (outside || o->facets < 4) {
        find_square(o);
        outside = mpq_sgn(o->best) > 0;
        answer.distance = root(o->best);
    }
    answer.state = outside ? PIR_OUTSIDE : touches ? PIR_BOUNDARY : PIR_INSIDE;
    return answer;
}

double place_oracle_slack(place_oracle *o, pir_vec3 translation, pir_vec3 direction) {
    set_t(o, translation);
    vec n;
    vec_init(n);
    mpq_set_d(n[0], direction.x);
    mpq_set_d(n[1], direction.y);
    mpq_set_d(n[2], direction.z);
    bool any = false;
    for (uint32_t v = 0; v < o->vertices; v++) {
        vec_sub(o->a, o->vertex[v], o->t);
        vec_dot(o->x, o->a, n);
        if (!any || mpq_cmp(o->x, o->best) > 0)
            mpq_set(o->best, o->x);
        any = true;
    }
    vec_dot(o->y, n, n);
    double length = root(o->y);
    vec_clear(n);
    mpf_t f;
    mpf_init2(f, 256);
    mpf_set_q(f, o->best);
    double s = mpf_get_d(f) / length;
    mpf_clear(f);
    return s;
}

pir_vec3 place_oracle_vertex(const place_oracle *o, uint32_t index) {
    return pir_mesh_vertices(o->mesh)[index % o->vertices];
}

pir_vec3 place_oracle_on_facet(const place_oracle *o, uint32_t index) {
    if (o->facets == 0)
        return place_oracle_vertex(o, index);
    uint32_t n;
    const uint32_t *loop = pir_mesh_facet(o->mesh, index % o->facets, &n);
    pir_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < n; i++) {
        pir_vec3 v = pir_mesh_vertices(o->mesh)[loop[i]];
        sum = (pir_vec3){sum.x + v.x, sum.y + v.y, sum.z + v.z};
    }
    return (pir_vec3){sum.x / n, sum.y / n, sum.z / n};
}

pir_vec3 place_oracle_on_edge(const place_oracle *o, uint32_t index) {
    if (o->facets == 0)
        return place_oracle_vertex(o, index);
    uint32_t n;
    const uint32_t *loop = pir_mesh_facet(o->mesh, index % o->facets, &n);
    pir_vec3 u = pir_mesh_vertices(o->mesh)[loop[0]], v = pir_mesh_vertices(o->mesh)[loop[1]];
    return (pir_vec3){(u.x + v.x) / 2, (u.y + v.y) / 2, (u.z + v.z) / 2};
}

double place_oracle_size(const place_oracle *o) {
    const pir_vec3 *v = pir_mesh_vertices(o->mesh);
    pir_vec3 low = v[0], high = v[0];
    for (uint32_t i = 1; i < o->vertices; i++) {
        low = (pir_vec3){fmin(low.x, v[i].x), fmin(low.y, v[i].y), fmin(low.z, v[i].z)};
        high = (pir_vec3){fmax(high.x, v[i].x), fmax(high.y, v[i].y), fmax(high.z, v[i].z)};
    }
    return sqrt((high.x - low.x) * (high.x - low.x) + (high.y - low.y) * (high.y - low.y) +
                (high.z - low.z) * (high.z - low.z));
}
