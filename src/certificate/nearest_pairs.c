/* SPDX-License-Identifier: MIT */
/*
 * Nearest points by the descent of Gilbert, Johnson and Keerthi (IEEE J. Robotics and Automation 4(2), 1988), in
 * integers. A simplex of corners holds the point z. The corner that is lowest along z either proves z the nearest, or
 * joins the simplex, which then shrinks to the corners that carry its own nearest point. |z| falls at every step and
 * there are finitely many simplices, so it ends, and the end is exact.
 *
 * The nearest point of a simplex of up to four corners is found among its faces: that of a face's plane is
 * Σ w_k v_k / w, with w_k by Cramer's rule from the products of the edges at its first corner. It is the simplex's
 * where each w_k is positive and no corner is lower along it.
 */
#include "certificate/nearest_pairs.h"

void pir_mix_init(pir_mix *mix) {
    mix->count = 0;
    mpz_init(mix->whole);
    for (int k = 0; k < 8; k++)
        mpz_init(mix->weight[k]);
    pir_triple_init(&mix->point);
}

void pir_mix_finish(pir_mix *mix) {
    mpz_clear(mix->whole);
    for (int k = 0; k < 8; k++)
        mpz_clear(mix->weight[k]);
    pir_triple_finish(&mix->point);
}

void pir_mix_reduce(pir_mix *mix, const pir_stance *bodies) {
    mpz_t common;
    pir_triple v;
    mpz_init(common);
    pir_triple_init(&v);
    for (int k = 0; k < mix->count; k++)
        mpz_gcd(common, common, mix->weight[k]);
    mpz_set_ui(mix->whole, 0);
    for (int i = 0; i < 3; i++)
        mpz_set_ui(mix->point.c[i], 0);
    for (int k = 0; k < mix->count; k++) {
        mpz_divexact(mix->weight[k], mix->weight[k], common);
        mpz_add(mix->whole, mix->whole, mix->weight[k]);
        pir_stance_vertex(bodies, mix->corner[k], &v);
        for (int i = 0; i < 3; i++)
            mpz_addmul(mix->point.c[i], mix->weight[k], v.c[i]);
    }
    pir_triple_finish(&v);
    mpz_clear(common);
}

/* Work space of one search: the simplex's vertices, edges at the first one of a face, their products. */
struct descent_room {
    const pir_stance *bodies;
    pir_triple v[4], e[3];
    mpz_t g[3][4]; /* products of edges, and in column 3 those with minus the first vertex */
    mpz_t x, y;
};

static void search_init(struct descent_room *s, const pir_stance *bodies) {
    s->bodies = bodies;
    for (int k = 0; k < 4; k++)
        pir_triple_init(&s->v[k]);
    for (int k = 0; k < 3; k++) {
        pir_triple_init(&s->e[k]);
        mpz_inits(s->g[k][0], s->g[k][1], s->g[k][2], s->g[k][3], NULL);
    }
    mpz_inits(s->x, s->y, NULL);
}

static void search_finish(struct descent_room *s) {
    for (int k = 0; k < 4; k++)
        pir_triple_finish(&s->v[k]);
    for (int k = 0; k < 3; k++) {
        pir_triple_finish(&s->e[k]);
        mpz_clears(s->g[k][0], s->g[k][1], s->g[k][2], s->g[k][3], NULL);
    }
    mpz_clears(s->x, s->y, NULL);
}

/* to = g[0][a]·g[1][b] − g[0][b]·g[1][a], of rows r and t. */
static void minor_of(struct descent_room *s, int r, int t, int a, int b, mpz_t to) {
    mpz_mul(to, s->g[r][a], s->g[t][b]);
    mpz_submul(to, s->g[r][b], s->g[t][a]);
}

/* The determinant of the first n rows, with column `by` replaced by column 3; none is where it is 3. */
static void determinant(struct descent_room *s, int n, int by, mpz_t to) {
    int c[3];
    for (int k = 0; k < 3; k++)
        c[k] = k == by ? 3 : k;
    if (n == 0)
        mpz_set_ui(to, 1);
    else if (n == 1)
        mpz_set(to, s->g[0][c[0]]);
    else if (n == 2)
        minor_of(s, 0, 1, c[0], c[1], to);
    else {
        minor_of(s, 1, 2, c[1], c[2], s->x);
        mpz_mul(to, s->g[0][c[0]], s->x);
        minor_of(s, 1, 2, c[0], c[2], s->x);
        mpz_submul(to, s->g[0][c[1]], s->x);
        minor_of(s, 1, 2, c[0], c[1], s->x);
        mpz_addmul(to, s->g[0][c[2]], s->x);
    }
}

/* The weights of the point of a face's plane that is nearest; false where one is not positive, or there is no plane. */
static bool face_weights(struct descent_room *s, const int *face, int count, mpz_t weight[4]) {
    int n = count - 1;
    for (int k = 0; k < n; k++)
        pir_triple_subtract(&s->e[k], &s->v[face[k + 1]], &s->v[face[0]]);
    for (int k = 0; k < n; k++) {
        for (int l = 0; l < n; l++)
            pir_triple_dot(s->g[k][l], &s->e[k], &s->e[l]);
        pir_triple_dot(s->g[k][3], &s->e[k], &s->v[face[0]]);
        mpz_neg(s->g[k][3], s->g[k][3]);
    }
    determinant(s, n, 3, weight[0]);
    if (mpz_sgn(weight[0]) <= 0)
        return false;
    for (int k = 0; k < n; k++) {
        determinant(s, n, k, weight[k + 1]);
        if (mpz_sgn(weight[k + 1]) <= 0)
            return false;
    }
    for (int k = 0; k < n; k++)
        mpz_sub(weight[0], weight[0], weight[k + 1]);
    return mpz_sgn(weight[0]) > 0;
}

/* Whether vertex v is not lower along the mix's point than the point itself. */
static bool is_not_lower(struct descent_room *s, const pir_mix *mix, const pir_triple *v) {
    pir_triple_dot(s->x, v, &mix->point);
    mpz_mul(s->x, s->x, mix->whole);
    pir_triple_dot(s->y, &mix->point, &mix->point);
    return mpz_cmp(s->x, s->y) >= 0;
}

/* Shrinks the mix's corners, up to four, to those that carry their nearest point, and sets that. */
static void shrink(struct descent_room *s, pir_mix *mix) {
    pir_vertex_pair corner[4];
    int all = mix->count;
    for (int k = 0; k < all; k++) {
        corner[k] = mix->corner[k];
        pir_stance_vertex(s->bodies, corner[k], &s->v[k]);
    }
    for (int set = 1; set < 1 << all; set++) {
        int face[4], count = 0;
        for (int k = 0; k < all; k++)
            if (set >> k & 1)
                face[count++] = k;
        if (!face_weights(s, face, count, mix->weight))
            continue;
        mix->count = count;
        for (int k = 0; k < count; k++)
            mix->corner[k] = corner[face[k]];
        pir_mix_reduce(mix, s->bodies);
        bool nearest = true;
        for (int k = 0; k < all && nearest; k++)
            nearest = is_not_lower(s, mix, &s->v[k]);
        if (nearest)
            return;
    }
}

void pir_nearest_pairs(const pir_stance *bodies, const pir_triple *start, pir_mix *mix) {
    struct descent_room s;
    search_init(&s, bodies);
    mix->corner[0] = pir_stance_lowest(bodies, start);
    mix->count = 1;
    shrink(&s, mix);
    for (;;) {
        pir_vertex_pair lowest = pir_stance_lowest(bodies, &mix->point);
        pir_stance_vertex(bodies, lowest, &s.v[0]);
        if (is_not_lower(&s, mix, &s.v[0]))
            break;
        mix->corner[mix->count++] = lowest;
        shrink(&s, mix);
    }
    search_finish(&s);
}
