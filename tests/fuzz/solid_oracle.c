/* SPDX-License-Identifier: MIT */
/*
 * See solid_oracle.h. A point is inside when a ray from it passes through an odd number of facets that are not
 * two-sided. A ray that meets an edge is replaced by another.
 */
#include "fuzz/solid_oracle.h"

#include <stdlib.h>

#include <pirouette/exact.h>

typedef mpq_t place[3];

/* Scratch of one call, made and cleared at once. */
struct oracle {
    const pir_mesh *mesh;
    place *vertex;
    place from, way; /* a ray */
    place normal, u, v, hit;
    mpq_t s, t;
};

static void difference(place ret, place a, place b) {
    for (int k = 0; k < 3; k++)
        mpq_sub(ret[k], a[k], b[k]);
}

static void dot(mpq_t ret, place a, place b) {
    mpq_t product;
    mpq_init(product);
    mpq_mul(ret, a[0], b[0]);
    for (int k = 1; k < 3; k++) {
        mpq_mul(product, a[k], b[k]);
        mpq_add(ret, ret, product);
    }
    mpq_clear(product);
}

static void add_cross(mpq_t *ret, mpq_t *a, mpq_t *b) {
    mpq_t product;
    mpq_init(product);
    for (int k = 0; k < 3; k++) {
        mpq_mul(product, a[(k + 1) % 3], b[(k + 2) % 3]);
        mpq_add(ret[k], ret[k], product);
        mpq_mul(product, a[(k + 2) % 3], b[(k + 1) % 3]);
        mpq_sub(ret[k], ret[k], product);
    }
    mpq_clear(product);
}

static void begin(struct oracle *o, const pir_mesh *mesh) {
    const uint32_t count = pir_mesh_vertex_count(mesh);
    o->mesh = mesh;
    o->vertex = malloc((count + 1) * sizeof *o->vertex);
    if (!o->vertex)
        exit(2);
    place *const scratch[6] = {&o->from, &o->way, &o->normal, &o->u, &o->v, &o->hit};
    for (int k = 0; k < 3; k++) {
        for (uint32_t i = 0; i < count; i++)
            mpq_init(o->vertex[i][k]);
        for (int i = 0; i < 6; i++)
            mpq_init((*scratch[i])[k]);
    }
    mpq_inits(o->s, o->t, NULL);
    for (uint32_t i = 0; i < count; i++)
        pir_mesh_vertex_exact(mesh, i, o->vertex[i]);
}

static void finish(struct oracle *o) {
    place *const scratch[6] = {&o->from, &o->way, &o->normal, &o->u, &o->v, &o->hit};
    for (int k = 0; k < 3; k++) {
        for (uint32_t i = 0; i < pir_mesh_vertex_count(o->mesh); i++)
            mpq_clear(o->vertex[i][k]);
        for (int i = 0; i < 6; i++)
            mpq_clear((*scratch[i])[k]);
    }
    mpq_clears(o->s, o->t, NULL);
    free(o->vertex);
}

void oracle_volume(const pir_mesh *mesh, mpq_t ret_volume) {
    struct oracle o;
    begin(&o, mesh);
    mpq_set_ui(ret_volume, 0, 1);
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        for (uint32_t i = 1; i + 1 < count; i++) {
            for (int k = 0; k < 3; k++)
                mpq_set_ui(o.u[k], 0, 1);
            add_cross(o.u, o.vertex[corner[i]], o.vertex[corner[i + 1]]);
            dot(o.s, o.u, o.vertex[corner[0]]);
            mpq_add(ret_volume, ret_volume, o.s);
        }
    }
    mpq_set_ui(o.t, 6, 1);
    mpq_div(ret_volume, ret_volume, o.t);
    finish(&o);
}

/* Newell's normal. */
static void set_normal(struct oracle *o, const uint32_t *corner, uint32_t count) {
    for (int k = 0; k < 3; k++)
        mpq_set_ui(o->normal[k], 0, 1);
    for (uint32_t i = 0; i < count; i++)
        add_cross(o->normal, o->vertex[corner[i]], o->vertex[corner[i + 1 < count ? i + 1 : 0]]);
}

/* Whether `hit` is on the segment from a to b. */
static int is_on(struct oracle *o, uint32_t a, uint32_t b) {
    difference(o->u, o->hit, o->vertex[a]);
    difference(o->v, o->vertex[b], o->vertex[a]);
    dot(o->s, o->u, o->v);
    dot(o->t, o->v, o->v);
    if (mpq_sgn(o->s) < 0 || mpq_cmp(o->s, o->t) > 0)
        return 0;
    place cross;
    for (int k = 0; k < 3; k++)
        mpq_init(cross[k]);
    add_cross(cross, o->u, o->v);
    const int on = mpq_sgn(cross[0]) == 0 && mpq_sgn(cross[1]) == 0 && mpq_sgn(cross[2]) == 0;
    for (int k = 0; k < 3; k++)
        mpq_clear(cross[k]);
    return on;
}

enum { BESIDE, WITHIN, ON_EDGE };

/* Where `hit`, in the plane of a facet with `normal`, is: seen along an axis that the normal is not square to. */
static int look(struct oracle *o, const uint32_t *corner, uint32_t count) {
    int axis = 0, within = 0;
    while (mpq_sgn(o->normal[axis]) == 0)
        axis++;
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t a = corner[i], b = corner[i + 1 < count ? i + 1 : 0];
        if (is_on(o, a, b))
            return ON_EDGE;
        const int from = mpq_cmp(o->vertex[a][y], o->hit[y]) > 0, to = mpq_cmp(o->vertex[b][y], o->hit[y]) > 0;
        if (from == to)
            continue;
        // which side of the line from a to b, upwards, it is on
        mpq_sub(o->u[0], o->vertex[b][x], o->vertex[a][x]);
        mpq_sub(o->u[1], o->hit[y], o->vertex[a][y]);
        mpq_mul(o->s, o->u[0], o->u[1]);
        mpq_sub(o->u[0], o->vertex[b][y], o->vertex[a][y]);
        mpq_sub(o->u[1], o->hit[x], o->vertex[a][x]);
        mpq_mul(o->t, o->u[0], o->u[1]);
        within ^= (mpq_cmp(o->s, o->t) > 0) == to;
    }
    return within ? WITHIN : BESIDE;
}

static int is_boundary(struct oracle *o) {
    uint32_t count;
    for (int k = 0; k < 3; k++)
        mpq_set(o->hit[k], o->from[k]);
    for (uint32_t f = 0; f < pir_mesh_facet_count(o->mesh); f++) {
        const uint32_t *corner = pir_mesh_facet(o->mesh, f, &count);
        set_normal(o, corner, count);
        difference(o->u, o->hit, o->vertex[corner[0]]);
        dot(o->s, o->u, o->normal);
        if (mpq_sgn(o->s) == 0 && look(o, corner, count) != BESIDE)
            return 1;
    }
    const uint32_t *end = pir_mesh_segments(o->mesh, &count);
    for (uint32_t i = 0; i < count; i++)
        if (is_on(o, end[2 * i], end[2 * i + 1]))
            return 1;
    const uint32_t *point = pir_mesh_points(o->mesh, &count);
    for (uint32_t i = 0; i < count; i++)
        if (mpq_equal(o->hit[0], o->vertex[point[i]][0]) && mpq_equal(o->hit[1], o->vertex[point[i]][1]) &&
            mpq_equal(o->hit[2], o->vertex[point[i]][2]))
            return 1;
    return 0;
}

/* Whether the ray passes through an odd number of facets; −1 where it meets an edge. */
static int is_odd(struct oracle *o) {
    int odd = 0;
    for (uint32_t f = 0; f < pir_mesh_facet_count(o->mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(o->mesh, f, &count);
        if (pir_mesh_facet_kind(o->mesh, f) == PIR_FACET_TWO_SIDED)
            continue;
        set_normal(o, corner, count);
        difference(o->u, o->vertex[corner[0]], o->from);
        dot(o->s, o->u, o->normal);
        dot(o->t, o->way, o->normal);
        if (mpq_sgn(o->t) == 0)
            continue;
        mpq_div(o->s, o->s, o->t);
        if (mpq_sgn(o->s) < 0)
            continue;
        for (int k = 0; k < 3; k++) {
            mpq_mul(o->hit[k], o->s, o->way[k]);
            mpq_add(o->hit[k], o->hit[k], o->from[k]);
        }
        const int where = look(o, corner, count);
        if (where == ON_EDGE)
            return -1;
        odd ^= where == WITHIN;
    }
    return odd;
}

pir_state oracle_state(const pir_mesh *mesh, pir_vec3 point) {
    struct oracle o;
    const double x[3] = {point.x, point.y, point.z};
    begin(&o, mesh);
    for (int k = 0; k < 3; k++)
        mpq_set_d(o.from[k], x[k]);
    int odd = -1;
    pir_state state = PIR_BOUNDARY;
    if (!is_boundary(&o)) {
        for (long n = 1; odd < 0; n++) {
            mpq_set_si(o.way[0], 1000003 + n * n, 1);
            mpq_set_si(o.way[1], 777 * n + 31, 1);
            mpq_set_si(o.way[2], 5003 * n + 7, 1);
            odd = is_odd(&o);
        }
        state = odd ? PIR_INSIDE : PIR_OUTSIDE;
    }
    finish(&o);
    return state;
}
