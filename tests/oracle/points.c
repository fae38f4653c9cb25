/* SPDX-License-Identifier: MIT */
/* See points.h. */
#include "oracle/points.h"

#include <stdlib.h>

#include <pirouette/exact.h>

void oracle_vec_init(oracle_vec v) {
    mpz_inits(v[0], v[1], v[2], NULL);
}

void oracle_vec_clear(oracle_vec v) {
    mpz_clears(v[0], v[1], v[2], NULL);
}

void oracle_sub(oracle_vec r, oracle_vec a, oracle_vec b) {
    for (int k = 0; k < 3; k++)
        mpz_sub(r[k], a[k], b[k]);
}

void oracle_cross(oracle_vec r, oracle_vec a, oracle_vec b) {
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(r[k], a[i], b[j]);
        mpz_submul(r[k], a[j], b[i]);
    }
}

void oracle_dot(mpz_t r, oracle_vec a, oracle_vec b) {
    mpz_mul(r, a[0], b[0]);
    mpz_addmul(r, a[1], b[1]);
    mpz_addmul(r, a[2], b[2]);
}

int oracle_is_zero(oracle_vec a) {
    return mpz_sgn(a[0]) == 0 && mpz_sgn(a[1]) == 0 && mpz_sgn(a[2]) == 0;
}

int oracle_equal(oracle_vec a, oracle_vec b) {
    return mpz_cmp(a[0], b[0]) == 0 && mpz_cmp(a[1], b[1]) == 0 && mpz_cmp(a[2], b[2]) == 0;
}

/* --- points --- */

/* From 3·count rationals, which are cleared. */
static void from_rationals(oracle_points *points, mpq_t *rational, size_t count) {
    points->count = (uint32_t)count;
    points->at = malloc((count ? count : 1) * sizeof *points->at);
    if (!points->at)
        abort();
    mpz_init_set_ui(points->den, 1);
    for (size_t i = 0; i < 3 * count; i++)
        mpz_lcm(points->den, points->den, mpq_denref(rational[i]));
    for (size_t i = 0; i < 3 * count; i++) {
        mpz_t *to = &points->at[i / 3][i % 3];
        mpz_init(*to);
        mpz_divexact(*to, points->den, mpq_denref(rational[i]));
        mpz_mul(*to, *to, mpq_numref(rational[i]));
        mpq_clear(rational[i]);
    }
    free(rational);
}

static mpq_t *new_rationals(size_t count) {
    mpq_t *rational = malloc((3 * count + 1) * sizeof *rational);
    if (!rational)
        abort();
    for (size_t i = 0; i < 3 * count; i++)
        mpq_init(rational[i]);
    return rational;
}

void oracle_points_from_doubles(oracle_points *points, const pir_vec3 *from, size_t count) {
    mpq_t *rational = new_rationals(count);
    for (size_t i = 0; i < count; i++) {
        mpq_set_d(rational[3 * i], from[i].x);
        mpq_set_d(rational[3 * i + 1], from[i].y);
        mpq_set_d(rational[3 * i + 2], from[i].z);
    }
    from_rationals(points, rational, count);
}

void oracle_points_from_polytope(oracle_points *points, const pir_polytope *polytope) {
    uint32_t count = pir_polytope_vertex_count(polytope);
    mpq_t *rational = new_rationals(count);
    for (uint32_t v = 0; v < count; v++)
        pir_polytope_vertex_exact(polytope, v, &rational[3 * v]);
    from_rationals(points, rational, count);
}

void oracle_points_from_mesh(oracle_points *points, const pir_mesh *mesh) {
    uint32_t count = pir_mesh_vertex_count(mesh);
    mpq_t *rational = new_rationals(count);
    for (uint32_t v = 0; v < count; v++)
        if (pir_mesh_vertex_exact(mesh, v, &rational[3 * v]) != PIR_OK)
            abort();
    from_rationals(points, rational, count);
}

void oracle_points_clear(oracle_points *points) {
    for (uint32_t i = 0; i < points->count; i++)
        oracle_vec_clear(points->at[i]);
    free(points->at);
    mpz_clear(points->den);
}

void oracle_points_common(oracle_points *const *sets, size_t count) {
    mpz_t den, factor;
    mpz_init_set_ui(den, 1);
    mpz_init(factor);
    for (size_t s = 0; s < count; s++)
        mpz_lcm(den, den, sets[s]->den);
    for (size_t s = 0; s < count; s++) {
        mpz_divexact(factor, den, sets[s]->den);
        for (uint32_t i = 0; i < sets[s]->count; i++)
            for (int k = 0; k < 3; k++)
                mpz_mul(sets[s]->at[i][k], sets[s]->at[i][k], factor);
        mpz_set(sets[s]->den, den);
    }
    mpz_clears(den, factor, NULL);
}

void oracle_support(mpz_t r, const oracle_points *points, oracle_vec n) {
    mpz_t height;
    mpz_init(height);
    for (uint32_t i = 0; i < points->count; i++) {
        oracle_dot(height, n, points->at[i]);
        if (i == 0 || mpz_cmp(height, r) > 0)
            mpz_set(r, height);
    }
    mpz_clear(height);
}

/* --- rotations --- */

void oracle_quat_init(oracle_quat to, pir_quat q) {
    const double c[4] = {q.x, q.y, q.z, q.w};
    mpz_t den;
    mpq_t rational[4];
    mpz_init_set_ui(den, 1);
    for (int k = 0; k < 4; k++) {
        mpq_init(rational[k]);
        mpq_set_d(rational[k], c[k]);
        mpz_lcm(den, den, mpq_denref(rational[k]));
    }
    for (int k = 0; k < 4; k++) {
        mpz_init(to[k]);
        mpz_divexact(to[k], den, mpq_denref(rational[k]));
        mpz_mul(to[k], to[k], mpq_numref(rational[k]));
        mpq_clear(rational[k]);
    }
    mpz_clear(den);
}

void oracle_quat_clear(oracle_quat q) {
    for (int k = 0; k < 4; k++)
        mpz_clear(q[k]);
}

static void square_length(mpz_t r, oracle_quat q) {
    mpz_set_ui(r, 0);
    for (int k = 0; k < 4; k++)
        mpz_addmul(r, q[k], q[k]);
}

/* q·a·q* = |q|² a + 2 (w u + v × u) with v the vector part of q and u = v × a. */
void oracle_turn(oracle_vec r, oracle_quat q, oracle_vec a) {
    oracle_vec u;
    mpz_t square;
    oracle_vec_init(u);
    mpz_init(square);
    oracle_cross(u, q, a);
    oracle_cross(r, q, u);
    square_length(square, q);
    for (int k = 0; k < 3; k++) {
        mpz_addmul(r[k], q[3], u[k]);
        mpz_mul_2exp(r[k], r[k], 1);
        mpz_addmul(r[k], square, a[k]);
    }
    mpz_clear(square);
    oracle_vec_clear(u);
}

void oracle_points_rotate(oracle_points *points, oracle_quat q) {
    oracle_vec turned;
    mpz_t square;
    oracle_vec_init(turned);
    mpz_init(square);
    for (uint32_t i = 0; i < points->count; i++) {
        oracle_turn(turned, q, points->at[i]);
        for (int k = 0; k < 3; k++)
            mpz_swap(points->at[i][k], turned[k]);
    }
    square_length(square, q);
    mpz_mul(points->den, points->den, square);
    mpz_clear(square);
    oracle_vec_clear(turned);
}
