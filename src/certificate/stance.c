/* SPDX-License-Identifier: MIT */
/*
 * Bodies as integers of one unit. A quaternion of doubles is an exact rotation: R = M(q)/|q|², and M and |q|² are
 * integers once q is scaled by a power of two (exact/rotation.h). Here they are computed anew, from that formula and
 * GMP alone.
 */
#include "certificate/stance.h"

#include <math.h>
#include <string.h>

#include <pirouette/exact.h>

/* Numbers of answers agree within this, relative to the largest coordinate: ten times what they promise. */
#define NUMBER_ERROR 1e-11

void pir_triple_init(pir_triple *triple) {
    mpz_inits(triple->c[0], triple->c[1], triple->c[2], NULL);
}

void pir_triple_finish(pir_triple *triple) {
    mpz_clears(triple->c[0], triple->c[1], triple->c[2], NULL);
}

void pir_triple_subtract(pir_triple *to, const pir_triple *a, const pir_triple *b) {
    for (int k = 0; k < 3; k++)
        mpz_sub(to->c[k], a->c[k], b->c[k]);
}

void pir_triple_negate(pir_triple *triple) {
    for (int k = 0; k < 3; k++)
        mpz_neg(triple->c[k], triple->c[k]);
}

void pir_triple_strip(pir_triple *triple) {
    mpz_t common;
    mpz_init(common);
    for (int k = 0; k < 3; k++)
        mpz_gcd(common, common, triple->c[k]);
    if (mpz_sgn(common) > 0)
        for (int k = 0; k < 3; k++)
            mpz_divexact(triple->c[k], triple->c[k], common);
    mpz_clear(common);
}

void pir_triple_cross(pir_triple *to, const pir_triple *a, const pir_triple *b) {
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(to->c[k], a->c[i], b->c[j]);
        mpz_submul(to->c[k], a->c[j], b->c[i]);
    }
}

void pir_triple_dot(mpz_t to, const pir_triple *a, const pir_triple *b) {
    mpz_mul(to, a->c[0], b->c[0]);
    mpz_addmul(to, a->c[1], b->c[1]);
    mpz_addmul(to, a->c[2], b->c[2]);
}

/* --- the rotation --- */

/* M(q) and |q|² as integers without a common factor. */
struct turn {
    mpz_t m[3][3], norm;
};

static void turn_init(struct turn *turn) {
    mpz_init(turn->norm);
    for (int i = 0; i < 9; i++)
        mpz_init(turn->m[i / 3][i % 3]);
}

static void turn_finish(struct turn *turn) {
    mpz_clear(turn->norm);
    for (int i = 0; i < 9; i++)
        mpz_clear(turn->m[i / 3][i % 3]);
}

/* Four doubles as integers, by one power of two. */
static void integers_of(const double x[4], mpz_t ret[4]) {
    mpq_t q[4];
    mpz_t den;
    mpz_init_set_ui(den, 1);
    for (int k = 0; k < 4; k++) {
        mpq_init(q[k]);
        mpq_set_d(q[k], x[k]);
        mpz_lcm(den, den, mpq_denref(q[k]));
    }
    for (int k = 0; k < 4; k++) {
        mpz_divexact(ret[k], den, mpq_denref(q[k]));
        mpz_mul(ret[k], ret[k], mpq_numref(q[k]));
        mpq_clear(q[k]);
    }
    mpz_clear(den);
}

/* M = (w² − |v|²) I + 2 v vᵀ + 2w [v]. */
static void turn_set(struct turn *turn, pir_quat given) {
    const double x[4] = {given.x, given.y, given.z, given.w};
    mpz_t q[4], term, common;
    mpz_inits(q[0], q[1], q[2], q[3], term, common, NULL);
    integers_of(x, q);
    mpz_mul(term, q[3], q[3]);
    mpz_set(turn->norm, term);
    for (int k = 0; k < 3; k++) {
        mpz_submul(term, q[k], q[k]);
        mpz_addmul(turn->norm, q[k], q[k]);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            mpz_ptr m = turn->m[i][j];
            mpz_mul(m, q[i], q[j]);
            if (i != j && (i + 1) % 3 == j)
                mpz_submul(m, q[3], q[3 - i - j]);
            else if (i != j)
                mpz_addmul(m, q[3], q[3 - i - j]);
            mpz_mul_2exp(m, m, 1);
            if (i == j)
                mpz_add(m, m, term);
        }
    mpz_set(common, turn->norm);
    for (int i = 0; i < 9; i++)
        mpz_gcd(common, common, turn->m[i / 3][i % 3]);
    mpz_divexact(turn->norm, turn->norm, common);
    for (int i = 0; i < 9; i++)
        mpz_divexact(turn->m[i / 3][i % 3], turn->m[i / 3][i % 3], common);
    mpz_clears(q[0], q[1], q[2], q[3], term, common, NULL);
}

/* --- bodies --- */

/* Zeros for the vertices of all parts; false when out of memory. */
static bool stood_init(pir_stood *stood, const pir_allocator *allocator, const pir_stance_body *body) {
    uint32_t count = 0;
    for (uint32_t part = 0; part < body->count; part++)
        count += pir_polytope_vertex_count(body->part[part]);
    stood->at = PIR_NEW(allocator, pir_triple, count);
    stood->listed = PIR_NEW(allocator, uint32_t, count);
    if (stood->at && stood->listed)
        stood->count = count;
    for (uint32_t i = 0; i < stood->count; i++) {
        pir_triple_init(&stood->at[i]);
        stood->listed[i] = PIR_UNLISTED;
    }
    if (stood->count > 0)
        return true;
    PIR_FREE(allocator, stood->at, count);
    PIR_FREE(allocator, stood->listed, count);
    *stood = (pir_stood){0};
    return false;
}

/* Multiplies `den` to a denominator of a part's vertices, too. */
static void add_denominators(const pir_polytope *part, mpz_t den) {
    mpq_t v[3];
    mpq_inits(v[0], v[1], v[2], NULL);
    for (uint32_t i = 0; i < pir_polytope_vertex_count(part); i++) {
        pir_polytope_vertex_exact(part, i, v);
        for (int k = 0; k < 3; k++)
            mpz_lcm(den, den, mpq_denref(v[k]));
    }
    mpq_clears(v[0], v[1], v[2], NULL);
}

/* A part's vertices as integers of 1 / den. */
static void fill_part(pir_triple *at, const pir_polytope *part, const mpz_t den) {
    mpq_t v[3];
    mpq_inits(v[0], v[1], v[2], NULL);
    for (uint32_t i = 0; i < pir_polytope_vertex_count(part); i++) {
        pir_polytope_vertex_exact(part, i, v);
        for (int k = 0; k < 3; k++) {
            mpz_divexact(at[i].c[k], den, mpq_denref(v[k]));
            mpz_mul(at[i].c[k], at[i].c[k], mpq_numref(v[k]));
        }
    }
    mpq_clears(v[0], v[1], v[2], NULL);
}

/* The vertices as integers of 1 / *den, the least common denominator. */
static void stood_fill(pir_stood *stood, const pir_stance_body *body, mpz_t den) {
    pir_triple *at = stood->at;
    mpz_set_ui(den, 1);
    for (uint32_t part = 0; part < body->count; part++)
        add_denominators(body->part[part], den);
    for (uint32_t part = 0; part < body->count; part++) {
        fill_part(at, body->part[part], den);
        at += pir_polytope_vertex_count(body->part[part]);
    }
}

/* Multiplies all coordinates. */
static void stood_scale(pir_stood *stood, const mpz_t by) {
    for (uint32_t i = 0; i < stood->count; i++)
        for (int k = 0; k < 3; k++)
            mpz_mul(stood->at[i].c[k], stood->at[i].c[k], by);
}

static void stood_turn(pir_stood *stood, const struct turn *turn) {
    pir_triple to;
    pir_triple_init(&to);
    for (uint32_t i = 0; i < stood->count; i++) {
        pir_triple *v = &stood->at[i];
        for (int r = 0; r < 3; r++) {
            mpz_mul(to.c[r], turn->m[r][0], v->c[0]);
            mpz_addmul(to.c[r], turn->m[r][1], v->c[1]);
            mpz_addmul(to.c[r], turn->m[r][2], v->c[2]);
        }
        for (int r = 0; r < 3; r++)
            mpz_swap(v->c[r], to.c[r]);
    }
    pir_triple_finish(&to);
}

static void common_factor(const pir_stood *stood, mpz_t common) {
    for (uint32_t i = 0; i < stood->count; i++)
        for (int k = 0; k < 3; k++)
            mpz_gcd(common, common, stood->at[i].c[k]);
}

static void divide(pir_stood *stood, const mpz_t by) {
    for (uint32_t i = 0; i < stood->count; i++)
        for (int k = 0; k < 3; k++)
            mpz_divexact(stood->at[i].c[k], stood->at[i].c[k], by);
}

/* Moves P by a translation of numerators t over `den`, both bodies being integers of the unit. */
static void move(pir_stance *bodies, mpq_t t[3]) {
    mpz_t step;
    mpz_init(step);
    for (int k = 0; k < 3; k++) {
        mpz_divexact(step, bodies->unit, mpq_denref(t[k]));
        mpz_mul(step, step, mpq_numref(t[k]));
        for (uint32_t i = 0; i < bodies->p.count; i++)
            mpz_add(bodies->p.at[i].c[k], bodies->p.at[i].c[k], step);
    }
    mpz_clear(step);
}

/* Turns and moves P, which may be given reflected, and brings both bodies to one unit. */
static void stand(pir_stance *bodies, const pir_stance_body body[2], bool is_reflected) {
    struct turn turn;
    mpz_t den_p, den_q, by;
    mpq_t t[3];
    const double moved[3] = {bodies->translation.x, bodies->translation.y, bodies->translation.z};
    turn_init(&turn);
    mpz_inits(den_p, den_q, by, NULL);
    turn_set(&turn, bodies->rotation);
    stood_fill(&bodies->p, &body[0], den_p);
    stood_fill(&bodies->q, &body[1], den_q);
    stood_turn(&bodies->p, &turn);
    mpz_mul(den_p, den_p, turn.norm);
    mpz_lcm(bodies->unit, den_p, den_q);
    for (int k = 0; k < 3; k++) {
        mpq_init(t[k]);
        mpq_set_d(t[k], moved[k]);
        mpz_lcm(bodies->unit, bodies->unit, mpq_denref(t[k]));
    }
    mpz_divexact(by, bodies->unit, den_p);
    if (is_reflected)
        mpz_neg(by, by);
    stood_scale(&bodies->p, by);
    mpz_divexact(by, bodies->unit, den_q);
    stood_scale(&bodies->q, by);
    move(bodies, t);
    mpz_set(by, bodies->unit);
    common_factor(&bodies->p, by);
    common_factor(&bodies->q, by);
    mpz_divexact(bodies->unit, bodies->unit, by);
    divide(&bodies->p, by);
    divide(&bodies->q, by);
    mpq_clears(t[0], t[1], t[2], NULL);
    mpz_clears(den_p, den_q, by, NULL);
    turn_finish(&turn);
}

static pir_status make(pir_stance *bodies, const pir_stance_body body[2], bool is_reflected) {
    mpz_init_set_ui(bodies->unit, 1);
    if (!stood_init(&bodies->p, &bodies->allocator, &body[0]) ||
        !stood_init(&bodies->q, &bodies->allocator, &body[1])) {
        pir_stance_finish(bodies);
        return PIR_ERR_MEMORY;
    }
    stand(bodies, body, is_reflected);
    return PIR_OK;
}

pir_status pir_stance_make(pir_stance *bodies, const pir_allocator *allocator, const pir_sum *sum, bool difference,
                           pir_vec3 translation) {
    const pir_polytope *p = pir_sum_p(sum), *q = pir_sum_q(sum);
    *bodies = (pir_stance){.allocator = *allocator, .rotation = pir_sum_rotation(sum), .translation = translation};
    bodies->difference = difference;
    return make(bodies, (const pir_stance_body[]){{&p, 1}, {&q, 1}}, difference); // which holds P reflected
}

pir_status pir_stance_make_parts(pir_stance *bodies, const pir_allocator *allocator, const pir_stance_body body[2],
                                 pir_pose pose_p) {
    *bodies = (pir_stance){.allocator = *allocator, .rotation = pose_p.rotation, .translation = pose_p.translation};
    bodies->difference = true;
    return make(bodies, body, false);
}

static void stood_finish(pir_stood *stood, const pir_allocator *allocator) {
    for (uint32_t i = 0; i < stood->count; i++)
        pir_triple_finish(&stood->at[i]);
    PIR_FREE(allocator, stood->at, stood->count);
    PIR_FREE(allocator, stood->listed, stood->count);
}

void pir_stance_finish(pir_stance *bodies) {
    stood_finish(&bodies->p, &bodies->allocator);
    stood_finish(&bodies->q, &bodies->allocator);
    mpz_clear(bodies->unit);
}

/* --- what is asked of them --- */

void pir_stance_vertex(const pir_stance *bodies, pir_vertex_pair corner, pir_triple *to) {
    for (int k = 0; k < 3; k++)
        if (bodies->difference)
            mpz_sub(to->c[k], bodies->q.at[corner.q].c[k], bodies->p.at[corner.p].c[k]);
        else
            mpz_add(to->c[k], bodies->q.at[corner.q].c[k], bodies->p.at[corner.p].c[k]);
}

void pir_stance_list(pir_stance *bodies, pir_vertex_pair corner) {
    bodies->p.listed[corner.p] = 1;
    bodies->q.listed[corner.q] = 1;
}

/* The first vertex that lies farthest along sign·way. */
static uint32_t farthest(const pir_stood *stood, const pir_triple *way, int sign) {
    mpz_t here, best;
    uint32_t found = 0;
    mpz_inits(here, best, NULL);
    for (uint32_t i = 0; i < stood->count; i++) {
        pir_triple_dot(here, &stood->at[i], way);
        if (i == 0 || sign * mpz_cmp(here, best) > 0) {
            mpz_swap(here, best);
            found = i;
        }
    }
    mpz_clears(here, best, NULL);
    return found;
}

pir_vertex_pair pir_stance_lowest(const pir_stance *bodies, const pir_triple *way) {
    return (pir_vertex_pair){farthest(&bodies->p, way, bodies->difference ? 1 : -1), farthest(&bodies->q, way, -1)};
}

void pir_stood_range(const pir_stood *stood, const pir_triple *way, mpz_ptr ret_least, mpz_ptr ret_most) {
    if (ret_least)
        pir_triple_dot(ret_least, &stood->at[farthest(stood, way, -1)], way);
    if (ret_most)
        pir_triple_dot(ret_most, &stood->at[farthest(stood, way, 1)], way);
}

double pir_ratio_split(const mpz_t num, const mpz_t den, long *ret_exponent) {
    long up, down;
    double n = mpz_get_d_2exp(&up, num), d = mpz_get_d_2exp(&down, den);
    *ret_exponent = n == 0 ? 0 : up - down;
    return n / d;
}

double pir_stance_reach(const pir_stance *bodies) {
    double most = 0;
    for (int body = 0; body < 2; body++) {
        const pir_stood *stood = body ? &bodies->q : &bodies->p;
        for (uint32_t i = 0; i < stood->count; i++)
            for (int k = 0; k < 3; k++) {
                long exponent;
                double x = pir_ratio_split(stood->at[i].c[k], bodies->unit, &exponent);
                most = fmax(most, fabs(ldexp(x, (int)exponent)));
            }
    }
    return most;
}

bool pir_stance_is_length(const pir_stance *bodies, double told, const mpz_t num, const mpz_t den) {
    long exponent;
    double square = pir_ratio_split(num, den, &exponent);
    if (exponent % 2 != 0) {
        square *= 2;
        exponent--;
    }
    double length = ldexp(sqrt(square), (int)(exponent / 2));
    const pir_vec3 t = bodies->translation;
    double reach = length + pir_stance_reach(bodies) + fabs(t.x) + fabs(t.y) + fabs(t.z);
    double off = fabs(fabs(told) - length);
    return off <= NUMBER_ERROR * reach || (isinf(reach) && !isnan(told));
}
