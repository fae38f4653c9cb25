/* SPDX-License-Identifier: MIT */
/* See perturbed.h. */
#include "oracle/perturbed.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t bits_of(mpz_t *z, size_t count) {
    size_t bits = 1;
    for (size_t i = 0; i < count; i++)
        if (mpz_sizeinbase(z[i], 2) > bits)
            bits = mpz_sizeinbase(z[i], 2);
    return (uint32_t)bits;
}

/* Of the two quaternions of a rotation the one whose w is positive; of a half turn, x, else y, else z. */
static void give_sign(oracle_quat q) {
    int sign = 0;
    for (int k = 3, left = 4; left > 0 && sign == 0; left--, k = (k + 1) % 4)
        sign = mpz_sgn(q[k]);
    for (int k = 0; k < 4 && sign < 0; k++)
        mpz_neg(q[k], q[k]);
}

void oracle_perturbed_quat_init(oracle_quat to, pir_quat q, uint32_t bits) {
    oracle_quat_init(to, q);
    give_sign(to);
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

/* Both operands, and the vertices of P at the rotation itself and at the perturbed one. */
struct bodies {
    const pir_polytope *p, *q;
    oracle_points at_p, at_q, turned, moved;
};

static void bodies_init(struct bodies *b, const pir_polytope *p, const pir_polytope *q, pir_quat rotation) {
    *b = (struct bodies){.p = p, .q = q};
    oracle_points_from_polytope(&b->at_p, p);
    oracle_points_from_polytope(&b->at_q, q);
    oracle_points_from_polytope(&b->turned, p);
    oracle_points_from_polytope(&b->moved, p);
    // normals are products of two differences
    uint32_t bits = bits_of(&b->at_p.at[0][0], 3 * (size_t)b->at_p.count);
    uint32_t bits_q = bits_of(&b->at_q.at[0][0], 3 * (size_t)b->at_q.count);
    oracle_quat at, near;
    oracle_quat_init(at, rotation);
    oracle_perturbed_quat_init(near, rotation, 2 * (bits > bits_q ? bits : bits_q) + 4);
    oracle_points_rotate(&b->turned, at);
    oracle_points_rotate(&b->moved, near);
    oracle_quat_clear(near);
    oracle_quat_clear(at);
}

static void bodies_clear(struct bodies *b) {
    oracle_points_clear(&b->moved);
    oracle_points_clear(&b->turned);
    oracle_points_clear(&b->at_q);
    oracle_points_clear(&b->at_p);
}

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
    uint32_t found = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        oracle_dot(height, n, points->at[i]);
        int order = i == 0 ? 1 : mpz_cmp(height, most);
        if (order > 0)
            mpz_set(most, height);
        found = order > 0 ? i : order == 0 ? points->count : found;
    }
    mpz_clears(most, height, NULL);
    return found;
}

/*
 * The vertex of one operand farthest along the normal of facet f of the other. The tiny perturbation is asked only
 * where several are: its integers are long.
 */
static uint32_t cell_of(const pir_polytope *polytope, uint32_t f, const oracle_points *own[2],
                        const oracle_points *other[2]) {
    uint32_t found = other[0]->count;
    oracle_vec n;
    oracle_vec_init(n);
    for (int i = 0; i < 2 && found == other[0]->count; i++) {
        facet_normal(polytope, own[i], f, n);
        found = farthest(other[i], n);
    }
    oracle_vec_clear(n);
    return found;
}

/* How the ends of an edge, level along n, lie along it. */
enum standing { BEHIND, TIED, ALONE };

static enum standing standing_of(const pir_polytope *polytope, const oracle_points *points, uint32_t e, oracle_vec n) {
    uint32_t ends[2];
    enum standing standing = ALONE;
    mpz_t level, height;
    pir_polytope_edge(polytope, e, ends);
    mpz_inits(level, height, NULL);
    oracle_dot(level, n, points->at[ends[0]]);
    for (uint32_t i = 0; i < points->count && standing != BEHIND; i++) {
        if (i == ends[0] || i == ends[1])
            continue;
        oracle_dot(height, n, points->at[i]);
        int order = mpz_cmp(height, level);
        standing = order > 0 ? BEHIND : order == 0 ? TIED : standing;
    }
    mpz_clears(level, height, NULL);
    return standing;
}

/* The cross product of edge e of P, as it lies in `points`, and edge d of Q. */
static void cross_edges(const struct bodies *b, const oracle_points *points, uint32_t e, uint32_t d, oracle_vec ret_n) {
    uint32_t of_e[2], of_d[2];
    oracle_vec s, t;
    oracle_vec_init(s);
    oracle_vec_init(t);
    pir_polytope_edge(b->p, e, of_e);
    pir_polytope_edge(b->q, d, of_d);
    oracle_sub(s, points->at[of_e[1]], points->at[of_e[0]]);
    oracle_sub(t, b->at_q.at[of_d[1]], b->at_q.at[of_d[0]]);
    oracle_cross(ret_n, s, t);
    oracle_vec_clear(t);
    oracle_vec_clear(s);
}

static void negate(oracle_vec n) {
    for (int k = 0; k < 3; k++)
        mpz_neg(n[k], n[k]);
}

static enum standing pair_standing(const struct bodies *b, const oracle_points *points, uint32_t e, uint32_t d,
                                   oracle_vec n) {
    enum standing of_p = standing_of(b->p, points, e, n);
    if (of_p == BEHIND)
        return BEHIND;
    enum standing of_q = standing_of(b->q, &b->at_q, d, n);
    return of_p < of_q ? of_p : of_q;
}

/* The direction of n in doubles, of length between 0.5 and √3; zero for zero. */
static pir_vec3 direction_of(oracle_vec n) {
    double part[3];
    long exponent[3], top = LONG_MIN;
    for (int k = 0; k < 3; k++) {
        part[k] = mpz_get_d_2exp(&exponent[k], n[k]);
        if (part[k] != 0 && exponent[k] > top)
            top = exponent[k];
    }
    for (int k = 0; k < 3; k++)
        part[k] = part[k] != 0 && top - exponent[k] < 1000 ? ldexp(part[k], (int)(exponent[k] - top)) : 0;
    return (pir_vec3){part[0], part[1], part[2]};
}

/* Whether edges e and d make a facet of the sum, and its normal at the rotation itself. */
static int edges_pair(const struct bodies *b, uint32_t e, uint32_t d, pir_vec3 *ret_normal) {
    oracle_vec n, near;
    oracle_vec_init(n);
    oracle_vec_init(near);
    cross_edges(b, &b->turned, e, d, n);
    int found = 0, parallel = oracle_is_zero(n);
    for (int both = 0; both < 2 && !found; both++) {
        enum standing standing = parallel ? TIED : pair_standing(b, &b->turned, e, d, n);
        if (standing == TIED) {
            cross_edges(b, &b->moved, e, d, near);
            if (both)
                negate(near);
            standing = pair_standing(b, &b->moved, e, d, near);
        }
        found = standing == ALONE;
        if (found)
            *ret_normal = direction_of(n);
        negate(n);
    }
    oracle_vec_clear(near);
    oracle_vec_clear(n);
    return found;
}

static void *room_for(size_t count, size_t size) {
    void *room = calloc(count + 1, size);
    if (!room)
        abort();
    return room;
}

void oracle_pairing_init(oracle_pairing *pairing, const pir_polytope *p, const pir_polytope *q, pir_quat rotation) {
    struct bodies b;
    bodies_init(&b, p, q, rotation);
    uint32_t of_p = pir_polytope_facet_count(p), of_q = pir_polytope_facet_count(q),
             edges_p = pir_polytope_edge_count(p), edges_q = pir_polytope_edge_count(q);
    *pairing = (oracle_pairing){.fv = room_for(of_p, sizeof(uint32_t)),
                                .vf = room_for(of_q, sizeof(uint32_t)),
                                .ee = room_for((size_t)edges_p * edges_q, sizeof *pairing->ee)};
    const oracle_points *points_p[2] = {&b.turned, &b.moved}, *points_q[2] = {&b.at_q, &b.at_q};
    for (uint32_t f = 0; f < of_p; f++)
        pairing->fv[f] = cell_of(p, f, points_p, points_q);
    for (uint32_t g = 0; g < of_q; g++)
        pairing->vf[g] = cell_of(q, g, points_q, points_p);
    for (uint32_t e = 0; e < edges_p; e++)
        for (uint32_t d = 0; d < edges_q; d++) {
            oracle_edges *next = &pairing->ee[pairing->count];
            *next = (oracle_edges){.p = e, .q = d};
            pairing->count += (uint32_t)edges_pair(&b, e, d, &next->normal);
        }
    bodies_clear(&b);
}

void oracle_pairing_clear(oracle_pairing *pairing) {
    free(pairing->ee);
    free(pairing->vf);
    free(pairing->fv);
}

/* --- the pairing of a sum --- */

static const char *check_edges(const pir_sum *sum, const oracle_pairing *pairing) {
    uint32_t listed = pir_sum_ee_count(sum), edges_q = pir_polytope_edge_count(pir_sum_q(sum));
    uint32_t(*pairs)[2] = room_for(listed, sizeof *pairs);
    unsigned char *in_list = room_for((size_t)pir_polytope_edge_count(pir_sum_p(sum)) * edges_q, 1);
    const char *wrong = NULL;
    pir_sum_ee(sum, pairs);
    for (uint32_t i = 0; i < pairing->count; i++)
        in_list[(size_t)pairing->ee[i].p * edges_q + pairing->ee[i].q] = 1;
    for (uint32_t i = 0; i < listed && !wrong; i++) {
        if (pairs[i][0] >= pir_polytope_edge_count(pir_sum_p(sum)) || pairs[i][1] >= edges_q ||
            !in_list[(size_t)pairs[i][0] * edges_q + pairs[i][1]])
            wrong = "an ee pair is out of range, there twice, or none";
        else
            in_list[(size_t)pairs[i][0] * edges_q + pairs[i][1]] = 0;
    }
    if (!wrong && listed != pairing->count)
        wrong = "an ee pair is missing";
    free(in_list);
    free(pairs);
    return wrong;
}

const char *oracle_check_pairing(const pir_sum *sum) {
    oracle_pairing pairing;
    const pir_polytope *p = pir_sum_p(sum), *q = pir_sum_q(sum);
    oracle_pairing_init(&pairing, p, q, pir_sum_rotation(sum));
    const char *wrong = check_edges(sum, &pairing);
    if (memcmp(pairing.fv, pir_sum_fv(sum), pir_polytope_facet_count(p) * sizeof *pairing.fv) != 0)
        wrong = "an fv pair is not that of the perturbed rotation";
    if (memcmp(pairing.vf, pir_sum_vf(sum), pir_polytope_facet_count(q) * sizeof *pairing.vf) != 0)
        wrong = "a vf pair is not that of the perturbed rotation";
    oracle_pairing_clear(&pairing);
    return wrong;
}
