/* SPDX-License-Identifier: MIT */
/* The integers of a placement: see exact.h. */
#include "query/decide/placed.h"

#include "query/query.h"

/* --- reals --- */

static pir_real normal_real(double m, int e) {
    int shift;
    m = frexp(m, &shift);
    return (pir_real){m, m != 0 ? e + shift : 0};
}

pir_real pir_real_of(const pir_int *a) {
    pir_real real;
    real.m = pir_int_to_double(a, &real.e);
    return real;
}

pir_real pir_real_over(pir_real a, pir_real b) {
    return normal_real(a.m / b.m, a.e - b.e);
}

pir_real pir_real_times(pir_real a, pir_real b) {
    return normal_real(a.m * b.m, a.e + b.e);
}

pir_real pir_real_root(pir_real a) {
    bool odd = a.e % 2 != 0;
    return normal_real(sqrt(odd ? 2 * a.m : a.m), (a.e - odd) / 2);
}

double pir_real_double(pir_real a) {
    return ldexp(a.m, a.e);
}

/* --- integers on the scratch --- */

pir_int3 pir_exact_cross(pir_query *query, const pir_int3 *a, const pir_int3 *b) {
    pir_int3 to = pir_int3_take(&query->scratch, pir_int3_length(a) + pir_int3_length(b) + 1);
    pir_int3_cross(&to, a, b, &query->scratch);
    return to;
}

pir_int3 pir_exact_difference(pir_query *query, const pir_int3 *a, const pir_int3 *b) {
    uint32_t la = pir_int3_length(a), lb = pir_int3_length(b);
    pir_int3 to = pir_int3_take(&query->scratch, (la > lb ? la : lb) + 1);
    for (int k = 0; k < 3; k++)
        pir_int_sub(&to.c[k], &a->c[k], &b->c[k]);
    return to;
}

pir_int pir_exact_dot(pir_query *query, const pir_int3 *a, const pir_int3 *b) {
    pir_int to = pir_limbs_take(&query->scratch, pir_int3_length(a) + pir_int3_length(b) + 1);
    pir_int3_dot(&to, a, b, &query->scratch);
    return to;
}

int pir_exact_dot_sign(pir_query *query, const pir_int3 *a, const pir_int3 *b) {
    uint32_t mark = query->scratch.used;
    pir_int dot = pir_exact_dot(query, a, b);
    query->scratch.used = mark;
    return pir_int_sign(&dot);
}

int pir_exact_compare(pir_query *query, const pir_int *a, const pir_int *b) {
    uint32_t mark = query->scratch.used, la = pir_int_length(a), lb = pir_int_length(b);
    pir_int rest = pir_limbs_take(&query->scratch, (la > lb ? la : lb) + 1);
    pir_int_sub(&rest, a, b);
    query->scratch.used = mark;
    return pir_int_sign(&rest);
}

pir_int pir_exact_product(pir_query *query, const pir_int *a, const pir_int *b) {
    pir_int to = pir_limbs_take(&query->scratch, pir_int_length(a) + pir_int_length(b));
    pir_int_mul(&to, a, b);
    return to;
}

pir_int3 pir_exact_scaled(pir_query *query, const pir_int3 *v, const pir_int *s) {
    pir_int3 to;
    for (int k = 0; k < 3; k++)
        to.c[k] = pir_exact_product(query, &v->c[k], s);
    return to;
}

pir_int pir_exact_square(pir_query *query, const pir_int3 *v) {
    return pir_exact_dot(query, v, v);
}

pir_real pir_exact_length(pir_query *query, const pir_int3 *v) {
    uint32_t mark = query->scratch.used;
    pir_int square = pir_exact_square(query, v);
    query->scratch.used = mark;
    return pir_real_root(pir_real_of(&square));
}

/* The exponent of the lowest set bit; INT32_MAX for zero. */
static int low_bit(double x) {
    if (x == 0)
        return INT32_MAX;
    int e;
    uint64_t mantissa = (uint64_t)ldexp(frexp(fabs(x), &e), 53);
    for (e -= 53; (mantissa & 1) == 0; e++)
        mantissa >>= 1;
    return e;
}

/* The lowest set bit of three numbers, but 0 at most. */
static int low_bit_of(pir_vec3 v) {
    const double c[3] = {v.x, v.y, v.z};
    int e = 0;
    for (int k = 0; k < 3; k++)
        e = low_bit(c[k]) < e ? low_bit(c[k]) : e;
    return e;
}

pir_int3 pir_exact_vector(pir_query *query, pir_vec3 v, int *ret_exponent) {
    const double c[3] = {v.x, v.y, v.z};
    pir_int3 to = pir_int3_take(&query->scratch, PIR_QUAT_LIMBS);
    *ret_exponent = low_bit_of(v);
    for (int k = 0; k < 3; k++)
        pir_int_set_double(&to.c[k], c[k], *ret_exponent);
    return to;
}

/* --- a placement --- */

static uint32_t longer(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

/*
 * Limbs of W, of an edge vector and of a normal are at most w, e and n below. What is live at a time is at most: the
 * placement's own integers; four corners and three differences of them (21 w); their nearest point's normal (3·(3w +
 * 4)) with the determinants that choose it (8w, three times over); in comparisons, two slacks and squares of two
 * normals, each pair multiplied (12 (n + w)); and, along a way, a corner that is moved (3 (n + w + PIR_QUAT_LIMBS))
 * with a side's normal (3 (n + e)) and their product. All of it together is below what is returned.
 */
uint32_t pir_exact_limbs(const pir_polytope *p, const pir_polytope *q) {
    const uint32_t a = pir_int_length(&p->scale.num), b = pir_int_length(&p->scale.den),
                   c = pir_int_length(&q->scale.num), d = pir_int_length(&q->scale.den),
                   shift = 1074 / GMP_NUMB_BITS + 2;
    uint32_t of_p = a + d + shift + PIR_MATRIX_LIMBS + 1 + p->exact_vertex.stride,
             of_q = PIR_MATRIX_LIMBS + c + b + shift + q->exact_vertex.stride,
             of_t = PIR_MATRIX_LIMBS + b + d + PIR_QUAT_LIMBS;
    uint32_t w = longer(of_p, longer(of_q, of_t)) + 3;
    uint32_t e = longer(PIR_MATRIX_LIMBS + p->exact_edge.stride, q->exact_edge.stride) + 2;
    uint32_t n = longer(PIR_MATRIX_LIMBS + p->exact_normal.stride + 2,
                        longer(q->exact_normal.stride, e + q->exact_edge.stride + 2));
    return 64 * w + 24 * (n + e + PIR_QUAT_LIMBS) + 256;
}

/* a·b·c·2^bits. */
static pir_int product(pir_query *query, const pir_int *a, const pir_int *b, const pir_int *c, uint32_t bits) {
    pir_limbs *scratch = &query->scratch;
    uint32_t length = pir_int_length(a) + pir_int_length(b) + pir_int_length(c) + bits / GMP_NUMB_BITS + 2;
    pir_int to = pir_limbs_take(scratch, length);
    uint32_t mark = scratch->used;
    pir_int part = pir_limbs_take(scratch, length), whole = pir_limbs_take(scratch, length);
    pir_int_mul(&part, a, b);
    pir_int_mul(&whole, &part, c);
    pir_int_shift_left(&to, &whole, bits);
    scratch->used = mark;
    return to;
}

static bool same(pir_vec3 a, pir_vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

void pir_exact_begin(pir_query *query, pir_vec3 translation) {
    pir_exact *exact = &query->exact;
    if (exact->made && same(exact->translation, translation))
        return;
    PIR_ASSERT(!exact->made || query->scratch.used == exact->mark);
    const pir_scale *sp = &query->p->scale, *sq = &query->q->scale;
    pir_rotation *rotation = pir_sum_exact_rotation(query->sum);
    pir_rotation_make_exact(rotation);
    mp_limb_t one_limb = 1;
    pir_int one = {&one_limb, 1, 0};
    query->scratch.used = 0;
    exact->translation = translation;
    int exponent;
    exact->t = pir_exact_vector(query, translation, &exponent);
    exact->i = (uint32_t)-exponent;
    exact->p = product(query, &sp->num, &sq->den, &one, exact->i);
    exact->q = product(query, &rotation->norm, &sq->num, &sp->den, exact->i);
    exact->k = product(query, &rotation->norm, &sp->den, &sq->den, 0);
    exact->mark = query->scratch.used;
    exact->made = true;
}

pir_real pir_exact_unit(const pir_query *query) {
    pir_real k = pir_real_of(&query->exact.k);
    return pir_real_over((pir_real){0.5, 1 - (int)query->exact.i - query->exponent}, k);
}

pir_int3 pir_exact_half_p(pir_query *query, uint32_t half) {
    pir_int3 e = pir_half_exact(query->p, half);
    pir_int3 to = pir_int3_take(&query->scratch, pir_int3_length(&e) + PIR_MATRIX_LIMBS + 1);
    pir_rotation_apply(pir_sum_exact_rotation(query->sum), &to, &e, &query->scratch);
    return to;
}

pir_int3 pir_exact_half_q(const pir_query *query, uint32_t half) {
    return pir_half_exact(query->q, half);
}

pir_int3 pir_exact_corner(pir_query *query, uint32_t a, uint32_t b) {
    const pir_exact *exact = &query->exact;
    pir_limbs *scratch = &query->scratch;
    pir_int3 va = pir_vertex_exact(query->p, a), vb = pir_vertex_exact(query->q, b);
    uint32_t turned_length = pir_int3_length(&va) + PIR_MATRIX_LIMBS + 1;
    uint32_t length = turned_length + pir_int_length(&exact->p);
    length = longer(length, pir_int3_length(&vb) + pir_int_length(&exact->q));
    length = longer(length, pir_int3_length(&exact->t) + pir_int_length(&exact->k)) + 2;
    pir_int3 to = pir_int3_take(scratch, length);
    uint32_t mark = scratch->used;
    pir_int3 turned = pir_int3_take(scratch, turned_length);
    pir_rotation_apply(pir_sum_exact_rotation(query->sum), &turned, &va, scratch);
    for (int k = 0; k < 3; k++) {
        pir_int_add_mul(&to.c[k], &turned.c[k], &exact->p, scratch);
        pir_int_add_mul(&to.c[k], &vb.c[k], &exact->q, scratch);
        pir_int_sub_mul(&to.c[k], &exact->t.c[k], &exact->k, scratch);
    }
    scratch->used = mark;
    return to;
}

pir_int3 pir_exact_normal(pir_query *query, pir_piece piece) {
    if (piece.kind == PIR_FACET_VF)
        return pir_normal_exact(query->q, piece.second);
    if (piece.kind == PIR_FACET_FV) {
        pir_int3 n = pir_normal_exact(query->p, piece.first);
        pir_int3 to = pir_int3_take(&query->scratch, pir_int3_length(&n) + PIR_MATRIX_LIMBS + 1);
        pir_rotation_apply(pir_sum_exact_rotation(query->sum), &to, &n, &query->scratch);
        return to;
    }
    pir_int3 e = pir_exact_half_p(query, query->p->edge_half[piece.first]), d = pir_half_exact(query->q, piece.second);
    return pir_exact_cross(query, &d, &e);
}
