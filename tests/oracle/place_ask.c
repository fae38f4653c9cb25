/* SPDX-License-Identifier: MIT */
/* See place.h: what half-spaces tell. Every comparison is of exact integers; only the last step rounds. */
#include "oracle/place.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static oracle_real real_of(mpz_t x) {
    oracle_real r;
    r.m = mpz_get_d_2exp(&r.e, x);
    return r;
}

static oracle_real times(oracle_real a, oracle_real b) {
    return (oracle_real){a.m * b.m, a.e + b.e};
}

static oracle_real over(oracle_real a, oracle_real b) {
    return (oracle_real){a.m / b.m, a.e - b.e};
}

double oracle_real_double(oracle_real x) {
    long e = x.e < -3000 ? -3000 : x.e > 3000 ? 3000 : x.e;
    return ldexp(x.m, (int)e);
}

/* x / |q|² as a length; the nearest double or one beside it, and itself where it is a double. */
static double coordinate(const oracle_place *o, mpz_t x) {
    oracle_place *place = (oracle_place *)o;
    mp_bitcnt_t shift = mpz_sizeinbase(place->square, 2) + 64;
    long e;
    mpz_mul_2exp(x, x, shift);
    mpz_tdiv_q(x, x, place->square);
    double m = mpz_get_d_2exp(&e, x);
    return oracle_real_double((oracle_real){m, e - (long)shift + o->unit});
}

pir_vec3 oracle_place_vertex(const oracle_place *o, uint32_t i, uint32_t j) {
    double c[3];
    mpz_t x;
    mpz_init(x);
    for (int k = 0; k < 3; k++) {
        mpz_add(x, o->first_q[k], o->b[j][k]);
        mpz_sub(x, x, o->first_p[k]);
        mpz_sub(x, x, o->a[i][k]);
        c[k] = coordinate(o, x);
    }
    mpz_clear(x);
    return (pir_vec3){c[0], c[1], c[2]};
}

/* --- poses --- */

/* x·|q|² in units of 2^unit. */
static void set_vector(oracle_place *o, oracle_vec r, pir_vec3 x, long unit) {
    const double c[3] = {x.x, x.y, x.z};
    for (int k = 0; k < 3; k++) {
        oracle_set_double(r[k], c[k], unit);
        mpz_mul(r[k], r[k], o->square);
    }
}

/* The unit that holds both vectors and the bodies; sets grain and scale. */
static long take_unit(oracle_place *o, pir_vec3 x, pir_vec3 y) {
    const double c[6] = {x.x, x.y, x.z, y.x, y.y, y.z};
    long unit = oracle_unit(c, 6, o->unit);
    mpz_set_ui(o->grain, 1);
    mpz_mul_2exp(o->grain, o->grain, (mp_bitcnt_t)(o->unit - unit));
    o->scale = over((oracle_real){1, unit}, real_of(o->square));
    return unit;
}

void oracle_place_set(oracle_place *o, pir_vec3 translation, pir_vec3 direction) {
    long unit = take_unit(o, translation, direction);
    mpz_t x;
    mpz_init(x);
    set_vector(o, o->t, translation, unit);
    set_vector(o, o->d, direction, unit);
    for (int k = 0; k < 3; k++) {
        mpz_sub(x, o->first_q[k], o->first_p[k]);
        mpz_mul(x, x, o->grain);
        mpz_sub(o->t[k], o->t[k], x);
    }
    for (uint32_t i = 0; i < o->plane_count; i++) {
        oracle_dot(o->rate[i], o->plane[i].normal, o->d);
        oracle_dot(x, o->plane[i].normal, o->t);
        mpz_mul(o->slack[i], o->plane[i].offset, o->grain);
        mpz_sub(o->slack[i], o->slack[i], x);
    }
    mpz_clear(x);
}

void oracle_place_set_point(oracle_place *o, pir_operand operand, pir_vec3 point, pir_vec3 translation) {
    long unit = take_unit(o, point, translation);
    oracle_vec x;
    oracle_vec_init(x);
    set_vector(o, o->t, point, unit);
    set_vector(o, x, translation, unit);
    for (int k = 0; k < 3; k++) {
        oracle_vec *first = operand == PIR_OPERAND_P ? &o->first_p : &o->first_q;
        mpz_t at;
        mpz_init(at);
        mpz_mul(at, (*first)[k], o->grain);
        mpz_sub(o->t[k], o->t[k], at);
        if (operand == PIR_OPERAND_P) {
            // {−a} is looked at from first + translation − point
            mpz_sub(o->t[k], x[k], o->t[k]);
        }
        mpz_clear(at);
    }
    oracle_vec_clear(x);
}

/* t + v·part / whole, whole > 0. */
static void move(oracle_place *o, oracle_vec v, mpz_t part, mpz_t whole) {
    for (int k = 0; k < 3; k++) {
        mpz_mul(o->t[k], o->t[k], whole);
        mpz_addmul(o->t[k], v[k], part);
    }
    mpz_mul(o->grain, o->grain, whole);
}

void oracle_place_to_plane(oracle_place *o, uint32_t i) {
    mpz_t square;
    mpz_init(square);
    oracle_dot(square, o->plane[i].normal, o->plane[i].normal);
    move(o, o->plane[i].normal, o->slack[i], square);
    mpz_clear(square);
}

void oracle_place_along_to_plane(oracle_place *o, uint32_t i) {
    mpz_t part, whole;
    mpz_init_set(part, o->slack[i]);
    mpz_init_set(whole, o->rate[i]);
    if (mpz_sgn(whole) < 0)
        mpz_neg(part, part);
    mpz_abs(whole, whole);
    move(o, o->d, part, whole);
    mpz_clears(part, whole, NULL);
}

/* --- inside --- */

pir_state oracle_place_state(const oracle_place *o) {
    bool touches = o->dimension < 3;
    for (uint32_t i = 0; i < o->plane_count; i++) {
        if (mpz_sgn(o->slack[i]) < 0)
            return PIR_OUTSIDE;
        touches |= mpz_sgn(o->slack[i]) == 0;
    }
    return touches ? PIR_BOUNDARY : PIR_INSIDE;
}

double oracle_place_slack(const oracle_place *o, uint32_t i) {
    return oracle_real_double(times(over(real_of(o->slack[i]), o->plane[i].length), o->scale));
}

int oracle_place_compare(const oracle_place *o, uint32_t i, uint32_t j) {
    // x / |n| against y / |m|, by squares
    mpz_t x, y, square;
    mpz_inits(x, y, square, NULL);
    mpz_mul(x, o->slack[i], o->slack[i]);
    mpz_mul(y, o->slack[j], o->slack[j]);
    oracle_dot(square, o->plane[j].normal, o->plane[j].normal);
    mpz_mul(x, x, square);
    oracle_dot(square, o->plane[i].normal, o->plane[i].normal);
    mpz_mul(y, y, square);
    int order = mpz_cmp(x, y);
    mpz_clears(x, y, square, NULL);
    return order;
}

uint32_t oracle_place_deepest(const oracle_place *o) {
    uint32_t best = 0;
    oracle_real least = {0, 0};
    for (uint32_t i = 0; i < o->plane_count; i++) {
        oracle_real slack = over(real_of(o->slack[i]), o->plane[i].length);
        double order = i == 0 ? -1 : oracle_real_double((oracle_real){slack.m, slack.e - least.e}) - least.m;
        // what doubles leave open is decided exactly
        if (order < 0x1p-40 * least.m &&
            (order < -0x1p-40 * least.m || i == 0 || oracle_place_compare(o, i, best) < 0)) {
            best = i;
            least = slack;
        }
    }
    return best;
}

/* --- along a direction --- */

/* slack/rate of plane i against that of plane j; rates of one sign. */
static int compare_times(const oracle_place *o, uint32_t i, uint32_t j, mpz_t x, mpz_t y) {
    mpz_mul(x, o->slack[i], o->rate[j]);
    mpz_mul(y, o->slack[j], o->rate[i]);
    return mpz_cmp(x, y);
}

static double time_of(const oracle_place *o, uint32_t i) {
    return oracle_real_double(over(real_of(o->slack[i]), real_of(o->rate[i])));
}

/* Whether slack/rate of plane `enter` is at most 1. */
static bool is_within(const oracle_place *o, uint32_t enter) {
    return mpz_cmpabs(o->slack[enter], o->rate[enter]) <= 0;
}

oracle_ray oracle_place_ray(const oracle_place *o) {
    oracle_ray ray = {.meets = 1, .inwards = o->dimension == 3, .leave = HUGE_VAL};
    bool enters = false, leaves = false;
    mpz_t x, y;
    mpz_inits(x, y, NULL);
    for (uint32_t i = 0; i < o->plane_count; i++) {
        int slack = mpz_sgn(o->slack[i]), rate = mpz_sgn(o->rate[i]);
        ray.meets &= slack >= 0 || rate < 0;
        ray.inwards &= slack > 0 || rate < 0;
        if (rate < 0 && slack < 0 && (!enters || compare_times(o, i, ray.first, x, y) > 0)) {
            enters = true;
            ray.first = i;
        }
        if (rate > 0 && (!leaves || compare_times(o, i, ray.last, x, y) < 0)) {
            leaves = true;
            ray.last = i;
        }
    }
    ray.enter = enters ? time_of(o, ray.first) : 0;
    ray.leave = leaves ? time_of(o, ray.last) : HUGE_VAL;
    // rates differ in sign: the product turns the comparison around
    if (ray.meets && enters && leaves)
        ray.meets = compare_times(o, ray.first, ray.last, x, y) >= 0;
    ray.within = ray.meets && (!enters || is_within(o, ray.first));
    mpz_clears(x, y, NULL);
    return ray;
}

/* --- far --- */

double oracle_place_farthest(oracle_place *o) {
    oracle_vec y;
    mpz_t square, most;
    oracle_vec_init(y);
    mpz_inits(square, most, NULL);
    for (uint32_t i = 0; i < o->p->count; i++)
        for (uint32_t j = 0; j < o->q->count; j++) {
            for (int k = 0; k < 3; k++) {
                mpz_sub(y[k], o->b[j][k], o->a[i][k]);
                mpz_mul(y[k], y[k], o->grain);
                mpz_sub(y[k], y[k], o->t[k]);
            }
            oracle_dot(square, y, y);
            if (mpz_cmp(square, most) > 0)
                mpz_swap(square, most);
        }
    oracle_real r = real_of(most);
    r = r.e % 2 == 0 ? (oracle_real){sqrt(r.m), r.e / 2} : (oracle_real){sqrt(2 * r.m), (r.e - 1) / 2};
    oracle_vec_clear(y);
    mpz_clears(square, most, NULL);
    return oracle_real_double(times(r, o->scale));
}

double oracle_place_reach(oracle_place *o, pir_vec3 direction) {
    const double c[3] = {direction.x, direction.y, direction.z};
    long unit = oracle_unit(c, 3, 2000);
    oracle_vec n, y;
    mpz_t height, most;
    oracle_vec_init(n);
    oracle_vec_init(y);
    mpz_inits(height, most, NULL);
    for (int k = 0; k < 3; k++)
        oracle_set_double(n[k], c[k], unit);
    // n·b and −n·a apart
    for (int which = 0; which < 2; which++) {
        uint32_t count = which ? o->q->count : o->p->count;
        oracle_vec *at = which ? o->b : o->a;
        mpz_t best;
        mpz_init(best);
        for (uint32_t i = 0; i < count; i++) {
            oracle_dot(height, n, at[i]);
            if (!which)
                mpz_neg(height, height);
            if (i == 0 || mpz_cmp(height, best) > 0)
                mpz_set(best, height);
        }
        mpz_add(most, most, best);
        mpz_clear(best);
    }
    mpz_mul(most, most, o->grain);
    oracle_dot(height, n, o->t);
    mpz_sub(most, most, height);
    oracle_dot(height, n, n);
    oracle_real square = real_of(height);
    oracle_real length = square.e % 2 == 0 ? (oracle_real){sqrt(square.m), square.e / 2}
                                           : (oracle_real){sqrt(2 * square.m), (square.e - 1) / 2};
    double reach = oracle_real_double(times(over(real_of(most), length), o->scale));
    oracle_vec_clear(n);
    oracle_vec_clear(y);
    mpz_clears(height, most, NULL);
    return reach;
}
