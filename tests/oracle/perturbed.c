/* SPDX-License-Identifier: MIT */
/* See perturbed.h. */
#include "oracle/perturbed.h"

#include <stdlib.h>

static uint32_t bits_of(mpz_t *z, size_t count) {
    size_t bits = 1;
    for (size_t i = 0; i < count; i++)
        if (mpz_sizeinbase(z[i], 2) > bits)
            bits = mpz_sizeinbase(z[i], 2);
    return (uint32_t)bits;
}

void oracle_perturbed_quat_init(oracle_quat to, pir_quat q, uint32_t bits) {
    oracle_quat_init(to, q);
    // The components are integers now: coefficients are integers below 2^(2·bits + 2·span + 8), and neighbours in
    // rank differ by ε at least.
    uint32_t k = 2 * bits + 2 * bits_of(to, 4) + 16;
    mpz_t one;
    mpz_init_set_ui(one, 1);
    for (uint32_t i = 0, power = 1; i < 4; i++, power *= 3) {
        mpz_mul_2exp(to[i], to[i], 27 * k);
        mpz_t epsilon;
        mpz_init(epsilon);
        mpz_mul_2exp(epsilon, one, (27 - power) * k);
        mpz_add(to[i], to[i], epsilon);
        mpz_clear(epsilon);
    }
    mpz_clear(one);
}

int oracle_sign(oracle_quat q, oracle_vec a, oracle_vec b) {
    oracle_vec turned;
    mpz_t s;
    oracle_vec_init(turned);
    mpz_init(s);
    oracle_turn(turned, q, a);
    oracle_dot(s, turned, b);
    int sign = mpz_sgn(s);
    mpz_clear(s);
    oracle_vec_clear(turned);
    return sign;
}

/* --- the pairing --- */

struct pairing {
    const pir_sum *sum;
    const pir_polytope *p, *q;
    oracle_points at_p, at_q, turned; /* turned: the vertices of P at the perturbed rotation */
};

static void facet_normal(const pir_polytope *polytope, const oracle_points *at, uint32_t f, oracle_vec ret_normal) {
    uint32_t size = pir_polytope_facet_size(polytope, f), *corner = malloc(size * sizeof *corner);
    oracle_vec s, t;
    oracle_vec_init(s);
    oracle_vec_init(t);
    if (!corner)
        abort();
    pir_polytope_facet(polytope, f, corner);
    oracle_sub(s, at->at[corner[1]], at->at[corner[0]]);
    oracle_sub(t, at->at[corner[2]], at->at[corner[0]]);
    oracle_cross(ret_normal, s, t);
    oracle_vec_clear(t);
    oracle_vec_clear(s);
    free(corner);
}

/* The one vertex farthest along n, or the count when several are. */
static uint32_t farthest(const oracle_points *points, oracle_vec n) {
    mpz_t most, height;
    mpz_inits(most, height, NULL);
    oracle_support(most, points, n);
    uint32_t found = points->count, times = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        oracle_dot(height, n, points->at[i]);
        if (mpz_cmp(height, most) == 0) {
            found = i;
            times++;
        }
    }
    mpz_clears(most, height, NULL);
    return times == 1 ? found : points->count;
}

/* Whether the edge's ends, and nothing else, lie farthest along n. */
static int edge_is_farthest(const pir_polytope *polytope, const oracle_points *points, uint32_t e, oracle_vec n) {
    uint32_t ends[2];
    mpz_t level, height;
    pir_polytope_edge(polytope, e, ends);
    mpz_inits(level, height, NULL);
    oracle_dot(level, n, points->at[ends[0]]);
    int alone = 1;
    for (uint32_t i = 0; i < points->count && alone; i++) {
        oracle_dot(height, n, points->at[i]);
        int order = mpz_cmp(height, level);
        alone = order < 0 || (order == 0 && (i == ends[0] || i == ends[1]));
    }
    mpz_clears(level, height, NULL);
    return alone;
}

static void edge_vector(const pir_polytope *polytope, const oracle_points *points, uint32_t e, oracle_vec ret_vector) {
    uint32_t ends[2];
    pir_polytope_edge(polytope, e, ends);
    oracle_sub(ret_vector, points->at[ends[1]], points->at[ends[0]]);
}

static const char *check_facets(struct pairing *pairing) {
    oracle_vec n;
    const char *wrong = NULL;
    oracle_vec_init(n);
    for (uint32_t f = 0; f < pir_polytope_facet_count(pairing->p) && !wrong; f++) {
        facet_normal(pairing->p, &pairing->turned, f, n);
        if (farthest(&pairing->at_q, n) != pir_sum_fv(pairing->sum)[f])
            wrong = "an fv pair is not that of the perturbed rotation";
    }
    for (uint32_t g = 0; g < pir_polytope_facet_count(pairing->q) && !wrong; g++) {
        facet_normal(pairing->q, &pairing->at_q, g, n);
        if (farthest(&pairing->turned, n) != pir_sum_vf(pairing->sum)[g])
            wrong = "a vf pair is not that of the perturbed rotation";
    }
    oracle_vec_clear(n);
    return wrong;
}

/* Whether edges e and d make a facet of the sum. */
static int edges_pair(struct pairing *pairing, uint32_t e, uint32_t d) {
    oracle_vec s, t, n;
    oracle_vec_init(s);
    oracle_vec_init(t);
    oracle_vec_init(n);
    edge_vector(pairing->p, &pairing->turned, e, s);
    edge_vector(pairing->q, &pairing->at_q, d, t);
    oracle_cross(n, s, t);
    int found = 0;
    for (int both = 0; both < 2 && !found; both++) {
        found =
            edge_is_farthest(pairing->p, &pairing->turned, e, n) && edge_is_farthest(pairing->q, &pairing->at_q, d, n);
        for (int k = 0; k < 3; k++)
            mpz_neg(n[k], n[k]);
    }
    oracle_vec_clear(n);
    oracle_vec_clear(t);
    oracle_vec_clear(s);
    return found;
}

static const char *check_edges(struct pairing *pairing) {
    uint32_t listed = pir_sum_ee_count(pairing->sum), edges_p = pir_polytope_edge_count(pairing->p);
    uint32_t edges_q = pir_polytope_edge_count(pairing->q), found = 0;
    uint32_t(*pairs)[2] = malloc((listed + 1) * sizeof *pairs);
    unsigned char *in_list = calloc((size_t)edges_p * edges_q + 1, 1);
    const char *wrong = NULL;
    if (!pairs || !in_list)
        abort();
    pir_sum_ee(pairing->sum, pairs);
    for (uint32_t i = 0; i < listed && !wrong; i++) {
        if (pairs[i][0] >= edges_p || pairs[i][1] >= edges_q || in_list[(size_t)pairs[i][0] * edges_q + pairs[i][1]])
            wrong = "an ee pair is out of range or there twice";
        else
            in_list[(size_t)pairs[i][0] * edges_q + pairs[i][1]] = 1;
    }
    for (uint32_t e = 0; e < edges_p && !wrong; e++)
        for (uint32_t d = 0; d < edges_q && !wrong; d++) {
            int pair = edges_pair(pairing, e, d);
            found += (uint32_t)pair;
            if (pair != in_list[(size_t)e * edges_q + d])
                wrong = pair ? "an ee pair is missing" : "an ee pair is none";
        }
    if (!wrong && found != listed)
        wrong = "the number of ee pairs is wrong";
    free(in_list);
    free(pairs);
    return wrong;
}

const char *oracle_check_pairing(const pir_sum *sum) {
    struct pairing pairing = {.sum = sum, .p = pir_sum_p(sum), .q = pir_sum_q(sum)};
    oracle_points_from_polytope(&pairing.at_p, pairing.p);
    oracle_points_from_polytope(&pairing.at_q, pairing.q);
    oracle_points_from_polytope(&pairing.turned, pairing.p);
    // normals are products of two differences
    uint32_t bits = bits_of(&pairing.at_p.at[0][0], 3 * (size_t)pairing.at_p.count);
    uint32_t bits_q = bits_of(&pairing.at_q.at[0][0], 3 * (size_t)pairing.at_q.count);
    oracle_quat q;
    oracle_perturbed_quat_init(q, pir_sum_rotation(sum), 2 * (bits > bits_q ? bits : bits_q) + 4);
    oracle_points_rotate(&pairing.turned, q);
    const char *wrong = check_facets(&pairing);
    if (!wrong)
        wrong = check_edges(&pairing);
    oracle_quat_clear(q);
    oracle_points_clear(&pairing.turned);
    oracle_points_clear(&pairing.at_q);
    oracle_points_clear(&pairing.at_p);
    return wrong;
}
