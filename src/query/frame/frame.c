/* SPDX-License-Identifier: MIT */
/*
 * The frame that queries compute in: see frame.h.
 *
 * Differences of vertices are taken in exact integers and rounded once. So a body at a distance of 1e7 from its
 * origin is known as well as one at its origin. The distance between the two middles is kept in double-double, and so
 * is the translation's.
 */
#include "query/frame/frame.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static pir_dd times_power(double high, double low, int by) {
    return by == 0 ? (pir_dd){high, low} : (pir_dd){ldexp(high, by), ldexp(low, by)};
}

/*
 * v turned by R = M(q)/|q|², or by its transpose, for the quaternion q + rest. |q|² divides it at the end, by one
 * inverse for all: each coordinate is off by a few 2^-103 of v's length.
 */
static pir_dd3 dd_turn(pir_quat q, pir_quat rest, bool back, const pir_dd3 *v) {
    int top;
    frexp(fmax(fmax(fabs(q.x), fabs(q.y)), fmax(fabs(q.z), fabs(q.w))), &top);
    const int by = abs(top) > 100 ? -top : 0; // squares of others are far from the ends of the range
    const pir_dd c[4] = {times_power(q.x, rest.x, by), times_power(q.y, rest.y, by), times_power(q.z, rest.z, by),
                         times_power(back ? -q.w : q.w, back ? -rest.w : rest.w, by)};
    pir_dd square[4], norm = {0, 0};
    pir_dd3 row[3], turned;
    for (int k = 0; k < 4; k++) {
        square[k] = pir_dd_mul(c[k], c[k]);
        norm = pir_dd_add(norm, square[k]);
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const pir_dd both = pir_dd_scale(pir_dd_mul(c[i], c[j]), 2), turn = pir_dd_scale(pir_dd_mul(c[3], c[k]), 2);
        row[i].c[i] = pir_dd_sub(pir_dd_add(square[3], square[i]), pir_dd_add(square[j], square[k]));
        row[i].c[j] = pir_dd_sub(both, turn);
        row[j].c[i] = pir_dd_add(both, turn);
    }
    const pir_dd inverse = pir_dd_divide((pir_dd){1, 0}, norm);
    for (int i = 0; i < 3; i++) {
        pir_dd sum = pir_dd_mul(row[i].c[0], v->c[0]);
        for (int j = 1; j < 3; j++)
            sum = pir_dd_add(sum, pir_dd_mul(row[i].c[j], v->c[j]));
        turned.c[i] = pir_dd_mul(sum, inverse);
    }
    return turned;
}

/* The scale of a polytope's integers as ratio · 2^exponent. */
struct unit {
    double ratio;
    int exponent;
};

static struct unit unit_of(const pir_polytope *p) {
    int num, den;
    const double n = pir_int_to_double(&p->scale.num, &num), d = pir_int_to_double(&p->scale.den, &den);
    return (struct unit){n / d, num - den};
}

/* a − b as m · 2^*ret_exponent, m in ±[0.5, 1) or 0; `room` has limbs for either and one more. */
static double difference_of(const pir_int *a, const pir_int *b, mp_limb_t *room, uint32_t limbs, int *ret_exponent) {
#if GMP_NUMB_BITS == 64
    int64_t x, y;
    if (pir_int_get_short(a, &x) && pir_int_get_short(b, &y))
        return frexp((double)(x - y), ret_exponent);
#endif
    pir_int difference = {room, 0, limbs};
    pir_int_sub(&difference, a, b);
    return pir_int_to_double(&difference, ret_exponent);
}

/* Component k of vertex v minus vertex 0, as m · 2^*ret_exponent. `room` has the limbs of a vertex and one more. */
static double from_first(const pir_polytope *p, const struct unit *unit, uint32_t v, int k, mp_limb_t *room,
                         int *ret_exponent) {
    const pir_int3 a = pir_vertex_exact(p, v), o = pir_vertex_exact(p, 0);
    const double m = difference_of(&a.c[k], &o.c[k], room, p->exact_vertex.stride + 1, ret_exponent);
    *ret_exponent += unit->exponent;
    return m * unit->ratio;
}

int pir_body_exponent(const pir_polytope *p, mp_limb_t *room) {
    const struct unit unit = unit_of(p);
    int top = INT_MIN;
    for (uint32_t v = 1; v < p->vertex_count; v++)
        for (int k = 0; k < 3; k++) {
            int e;
            if (from_first(p, &unit, v, k, room, &e) != 0 && e > top)
                top = e;
        }
    return top;
}

/*
 * Whether an exact coordinate is known to be its nearest double, as most are: a whole number of up to 53 bits times a
 * power of two, and not so small that doubles have fewer.
 */
static bool is_double(const pir_scale *scale, const pir_int *a, double nearest) {
#if GMP_NUMB_BITS == 64
    const pir_int *num = &scale->num, *den = &scale->den;
    int64_t whole;
    return num->size == 1 && den->size == 1 && (num->limb[0] & (num->limb[0] - 1)) == 0 &&
           (den->limb[0] & (den->limb[0] - 1)) == 0 && pir_int_get_short(a, &whole) &&
           whole == (int64_t)(double)whole && (whole == 0 || fabs(nearest) >= 0x1p-1022);
#else
    (void)scale;
    return a->size == 0 && nearest == 0;
#endif
}

/* An exact coordinate minus its nearest double. */
static double remainder_of(const pir_polytope *p, const pir_int *a, double nearest) {
    if (is_double(&p->scale, a, nearest))
        return 0;
    mpq_t exact, rounded;
    mpq_inits(exact, rounded, NULL);
    pir_scale_to_rational(exact, a, &p->scale);
    mpq_set_d(rounded, nearest);
    mpq_sub(exact, exact, rounded);
    double rest = mpq_get_d(exact);
    mpq_clears(exact, rounded, NULL);
    return rest;
}

/*
 * Sets the vertices of a body about the middle of its bounds, its size and its middle. False where the middle is too
 * far away.
 */
static bool place_body(pir_body *body, int exponent, mp_limb_t *room) {
    const pir_polytope *p = body->polytope;
    const struct unit unit = unit_of(p);
    pir_vec3 *vertices = body->vertex;
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        double c[3];
        for (int k = 0; k < 3; k++) {
            int e;
            c[k] = from_first(p, &unit, v, k, room, &e);
            c[k] = c[k] != 0 ? ldexp(c[k], e - exponent) : 0;
            low[k] = pir_lesser(low[k], c[k]);
            high[k] = pir_greater(high[k], c[k]);
        }
        vertices[v] = (pir_vec3){c[0], c[1], c[2]};
    }
    pir_vec3 middle = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])};
    double square = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        vertices[v] = pir_vec_sub(vertices[v], middle);
        square = pir_greater(square, pir_vec_dot(vertices[v], vertices[v]));
    }
    // the root and the square round by a few 2^-53
    body->size = sqrt(square) * (1 + 0x1p-48);
    pir_int3 first = pir_vertex_exact(p, 0);
    for (int k = 0; k < 3; k++) {
        double nearest = pir_vec_component(p->vertex[0], k), away = ldexp(nearest, -exponent);
        if (!(fabs(away) < PIR_FARTHEST))
            return false;
        double rest = ldexp(remainder_of(p, &first.c[k], nearest), -exponent);
        body->centre.c[k] = pir_dd_add((pir_dd){away, rest}, (pir_dd){pir_vec_component(middle, k), 0});
    }
    body->far = pir_vec_taxicab(pir_dd3_round(body->centre));
    return true;
}

/* Sets the facets' offsets and the body's swing: see depth/bounds.c. */
static void set_offsets(pir_body *body) {
    const pir_polytope *p = body->polytope;
    double size = body->size, inner = p->dimension == 3 ? size : 0;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        body->offset[f] = pir_vec_dot(p->normal[f], body->vertex[p->origin[p->loop[p->loop_start[f]]]]);
        inner = pir_lesser(inner, pir_greater(0, body->offset[f] - 0x1p-46 * size));
    }
    // what rounding may add is far below 2^-40 of the size
    body->swing = sqrt(size * size - inner * inner) * (1 + 0x1p-40) + 0x1p-40 * size;
}

/*
 * The unit of a frame of two points, which have no size. It is 1, unless the points are so near the origin, or so far
 * from it, that squares would lose digits. Then it comes from their coordinates.
 */
static int exponent_of_points(pir_vec3 p, pir_vec3 q) {
    double most = pir_greater(pir_greater(pir_greater(fabs(p.x), fabs(p.y)), fabs(p.z)),
                              pir_greater(pir_greater(fabs(q.x), fabs(q.y)), fabs(q.z)));
    int e;
    frexp(most, &e);
    // beyond 2^300 a square of squares would leave the range of doubles
    return abs(e) > 300 ? e : 0;
}

int pir_frame_exponent(int exponent_p, int exponent_q, const pir_polytope *p, const pir_polytope *q) {
    int exponent = exponent_p > exponent_q ? exponent_p : exponent_q;
    return exponent == INT_MIN ? exponent_of_points(p->vertex[0], q->vertex[0]) : exponent;
}

/* 2^exponent, a normal number, as its bits: ldexp takes a part of a query. */
static double power_of_two(int exponent) {
    uint64_t bits = (uint64_t)(exponent + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

void pir_frame_set_exponent(pir_frame *frame, int exponent) {
    // within these bounds both powers are normal numbers
    bool normal = exponent > -1000 && exponent < 1000;
    frame->exponent = exponent;
    frame->up = normal ? power_of_two(exponent) : 0;
    frame->down = normal ? power_of_two(-exponent) : 0;
}

pir_status pir_body_fill(pir_body *body, int exponent, mp_limb_t *room) {
    if (!place_body(body, exponent, room))
        return PIR_ERR_LIMIT;
    pir_landmarks_set(body->polytope, body->landmarks);
    set_offsets(body);
    return PIR_OK;
}

/* --- the rotation --- */

static bool same(pir_quat a, pir_quat b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

void pir_frame_set_far_offset(pir_frame *frame) {
    const pir_dd3 turned = dd_turn(frame->given, frame->rest, false, &frame->p.centre);
    for (int i = 0; i < 3; i++)
        frame->offset.c[i] = pir_dd_add(frame->q.centre.c[i], turned.c[i]);
}

bool pir_frame_turn(pir_frame *frame, const pir_rotation *rotation) {
    // a relative rotation has more than its doubles
    if (frame->is_set && !rotation->relative && same(rotation->given, frame->given))
        return false;
    frame->is_set = true;
    frame->given = rotation->given;
    frame->unit = rotation->unit;
    frame->rest = rotation->rest;
    frame->r = rotation->r;
    pir_frame_set_offset(frame);
    return true;
}

/* x for any t. */
static pir_vec3 turn_far(const pir_frame *frame, const pir_world *world, const pir_dd3 *t) {
    const pir_dd3 turned = dd_turn(world->rotation_q->given, (pir_quat){0, 0, 0, 0}, true, t);
    pir_dd3 x = pir_dd3_negate(frame->offset);
    for (int i = 0; i < 3; i++)
        x.c[i] = pir_dd_add(x.c[i], turned.c[i]);
    return pir_dd3_round(x);
}

pir_status pir_frame_place_relative(const pir_frame *frame, const pir_world *world, pir_placement *ret_placement) {
    if (!pir_vec_is_finite(world->translation_p) || !pir_vec_is_finite(world->translation_q))
        return PIR_ERR_NOT_FINITE;
    if (pir_world_is_plain(world))
        return pir_frame_place(frame, world->translation_p, ret_placement);
    if (pir_frame_place_near(frame, world, ret_placement))
        return PIR_OK;
    pir_vec3 to = pir_frame_units(frame, world->translation_p), from = pir_frame_units(frame, world->translation_q);
    if (!pir_frame_is_near(to) || !pir_frame_is_near(from))
        return PIR_ERR_LIMIT;
    pir_dd3 t = {{pir_dd_two_sum(to.x, -from.x), pir_dd_two_sum(to.y, -from.y), pir_dd_two_sum(to.z, -from.z)}};
    ret_placement->translation = world->translation_p;
    ret_placement->x = turn_far(frame, world, &t);
    pir_frame_set_reach(frame, pir_vec_taxicab(to) + pir_vec_taxicab(from), ret_placement);
    return PIR_OK;
}
