/* SPDX-License-Identifier: MIT */
/*
 * On which side of a facet's plane a translation lies, exactly.
 *
 * With P on the scale a/b and Q on the scale c/d (vertices are integers times those), R = M/N and t = T·2^e, T integers, the sign of
 * n·(R p + q − t) is that of
 *
 *     n·( a·d·2^i · M p  +  N·c·b·2^i · q  −  N·b·d·2^j · T ),      2^i = 2^max(−e, 0), 2^j = 2^max(e, 0)
 *
 * where n is M n_f, n_g or d × M e. All integers, no allocation: `scratch` is as large as the largest of them can ask for.
 *
 * A difference of two flat bodies may be flat itself, and then its planes do not bound it sideways. More directions do: the normals
 * of its sides within the plane, of its ends along the line, or of the axes about a point. If t is in no open halfspace beyond a support plane
 * in any of these, it is in the difference, since they include all that bound a flat polytope.
 */
#include "query/query.h"

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

uint32_t pir_side_limbs(const pir_query *query) {
    const pir_polytope *p = query->p, *q = query->q;
    const pir_int *scale[4] = {&p->scale.num, &p->scale.den, &q->scale.num, &q->scale.den};
    uint32_t point = 2 * PIR_MATRIX_LIMBS + 3 * PIR_QUAT_LIMBS + p->exact_vertex.stride + q->exact_vertex.stride + 8;
    for (int k = 0; k < 4; k++)
        point += pir_int_length(scale[k]);
    uint32_t normal =
        2 * PIR_MATRIX_LIMBS +
        2 * (p->exact_normal.stride + q->exact_normal.stride + p->exact_edge.stride + q->exact_edge.stride) + 8;
    return 16 * (point + normal);
}

/* dst = M·v for a vector of P; taken from the scratch. */
static pir_int3 turned(pir_query *query, const pir_int3 *v) {
    pir_rotation *rotation = &query->sum->signs.rotation;
    pir_rotation_make_exact(rotation);
    pir_int3 to = pir_int3_take(&query->scratch, pir_int3_length(v) + PIR_MATRIX_LIMBS + 1);
    pir_rotation_apply(rotation, &to, v, &query->scratch);
    return to;
}

static pir_int3 crossed(pir_query *query, const pir_int3 *a, const pir_int3 *b) {
    pir_int3 to = pir_int3_take(&query->scratch, pir_int3_length(a) + pir_int3_length(b) + 1);
    pir_int3_cross(&to, a, b, &query->scratch);
    return to;
}

/* A piece's normal, of any length; zero for parallel edges. Left in the scratch. */
static pir_int3 exact_normal(pir_query *query, pir_piece piece) {
    if (piece.kind == PIR_FACET_VF)
        return pir_normal_exact(query->q, piece.second);
    if (piece.kind == PIR_FACET_FV) {
        pir_int3 n = pir_normal_exact(query->p, piece.first);
        return turned(query, &n);
    }
    pir_int3 e = pir_half_exact(query->p, query->p->edge_half[piece.first]), d = pir_half_exact(query->q, piece.second);
    pir_int3 rotated = turned(query, &e);
    return crossed(query, &d, &rotated);
}

bool pir_side_normal(pir_query *query, pir_piece piece, pir_vec3 *ret_normal) {
    uint32_t mark = query->scratch.used;
    pir_int3 n = exact_normal(query, piece);
    bool is_normal = !pir_int3_is_zero(&n);
    if (is_normal)
        *ret_normal = pir_int3_unit(&n);
    query->scratch.used = mark;
    return is_normal;
}

/* a·b·c·2^bits from the scratch. */
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

/* What turns vertices and t into integers of one scale, for one translation. */
struct scales {
    pir_int p, q, t;
    pir_int3 at; /* T */
};

static struct scales make_scales(pir_query *query, pir_vec3 translation) {
    const double c[3] = {translation.x, translation.y, translation.z};
    const pir_scale *sp = &query->p->scale, *sq = &query->q->scale;
    pir_rotation *rotation = &query->sum->signs.rotation;
    pir_rotation_make_exact(rotation);
    mp_limb_t one_limb = 1;
    pir_int one = {&one_limb, 1};
    int e = INT32_MAX;
    for (int k = 0; k < 3; k++)
        e = low_bit(c[k]) < e ? low_bit(c[k]) : e;
    e = e == INT32_MAX ? 0 : e;
    uint32_t down = e < 0 ? (uint32_t)-e : 0, up = e > 0 ? (uint32_t)e : 0;
    struct scales scales;
    scales.p = product(query, &sp->num, &sq->den, &one, down);
    scales.q = product(query, &rotation->norm, &sq->num, &sp->den, down);
    scales.t = product(query, &rotation->norm, &sp->den, &sq->den, up);
    scales.at = pir_int3_take(&query->scratch, PIR_QUAT_LIMBS);
    for (int k = 0; k < 3; k++)
        pir_int_set_double(&scales.at.c[k], c[k], e);
    return scales;
}

/* The sign of n·(R a + b − t); n is not zero. */
static int side_of(pir_query *query, const struct scales *scales, const pir_int3 *n, uint32_t a, uint32_t b) {
    pir_limbs *scratch = &query->scratch;
    uint32_t mark = scratch->used;
    pir_int3 va = pir_vertex_exact(query->p, a), vb = pir_vertex_exact(query->q, b);
    pir_int3 rotated = turned(query, &va);
    uint32_t length = pir_int3_length(&rotated) + pir_int_length(&scales->p);
    uint32_t of_q = pir_int3_length(&vb) + pir_int_length(&scales->q);
    uint32_t of_t = PIR_QUAT_LIMBS + pir_int_length(&scales->t);
    length = length > of_q ? length : of_q;
    length = (length > of_t ? length : of_t) + 2;
    pir_int sum = pir_limbs_take(scratch, length + pir_int3_length(n) + 2);
    pir_int part = pir_limbs_take(scratch, length);
    for (int k = 0; k < 3; k++) {
        part.size = 0;
        pir_int_add_mul(&part, &rotated.c[k], &scales->p, scratch);
        pir_int_add_mul(&part, &vb.c[k], &scales->q, scratch);
        pir_int_sub_mul(&part, &scales->at.c[k], &scales->t, scratch);
        pir_int_add_mul(&sum, &part, &n->c[k], scratch);
    }
    scratch->used = mark;
    return pir_int_sign(&sum);
}

int pir_side_exact(pir_query *query, pir_piece piece, pir_vec3 translation) {
    const pir_polytope *p = query->p, *q = query->q;
    uint32_t mark = query->scratch.used;
    pir_int3 n = exact_normal(query, piece);
    struct scales scales = make_scales(query, translation);
    uint32_t a, b;
    if (piece.kind == PIR_FACET_FV) {
        a = p->origin[p->loop[p->loop_start[piece.first]]];
        b = query->sum->fv[piece.first];
    } else if (piece.kind == PIR_FACET_VF) {
        a = query->sum->vf[piece.second];
        b = q->origin[q->loop[q->loop_start[piece.second]]];
    } else {
        a = p->origin[p->edge_half[piece.first]];
        b = q->origin[piece.second];
    }
    int sign = side_of(query, &scales, &n, a, b);
    query->scratch.used = mark;
    return sign;
}

/* --- flat differences --- */

/* Whether n·(D − t) is negative all over: t lies beyond the support plane of n. */
static bool is_beyond(pir_query *query, const struct scales *scales, const pir_int3 *n) {
    for (uint32_t a = 0; a < query->p->vertex_count; a++)
        for (uint32_t b = 0; b < query->q->vertex_count; b++)
            if (side_of(query, scales, n, a, b) >= 0)
                return false;
    return true;
}

static bool is_beyond_either(pir_query *query, const struct scales *scales, const pir_int3 *n) {
    pir_int3 side = *n;
    for (int i = 0; i < 2; i++) {
        if (is_beyond(query, scales, &side)) {
            query->beyond = pir_int3_unit(&side);
            return true;
        }
        for (int k = 0; k < 3; k++)
            pir_int_negate(&side.c[k]);
    }
    return false;
}

/* An edge's vector in Q's frame, of P for index < its count, then of Q. */
static pir_int3 edge_vector(pir_query *query, uint32_t index) {
    if (index >= query->p->edge_count)
        return pir_half_exact(query->q, query->q->edge_half[index - query->p->edge_count]);
    pir_int3 e = pir_half_exact(query->p, query->p->edge_half[index]);
    return turned(query, &e);
}

bool pir_side_in_flat(pir_query *query, pir_vec3 translation) {
    uint32_t mark = query->scratch.used, edges = query->p->edge_count + query->q->edge_count;
    struct scales scales = make_scales(query, translation);
    mp_limb_t one_limb = 1;
    bool beyond = false;
    for (int k = 0; k < 3 && !beyond; k++) {
        pir_int3 axis = {{{&one_limb, k == 0}, {&one_limb, k == 1}, {&one_limb, k == 2}}};
        beyond = is_beyond_either(query, &scales, &axis);
        for (uint32_t i = 0; i < edges && !beyond; i++) {
            uint32_t inner = query->scratch.used;
            pir_int3 e = edge_vector(query, i), across = crossed(query, &e, &axis);
            beyond = is_beyond_either(query, &scales, &e) ||
                     (!pir_int3_is_zero(&across) && is_beyond_either(query, &scales, &across));
            query->scratch.used = inner;
        }
    }
    // sides within a plane that two edges span: perpendicular to one of them and to the plane's normal
    for (uint32_t i = 0; i < edges && !beyond; i++)
        for (uint32_t j = 0; j < edges && !beyond; j++) {
            uint32_t inner = query->scratch.used;
            pir_int3 e = edge_vector(query, i), f = edge_vector(query, j), n = crossed(query, &e, &f);
            if (!pir_int3_is_zero(&n)) {
                pir_int3 side = crossed(query, &n, &e);
                beyond = is_beyond_either(query, &scales, &n) || is_beyond_either(query, &scales, &side);
            }
            query->scratch.used = inner;
        }
    query->scratch.used = mark;
    return !beyond;
}
