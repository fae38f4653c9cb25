/* SPDX-License-Identifier: MIT */
/* A line against the facets of D: see line.h. */
#include "query/decide/line.h"

#include "query/decide/placed.h"

/*
 * The error of a rate is at most this times the plane's err, with u = 2^-53: 64u·err of the normal, 4u of the line's
 * direction, 37u more where Q is turned, and 4u of rounding are below 115u·err, and the bound is 128u·err
 * (tests/proofs/directions.g).
 */
#define RATE_BOUND 0x1p-46

/*
 * A crossing that doubles know no better than this, relative to the placement's reach, is computed from integers.
 * Doubles at their best know it to 2^-46.
 */
#define GOOD_ENOUGH 0x1p-44

/* --- lines --- */

bool pir_unit_of(pir_vec3 v, pir_vec3 *ret_unit, double *ret_part, int *ret_exponent) {
    double most = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
    if (most == 0)
        return false;
    int e;
    frexp(most, &e);
    pir_vec3 scaled = {ldexp(v.x, -e), ldexp(v.y, -e), ldexp(v.z, -e)};
    double length = sqrt(pir_vec_dot(scaled, scaled));
    *ret_unit = (pir_vec3){scaled.x / length, scaled.y / length, scaled.z / length};
    *ret_part = length;
    *ret_exponent = e;
    return true;
}

/* --- bounds --- */

/* An interval that holds a number. */
struct span {
    double low, high;
};

/* An interval around s/r where s is known within es and r within er. All numbers where r may be 0. */
static struct span quotient(double s, double es, double r, double er) {
    if (!(fabs(r) > er))
        return (struct span){-HUGE_VAL, HUGE_VAL};
    double sign = r > 0 ? 1 : -1, least = fabs(r) - er, most = fabs(r) + er;
    double low = sign * s - es, high = sign * s + es;
    low = low >= 0 ? low / most : low / least;
    high = high >= 0 ? high / least : high / most;
    // the divisions round
    return (struct span){low - 0x1p-50 * fabs(low), high + 0x1p-50 * fabs(high)};
}

struct crossing {
    double s, es, r, er;
};

static struct crossing crossing_of(const pir_planes *planes, const pir_line *line, uint32_t slot) {
    pir_vec3 n = pir_planes_normal(planes, slot);
    double err = planes->err[slot];
    return (struct crossing){pir_planes_slack(planes, slot, line->placement->x), line->placement->error * err,
                             pir_vec_dot(n, line->u), RATE_BOUND * err};
}

void pir_clip_bound(const pir_planes *planes, const pir_line *line, pir_clip *clip, uint32_t slot) {
    struct crossing c = crossing_of(planes, line, slot);
    struct span at = quotient(c.s, c.es, c.r, c.er);
    if (c.r > c.er)
        clip->leave_high = fmin(clip->leave_high, at.high);
    if (c.r < -c.er)
        clip->enter_low = fmax(clip->enter_low, at.low);
}

/* Keeps in `best` the facet that is crossed first (sense 1) or last (sense −1). */
static void take(pir_exact *exact, const pir_line *line, pir_least *best, pir_piece piece, int sense) {
    pir_facet facet;
    if (!pir_facet_of(exact, piece, &facet))
        return;
    int order = -1;
    if (best->found) {
        if (pir_facet_same(&facet, &best->facet))
            return;
        order = sense * pir_line_compare(exact, line, &facet, &best->facet);
        if (order == 0)
            order = pir_facet_before(&facet, &best->facet) ? -1 : 1;
    }
    if (order < 0)
        best->facet = facet;
    best->found = true;
}

void pir_clip_take(pir_exact *exact, const pir_planes *planes, const pir_line *line, pir_clip *clip, uint32_t slot) {
    struct crossing c = crossing_of(planes, line, slot);
    pir_piece piece = planes->piece[slot];
    int rate = (c.r > c.er) - (c.r < -c.er);
    if (rate == 0) {
        // a plane that is crossed farther away, on both sides, than the line can enter or leave
        double far = c.s - c.es > 0 ? (c.s - c.es) / (fabs(c.r) + c.er) * (1 - 0x1p-50) : 0;
        if (far > 0 && far > clip->leave_high && -far < clip->enter_low)
            return;
        if (planes->err[slot] == 0)
            return;
        rate = pir_line_rate(exact, line, piece);
        if (rate == 0 &&
            (c.s < -c.es || (c.s <= c.es && pir_side_exact(exact, piece, line->placement->translation) < 0)))
            clip->misses = true;
    }
    struct span at = quotient(c.s, c.es, c.r, c.er);
    if (rate > 0 && at.low <= clip->leave_high)
        take(exact, line, &clip->leave, piece, 1);
    if (rate < 0 && at.high >= clip->enter_low)
        take(exact, line, &clip->enter, piece, -1);
}

/* --- exact --- */

int pir_line_rate(pir_exact *exact, const pir_line *line, pir_piece piece) {
    int exponent;
    pir_exact_begin(exact, line->placement->translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 n = pir_exact_normal(exact, piece), d = pir_exact_direction_by_q(exact, line->direction, &exponent);
    int sign = pir_exact_dot_sign(exact, &n, &d);
    exact->scratch.used = mark;
    return sign;
}

/* The slack S and the rate D of a facet as integers in the scratch. Needs pir_exact_begin. */
static void make_integers(pir_exact *exact, const pir_int3 *direction, const pir_facet *facet, pir_int *ret_s,
                          pir_int *ret_d) {
    pir_int3 n = pir_exact_normal(exact, facet->piece), corner = pir_exact_corner(exact, facet->a, facet->b);
    *ret_s = pir_exact_dot(exact, &n, &corner);
    *ret_d = pir_exact_dot(exact, &n, direction);
}

/* Where the line crosses a facet, in integers that lie in the scratch from `mark` on. The caller gives them back. */
struct exact_crossing {
    uint32_t mark;
    int exponent;
    pir_int3 direction;
    pir_int s, d;
};

static struct exact_crossing exact_crossing_of(pir_exact *exact, const pir_line *line, const pir_facet *facet) {
    struct exact_crossing crossing;
    pir_exact_begin(exact, line->placement->translation);
    crossing.mark = exact->scratch.used;
    crossing.direction = pir_exact_direction_by_q(exact, line->direction, &crossing.exponent);
    make_integers(exact, &crossing.direction, facet, &crossing.s, &crossing.d);
    return crossing;
}

static struct span span_of(const pir_line *line, const pir_facet *facet) {
    double s = facet->h - pir_vec_dot(facet->n, line->placement->x), r = pir_vec_dot(facet->n, line->u);
    return quotient(s, line->placement->error * facet->err, r, RATE_BOUND * facet->err);
}

int pir_line_compare(pir_exact *exact, const pir_line *line, const pir_facet *a, const pir_facet *b) {
    struct span of_a = span_of(line, a), of_b = span_of(line, b);
    if (of_a.high < of_b.low)
        return -1;
    if (of_b.high < of_a.low)
        return 1;
    int exponent;
    pir_int s[2], d[2];
    pir_exact_begin(exact, line->placement->translation);
    uint32_t mark = exact->scratch.used;
    pir_int3 direction = pir_exact_direction_by_q(exact, line->direction, &exponent);
    make_integers(exact, &direction, a, &s[0], &d[0]);
    make_integers(exact, &direction, b, &s[1], &d[1]);
    pir_int left = pir_exact_product(exact, &s[0], &d[1]), right = pir_exact_product(exact, &s[1], &d[0]);
    int order = pir_exact_compare(exact, &left, &right) * pir_int_sign(&d[0]) * pir_int_sign(&d[1]);
    exact->scratch.used = mark;
    return order;
}

double pir_line_length(pir_exact *exact, const pir_int3 *direction, const pir_int *s, const pir_int *d) {
    pir_real length = pir_exact_length(exact, direction);
    pir_real at = pir_real_over(pir_real_times(pir_real_of(s), length), pir_real_of(d));
    return pir_real_double(pir_real_times(at, pir_exact_unit(exact)));
}

double pir_line_at(pir_exact *exact, const pir_line *line, const pir_facet *facet, double *ret_error) {
    struct span span = span_of(line, facet);
    double reach = line->placement->reach;
    if (span.high - span.low <= GOOD_ENOUGH * reach) {
        *ret_error = span.high - span.low;
        return (facet->h - pir_vec_dot(facet->n, line->placement->x)) / pir_vec_dot(facet->n, line->u);
    }
    struct exact_crossing crossing = exact_crossing_of(exact, line, facet);
    double at = pir_line_length(exact, &crossing.direction, &crossing.s, &crossing.d);
    exact->scratch.used = crossing.mark;
    *ret_error = 0x1p-48 * fabs(at);
    return at;
}

int pir_line_past_end(pir_exact *exact, const pir_int *s, const pir_int *d, int exponent) {
    // compare S/(K·2^i) with D·2^exponent, where exponent ≤ 0
    uint32_t mark = exact->scratch.used, down = (uint32_t)-exponent;
    pir_int right = pir_exact_product(exact, d, &exact->k);
    uint32_t up_s = down > exact->i ? down - exact->i : 0, up_d = exact->i > down ? exact->i - down : 0;
    pir_int a = pir_limbs_take(&exact->scratch, pir_int_length(s) + up_s / GMP_NUMB_BITS + 2);
    pir_int b = pir_limbs_take(&exact->scratch, pir_int_length(&right) + up_d / GMP_NUMB_BITS + 2);
    pir_int_shift_left(&a, s, up_s);
    pir_int_shift_left(&b, &right, up_d);
    int order = pir_exact_compare(exact, &a, &b) * pir_int_sign(d);
    exact->scratch.used = mark;
    return order;
}

/* Whether the line crosses a facet within its direction's length. */
static bool is_within(pir_exact *exact, const pir_line *line, const pir_facet *facet, double at, double error) {
    // below the normal numbers the length has lost bits, beyond all numbers it is none
    double length = ldexp(line->part, line->exponent - exact->frame->exponent);
    if (length >= 0x1p-1022 && length < HUGE_VAL && fabs(at - length) > error + 0x1p-48 * length)
        return at < length;
    struct exact_crossing crossing = exact_crossing_of(exact, line, facet);
    bool within = pir_line_past_end(exact, &crossing.s, &crossing.d, crossing.exponent) <= 0;
    exact->scratch.used = crossing.mark;
    return within;
}

bool pir_line_arrive(pir_exact *exact, const pir_line *line, const pir_facet *facet, pir_arrival *ret_arrival) {
    pir_normal normal = pir_facet_normal(facet);
    pir_way way = {.u = line->u, .direction = line->direction, .normal = &normal, .a = facet->a, .b = facet->b};
    way.at = pir_line_at(exact, line, facet, &way.error);
    ret_arrival->at = fmax(0, way.at);
    ret_arrival->normal = facet->n;
    ret_arrival->within = is_within(exact, line, facet, way.at, way.error);
    return pir_touch_facet(exact, line->placement, facet, 0, &way, &ret_arrival->touch);
}
