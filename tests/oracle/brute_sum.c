/* SPDX-License-Identifier: MIT */
/*
 * See check_sum.h: the sum by brute force. A facet with outward normal n is F_P(n) ⊕ F_Q(n), the sum of the operands'
 * extreme sets along n. For it to be a polygon, one of the sets must hold three points not on a line, or both must hold
 * two whose lines cross: so n is, up to sign and length, one of finitely many cross products. All are tried.
 */
#include "oracle/check_sum.h"

#include <stdlib.h>

#define MOST 4096

struct search {
    const pir_mesh *mesh;
    oracle_points v;
    const oracle_points *p, *q;
    oracle_vec *seen; /* primitive normals that were facets */
    size_t seen_count, seen_room;
    uint32_t matched; /* facets of the mesh found again */
    const char *wrong;
};

/* Divides by the greatest common divisor. */
static void make_primitive(oracle_vec n) {
    mpz_t g;
    mpz_init(g);
    mpz_gcd(g, n[0], n[1]);
    mpz_gcd(g, g, n[2]);
    for (int k = 0; k < 3; k++)
        mpz_divexact(n[k], n[k], g);
    mpz_clear(g);
}

/* Notes n; 0 when it was there. */
static int note(struct search *search, oracle_vec n) {
    for (size_t i = 0; i < search->seen_count; i++)
        if (oracle_equal(search->seen[i], n))
            return 0;
    if (search->seen_count == search->seen_room) {
        search->seen_room = 2 * search->seen_room + 64;
        search->seen = realloc(search->seen, search->seen_room * sizeof *search->seen);
        if (!search->seen)
            abort();
    }
    oracle_vec_init(search->seen[search->seen_count]);
    for (int k = 0; k < 3; k++)
        mpz_set(search->seen[search->seen_count][k], n[k]);
    search->seen_count++;
    return 1;
}

/* The points that lie farthest along n, into `index`; their number. */
static uint32_t extreme_set(const oracle_points *points, oracle_vec n, uint32_t *index) {
    mpz_t most, height;
    mpz_inits(most, height, NULL);
    oracle_support(most, points, n);
    uint32_t count = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        oracle_dot(height, n, points->at[i]);
        if (mpz_cmp(height, most) == 0)
            index[count++] = i;
    }
    mpz_clears(most, height, NULL);
    return count;
}

/* The turn of a, b, c in the plane of coordinates i and j. */
static int turn(oracle_vec a, oracle_vec b, oracle_vec c, int i, int j) {
    mpz_t s, t, u, v;
    mpz_inits(s, t, u, v, NULL);
    mpz_sub(s, b[i], a[i]);
    mpz_sub(t, c[j], a[j]);
    mpz_sub(u, b[j], a[j]);
    mpz_sub(v, c[i], a[i]);
    mpz_mul(s, s, t);
    mpz_submul(s, u, v);
    int sign = mpz_sgn(s);
    mpz_clears(s, t, u, v, NULL);
    return sign;
}

static int before(oracle_vec a, oracle_vec b, int i, int j) {
    int order = mpz_cmp(a[i], b[i]);
    return order ? order < 0 : mpz_cmp(a[j], b[j]) < 0;
}

/* The corners of the points' hull in their plane, counter-clockwise about n (monotone chain:
   Andrew, 1979); sorts `at`. */
static uint32_t corners_of(oracle_vec *at, uint32_t count, oracle_vec n, uint32_t *corner) {
    int k = mpz_sgn(n[0]) ? 0 : mpz_sgn(n[1]) ? 1 : 2, i = (k + 1) % 3, j = (k + 2) % 3;
    for (uint32_t a = 1; a < count; a++)
        for (uint32_t b = a; b > 0 && before(at[b], at[b - 1], i, j); b--)
            for (int c = 0; c < 3; c++)
                mpz_swap(at[b][c], at[b - 1][c]);
    uint32_t distinct = count > 0;
    for (uint32_t a = 1; a < count; a++)
        if (before(at[distinct - 1], at[a], i, j)) {
            for (int c = 0; c < 3; c++)
                mpz_set(at[distinct][c], at[a][c]);
            distinct++;
        }
    if (distinct < 3)
        return 0;
    uint32_t top = 0;
    for (uint32_t a = 0; a < distinct; a++) {
        while (top >= 2 && turn(at[corner[top - 2]], at[corner[top - 1]], at[a], i, j) <= 0)
            top--;
        corner[top++] = a;
    }
    for (uint32_t a = distinct - 1, floor = top + 1; a-- > 0;) {
        while (top >= floor && turn(at[corner[top - 2]], at[corner[top - 1]], at[a], i, j) <= 0)
            top--;
        corner[top++] = a;
    }
    top--;
    for (uint32_t a = 0; mpz_sgn(n[k]) < 0 && a < top / 2; a++) {
        uint32_t kept = corner[a];
        corner[a] = corner[top - 1 - a];
        corner[top - 1 - a] = kept;
    }
    return top < 3 ? 0 : top;
}

static uint32_t vertex_at(const struct search *search, oracle_vec x) {
    uint32_t v = 0;
    while (v < search->v.count && !oracle_equal(search->v.at[v], x))
        v++;
    return v;
}

/* Whether the mesh has the facet with these vertices in this cyclic order. */
static int mesh_has(const struct search *search, const uint32_t *vertex, uint32_t count) {
    uint32_t first = 0;
    for (uint32_t i = 1; i < count; i++)
        if (vertex[i] < vertex[first])
            first = i;
    for (uint32_t f = 0; f < pir_mesh_facet_count(search->mesh); f++) {
        uint32_t corners, same = 0;
        const uint32_t *corner = pir_mesh_facet(search->mesh, f, &corners);
        if (corners != count)
            continue;
        while (same < count && corner[same] == vertex[(first + same) % count])
            same++;
        if (same == count)
            return 1;
    }
    return 0;
}

/* Tries n, not zero, as an outward normal. */
static void try_normal(struct search *search, oracle_vec n) {
    uint32_t *in_p = malloc(search->p->count * sizeof *in_p), *in_q = malloc(search->q->count * sizeof *in_q);
    oracle_vec *at = malloc(MOST * sizeof *at);
    uint32_t *corner = malloc((MOST + 1) * sizeof *corner), count = 0;
    if (!in_p || !in_q || !at || !corner)
        abort();
    uint32_t count_p = extreme_set(search->p, n, in_p), count_q = extreme_set(search->q, n, in_q);
    if (count_p * count_q > MOST)
        abort();
    for (uint32_t i = 0; i < count_p; i++)
        for (uint32_t j = 0; j < count_q; j++, count++) {
            oracle_vec_init(at[count]);
            for (int k = 0; k < 3; k++)
                mpz_add(at[count][k], search->p->at[in_p[i]][k], search->q->at[in_q[j]][k]);
        }
    uint32_t corners = corners_of(at, count, n, corner);
    if (corners > 0 && note(search, n)) {
        for (uint32_t i = 0; i < corners; i++)
            corner[i] = vertex_at(search, at[corner[i]]);
        if (mesh_has(search, corner, corners))
            search->matched++;
        else
            search->wrong = "a facet of the sum is missing in the mesh";
    }
    for (uint32_t i = 0; i < count; i++)
        oracle_vec_clear(at[i]);
    free(corner);
    free(at);
    free(in_q);
    free(in_p);
}

/* Tries s × t both ways. */
static void try_cross(struct search *search, oracle_vec s, oracle_vec t) {
    oracle_vec n;
    oracle_vec_init(n);
    oracle_cross(n, s, t);
    if (!oracle_is_zero(n)) {
        make_primitive(n);
        try_normal(search, n);
        for (int k = 0; k < 3; k++)
            mpz_neg(n[k], n[k]);
        try_normal(search, n);
    }
    oracle_vec_clear(n);
}

static void try_triples(struct search *search, const oracle_points *points) {
    oracle_vec s, t;
    oracle_vec_init(s);
    oracle_vec_init(t);
    for (uint32_t i = 0; i < points->count; i++)
        for (uint32_t j = i + 1; j < points->count; j++) {
            oracle_sub(s, points->at[j], points->at[i]);
            for (uint32_t k = j + 1; k < points->count && !search->wrong; k++) {
                oracle_sub(t, points->at[k], points->at[i]);
                try_cross(search, s, t);
            }
        }
    oracle_vec_clear(t);
    oracle_vec_clear(s);
}

static void try_pairs(struct search *search) {
    const oracle_points *p = search->p, *q = search->q;
    oracle_vec s, t;
    oracle_vec_init(s);
    oracle_vec_init(t);
    for (uint32_t i = 0; i < p->count; i++)
        for (uint32_t j = i + 1; j < p->count; j++) {
            oracle_sub(s, p->at[j], p->at[i]);
            for (uint32_t k = 0; k < q->count; k++)
                for (uint32_t l = k + 1; l < q->count && !search->wrong; l++) {
                    oracle_sub(t, q->at[l], q->at[k]);
                    try_cross(search, s, t);
                }
        }
    oracle_vec_clear(t);
    oracle_vec_clear(s);
}

const char *oracle_compare_brute_force(const pir_mesh *mesh, oracle_points *p, oracle_points *q) {
    if (!pir_mesh_is_exact(mesh))
        return "the mesh holds no exact coordinates";
    struct search search = {.mesh = mesh, .p = p, .q = q};
    oracle_points_from_mesh(&search.v, mesh);
    oracle_points_common((oracle_points *const[]){&search.v, p, q}, 3);
    try_triples(&search, p);
    try_triples(&search, q);
    try_pairs(&search);
    if (!search.wrong && search.matched != pir_mesh_facet_count(mesh))
        search.wrong = "the mesh has a facet that the sum has not";
    for (size_t i = 0; i < search.seen_count; i++)
        oracle_vec_clear(search.seen[i]);
    free(search.seen);
    oracle_points_clear(&search.v);
    return search.wrong;
}
