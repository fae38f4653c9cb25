/* SPDX-License-Identifier: MIT */
/* Features of a turn in integers: see turned_features.h. */
#include "critical/turned_features.h"

#include <math.h>

#include "base/memory.h"

/* A turned vector's coefficient of k^(2−i), and its components. */
#define AT(i, j) (3 * (i) + (j))

/* --- small parts --- */

void pir_integer_of_double(mpz_t dst, double x, int exponent) {
    int e;
    const uint64_t mantissa = pir_double_split(x, &e);
    mpz_import(dst, 1, -1, sizeof mantissa, 0, 0, &mantissa);
    if (e >= exponent)
        mpz_mul_2exp(dst, dst, (mp_bitcnt_t)(e - exponent));
    else
        mpz_tdiv_q_2exp(dst, dst, (mp_bitcnt_t)(exponent - e));
    if (x < 0)
        mpz_neg(dst, dst);
}

static void set_int(mpz_t dst, const pir_int *a) {
    mpz_import(dst, pir_int_length(a), -1, sizeof(mp_limb_t), 0, 0, a->limb);
    if (a->size < 0)
        mpz_neg(dst, dst);
}

static void set_vector(mpz_t *dst, const pir_int3 *v) {
    for (int k = 0; k < 3; k++)
        set_int(dst[k], &v->c[k]);
}

static void init_all(mpz_t *v, size_t count) {
    for (size_t i = 0; i < count; i++)
        mpz_init(v[i]);
}

static void clear_all(mpz_t *v, size_t count) {
    for (size_t i = 0; v != NULL && i < count; i++)
        mpz_clear(v[i]);
}

/* dst = x·y, and dst = a × b. */
static void dot(mpz_t dst, mpz_t *x, mpz_t *y) {
    mpz_mul(dst, x[0], y[0]);
    mpz_addmul(dst, x[1], y[1]);
    mpz_addmul(dst, x[2], y[2]);
}

static void cross(mpz_t *dst, mpz_t *a, mpz_t *b) {
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(dst[k], a[i], b[j]);
        mpz_submul(dst[k], a[j], b[i]);
    }
}

/* --- making --- */

/* How many integers `count` vectors of a body have. */
static size_t size_of(int body, uint32_t count) {
    return (body == 0 ? 9 : 3) * (size_t)count;
}

static bool make_arrays(pir_turned *turned, int body) {
    const pir_allocator *a = &turned->allocator;
    const pir_polytope *p = turned->body[body];
    pir_body_integers *exact = &turned->exact[body];
    exact->normal = PIR_NEW(a, mpz_t, size_of(body, p->facet_count));
    exact->edge = PIR_NEW(a, mpz_t, size_of(body, p->edge_count));
    exact->point = PIR_NEW(a, mpz_t, size_of(body, p->vertex_count));
    exact->offset = PIR_NEW(a, mpz_t, p->facet_count);
    exact->moment = body == 0 ? PIR_NEW(a, mpz_t, size_of(body, p->edge_count)) : NULL;
    return exact->normal && exact->edge && exact->point && exact->offset && (body == 1 || exact->moment);
}

/* Begins all numbers, or ends them. */
static void for_all(pir_turned *turned, int body, void (*call)(mpz_t *, size_t)) {
    const pir_polytope *p = turned->body[body];
    pir_body_integers *exact = &turned->exact[body];
    call(exact->normal, size_of(body, p->facet_count));
    call(exact->edge, size_of(body, p->edge_count));
    call(exact->point, size_of(body, p->vertex_count));
    call(exact->offset, p->facet_count);
    if (body == 0)
        call(exact->moment, size_of(body, p->edge_count));
}

static void free_arrays(pir_turned *turned, int body) {
    const pir_allocator *a = &turned->allocator;
    const pir_polytope *p = turned->body[body];
    pir_body_integers *exact = &turned->exact[body];
    PIR_FREE(a, exact->normal, size_of(body, p->facet_count));
    PIR_FREE(a, exact->edge, size_of(body, p->edge_count));
    PIR_FREE(a, exact->point, size_of(body, p->vertex_count));
    PIR_FREE(a, exact->offset, p->facet_count);
    PIR_FREE(a, exact->moment, size_of(body, p->edge_count));
}

/* u, its square, and the unit: the least common multiple of both scales' denominators. */
static void make_numbers(pir_turned *turned, const pir_turning *turning, pir_quat start) {
    const double u[3] = {turning->axis.x, turning->axis.y, turning->axis.z};
    const double q[4] = {start.x, start.y, start.z, start.w};
    turned->exponent = turning->exponent;
    turned->length = turning->length;
    mpz_t other;
    mpz_init(other);
    for (int k = 0; k < 3; k++) {
        if (u[k] != 0)
            pir_integer_of_double(turned->axis[k], u[k], turned->exponent);
        mpz_addmul(turned->square, turned->axis[k], turned->axis[k]);
        const int bits = (int)mpz_sizeinbase(turned->axis[k], 2);
        turned->width = bits > turned->width ? bits : turned->width;
    }
    // M has q₀ on a scale of its own, on which it is made of integers without a common power of two
    int low = INT32_MAX;
    for (int k = 0; k < 4; k++)
        low = pir_double_low_bit(q[k]) < low ? pir_double_low_bit(q[k]) : low;
    for (int k = 0; k < 4; k++)
        if (q[k] != 0) {
            pir_integer_of_double(other, q[k], low);
            mpz_addmul(turned->norm, other, other);
        }
    set_int(turned->unit, &turned->body[0]->scale.den);
    set_int(other, &turned->body[1]->scale.den);
    mpz_lcm(turned->unit, turned->unit, other);
    mpz_clear(other);
}

/* The vector of P `x`, turned; `matrix` has the 27 entries. */
static void turn_vector(mpz_t *matrix, mpz_t *x, mpz_t *dst) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            dot(dst[AT(i, j)], &matrix[9 * i + 3 * j], x);
}

/* Directions, points and offsets of a body; those of P are turned where `matrix` is not NULL. */
static void make_body(pir_turned *turned, int body, mpz_t *matrix) {
    const pir_polytope *p = turned->body[body];
    pir_body_integers *exact = &turned->exact[body];
    const size_t by = matrix ? 9 : 3;
    mpz_t x[12], factor, part; // a point, a direction, a moment
    init_all(x, 12);
    mpz_inits(factor, part, NULL);
    set_int(part, &p->scale.den);
    mpz_divexact(factor, turned->unit, part);
    set_int(part, &p->scale.num);
    mpz_mul(factor, factor, part);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        const pir_int3 at = pir_vertex_exact(p, v);
        set_vector(x, &at);
        for (int k = 0; k < 3; k++)
            mpz_mul(matrix ? x[k] : exact->point[by * v + (size_t)k], x[k], factor);
        if (matrix)
            turn_vector(matrix, x, &exact->point[by * v]);
    }
    for (uint32_t f = 0; f < p->facet_count; f++) {
        const pir_int3 n = pir_normal_exact(p, f), at = pir_vertex_exact(p, p->origin[p->loop[p->loop_start[f]]]);
        set_vector(x, &at);
        set_vector(x + 3, &n);
        dot(exact->offset[f], x, x + 3);
        mpz_mul(exact->offset[f], exact->offset[f], factor);
        if (matrix)
            turn_vector(matrix, x + 3, &exact->normal[by * f]);
        else
            set_vector(&exact->normal[by * f], &n);
    }
    for (uint32_t e = 0; e < p->edge_count; e++) {
        const pir_int3 d = pir_half_exact(p, p->edge_half[e]), at = pir_vertex_exact(p, p->origin[p->edge_half[e]]);
        set_vector(matrix ? x + 3 : &exact->edge[by * e], &d);
        if (!matrix)
            continue;
        set_vector(x, &at);
        for (int k = 0; k < 3; k++)
            mpz_mul(x[k], x[k], factor);
        cross(x + 6, x, x + 3);
        turn_vector(matrix, x + 3, &exact->edge[by * e]);
        turn_vector(matrix, x + 6, &exact->moment[by * e]);
    }
    clear_all(x, 12);
    mpz_clears(factor, part, NULL);
}

pir_status pir_turned_init(pir_turned *turned, const pir_allocator *allocator, const pir_polytope *const body[2],
                           const pir_turning *turning, pir_quat start) {
    *turned = (pir_turned){.allocator = *allocator, .body = {body[0], body[1]}};
    if (!make_arrays(turned, 0) || !make_arrays(turned, 1)) {
        free_arrays(turned, 0);
        free_arrays(turned, 1);
        *turned = (pir_turned){.exponent = 0};
        return PIR_ERR_MEMORY;
    }
    mpz_inits(turned->axis[0], turned->axis[1], turned->axis[2], turned->square, turned->norm, turned->unit, NULL);
    for_all(turned, 0, init_all);
    for_all(turned, 1, init_all);
    make_numbers(turned, turning, start);
    mpz_t matrix[27];
    init_all(matrix, 27);
    for (int n = 0; n < 27; n++)
        set_int(matrix[n], &turning->matrix[n / 9][n / 3 % 3][n % 3]);
    make_body(turned, 0, matrix);
    make_body(turned, 1, NULL);
    clear_all(matrix, 27);
    return PIR_OK;
}

void pir_turned_finish(pir_turned *turned) {
    for (int body = 0; body < 2; body++) {
        for_all(turned, body, clear_all);
        free_arrays(turned, body);
    }
    mpz_clears(turned->axis[0], turned->axis[1], turned->axis[2], turned->square, turned->norm, turned->unit, NULL);
}

/* --- planes --- */

void pir_exact_plane_init(pir_exact_plane *plane) {
    init_all(plane->a[0], 9);
    init_all(plane->b, 3);
    init_all(plane->o, 3);
    plane->has_sign = false;
}

void pir_exact_plane_clear(pir_exact_plane *plane) {
    clear_all(plane->a[0], 9);
    clear_all(plane->b, 3);
    clear_all(plane->o, 3);
}

/* dst = `by` times |q|²: its coefficients of k² and 1; that of k is 0. */
static void times_norm(const pir_turned *turned, const mpz_t by, mpz_t first, mpz_t last) {
    mpz_mul(first, by, turned->norm);
    mpz_mul(last, first, turned->square);
}

static uint32_t corner_of(const pir_polytope *p, pir_feature face) {
    if (face.kind == PIR_FEATURE_FACET)
        return p->origin[p->loop[p->loop_start[face.index]]];
    return face.kind == PIR_FEATURE_EDGE ? p->origin[p->edge_half[face.index]] : face.index;
}

/* A facet of P at a corner of Q. */
static void plane_of_p(const pir_turned *turned, uint32_t f, uint32_t b, pir_exact_plane *dst) {
    mpz_t *n = &turned->exact[0].normal[9 * (size_t)f], *at = &turned->exact[1].point[3 * (size_t)b];
    times_norm(turned, turned->exact[0].offset[f], dst->b[0], dst->b[2]);
    mpz_set_ui(dst->b[1], 0);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            mpz_set(dst->a[i][j], n[AT(i, j)]);
            mpz_addmul(dst->b[i], n[AT(i, j)], at[j]);
        }
        mpz_neg(dst->b[i], dst->b[i]);
    }
}

/* A facet of Q at a corner of P. */
static void plane_of_q(const pir_turned *turned, uint32_t g, uint32_t a, pir_exact_plane *dst) {
    mpz_t *n = &turned->exact[1].normal[3 * (size_t)g], *at = &turned->exact[0].point[9 * (size_t)a];
    times_norm(turned, turned->exact[1].offset[g], dst->b[0], dst->b[2]);
    mpz_set_ui(dst->b[1], 0);
    for (int j = 0; j < 3; j++) {
        times_norm(turned, n[j], dst->a[0][j], dst->a[2][j]);
        mpz_set_ui(dst->a[1][j], 0);
        for (int i = 0; i < 3; i++)
            mpz_addmul(dst->b[i], n[j], at[AT(i, j)]);
    }
    for (int i = 0; i < 3; i++)
        mpz_neg(dst->b[i], dst->b[i]);
}

/* Two edges. */
static void plane_of_edges(const pir_turned *turned, uint32_t d, uint32_t e, pir_exact_plane *dst) {
    const pir_polytope *p = turned->body[0], *q = turned->body[1];
    mpz_t *way = &turned->exact[0].edge[9 * (size_t)d], *moment = &turned->exact[0].moment[9 * (size_t)d];
    mpz_t *other = &turned->exact[1].edge[3 * (size_t)e];
    mpz_t *at = &turned->exact[1].point[3 * (size_t)q->origin[q->edge_half[e]]];
    mpz_t *left = &turned->exact[0].normal[9 * (size_t)p->arc_ends[d].from];
    for (int i = 0; i < 3; i++) {
        cross(dst->a[i], &way[AT(i, 0)], other);
        dot(dst->b[i], dst->a[i], at);
        for (int j = 0; j < 3; j++)
            mpz_addmul(dst->b[i], moment[AT(i, j)], other[j]);
        mpz_neg(dst->b[i], dst->b[i]);
        dot(dst->o[i], &left[AT(i, 0)], other);
    }
}

void pir_turned_plane(const pir_turned *turned, const pir_witness *faces, pir_exact_plane *dst) {
    dst->has_sign = faces->p.kind == PIR_FEATURE_EDGE && faces->q.kind == PIR_FEATURE_EDGE;
    if (dst->has_sign)
        plane_of_edges(turned, faces->p.index, faces->q.index, dst);
    else if (faces->q.kind == PIR_FEATURE_FACET)
        plane_of_q(turned, faces->q.index, corner_of(turned->body[0], faces->p), dst);
    else
        plane_of_p(turned, faces->p.index, corner_of(turned->body[1], faces->q), dst);
}

/* --- rounding --- */

/* Numbers that get one power of two: `shift` is added to the exponent of each. */
struct rounding {
    double m[12];
    int64_t e[12];
    int count;
};

static void add_number(struct rounding *rounding, const mpz_t x, int64_t shift) {
    signed long e;
    rounding->m[rounding->count] = mpz_get_d_2exp(&e, x);
    rounding->e[rounding->count++] = e + shift;
}

static void round_all(struct rounding *rounding) {
    int64_t top = INT64_MIN;
    for (int n = 0; n < rounding->count; n++)
        if (rounding->m[n] != 0 && rounding->e[n] > top)
            top = rounding->e[n];
    for (int n = 0; n < rounding->count; n++) {
        const int64_t e = rounding->e[n] - top;
        rounding->m[n] = rounding->m[n] == 0 || e < -1040 ? 0 : ldexp(rounding->m[n], (int)e);
    }
}

pir_rounded_plane pir_turned_round(const pir_turned *turned, const pir_exact_plane *plane) {
    pir_rounded_plane dst = {.has_sign = plane->has_sign};
    struct rounding slack = {.count = 0}, sign = {.count = 0};
    signed long e;
    const double unit = mpz_get_d_2exp(&e, turned->unit);
    for (int i = 0; i < 3; i++) {
        const int64_t shift = (int64_t)(2 - i) * turned->width;
        for (int j = 0; j < 3; j++)
            add_number(&slack, plane->a[i][j], shift + e);
        add_number(&slack, plane->b[i], shift);
        if (plane->has_sign)
            add_number(&sign, plane->o[i], shift);
    }
    for (int n = 0; n < 12; n++)
        slack.m[n] *= n % 4 != 3 ? unit : 1;
    round_all(&slack);
    round_all(&sign);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            dst.a[i][j] = slack.m[4 * i + j];
        dst.b[i] = slack.m[4 * i + 3];
        dst.o[i] = plane->has_sign ? sign.m[i] : 0;
    }
    return dst;
}

void pir_turned_sign(const pir_turned *turned, bool of_p, uint32_t facet, uint32_t half, mpz_t dst[3]) {
    const pir_body_integers *p = &turned->exact[0], *q = &turned->exact[1];
    const pir_polytope *ground = turned->body[of_p];
    const uint32_t e = ground->edge[half];
    mpz_t *x = of_p ? &p->normal[9 * (size_t)facet] : &p->edge[9 * (size_t)e];
    mpz_t *y = of_p ? &q->edge[3 * (size_t)e] : &q->normal[3 * (size_t)facet];
    for (int i = 0; i < 3; i++) {
        dot(dst[i], &x[AT(i, 0)], y);
        if (ground->edge_half[e] != half)
            mpz_neg(dst[i], dst[i]);
    }
}
