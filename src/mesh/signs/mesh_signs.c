/* SPDX-License-Identifier: MIT */
/*
 * Signs of determinants: a filter (after Shewchuk, Discrete & Computational Geometry 18(3), 1997, whose static bounds
 * these are, rounded up), then integers on the stack.
 *
 * Below TINY a product may have lost what it should have kept, since coordinates are at most 2^60 and the least double
 * is 2^-1074: there integers decide.
 */
#include "mesh/signs/mesh_signs.h"

#include "mesh/signs/mesh_numbers.h"

#define TINY 0x1p-900

/* Limbs of a coordinate: 2^60 down to 2^-1074, a carry, and one to spare. */
#define COORDINATE_LIMBS (1136 / GMP_NUMB_BITS + 3)
/* The longest computation, pir_sign_time_order, takes 225 times the limbs of a coordinate. */
#define STACK_LIMBS (260 * COORDINATE_LIMBS)

struct exact {
    pir_limbs limbs;
    mp_limb_t room[STACK_LIMBS];
};

static void begin(struct exact *exact) {
    exact->limbs = (pir_limbs){exact->room, 0, STACK_LIMBS};
}

static int lower(int a, int b) {
    return a < b ? a : b;
}

static int sign_of(double x) {
    return (x > 0) - (x < 0);
}

/* --- in the plane --- */

static int exact_turn(const double a[2], const double b[2], const double c[2]) {
    struct exact exact;
    begin(&exact);
    pir_limbs *limbs = &exact.limbs;
    int e = INT32_MAX;
    for (int k = 0; k < 2; k++)
        e = lower(e, lower(pir_double_low_bit(a[k]), lower(pir_double_low_bit(b[k]), pir_double_low_bit(c[k]))));
    if (e == INT32_MAX)
        return 0;
    pir_int ab[2], ac[2];
    for (int k = 0; k < 2; k++) {
        pir_int ak = pir_num_double(limbs, a[k], e), bk = pir_num_double(limbs, b[k], e);
        pir_int ck = pir_num_double(limbs, c[k], e);
        ab[k] = pir_num_sub(limbs, &bk, &ak);
        ac[k] = pir_num_sub(limbs, &ck, &ak);
    }
    pir_int turn = pir_num_minor(limbs, &ab[0], &ac[1], &ab[1], &ac[0]);
    return pir_int_sign(&turn);
}

int pir_sign_turn(const double a[2], const double b[2], const double c[2]) {
    double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
    double turn = left - right;
    // (3 + 16u)u relative to both products together, u = 2^-53
    if (fabs(turn) > 0x1p-51 * (fabs(left) + fabs(right)) + TINY)
        return sign_of(turn);
    return exact_turn(a, b, c);
}

/* --- in space --- */

struct determinant {
    double value, bound;
};

/* a · (b × c) for vectors that are each off by a rounding, and a bound on the error: (7 + 56u)u of the permanent. */
static struct determinant determinant_of(pir_vec3 a, pir_vec3 b, pir_vec3 c) {
    double yz = b.y * c.z, zy = b.z * c.y, zx = b.z * c.x, xz = b.x * c.z, xy = b.x * c.y, yx = b.y * c.x;
    double permanent =
        (fabs(yz) + fabs(zy)) * fabs(a.x) + (fabs(zx) + fabs(xz)) * fabs(a.y) + (fabs(xy) + fabs(yx)) * fabs(a.z);
    return (struct determinant){a.x * (yz - zy) + a.y * (zx - xz) + a.z * (xy - yx), 0x1p-50 * permanent + TINY};
}

/* The exact a · ((b − o) × (c − o)). */
static pir_int exact_determinant(pir_limbs *limbs, const pir_int3 *o, const pir_int3 *a, const pir_int3 *b,
                                 const pir_int3 *c) {
    pir_int3 ob = pir_num3_sub(limbs, b, o), oc = pir_num3_sub(limbs, c, o);
    pir_int3 cross = pir_num3_cross(limbs, &ob, &oc);
    return pir_num3_dot(limbs, a, &cross);
}

static int low_bit_of_tri(const pir_tri *tri) {
    return lower(pir_vec_low_bit(tri->p[0]), lower(pir_vec_low_bit(tri->p[1]), pir_vec_low_bit(tri->p[2])));
}

static int exact_side(const pir_tri *tri, pir_vec3 d) {
    struct exact exact;
    begin(&exact);
    pir_limbs *limbs = &exact.limbs;
    int e = lower(low_bit_of_tri(tri), pir_vec_low_bit(d));
    if (e == INT32_MAX)
        return 0;
    pir_int3 p[3];
    for (int k = 0; k < 3; k++)
        p[k] = pir_num3_doubles(limbs, tri->p[k], e);
    pir_int3 at = pir_num3_doubles(limbs, d, e), away = pir_num3_sub(limbs, &at, &p[0]);
    pir_int side = exact_determinant(limbs, &p[0], &away, &p[1], &p[2]);
    return pir_int_sign(&side);
}

int pir_sign_side(const pir_tri *tri, pir_vec3 d) {
    struct determinant side =
        determinant_of(pir_vec_sub(d, tri->p[0]), pir_vec_sub(tri->p[1], tri->p[0]), pir_vec_sub(tri->p[2], tri->p[0]));
    return fabs(side.value) > side.bound ? sign_of(side.value) : exact_side(tri, d);
}

static int exact_around(const pir_mesh_segment *segment, pir_vec3 p, pir_vec3 q) {
    struct exact exact;
    begin(&exact);
    pir_limbs *limbs = &exact.limbs;
    int e = lower(lower(pir_vec_low_bit(segment->origin), pir_vec_low_bit(segment->way)),
                  lower(pir_vec_low_bit(p), pir_vec_low_bit(q)));
    if (e == INT32_MAX)
        return 0;
    pir_int3 o = pir_num3_doubles(limbs, segment->origin, e), d = pir_num3_doubles(limbs, segment->way, e);
    pir_int3 xp = pir_num3_doubles(limbs, p, e), xq = pir_num3_doubles(limbs, q, e);
    pir_int around = exact_determinant(limbs, &o, &d, &xp, &xq);
    return pir_int_sign(&around);
}

int pir_sign_around(const pir_mesh_segment *segment, pir_vec3 p, pir_vec3 q) {
    struct determinant around =
        determinant_of(segment->way, pir_vec_sub(p, segment->origin), pir_vec_sub(q, segment->origin));
    return fabs(around.value) > around.bound ? sign_of(around.value) : exact_around(segment, p, q);
}

bool pir_tri_is_degenerate(const pir_tri *tri) {
    for (int k = 0; k < 3; k++) {
        double flat[3][2];
        for (int i = 0; i < 3; i++) {
            const double c[3] = {tri->p[i].x, tri->p[i].y, tri->p[i].z};
            flat[i][0] = c[(k + 1) % 3];
            flat[i][1] = c[(k + 2) % 3];
        }
        if (pir_sign_turn(flat[0], flat[1], flat[2]) != 0)
            return false;
    }
    return true;
}

/* --- times along a segment --- */

/* time = over / under, with under > 0. */
struct time {
    pir_int over, under;
};

static struct time exact_time(pir_limbs *limbs, const pir_mesh_segment *segment, const pir_tri *tri, int e) {
    pir_int3 p[3];
    for (int k = 0; k < 3; k++)
        p[k] = pir_num3_doubles(limbs, tri->p[k], e);
    pir_int3 o = pir_num3_doubles(limbs, segment->origin, e), d = pir_num3_doubles(limbs, segment->way, e);
    pir_int3 away = pir_num3_sub(limbs, &p[0], &o);
    struct time time = {exact_determinant(limbs, &p[0], &away, &p[1], &p[2]),
                        exact_determinant(limbs, &p[0], &d, &p[1], &p[2])};
    if (time.under.size < 0) {
        pir_int_negate(&time.under);
        pir_int_negate(&time.over);
    }
    return time;
}

static int low_bit_of_segment(const pir_mesh_segment *segment) {
    return lower(pir_vec_low_bit(segment->origin), pir_vec_low_bit(segment->way));
}

int pir_sign_time_order(const pir_mesh_segment *segment, const pir_tri *first, const pir_tri *second) {
    struct exact exact;
    begin(&exact);
    int e = lower(low_bit_of_segment(segment), lower(low_bit_of_tri(first), low_bit_of_tri(second)));
    struct time a = exact_time(&exact.limbs, segment, first, e), b = exact_time(&exact.limbs, segment, second, e);
    pir_int order = pir_num_minor(&exact.limbs, &a.over, &b.under, &b.over, &a.under);
    return pir_int_sign(&order);
}

bool pir_time_is_within(const pir_mesh_segment *segment, const pir_tri *tri) {
    pir_vec3 e1 = pir_vec_sub(tri->p[1], tri->p[0]), e2 = pir_vec_sub(tri->p[2], tri->p[0]);
    struct determinant over = determinant_of(pir_vec_sub(tri->p[0], segment->origin), e1, e2);
    struct determinant under = determinant_of(segment->way, e1, e2);
    double sign = under.value < 0 ? -1 : 1, from = sign * over.value, rest = fabs(under.value) - from;
    double error = (over.bound + under.bound) * (1 + 0x1p-40);
    if (fabs(under.value) > under.bound && fabs(from) > over.bound && fabs(rest) > error + 0x1p-51 * fabs(from))
        return from > 0 && rest > 0;
    struct exact exact;
    begin(&exact);
    int e = lower(low_bit_of_segment(segment), low_bit_of_tri(tri));
    if (e == INT32_MAX)
        return false;
    struct time time = exact_time(&exact.limbs, segment, tri, e);
    return time.over.size >= 0 && pir_num_compare(&exact.limbs, &time.over, &time.under) <= 0;
}

/* A time by doubles is not told where it is off by more than this. */
#define TIME_ERROR 0x1p-44

double pir_time_of(const pir_mesh_segment *segment, const pir_tri *tri, double *ret_error) {
    pir_vec3 e1 = pir_vec_sub(tri->p[1], tri->p[0]), e2 = pir_vec_sub(tri->p[2], tri->p[0]);
    struct determinant over = determinant_of(pir_vec_sub(tri->p[0], segment->origin), e1, e2);
    struct determinant under = determinant_of(segment->way, e1, e2);
    double time = over.value / under.value, least = fabs(under.value) - under.bound;
    double error = (over.bound + fabs(time) * under.bound) / least + 0x1p-50;
    if (least > 0 && error < TIME_ERROR) {
        *ret_error = error;
        return time;
    }
    struct exact exact;
    begin(&exact);
    struct time at = exact_time(&exact.limbs, segment, tri, lower(low_bit_of_segment(segment), low_bit_of_tri(tri)));
    int over_exponent, under_exponent;
    double a = pir_int_to_double(&at.over, &over_exponent), b = pir_int_to_double(&at.under, &under_exponent);
    *ret_error = 0x1p-50;
    return b > 0 ? ldexp(a / b, over_exponent - under_exponent) : 0;
}
