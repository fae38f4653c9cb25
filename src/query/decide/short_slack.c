/* SPDX-License-Identifier: MIT */
/*
 * Slacks in integers of fixed length: see short_slack.h.
 *
 * With q an integer quaternion below 2^61 a component, the entries of M are below N = |q|² ≤ 2^124, and |M v| =
 * N |v|. Vertices p of P, and the difference d of one of Q and the translation, are integers below 2^122 on one power
 * of two. Then, componentwise,
 *
 *     W = M p + N d          below √3 · 2^246 + 2^246 < 2^248,
 *     n = M m, or m          below √3 · 2^246 < 2^247 for a facet normal m below 2^122,
 *     n = e' × M e           below 2 · 2^62 · √3 · 2^186 < 2^250 for edges e, e' below 2^62,
 *
 * and n·W and n·n are below 3 · 2^500.
 *
 * Where coordinates are small integers, as those of boxes are, n and M p take two limbs. With N, v, e and e' of b, c,
 * d and d' bits, M v is below 3 · 2^(b + c), and e' × M e below 3 · 2^(b + d + d'), and so is every sum on the way.
 * These are brief where that is at most BRIEF_BITS bits: below 2^126, and n·n below 2^254.
 */
#include "query/decide/short_slack.h"

#include "exact/wide.h"

#if PIR_HAVE_WIDE

#define VECTOR_BITS 122
#define EDGE_BITS   62
#define BRIEF_BITS  124

typedef struct two3 {
    pir_two_limbs c[3];
} two3;

/* M and N, and the bits of N. */
typedef struct turning {
    pir_two_limbs m[3][3], norm;
    uint32_t bits;
} turning;

/* The bits of the largest of three integers. */
static inline uint32_t bits_of(const pir_two_limbs c[3]) {
    pir_two_limbs_unsigned any = 0;
    for (int k = 0; k < 3; k++)
        any |= (pir_two_limbs_unsigned)(c[k] < 0 ? -c[k] : c[k]);
    uint64_t high = (uint64_t)(any >> 64), low = (uint64_t)any;
    return high ? 128 - (uint32_t)__builtin_clzll(high) : low ? 64 - (uint32_t)__builtin_clzll(low) : 0;
}

/* A double as an integer in units of 2^exponent, where that is below 2^bits. */
static inline bool get_double(double x, int exponent, uint32_t bits, pir_two_limbs *ret_value) {
    int shift;
    uint64_t mantissa = pir_double_split(x, &shift);
    *ret_value = 0;
    if (mantissa == 0)
        return true;
    uint32_t zeros = (uint32_t)__builtin_ctzll(mantissa), left = (uint32_t)(shift + (int)zeros - exponent);
    mantissa >>= zeros;
    if (left > bits || 64 - (uint32_t)__builtin_clzll(mantissa) + left > bits)
        return false;
    pir_two_limbs size = (pir_two_limbs)mantissa << left;
    *ret_value = x < 0 ? -size : size;
    return true;
}

/* The least exponent of a bit of `count` doubles that is set; INT32_MAX where there is none. */
static inline int low_bit(const double *c, int count) {
    int low = INT32_MAX;
    for (int k = 0; k < count; k++) {
        int e = pir_double_low_bit(c[k]);
        low = e < low ? e : low;
    }
    return low;
}

/* As set_short of exact/rotation.c. */
static inline bool get_turning(const pir_rotation *rotation, turning *to) {
    const double c[4] = {rotation->given.x, rotation->given.y, rotation->given.z, rotation->given.w};
    int low = low_bit(c, 4);
    pir_two_limbs q[4], square[4];
    for (int k = 0; k < 4; k++) {
        if (!get_double(c[k], low, 61, &q[k]))
            return false;
        square[k] = q[k] * q[k];
    }
    to->norm = square[0] + square[1] + square[2] + square[3];
    to->bits = bits_of((const pir_two_limbs[3]){to->norm, 0, 0});
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        pir_two_limbs of_v = q[i] * q[j], of_w = q[3] * q[k];
        to->m[i][i] = 2 * (square[i] + square[3]) - to->norm;
        to->m[i][j] = 2 * (of_v - of_w);
        to->m[j][i] = 2 * (of_v + of_w);
    }
    return true;
}

static inline bool get_vector(const pir_int3 *v, uint32_t bits, two3 *ret_v) {
    return pir_int_get_two(&v->c[0], bits, &ret_v->c[0]) && pir_int_get_two(&v->c[1], bits, &ret_v->c[1]) &&
           pir_int_get_two(&v->c[2], bits, &ret_v->c[2]);
}

/* The exponent of a scale that is a power of two. */
static inline bool get_exponent(const pir_scale *scale, int *ret_exponent) {
    uint32_t num = pir_int_trailing_zeros(&scale->num), den = pir_int_trailing_zeros(&scale->den);
    *ret_exponent = (int)num - (int)den;
    return num + 1 == pir_int_bits(&scale->num) && den + 1 == pir_int_bits(&scale->den);
}

/* A number that is shifted to the left, and stays below 2^bits. */
static inline bool get_unshifted(const pir_int3 *v, int shift, int bits, two3 *ret_v) {
    return shift < bits && get_vector(v, (uint32_t)(bits - shift), ret_v);
}

static inline void shift_vector(two3 *v, int shift) {
    for (int k = 0; k < 3; k++)
        v->c[k] *= (pir_two_limbs)1 << shift;
}

static inline void turn(const turning *by, const two3 *v, pir_int256 to[3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            pir_int256_add_product(&to[i], by->m[i][j], v->c[j]);
}

/* M v, where that is brief when multiplied by so many bits more. */
static inline bool turn_briefly(const turning *by, const two3 *v, uint32_t more, two3 *to) {
    if (by->bits + bits_of(v->c) + more > BRIEF_BITS)
        return false;
    for (int i = 0; i < 3; i++)
        to->c[i] = by->m[i][0] * v->c[0] + by->m[i][1] * v->c[1] + by->m[i][2] * v->c[2];
    return true;
}

/* to += M v · 2^shift. */
static inline void turn_shifted(const turning *by, two3 *v, int shift, pir_int256 to[3]) {
    two3 turned;
    if (turn_briefly(by, v, 0, &turned)) {
        for (int k = 0; k < 3; k++)
            pir_int256_add_product(&to[k], turned.c[k], (pir_two_limbs)1 << shift);
    } else {
        shift_vector(v, shift);
        turn(by, v, to);
    }
}

/* W, in units of 2^*ret_exponent / N. */
static bool get_corner(const pir_frame *frame, const turning *by, pir_vec3 translation, const pir_facet *facet,
                       pir_int256 corner[3], int *ret_exponent) {
    const double t[3] = {translation.x, translation.y, translation.z};
    int of_p, of_q, low = low_bit(t, 3);
    if (!get_exponent(&frame->p.polytope->scale, &of_p) || !get_exponent(&frame->q.polytope->scale, &of_q))
        return false;
    low = of_p < low ? of_p : low;
    low = of_q < low ? of_q : low;
    pir_int3 va = pir_vertex_exact(frame->p.polytope, facet->a), vb = pir_vertex_exact(frame->q.polytope, facet->b);
    two3 p, d;
    // a bit less for those that are subtracted
    if (!get_unshifted(&va, of_p - low, VECTOR_BITS, &p) || !get_unshifted(&vb, of_q - low, VECTOR_BITS - 1, &d))
        return false;
    shift_vector(&d, of_q - low);
    for (int k = 0; k < 3; k++) {
        pir_two_limbs moved;
        if (!get_double(t[k], low, VECTOR_BITS - 1, &moved))
            return false;
        d.c[k] -= moved;
    }
    turn_shifted(by, &p, of_p - low, corner);
    for (int k = 0; k < 3; k++)
        pir_int256_add_product(&corner[k], by->norm, d.c[k]);
    *ret_exponent = low;
    return true;
}

/* d × M e. */
static bool get_crossing(const pir_frame *frame, const turning *by, pir_piece piece, pir_int256 n[3]) {
    const pir_polytope *p = frame->p.polytope;
    pir_int3 of_p = pir_half_exact(p, p->edge_half[piece.first]),
             of_q = pir_half_exact(frame->q.polytope, piece.second);
    two3 e, d;
    if (!get_vector(&of_p, EDGE_BITS, &e) || !get_vector(&of_q, EDGE_BITS, &d))
        return false;
    pir_int256 turned[3] = {{{0}}, {{0}}, {{0}}};
    turn(by, &e, turned);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        pir_int256_add_scaled(&n[k], &turned[j], (int64_t)d.c[i]);
        pir_int256_add_scaled(&n[k], &turned[i], -(int64_t)d.c[j]);
    }
    return true;
}

static bool get_normal(const pir_frame *frame, const turning *by, pir_piece piece, pir_int256 n[3]) {
    if (piece.kind == PIR_FACET_EE)
        return get_crossing(frame, by, piece, n);
    bool of_p = piece.kind == PIR_FACET_FV;
    pir_int3 own =
        of_p ? pir_normal_exact(frame->p.polytope, piece.first) : pir_normal_exact(frame->q.polytope, piece.second);
    two3 m;
    if (!get_vector(&own, VECTOR_BITS, &m))
        return false;
    if (of_p)
        turn(by, &m, n);
    for (int k = 0; !of_p && k < 3; k++)
        pir_int256_add_product(&n[k], m.c[k], 1);
    return true;
}

/* The normal, where it is brief. */
static bool get_brief_normal(const pir_frame *frame, const turning *by, pir_piece piece, two3 *n) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    if (piece.kind == PIR_FACET_EE) {
        pir_int3 of_p = pir_half_exact(p, p->edge_half[piece.first]), of_q = pir_half_exact(q, piece.second);
        two3 e, d, turned;
        if (!get_vector(&of_p, EDGE_BITS, &e) || !get_vector(&of_q, EDGE_BITS, &d) ||
            !turn_briefly(by, &e, bits_of(d.c), &turned))
            return false;
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            n->c[k] = d.c[i] * turned.c[j] - d.c[j] * turned.c[i];
        }
        return true;
    }
    bool of_p = piece.kind == PIR_FACET_FV;
    pir_int3 own = of_p ? pir_normal_exact(p, piece.first) : pir_normal_exact(q, piece.second);
    two3 m;
    if (!get_vector(&own, VECTOR_BITS, of_p ? &m : n))
        return false;
    return !of_p || turn_briefly(by, &m, 0, n);
}

/* n·W and n·n. */
static bool get_products(const pir_frame *frame, const turning *by, pir_piece piece, const pir_int256 corner[3],
                         pir_int512 *ret_dot, pir_int512 *ret_square) {
    two3 brief;
    pir_int256 n[3] = {{{0}}, {{0}}, {{0}}};
    if (get_brief_normal(frame, by, piece, &brief)) {
        *ret_dot = pir_int256_dot_two(corner, brief.c);
        *ret_square = pir_two_square(brief.c);
        return true;
    }
    if (!get_normal(frame, by, piece, n))
        return false;
    *ret_dot = pir_int256_dot(n, corner);
    *ret_square = pir_int256_dot(n, n);
    return true;
}

/* The steps of facet.c from integers to a number: the slack in lengths of the frame. */
static double number_of(const pir_frame *frame, const pir_int512 *dot, const pir_int512 *square, pir_two_limbs norm,
                        int exponent) {
    mp_limb_t limbs[2];
    pir_int n = {limbs, 0, 2};
    pir_int_set_two(&n, norm);
    pir_real of_dot, of_square;
    of_dot.m = pir_int512_to_double(dot, &of_dot.e);
    of_square.m = pir_int512_to_double(square, &of_square.e);
    pir_real unit = pir_real_over((pir_real){0.5, 1 + exponent - frame->exponent}, pir_real_of(&n));
    return pir_real_double(pir_real_times(pir_real_over(of_dot, pir_real_root(of_square)), unit));
}

bool pir_short_slack(const pir_exact *exact, pir_vec3 translation, const pir_facet *facet, int *ret_sign,
                     double *ret_slack) {
    const pir_frame *frame = exact->frame;
    turning by;
    int exponent;
    pir_int256 corner[3] = {{{0}}, {{0}}, {{0}}};
    pir_int512 dot, square;
    if (exact->world || exact->rotation->relative || !get_turning(exact->rotation, &by) ||
        !get_corner(frame, &by, translation, facet, corner, &exponent) ||
        !get_products(frame, &by, facet->piece, corner, &dot, &square))
        return false;
    *ret_sign = pir_int512_sign(&dot);
    *ret_slack = number_of(frame, &dot, &square, by.norm, exponent);
    return true;
}

#else

bool pir_short_slack(const pir_exact *exact, pir_vec3 translation, const pir_facet *facet, int *ret_sign,
                     double *ret_slack) {
    (void)exact, (void)translation, (void)facet, (void)ret_sign, (void)ret_slack;
    return false;
}
#endif
