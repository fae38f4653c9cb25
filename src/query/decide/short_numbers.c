/* SPDX-License-Identifier: MIT */
/*
 * Numbers in integers of fixed length: see short_numbers.h.
 *
 * With q an integer quaternion of N = |q|² < 2^126, the entries of M are at most N, and |M v| = N |v|. Vertices p of
 * P, and the difference d of one of Q and the translation, are integers below 2^122 on one power of two. Then,
 * componentwise,
 *
 *     W = M p + N d          below √3 · 2^248 + 2^248 < 2^250,
 *     n = M m, or m          below √3 · 2^248 < 2^249 for a facet normal m below 2^122,
 *     n = e' × M e           below 2 · 2^62 · √3 · 2^188 < 2^252 for edges e, e' below 2^62,
 *
 * and n·W and n·n are below 3 · 2^504.
 *
 * Where coordinates are small integers, as those of boxes are, n and M p take two limbs. With N, v, e and e' of b, c,
 * d and d' bits, M v is below 3 · 2^(b + c), and e' × M e below 3 · 2^(b + d + d'), and so is every sum on the way.
 * These are brief where that is at most BRIEF_BITS bits: below 2^126, and n·n below 2^254.
 *
 * Where Q is turned too, the world is a better place than Q's frame, where P's rotation has twice as many bits. Let
 * M_P, N_P, M_Q and N_Q be of both as given, and T = q's translation less p's. Since M a × M b = N M(a × b) and
 * M a · M b = N² a·b, the n·W of placed.h is F s with
 *
 *     s = N_P N_Q m·p + M_P m · (M_Q q + N_Q T)                             F = N_P N_Q²     for a facet of P,
 *     s = N_P N_Q m·q + M_Q m · (M_P p + N_P T)                             F = N_Q          for a facet of Q,
 *     s = M_Q d · (M_P (e × p) + M_P e × T) + M_P e · M_Q (q × d)           F = N_P N_Q²     for two edges,
 *
 * and n·n = (N_P N_Q)² m·m, m·m, and |M_Q d × M_P e|². With m, p, q and T below 2^122 a vector in s is below
 * 2^250, s below 2^503. Of edges e × p, q × d and M_P e × T are refused where they may be longer than that.
 *
 * Of edges e and d below 2^62 that are nearly parallel, and of D's edges and corners, let
 *
 *     X = N_P N_Q e·p + M_P e · (M_Q q + N_Q T)            the first s, of e in place of m, below 2^443,
 *     Y = N_P N_Q d·q + M_Q d · (M_P p + N_P T)            the second, likewise,
 *     A = M_P e · M_Q d, E = N_P N_Q e·e, U = M_Qᵀ (M_P p + N_P T) + N_P N_Q q        below 2^378.
 *
 * With M = M_Qᵀ M_P, M_Q M = N_Q² M_P and M e · M e = N_P² N_Q² e·e, the integers of placed.h are
 *
 *     d × M e                  as it stands; M e = M_Qᵀ (M_P e) is below 2^315, the product below 2^379,
 *     ((d × M e) × M e)·W      N_P N_Q² (A X − E Y),
 *     W                        N_Q U,
 *     (W·e) e − (e·e) W        N_P N_Q² (X M e − E U)    along an edge of P, M e in place of e,
 *                              N_Q (Y d − (d·d) U)       along one of Q,
 *
 * where M e · M e = N_P N_Q E. A crossing's fraction is the second over what it is less at the other end of Q's
 * edge: from q to q + l d, X grows by l A and Y by l N_P N_Q d·d, so the second falls by
 * l N_P N_Q² (E N_P N_Q d·d − A²). All are below 2^1216.
 *
 * Where Q is not turned M_Q and N_Q are 1.
 */
#include "query/decide/short_numbers.h"

#include "exact/wide.h"

#if PIR_HAVE_WIDE

#define NORM_BITS   126
#define VECTOR_BITS 122
#define EDGE_BITS   62
#define BRIEF_BITS  124

/* Few frames come here, so code comes from memory, and that takes longer than its instructions: there is one copy. */
#define RARE __attribute__((noinline))

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
RARE static bool get_double(double x, int exponent, uint32_t bits, pir_two_limbs *ret_value) {
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
RARE static int low_bit(const double *c, int count) {
    int low = INT32_MAX;
    for (int k = 0; k < count; k++) {
        int e = pir_double_low_bit(c[k]);
        low = e < low ? e : low;
    }
    return low;
}

/* As set_short of exact/rotation.c does, where N is short. */
RARE static bool get_turning(pir_quat given, turning *to) {
    const double c[4] = {given.x, given.y, given.z, given.w};
    int low = low_bit(c, 4);
    pir_two_limbs q[4], square[4];
    pir_two_limbs_unsigned norm = 0;
    for (int k = 0; k < 4; k++) {
        if (!get_double(c[k], low, 63, &q[k]))
            return false;
        square[k] = q[k] * q[k];
        norm += (pir_two_limbs_unsigned)square[k];
    }
    if (norm >> NORM_BITS)
        return false;
    to->norm = (pir_two_limbs)norm;
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

RARE static bool get_vector(const pir_int3 *v, uint32_t bits, two3 *ret_v) {
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

/* to = M v. */
RARE static void turn(const turning *by, const two3 *v, pir_int256 to[3]) {
    for (int i = 0; i < 3; i++)
        to[i] = pir_two_dot(by->m[i], v->c);
}

/* M v, where that is brief when multiplied by so many bits more. */
RARE static bool turn_briefly(const turning *by, const two3 *v, uint32_t more, two3 *to) {
    if (by->bits + bits_of(v->c) + more > BRIEF_BITS)
        return false;
    for (int i = 0; i < 3; i++)
        to->c[i] = by->m[i][0] * v->c[0] + by->m[i][1] * v->c[1] + by->m[i][2] * v->c[2];
    return true;
}

/* to = M v · 2^shift. */
RARE static void turn_shifted(const turning *by, two3 *v, int shift, pir_int256 to[3]) {
    two3 turned;
    if (turn_briefly(by, v, 0, &turned)) {
        for (int k = 0; k < 3; k++) {
            to[k] = (pir_int256){{0}};
            pir_int256_add_product(&to[k], turned.c[k], (pir_two_limbs)1 << shift);
        }
    } else {
        shift_vector(v, shift);
        turn(by, v, to);
    }
}

/* W, in units of 2^*ret_exponent / N. `at`: the translations of both. */
static bool get_corner(const pir_frame *frame, const turning *by, const pir_vec3 at[2], const pir_facet *facet,
                       pir_int256 corner[3], int *ret_exponent) {
    const double t[6] = {at[0].x, at[0].y, at[0].z, at[1].x, at[1].y, at[1].z};
    int of_p, of_q, low = low_bit(t, 6);
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
        pir_two_limbs moved, back;
        if (!get_double(t[k], low, VECTOR_BITS - 2, &moved) || !get_double(t[3 + k], low, VECTOR_BITS - 2, &back))
            return false;
        d.c[k] -= moved - back;
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
    pir_int256 turned[3];
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

/* One unit of W, of what that is over, in lengths of the frame. */
static pir_real unit_of(const pir_frame *frame, pir_real over, int exponent) {
    return pir_real_over((pir_real){0.5, 1 + exponent - frame->exponent}, over);
}

/* The steps of facet.c from n·W, n·n and what one unit of W is over, to the slack in lengths of the frame. */
static double number_of(const pir_frame *frame, pir_real dot, pir_real square, pir_real over, int exponent) {
    const pir_real unit = unit_of(frame, over, exponent);
    return pir_real_double(pir_real_times(pir_real_over(dot, pir_real_root(square)), unit));
}

static pir_real real_of_two(pir_two_limbs a) {
    mp_limb_t limbs[2];
    pir_int n = {limbs, 0, 2};
    pir_int_set_two(&n, a);
    return pir_real_of(&n);
}

static pir_real real_of_wide(const pir_int512 *a) {
    pir_real real;
    real.m = pir_int512_to_double(a, &real.e);
    return real;
}

/* --- Q not turned --- */

/* Whether Q's quaternion turns nothing, and its N is a power of two: then W is that of placed.h but for such powers. */
static inline bool is_unturned(pir_quat q) {
    int exponent;
    return pir_quat_is_identity(q) && fabs(frexp(q.w, &exponent)) == 0.5;
}

static bool slack_at_rest(const pir_exact *exact, const pir_vec3 at[2], const pir_facet *facet, int *ret_sign,
                          double *ret_slack) {
    const pir_frame *frame = exact->frame;
    turning by;
    int exponent;
    pir_int256 corner[3] = {{{0}}, {{0}}, {{0}}};
    pir_int512 dot, square;
    if (!get_turning(exact->rotation->given, &by) || !get_corner(frame, &by, at, facet, corner, &exponent) ||
        !get_products(frame, &by, facet->piece, corner, &dot, &square))
        return false;
    *ret_sign = pir_int512_sign(&dot);
    *ret_slack = number_of(frame, real_of_wide(&dot), real_of_wide(&square), real_of_two(by.norm), exponent);
    return true;
}

/* --- Q turned too --- */

/* The integers that s is made of. */
typedef struct turned_both {
    bool is_turned; /* Q is */
    turning by_p, by_q;
    two3 p, q, t; /* in units of 2^exponent */
    int exponent;
    pir_int256 norm; /* N_P N_Q */
} turned_both;

/* The turnings of both. */
static bool get_turnings(const pir_rotation *rotation, turned_both *to) {
    to->is_turned = rotation->relative;
    to->norm = (pir_int256){{0}};
    if (!get_turning(to->is_turned ? rotation->factor[1] : rotation->given, &to->by_p))
        return false;
    if (!to->is_turned)
        to->by_q = (turning){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1, 1};
    else if (!get_turning(rotation->factor[0], &to->by_q))
        return false;
    pir_int256_add_product(&to->norm, to->by_p.norm, to->by_q.norm);
    return true;
}

/* All of them for corner (a, b); `at`: the translations of both. */
static bool get_both(const pir_exact *exact, const pir_vec3 at[2], uint32_t a, uint32_t b, turned_both *to) {
    const pir_frame *frame = exact->frame;
    const double from[3] = {at[0].x, at[0].y, at[0].z}, t[3] = {at[1].x, at[1].y, at[1].z};
    int of_p, of_q, low = low_bit(from, 3), other = low_bit(t, 3);
    if (!get_turnings(exact->rotation, to) || !get_exponent(&frame->p.polytope->scale, &of_p) ||
        !get_exponent(&frame->q.polytope->scale, &of_q))
        return false;
    low = other < low ? other : low;
    low = of_p < low ? of_p : low;
    low = of_q < low ? of_q : low;
    pir_int3 va = pir_vertex_exact(frame->p.polytope, a), vb = pir_vertex_exact(frame->q.polytope, b);
    if (!get_unshifted(&va, of_p - low, VECTOR_BITS, &to->p) || !get_unshifted(&vb, of_q - low, VECTOR_BITS, &to->q))
        return false;
    shift_vector(&to->p, of_p - low);
    shift_vector(&to->q, of_q - low);
    for (int k = 0; k < 3; k++) {
        pir_two_limbs less;
        if (!get_double(t[k], low, VECTOR_BITS - 1, &to->t.c[k]) || !get_double(from[k], low, VECTOR_BITS - 1, &less))
            return false;
        to->t.c[k] -= less;
    }
    to->exponent = low;
    return true;
}

/* M v + N T of a body. */
static void get_way(const turned_both *both, bool of_p, pir_int256 way[3]) {
    const turning *by = of_p ? &both->by_p : &both->by_q;
    turn(by, of_p ? &both->p : &both->q, way);
    for (int k = 0; k < 3; k++)
        pir_int256_add_product(&way[k], by->norm, both->t.c[k]);
}

/* N_P N_Q m·v + M m · way, M m and v being of m's body, the way of the other. */
static pir_int512 height_of(const turned_both *both, const two3 *m, const pir_int256 turned[3], const two3 *v,
                            const pir_int256 way[3]) {
    const pir_int256 height = pir_two_dot(m->c, v->c);
    pir_int512 sum = pir_int256_dot(turned, way);
    pir_int512_add_product(&sum, &height, &both->norm);
    return sum;
}

/* s of a facet. */
static pir_int512 facet_height(const turned_both *both, const two3 *m, bool of_p) {
    pir_int256 normal[3], way[3];
    turn(of_p ? &both->by_p : &both->by_q, m, normal);
    get_way(both, !of_p, way);
    return height_of(both, m, normal, of_p ? &both->p : &both->q, way);
}

/* a × b, where it is short for certain. */
RARE static bool cross_short(const two3 *a, const two3 *b, two3 *to) {
    if (bits_of(a->c) + bits_of(b->c) + 1 > VECTOR_BITS)
        return false;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        to->c[k] = a->c[i] * b->c[j] - a->c[j] * b->c[i];
    }
    return true;
}

/* sum += s of two edges; sets |M_Q d × M_P e|², of 17 limbs. False where the integers would be too long. */
static bool add_edges(const turned_both *both, const two3 *e, const two3 *d, pir_int512 *sum, pir_int *square) {
    two3 of_p, of_q;
    pir_int256 edge_p[3], edge_q[3], way_p[3], way_q[3], back[3];
    if (!cross_short(e, &both->p, &of_p) || !cross_short(&both->q, d, &of_q) ||
        both->by_p.bits + bits_of(e->c) + bits_of(both->t.c) + 3 > 250)
        return false;
    turn(&both->by_p, e, edge_p);
    turn(&both->by_p, &(two3){{-e->c[0], -e->c[1], -e->c[2]}}, back);
    turn(&both->by_q, d, edge_q);
    turn(&both->by_p, &of_p, way_p);
    turn(&both->by_q, &of_q, way_q);
    mp_limb_t limbs[8], product[16];
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        pir_int256_add_scaled(&way_p[k], &edge_p[i], both->t.c[j]);
        pir_int256_add_scaled(&way_p[k], &edge_p[j], -both->t.c[i]);
        pir_int512_add_product(sum, &edge_q[k], &way_p[k]);
        pir_int512_add_product(sum, &edge_p[k], &way_q[k]);
        pir_int512 n = {{0}};
        pir_int512_add_product(&n, &edge_q[i], &edge_p[j]);
        pir_int512_add_product(&n, &edge_q[j], &back[i]);
        pir_int of_n = {limbs, 0, 8}, part = {product, 0, 16};
        pir_int_set_limbs(&of_n, n.limb, 8);
        pir_int_mul(&part, &of_n, &of_n);
        pir_int_add(square, square, &part);
    }
    return true;
}

/* a·b·c·… of a number and `count` others that are above 0, in so many limbs. */
#define PRODUCT_LIMBS 20
static pir_real real_of_product(const pir_int *a, const pir_int *others, int count) {
    mp_limb_t limbs[2][PRODUCT_LIMBS];
    pir_int to[2] = {{limbs[0], 0, PRODUCT_LIMBS}, {limbs[1], 0, PRODUCT_LIMBS}};
    const pir_int *last = a;
    for (int k = 0; k < count; k++, last = &to[(k + 1) % 2])
        pir_int_mul(&to[k % 2], last, &others[k]);
    return pir_real_of(last);
}

static bool slack_in_world(const pir_exact *exact, const pir_vec3 at[2], const pir_facet *facet, int *ret_sign,
                           double *ret_slack) {
    const pir_polytope *p = exact->frame->p.polytope, *q = exact->frame->q.polytope;
    const pir_piece piece = facet->piece;
    turned_both both;
    two3 m = {{0, 0, 0}}, d = {{0, 0, 0}};
    pir_int512 sum = {{0}};
    mp_limb_t limbs[8], squares[18], norms[4], of_norms[2][2];
    pir_int s = {limbs, 0, 8}, square = {squares, 0, 18}, norm = {norms, 0, 4};
    pir_int norm_p = {of_norms[0], 0, 2}, norm_q = {of_norms[1], 0, 2};
    if (!get_both(exact, at, facet->a, facet->b, &both))
        return false;
    if (piece.kind == PIR_FACET_EE) {
        pir_int3 of_p = pir_half_exact(p, p->edge_half[piece.first]), of_q = pir_half_exact(q, piece.second);
        if (!get_vector(&of_p, EDGE_BITS, &m) || !get_vector(&of_q, EDGE_BITS, &d) ||
            !add_edges(&both, &m, &d, &sum, &square))
            return false;
    } else {
        const bool by_p = piece.kind == PIR_FACET_FV;
        pir_int3 own = by_p ? pir_normal_exact(p, piece.first) : pir_normal_exact(q, piece.second);
        if (!get_vector(&own, VECTOR_BITS, &m))
            return false;
        sum = facet_height(&both, &m, by_p);
        const pir_int512 of_m = pir_two_square(m.c);
        pir_int_set_limbs(&square, of_m.limb, 8);
    }
    pir_int_set_limbs(&s, sum.limb, 8);
    pir_int_set_limbs(&norm, both.norm.limb, 4);
    pir_int_set_two(&norm_p, both.by_p.norm);
    pir_int_set_two(&norm_q, both.by_q.norm);
    const pir_int factors[2] = {norm_q, norm};
    const pir_real dot = real_of_product(&s, factors, piece.kind == PIR_FACET_VF ? 1 : 2);
    const pir_real of_n = real_of_product(&square, (const pir_int[2]){norm, norm}, piece.kind == PIR_FACET_FV ? 2 : 0);
    const pir_real over = pir_real_times(pir_real_of(&norm), pir_real_of(&norm_q));
    *ret_sign = pir_int_sign(&s);
    *ret_slack = number_of(exact->frame, dot, of_n, over, both.exponent);
    return true;
}

/*
 * The translations of both as the integers of placed.h have them. False where Q is turned by a quaternion that turns
 * nothing, but has another N than a power of two.
 */
static bool get_places(const pir_exact *exact, pir_vec3 translation, pir_vec3 at[2]) {
    const pir_world *world = exact->world;
    at[0] = world ? world->translation_p : translation;
    at[1] = world ? world->translation_q : (pir_vec3){0, 0, 0};
    return exact->rotation->relative ? world != NULL : !world || is_unturned(world->rotation_q->given);
}

bool pir_short_slack(const pir_exact *exact, pir_vec3 translation, const pir_facet *facet, int *ret_sign,
                     double *ret_slack) {
    pir_vec3 at[2];
    return get_places(exact, translation, at) &&
           (exact->rotation->relative ? slack_in_world(exact, at, facet, ret_sign, ret_slack)
                                      : slack_at_rest(exact, at, facet, ret_sign, ret_slack));
}

/* --- edges --- */

/* A halfedge of a body. */
static bool get_edge(const pir_polytope *p, uint32_t half, two3 *e) {
    const pir_int3 given = pir_half_exact(p, half);
    return get_vector(&given, EDGE_BITS, e);
}

/* M_Qᵀ v. */
static void turn_back(const turned_both *both, const pir_int256 v[3], pir_int512 to[3]) {
    for (int k = 0; k < 3; k++) {
        const pir_two_limbs column[3] = {both->by_q.m[0][k], both->by_q.m[1][k], both->by_q.m[2][k]};
        if (both->is_turned)
            to[k] = pir_int256_dot_two(v, column);
        else
            pir_int512_set(&to[k], &v[k]);
    }
}

bool pir_short_normal(const pir_exact *exact, pir_piece piece, pir_vec3 *ret_normal) {
    turned_both both;
    two3 e, d;
    const pir_polytope *p = exact->frame->p.polytope;
    if (!get_edge(p, p->edge_half[piece.first], &e) || !get_edge(exact->frame->q.polytope, piece.second, &d) ||
        !get_turnings(exact->rotation, &both))
        return false;
    pir_int256 turned[3];
    pir_int512 back[3], n[3] = {{{0}}, {{0}}, {{0}}};
    mp_limb_t limbs[3][8];
    pir_int3 normal;
    turn(&both.by_p, &e, turned);
    turn_back(&both, turned, back);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        pir_int512_add_scaled(&n[k], &back[j], (int64_t)d.c[i]);
        pir_int512_add_scaled(&n[k], &back[i], -(int64_t)d.c[j]);
        normal.c[k] = (pir_int){limbs[k], 0, 8};
        pir_int_set_limbs(&normal.c[k], n[k].limb, 8);
    }
    *ret_normal = pir_int3_is_zero(&normal) ? (pir_vec3){0, 0, 0} : pir_int3_unit(&normal);
    return true;
}

/* --- numbers of more limbs --- */

/* The longest number, and a product of two: see above. */
#define LONG_LIMBS   22
#define SQUARE_LIMBS (2 * LONG_LIMBS + 1)

/* A number of up to so many limbs. */
typedef struct longer {
    mp_limb_t limb[LONG_LIMBS];
    int32_t size; /* as in pir_int */
} longer;

static inline pir_int view_of(const longer *a) {
    return (pir_int){(mp_limb_t *)a->limb, a->size, 0};
}

static void set_longer(longer *to, const mp_limb_t *a, int32_t count) {
    pir_int whole = {to->limb, 0, LONG_LIMBS};
    pir_int_set_limbs(&whole, a, count);
    to->size = whole.size;
}

/* a *= b. */
static void multiply(longer *a, const longer *b) {
    mp_limb_t limbs[LONG_LIMBS];
    const pir_int of_a = view_of(a), of_b = view_of(b);
    pir_int product = {limbs, 0, LONG_LIMBS}, whole = {a->limb, 0, LONG_LIMBS};
    pir_int_mul(&product, &of_a, &of_b);
    pir_int_copy(&whole, &product);
    a->size = whole.size;
}

/* a·b − c·d, times f. */
static void set_difference(longer *to, const longer *a, const longer *b, const longer *c, const longer *d,
                           const longer *f) {
    mp_limb_t limbs[2][LONG_LIMBS];
    pir_int first = {limbs[0], 0, LONG_LIMBS}, second = {limbs[1], 0, LONG_LIMBS}, whole = {to->limb, 0, LONG_LIMBS};
    const pir_int of_a = view_of(a), of_b = view_of(b), of_c = view_of(c), of_d = view_of(d), of_f = view_of(f);
    pir_int_mul(&first, &of_a, &of_b);
    pir_int_mul(&second, &of_c, &of_d);
    pir_int_sub(&first, &first, &second);
    pir_int_mul(&whole, &first, &of_f);
    to->size = whole.size;
}

static pir_real real_of_longer(const longer *a) {
    const pir_int whole = view_of(a);
    return pir_real_of(&whole);
}

/* Turned edges, and the factors of numbers. */
struct turned_edges {
    two3 e, d;
    pir_int256 along_p[3], along_q[3]; /* M_P e, M_Q d */
    longer norm_p, norm_q, norm;       /* N_P, N_Q, their product */
    longer square;                     /* E */
};

static void set_norms(const turned_both *both, struct turned_edges *edges) {
    pir_int256 norm[2] = {{{0}}, {{0}}};
    pir_int256_add_product(&norm[0], both->by_p.norm, 1);
    pir_int256_add_product(&norm[1], both->by_q.norm, 1);
    set_longer(&edges->norm_p, norm[0].limb, 4);
    set_longer(&edges->norm_q, norm[1].limb, 4);
    set_longer(&edges->norm, both->norm.limb, 4);
}

static void set_edge_p(const turned_both *both, struct turned_edges *edges) {
    const pir_int256 square = pir_two_dot(edges->e.c, edges->e.c);
    turn(&both->by_p, &edges->e, edges->along_p);
    set_longer(&edges->square, square.limb, 4);
    multiply(&edges->square, &edges->norm);
}

static void set_edge_q(const turned_both *both, struct turned_edges *edges) {
    turn(&both->by_q, &edges->d, edges->along_q);
}

/* X and Y, for the vertices and T at hand. */
static void set_x(const turned_both *both, const struct turned_edges *edges, longer *x) {
    pir_int256 way[3];
    get_way(both, false, way);
    const pir_int512 sum = height_of(both, &edges->e, edges->along_p, &both->p, way);
    set_longer(x, sum.limb, 8);
}

static void set_y(const turned_both *both, const struct turned_edges *edges, const pir_int256 way[3], longer *y) {
    const pir_int512 sum = height_of(both, &edges->d, edges->along_q, &both->q, way);
    set_longer(y, sum.limb, 8);
}

/* --- crossings --- */

/* How often d goes into the way between the ends of an edge of Q, which starts at the corner's vertex: it does. */
static bool get_times(const pir_polytope *q, uint32_t half, const two3 *d, const turned_both *both, longer *ret_times) {
    const pir_int3 to = pir_vertex_exact(q, q->target[half]);
    const int k = d->c[0] != 0 ? 0 : d->c[1] != 0 ? 1 : 2;
    pir_int256 times = {{0}};
    two3 end;
    int of_q;
    if (!get_exponent(&q->scale, &of_q) || !get_unshifted(&to, of_q - both->exponent, VECTOR_BITS, &end))
        return false;
    shift_vector(&end, of_q - both->exponent);
    pir_int256_add_product(&times, (end.c[k] - both->q.c[k]) / d->c[k], 1);
    set_longer(ret_times, times.limb, 4);
    return true;
}

bool pir_short_part(const pir_exact *exact, pir_vec3 translation, uint32_t half_p, uint32_t half_q, double *ret_part) {
    const pir_polytope *p = exact->frame->p.polytope, *q = exact->frame->q.polytope;
    turned_both both;
    struct turned_edges edges;
    pir_vec3 at[2];
    pir_int256 way[3];
    longer x, y, along, times, square, part, whole;
    if (!get_edge(p, half_p, &edges.e) || !get_edge(q, half_q, &edges.d) || !get_places(exact, translation, at) ||
        !get_both(exact, at, p->origin[half_p], q->origin[half_q], &both) ||
        !get_times(q, half_q, &edges.d, &both, &times))
        return false;
    set_norms(&both, &edges);
    set_edge_p(&both, &edges);
    set_edge_q(&both, &edges);
    get_way(&both, true, way);
    set_x(&both, &edges, &x);
    set_y(&both, &edges, way, &y);
    const pir_int512 both_along = pir_int256_dot(edges.along_p, edges.along_q);
    const pir_int256 of_d = pir_two_dot(edges.d.c, edges.d.c);
    longer factor = edges.norm;
    set_longer(&along, both_along.limb, 8);
    set_longer(&square, of_d.limb, 4);
    multiply(&factor, &edges.norm_q);
    multiply(&square, &edges.norm);
    set_difference(&part, &along, &x, &edges.square, &y, &factor);
    set_difference(&whole, &edges.square, &square, &along, &along, &factor);
    multiply(&whole, &times);
    *ret_part = pir_real_double(pir_real_over(real_of_longer(&part), real_of_longer(&whole)));
    return true;
}

/* --- distances --- */

/* The vector from x to a corner, or across an edge, and what it is times for an edge. */
struct away {
    longer n[3], times;
};

/* U. */
static void set_corner(const turned_both *both, const pir_int256 way[3], longer corner[3]) {
    pir_int512 u[3];
    turn_back(both, way, u);
    for (int k = 0; k < 3; k++) {
        pir_int256 own = {{0}};
        pir_int256_add_product(&own, both->q.c[k], 1);
        pir_int512_add_product(&u[k], &own, &both->norm);
        set_longer(&corner[k], u[k].limb, 8);
    }
}

static void set_across_p(const turned_both *both, const struct turned_edges *edges, const longer corner[3],
                         struct away *away) {
    pir_int512 back[3];
    longer x, factor = edges->norm;
    multiply(&factor, &edges->norm_q);
    turn_back(both, edges->along_p, back);
    set_x(both, edges, &x);
    for (int k = 0; k < 3; k++) {
        longer along;
        set_longer(&along, back[k].limb, 8);
        set_difference(&away->n[k], &x, &along, &edges->square, &corner[k], &factor);
    }
    away->times = edges->square;
    multiply(&away->times, &edges->norm);
}

static void set_across_q(const turned_both *both, const struct turned_edges *edges, const pir_int256 way[3],
                         const longer corner[3], struct away *away) {
    const pir_int256 square = pir_two_dot(edges->d.c, edges->d.c);
    longer y;
    set_y(both, edges, way, &y);
    set_longer(&away->times, square.limb, 4);
    for (int k = 0; k < 3; k++) {
        pir_int256 own = {{0}};
        longer along;
        pir_int256_add_product(&own, edges->d.c[k], 1);
        set_longer(&along, own.limb, 4);
        set_difference(&away->n[k], &y, &along, &away->times, &corner[k], &edges->norm_q);
    }
}

/* Sets the vector in `away`. False where an edge is too long. */
static bool set_away(const pir_exact *exact, const turned_both *both, const pir_edge_of_d *edge,
                     struct turned_edges *edges, struct away *away) {
    longer corner[3];
    pir_int256 way[3];
    if ((edge->of_p && !get_edge(exact->frame->p.polytope, edge->half, &edges->e)) ||
        (edge->of_q && !get_edge(exact->frame->q.polytope, edge->half, &edges->d)))
        return false;
    set_norms(both, edges);
    get_way(both, true, way);
    set_corner(both, way, corner);
    if (edge->of_p) {
        set_edge_p(both, edges);
        set_across_p(both, edges, corner, away);
        return true;
    }
    if (edge->of_q) {
        set_edge_q(both, edges);
        set_across_q(both, edges, way, corner, away);
        return true;
    }
    for (int k = 0; k < 3; k++) {
        away->n[k] = corner[k];
        multiply(&away->n[k], &edges->norm_q);
        away->n[k].size = -away->n[k].size;
    }
    return true;
}

/* |n|². */
static pir_real square_of(const pir_int3 *n) {
    mp_limb_t limbs[2][SQUARE_LIMBS];
    pir_int sum = {limbs[0], 0, SQUARE_LIMBS}, product = {limbs[1], 0, SQUARE_LIMBS};
    for (int k = 0; k < 3; k++) {
        pir_int_mul(&product, &n->c[k], &n->c[k]);
        pir_int_add(&sum, &sum, &product);
    }
    return pir_real_of(&sum);
}

bool pir_short_distance(const pir_exact *exact, pir_vec3 translation, const pir_edge_of_d *edge, double *ret_distance,
                        pir_vec3 *ret_normal) {
    turned_both both;
    struct turned_edges edges;
    struct away away;
    pir_vec3 at[2];
    if (!get_places(exact, translation, at) || !get_both(exact, at, edge->a, edge->b, &both) ||
        !set_away(exact, &both, edge, &edges, &away))
        return false;
    const pir_int3 n = {{view_of(&away.n[0]), view_of(&away.n[1]), view_of(&away.n[2])}};
    pir_real length = pir_real_root(square_of(&n));
    if (edge->of_p || edge->of_q)
        length = pir_real_over(length, real_of_longer(&away.times));
    const pir_real over = pir_real_times(real_of_longer(&edges.norm), real_of_longer(&edges.norm_q));
    *ret_normal = pir_int3_is_zero(&n) ? (pir_vec3){1, 0, 0} : pir_int3_unit(&n);
    *ret_distance = pir_real_double(pir_real_times(length, unit_of(exact->frame, over, both.exponent)));
    return true;
}

#else

bool pir_short_slack(const pir_exact *exact, pir_vec3 translation, const pir_facet *facet, int *ret_sign,
                     double *ret_slack) {
    (void)exact, (void)translation, (void)facet, (void)ret_sign, (void)ret_slack;
    return false;
}

bool pir_short_normal(const pir_exact *exact, pir_piece piece, pir_vec3 *ret_normal) {
    (void)exact, (void)piece, (void)ret_normal;
    return false;
}

bool pir_short_part(const pir_exact *exact, pir_vec3 translation, uint32_t half_p, uint32_t half_q, double *ret_part) {
    (void)exact, (void)translation, (void)half_p, (void)half_q, (void)ret_part;
    return false;
}

bool pir_short_distance(const pir_exact *exact, pir_vec3 translation, const pir_edge_of_d *edge, double *ret_distance,
                        pir_vec3 *ret_normal) {
    (void)exact, (void)translation, (void)edge, (void)ret_distance, (void)ret_normal;
    return false;
}
#endif
