/* SPDX-License-Identifier: MIT */
/* The integers of a placement: see placed.h. */
#include "query/decide/placed.h"

#include "query/decide/short_numbers.h"

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

pir_int3 pir_exact_cross(pir_exact *exact, const pir_int3 *a, const pir_int3 *b) {
    pir_int3 to = pir_int3_take(&exact->scratch, pir_int3_length(a) + pir_int3_length(b) + 1);
    pir_int3_cross(&to, a, b, &exact->scratch);
    return to;
}

pir_int3 pir_exact_difference(pir_exact *exact, const pir_int3 *a, const pir_int3 *b) {
    uint32_t la = pir_int3_length(a), lb = pir_int3_length(b);
    pir_int3 to = pir_int3_take(&exact->scratch, (la > lb ? la : lb) + 1);
    for (int k = 0; k < 3; k++)
        pir_int_sub(&to.c[k], &a->c[k], &b->c[k]);
    return to;
}

pir_int pir_exact_dot(pir_exact *exact, const pir_int3 *a, const pir_int3 *b) {
    pir_int to = pir_limbs_take(&exact->scratch, pir_int3_length(a) + pir_int3_length(b) + 1);
    pir_int3_dot(&to, a, b, &exact->scratch);
    return to;
}

int pir_exact_dot_sign(pir_exact *exact, const pir_int3 *a, const pir_int3 *b) {
    uint32_t mark = exact->scratch.used;
    pir_int dot = pir_exact_dot(exact, a, b);
    exact->scratch.used = mark;
    return pir_int_sign(&dot);
}

int pir_exact_compare(pir_exact *exact, const pir_int *a, const pir_int *b) {
    uint32_t mark = exact->scratch.used, la = pir_int_length(a), lb = pir_int_length(b);
    pir_int rest = pir_limbs_take(&exact->scratch, (la > lb ? la : lb) + 1);
    pir_int_sub(&rest, a, b);
    exact->scratch.used = mark;
    return pir_int_sign(&rest);
}

pir_int pir_exact_product(pir_exact *exact, const pir_int *a, const pir_int *b) {
    pir_int to = pir_limbs_take(&exact->scratch, pir_int_length(a) + pir_int_length(b));
    pir_int_mul(&to, a, b);
    return to;
}

pir_int3 pir_exact_scaled(pir_exact *exact, const pir_int3 *v, const pir_int *s) {
    pir_int3 to;
    for (int k = 0; k < 3; k++)
        to.c[k] = pir_exact_product(exact, &v->c[k], s);
    return to;
}

pir_int pir_exact_square(pir_exact *exact, const pir_int3 *v) {
    return pir_exact_dot(exact, v, v);
}

pir_real pir_exact_length(pir_exact *exact, const pir_int3 *v) {
    uint32_t mark = exact->scratch.used;
    pir_int square = pir_exact_square(exact, v);
    exact->scratch.used = mark;
    return pir_real_root(pir_real_of(&square));
}

/* The exponent of the lowest set bit of three numbers, at most 0. */
static int low_bit_of(pir_vec3 v) {
    const double c[3] = {v.x, v.y, v.z};
    int e = 0;
    for (int k = 0; k < 3; k++)
        e = pir_double_low_bit(c[k]) < e ? pir_double_low_bit(c[k]) : e;
    return e;
}

pir_int3 pir_exact_vector(pir_exact *exact, pir_vec3 v, int *ret_exponent) {
    const double c[3] = {v.x, v.y, v.z};
    pir_int3 to = pir_int3_take(&exact->scratch, PIR_QUAT_LIMBS);
    *ret_exponent = low_bit_of(v);
    for (int k = 0; k < 3; k++)
        pir_int_set_double(&to.c[k], c[k], *ret_exponent);
    return to;
}

pir_int3 pir_exact_direction_by_q(pir_exact *exact, pir_vec3 v, int *ret_exponent) {
    if (!exact->world)
        return pir_exact_vector(exact, v, ret_exponent);
    pir_int3 to = pir_int3_take(&exact->scratch, PIR_QUAT_LIMBS + PIR_MATRIX_LIMBS + 1);
    uint32_t mark = exact->scratch.used;
    pir_int3 given = pir_exact_vector(exact, v, ret_exponent);
    pir_rotation_apply_transposed(exact->world->rotation_q, &to, &given, &exact->scratch);
    exact->scratch.used = mark;
    return to;
}

/* --- a placement --- */

static uint32_t longer(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

/*
 * The limbs that scratch needs. W, an edge vector and a normal have at most w, e and n limbs. At one time these are
 * in use at most:
 *
 * - the placement's own integers;
 * - four corners and three differences of them: 21 w;
 * - the normal at their nearest point, 3·(3w + 4), with the determinants that choose it: 8w, three times;
 * - in comparisons, two slacks and the squares of two normals, each pair multiplied: 12 (n + w);
 * - along a way, a corner that is moved, 3 (n + w + PIR_QUAT_LIMBS), a side's normal, 3 (n + e), and their product,
 *   each longer by a matrix where Q is turned.
 *
 * Their sum is below what is returned.
 */
uint32_t pir_exact_limbs(const pir_polytope *p, const pir_polytope *q) {
    const uint32_t a = pir_int_length(&p->scale.num), b = pir_int_length(&p->scale.den),
                   c = pir_int_length(&q->scale.num), d = pir_int_length(&q->scale.den),
                   shift = 1074 / GMP_NUMB_BITS + 2;
    // with Q's rotation: its norm, its matrix, and the carries of three products
    uint32_t of_p = a + d + shift + 2 * PIR_MATRIX_LIMBS + 1 + p->exact_vertex.stride,
             of_q = 2 * PIR_MATRIX_LIMBS + c + b + shift + q->exact_vertex.stride,
             of_t = 2 * PIR_MATRIX_LIMBS + b + d + PIR_QUAT_LIMBS + 3;
    uint32_t w = longer(of_p, longer(of_q, of_t)) + 3;
    uint32_t e = longer(PIR_MATRIX_LIMBS + p->exact_edge.stride, q->exact_edge.stride) + 2;
    uint32_t n = longer(PIR_MATRIX_LIMBS + p->exact_normal.stride + 2,
                        longer(q->exact_normal.stride, e + q->exact_edge.stride + 2));
    return 64 * w + 24 * (n + e + PIR_QUAT_LIMBS) + 16 * PIR_MATRIX_LIMBS + 256;
}

bool pir_exact_reserve_limbs(pir_exact *exact, const pir_allocator *allocator, uint32_t need) {
    pir_exact_forget(exact);
    if (pir_exact_has_limbs(exact, need))
        return true;
    mp_limb_t *limbs = PIR_NEW(allocator, mp_limb_t, need);
    if (!limbs)
        return false;
    pir_exact_finish(exact, allocator);
    exact->scratch = (pir_limbs){limbs, 0, need};
    return true;
}

void pir_exact_finish(pir_exact *exact, const pir_allocator *allocator) {
    PIR_FREE(allocator, exact->scratch.base, exact->scratch.capacity);
}

/* a·b·c·2^bits. */
static pir_int product(pir_exact *exact, const pir_int *a, const pir_int *b, const pir_int *c, uint32_t bits) {
    pir_limbs *scratch = &exact->scratch;
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

/* T in units of 2^*ret_exponent, and N'. */
static void set_translation(pir_exact *exact, pir_vec3 translation, int *ret_exponent) {
    const pir_world *world = exact->world;
    exact->one = 1;
    exact->norm_q = (pir_int){&exact->one, 1, 0};
    if (!world) {
        exact->t = pir_exact_vector(exact, translation, ret_exponent);
        return;
    }
    pir_vec3 to = world->translation_p, from = world->translation_q;
    pir_rotation_make_exact(world->rotation_q);
    exact->norm_q = world->rotation_q->integers->norm;
    int e = low_bit_of(to) < low_bit_of(from) ? low_bit_of(to) : low_bit_of(from);
    exact->t = pir_int3_take(&exact->scratch, PIR_QUAT_LIMBS + PIR_MATRIX_LIMBS + 3);
    uint32_t mark = exact->scratch.used;
    pir_int3 difference = pir_int3_take(&exact->scratch, PIR_QUAT_LIMBS + 1);
    const double p[3] = {to.x, to.y, to.z}, q[3] = {from.x, from.y, from.z};
    for (int k = 0; k < 3; k++) {
        pir_int of_q = pir_limbs_take(&exact->scratch, PIR_QUAT_LIMBS);
        pir_int_set_double(&difference.c[k], p[k], e);
        pir_int_set_double(&of_q, q[k], e);
        pir_int_sub(&difference.c[k], &difference.c[k], &of_q);
    }
    pir_rotation_apply_transposed(world->rotation_q, &exact->t, &difference, &exact->scratch);
    exact->scratch.used = mark;
    *ret_exponent = e;
}

void pir_exact_begin(pir_exact *exact, pir_vec3 translation) {
    if (exact->made && same(exact->translation, translation) && pir_rotation_has_integers(exact->rotation))
        return;
    PIR_ASSERT(!exact->made || exact->scratch.used == exact->mark);
    const pir_scale *sp = &exact->frame->p.polytope->scale, *sq = &exact->frame->q.polytope->scale;
    pir_rotation *rotation = exact->rotation;
    pir_rotation_make_exact(rotation);
    exact->scratch.used = 0;
    exact->translation = translation;
    int exponent;
    set_translation(exact, translation, &exponent);
    exact->i = (uint32_t)-exponent;
    pir_int norm = pir_exact_product(exact, &rotation->integers->norm, &exact->norm_q);
    exact->p = product(exact, &sp->num, &sq->den, &exact->norm_q, exact->i);
    exact->q = product(exact, &norm, &sq->num, &sp->den, exact->i);
    exact->k = product(exact, &rotation->integers->norm, &sp->den, &sq->den, 0);
    exact->mark = exact->scratch.used;
    exact->made = true;
}

pir_real pir_exact_unit(const pir_exact *exact) {
    pir_real k = pir_real_times(pir_real_of(&exact->k), pir_real_of(&exact->norm_q));
    return pir_real_over((pir_real){0.5, 1 - (int)exact->i - exact->frame->exponent}, k);
}

pir_int3 pir_exact_half_p(pir_exact *exact, uint32_t half) {
    pir_int3 e = pir_half_exact(exact->frame->p.polytope, half);
    pir_int3 to = pir_int3_take(&exact->scratch, pir_int3_length(&e) + PIR_MATRIX_LIMBS + 1);
    pir_rotation_apply(exact->rotation, &to, &e, &exact->scratch);
    return to;
}

pir_int3 pir_exact_half_q(const pir_exact *exact, uint32_t half) {
    return pir_half_exact(exact->frame->q.polytope, half);
}

pir_int3 pir_exact_corner(pir_exact *exact, uint32_t a, uint32_t b) {
    pir_limbs *scratch = &exact->scratch;
    pir_int3 va = pir_vertex_exact(exact->frame->p.polytope, a), vb = pir_vertex_exact(exact->frame->q.polytope, b);
    uint32_t turned_length = pir_int3_length(&va) + PIR_MATRIX_LIMBS + 1;
    uint32_t length = turned_length + pir_int_length(&exact->p);
    length = longer(length, pir_int3_length(&vb) + pir_int_length(&exact->q));
    length = longer(length, pir_int3_length(&exact->t) + pir_int_length(&exact->k)) + 2;
    pir_int3 to = pir_int3_take(scratch, length);
    uint32_t mark = scratch->used;
    pir_int3 turned = pir_int3_take(scratch, turned_length);
    pir_rotation_apply(exact->rotation, &turned, &va, scratch);
    for (int k = 0; k < 3; k++) {
        const pir_term terms[3] = {
            {&turned.c[k], &exact->p, false}, {&vb.c[k], &exact->q, false}, {&exact->t.c[k], &exact->k, true}};
        pir_int_sum(&to.c[k], terms, 3, scratch);
    }
    scratch->used = mark;
    return to;
}

pir_int3 pir_exact_normal(pir_exact *exact, pir_piece piece) {
    if (piece.kind == PIR_FACET_VF)
        return pir_normal_exact(exact->frame->q.polytope, piece.second);
    if (piece.kind == PIR_FACET_FV) {
        pir_int3 n = pir_normal_exact(exact->frame->p.polytope, piece.first);
        pir_int3 to = pir_int3_take(&exact->scratch, pir_int3_length(&n) + PIR_MATRIX_LIMBS + 1);
        pir_rotation_apply(exact->rotation, &to, &n, &exact->scratch);
        return to;
    }
    pir_int3 e = pir_exact_half_p(exact, exact->frame->p.polytope->edge_half[piece.first]),
             d = pir_half_exact(exact->frame->q.polytope, piece.second);
    return pir_exact_cross(exact, &d, &e);
}

/* --- the side of a piece's plane --- */

bool pir_side_normal(pir_exact *exact, pir_piece piece, pir_vec3 *ret_normal) {
    if (pir_short_normal(exact, piece, ret_normal))
        return pir_vec_dot(*ret_normal, *ret_normal) > 0;
    pir_rotation_make_exact(exact->rotation);
    uint32_t mark = exact->scratch.used;
    pir_int3 n = pir_exact_normal(exact, piece);
    bool is_normal = !pir_int3_is_zero(&n);
    if (is_normal)
        *ret_normal = pir_int3_unit(&n);
    exact->scratch.used = mark;
    return is_normal;
}

int pir_side_exact(pir_exact *exact, pir_piece piece, pir_vec3 translation) {
    pir_exact_begin(exact, translation);
    uint32_t mark = exact->scratch.used, a, b;
    pir_piece_corner(exact->frame, piece, &a, &b);
    pir_int3 n = pir_exact_normal(exact, piece), corner = pir_exact_corner(exact, a, b);
    int sign = pir_exact_dot_sign(exact, &n, &corner);
    exact->scratch.used = mark;
    return sign;
}
