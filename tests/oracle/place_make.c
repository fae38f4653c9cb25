/* SPDX-License-Identifier: MIT */
/*
 * See place.h: the difference D as half-spaces. A facet of D with outward normal n is F_Q(n) − F_P(−n), the
 * difference of the sets of vertices that lie farthest. One of them is a facet, or both hold edges that are not
 * parallel: so n is that of a facet of −R·P or Q, or ± the cross product of two edges. All are tried.
 */
#include "oracle/place.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/*
 * The filter: coordinates of bodies below 1 and within 2^-52 of the exact ones; a direction below 1, each coordinate
 * within 2^-48. Then a height is off by less than 3·(2^-48 + 2^-52) + 2^-50, the difference of two by less than 2^-45.
 */
#define CERTAIN 0x1p-45

/* --- bodies --- */

static void scale_up(oracle_vec v, mpz_t factor, unsigned long shift) {
    for (int k = 0; k < 3; k++) {
        mpz_mul(v[k], v[k], factor);
        mpz_mul_2exp(v[k], v[k], shift);
    }
}

static void copy(oracle_vec to, oracle_vec from) {
    for (int k = 0; k < 3; k++)
        mpz_set(to[k], from[k]);
}

/* v turned, when `quat`, otherwise as it is, times |q|², in units of 2^unit. */
static void bring(oracle_place *o, oracle_vec r, oracle_vec v, bool turned, unsigned long shift) {
    mpz_t one;
    mpz_init_set_ui(one, 1);
    if (turned)
        oracle_turn(r, o->quat, v);
    else
        copy(r, v);
    scale_up(r, turned ? one : o->square, shift);
    mpz_clear(one);
}

static void bring_bodies(oracle_place *o) {
    unsigned long shift_p = (unsigned long)(o->p->unit - o->unit), shift_q = (unsigned long)(o->q->unit - o->unit);
    oracle_vec_init(o->first_p);
    oracle_vec_init(o->first_q);
    bring(o, o->first_p, ((oracle_solid *)o->p)->first, true, shift_p);
    bring(o, o->first_q, ((oracle_solid *)o->q)->first, false, shift_q);
    for (uint32_t i = 0; i < o->p->count; i++) {
        oracle_vec_init(o->a[i]);
        bring(o, o->a[i], o->p->at[i], true, shift_p);
    }
    for (uint32_t j = 0; j < o->q->count; j++) {
        oracle_vec_init(o->b[j]);
        bring(o, o->b[j], o->q->at[j], false, shift_q);
    }
}

static void take_near(oracle_place *o) {
    double near[3];
    o->exponent = LONG_MIN;
    for (uint32_t i = 0; i < o->p->count; i++) {
        long e = oracle_near(near, o->a[i]);
        o->exponent = e > o->exponent ? e : o->exponent;
    }
    for (uint32_t j = 0; j < o->q->count; j++) {
        long e = oracle_near(near, o->b[j]);
        o->exponent = e > o->exponent ? e : o->exponent;
    }
    o->exponent = o->exponent == LONG_MIN ? 0 : o->exponent;
    for (uint32_t i = 0; i < o->p->count; i++)
        oracle_near_at(o->near_a[i], o->a[i], o->exponent);
    for (uint32_t j = 0; j < o->q->count; j++)
        oracle_near_at(o->near_b[j], o->b[j], o->exponent);
}

/* --- planes --- */

/* The vertices of one body, and the sign with which they enter the difference. */
struct cloud {
    oracle_vec *at;
    double (*near)[3];
    uint32_t count, words;
    int sign;
};

/* The vertices that lie farthest along sign·n, into `set`. */
static void find_extreme(const struct cloud *c, oracle_vec n, const double near[3], oracle_set *set) {
    double most = -HUGE_VAL;
    for (uint32_t i = 0; i < c->count; i++) {
        const double *x = c->near[i];
        double height = c->sign * (near[0] * x[0] + near[1] * x[1] + near[2] * x[2]);
        most = height > most ? height : most;
    }
    mpz_t height, best;
    mpz_inits(height, best, NULL);
    bool any = false;
    for (uint32_t i = 0; i < c->count; i++) {
        const double *x = c->near[i];
        if (c->sign * (near[0] * x[0] + near[1] * x[1] + near[2] * x[2]) < most - CERTAIN)
            continue;
        oracle_dot(height, n, c->at[i]);
        int order = any ? c->sign * mpz_cmp(height, best) : 1;
        if (order > 0) {
            mpz_set(best, height);
            memset(set, 0, c->words * sizeof *set);
        }
        if (order >= 0)
            oracle_set_put(set, i);
        any = true;
    }
    mpz_clears(height, best, NULL);
}

static struct cloud cloud_p(const oracle_place *o) {
    return (struct cloud){o->a, o->near_a, o->p->count, o->p->words, -1};
}

static struct cloud cloud_q(const oracle_place *o) {
    return (struct cloud){o->b, o->near_b, o->q->count, o->q->words, 1};
}

static bool is_known(const oracle_place *o, const oracle_set *p, const oracle_set *q) {
    for (uint32_t i = 0; i < o->plane_count; i++)
        if (memcmp(o->plane[i].p, p, o->p->words * sizeof *p) == 0 &&
            memcmp(o->plane[i].q, q, o->q->words * sizeof *q) == 0)
            return true;
    return false;
}

static uint32_t first_of(const oracle_set *set) {
    uint32_t i = 0;
    while (!oracle_set_has(set, i))
        i++;
    return i;
}

/* The length of a vector of integers. */
static oracle_real length_of(oracle_vec v) {
    mpz_t square;
    long e;
    mpz_init(square);
    oracle_dot(square, v, v);
    double m = mpz_get_d_2exp(&e, square);
    mpz_clear(square);
    return e % 2 == 0 ? (oracle_real){sqrt(m), e / 2} : (oracle_real){sqrt(2 * m), (e - 1) / 2};
}

static oracle_plane *add_plane(oracle_place *o, oracle_vec n, const oracle_set *p, const oracle_set *q) {
    o->plane = oracle_grow(o->plane, o->plane_count, &o->plane_room, sizeof *o->plane);
    oracle_plane *plane = &o->plane[o->plane_count++];
    oracle_vec x;
    oracle_vec_init(x);
    oracle_vec_init(plane->normal);
    mpz_init(plane->offset);
    copy(plane->normal, n);
    oracle_sub(x, o->b[first_of(q)], o->a[first_of(p)]);
    oracle_dot(plane->offset, n, x);
    oracle_vec_clear(x);
    plane->p = oracle_new(o->p->words, sizeof *p);
    plane->q = oracle_new(o->q->words, sizeof *q);
    memcpy(plane->p, p, o->p->words * sizeof *p);
    memcpy(plane->q, q, o->q->words * sizeof *q);
    plane->length = length_of(n);
    oracle_near(plane->near, n);
    double length =
        sqrt(plane->near[0] * plane->near[0] + plane->near[1] * plane->near[1] + plane->near[2] * plane->near[2]);
    for (int k = 0; k < 3; k++)
        plane->near[k] /= length;
    return plane;
}

/* Adds the supporting plane with outward normal n, unless it is there. */
static void take_normal(oracle_place *o, oracle_vec n) {
    double near[3];
    struct cloud p = cloud_p(o), q = cloud_q(o);
    oracle_set *set_p = oracle_new(p.words, sizeof *set_p), *set_q = oracle_new(q.words, sizeof *set_q);
    oracle_near(near, n);
    find_extreme(&p, n, near, set_p);
    find_extreme(&q, n, near, set_q);
    // in a flat difference, the two sides of its plane hold all vertices
    if (o->dimension < 3 || !is_known(o, set_p, set_q))
        add_plane(o, n, set_p, set_q);
    free(set_p);
    free(set_q);
}

static void negate(oracle_vec n) {
    for (int k = 0; k < 3; k++)
        mpz_neg(n[k], n[k]);
}

static void take_both(oracle_place *o, oracle_vec n) {
    take_normal(o, n);
    negate(n);
    take_normal(o, n);
    negate(n);
}

static void take_facets(oracle_place *o) {
    oracle_vec n;
    oracle_vec_init(n);
    for (uint32_t f = 0; f < o->p->facet_count; f++) {
        oracle_turn(n, o->quat, o->p->normal[f]);
        negate(n);
        take_normal(o, n);
    }
    for (uint32_t g = 0; g < o->q->facet_count; g++)
        take_normal(o, o->q->normal[g]);
    oracle_vec_clear(n);
}

/* --- pairs of edges --- */

/* An edge's direction, exactly, and as a double of which the largest coordinate is about 1. */
struct side {
    oracle_vec along;
    double near[3];
    uint32_t end[2];
};

static struct side *sides_of(oracle_vec *at, const oracle_solid *s) {
    struct side *side = oracle_new(s->edge_count, sizeof *side);
    for (uint32_t e = 0; e < s->edge_count; e++) {
        memcpy(side[e].end, s->edge[e], sizeof side[e].end);
        oracle_vec_init(side[e].along);
        oracle_sub(side[e].along, at[s->edge[e][1]], at[s->edge[e][0]]);
        oracle_near(side[e].near, side[e].along);
    }
    return side;
}

static void free_sides(struct side *side, uint32_t count) {
    for (uint32_t e = 0; e < count; e++)
        oracle_vec_clear(side[e].along);
    free(side);
}

/* On which sides of vertex `from` of a cloud, along n, others certainly lie, as bits; n is off by less than 2^-49. */
static int certain_sides(const struct cloud *c, const double n[3], uint32_t from) {
    const double *o = c->near[from];
    int sides = 0;
    for (uint32_t i = 0; i < c->count && sides != 3; i++) {
        const double *x = c->near[i];
        double height = c->sign * (n[0] * (x[0] - o[0]) + n[1] * (x[1] - o[1]) + n[2] * (x[2] - o[2]));
        sides |= height > CERTAIN ? 1 : height < -CERTAIN ? 2 : 0;
    }
    return sides;
}

static bool both_lie_in(const oracle_set *set, const uint32_t end[2]) {
    return oracle_set_has(set, end[0]) && oracle_set_has(set, end[1]);
}

/* Adds the plane of normal n where both edges lie in it. */
static void try_normal(oracle_place *o, oracle_vec n, const struct side *e, const struct side *f) {
    double near[3];
    struct cloud p = cloud_p(o), q = cloud_q(o);
    oracle_set *set_p = oracle_new(p.words, sizeof *set_p), *set_q = oracle_new(q.words, sizeof *set_q);
    oracle_near(near, n);
    find_extreme(&p, n, near, set_p);
    if (both_lie_in(set_p, e->end)) {
        find_extreme(&q, n, near, set_q);
        if (both_lie_in(set_q, f->end) && !is_known(o, set_p, set_q))
            add_plane(o, n, set_p, set_q);
    }
    free(set_p);
    free(set_q);
}

static void try_edges(oracle_place *o, struct side *e, struct side *f) {
    const double *u = e->near, *v = f->near;
    const double near[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    struct cloud p = cloud_p(o), q = cloud_q(o);
    // n needs all of both bodies on the lower side, −n on the upper
    int sides = certain_sides(&p, near, e->end[0]);
    if (sides != 3)
        sides |= certain_sides(&q, near, f->end[0]);
    if (sides == 3)
        return;
    oracle_vec n;
    oracle_vec_init(n);
    oracle_cross(n, e->along, f->along);
    if (!oracle_is_zero(n)) {
        if (!(sides & 1))
            try_normal(o, n, e, f);
        negate(n);
        if (!(sides & 2))
            try_normal(o, n, e, f);
    }
    oracle_vec_clear(n);
}

static void take_edges(oracle_place *o) {
    struct side *e = sides_of(o->a, o->p), *f = sides_of(o->b, o->q);
    for (uint32_t i = 0; i < o->p->edge_count; i++)
        for (uint32_t j = 0; j < o->q->edge_count; j++)
            try_edges(o, &e[i], &f[j]);
    free_sides(e, o->p->edge_count);
    free_sides(f, o->q->edge_count);
}

/* --- flat differences --- */

/* Vectors from the first vertices to the others, up to three of them that are independent; their number. */
static int find_basis(oracle_place *o, oracle_vec basis[3]) {
    int rank = 0;
    oracle_vec n;
    mpz_t volume;
    oracle_vec_init(n);
    mpz_init(volume);
    for (uint32_t i = 0; i < o->p->count + o->q->count && rank < 3; i++) {
        oracle_vec *x = i < o->p->count ? &o->a[i] : &o->b[i - o->p->count];
        if (rank == 0 && oracle_is_zero(*x))
            continue;
        if (rank == 1) {
            oracle_cross(n, basis[0], *x);
            if (oracle_is_zero(n))
                continue;
        }
        if (rank == 2) {
            oracle_dot(volume, n, *x);
            if (mpz_sgn(volume) == 0)
                continue;
        }
        copy(basis[rank++], *x);
    }
    mpz_clear(volume);
    oracle_vec_clear(n);
    return rank;
}

/* Two independent directions across u. */
static void find_across(oracle_vec u, oracle_vec v, oracle_vec w) {
    int k = mpz_sgn(u[0]) ? 0 : mpz_sgn(u[1]) ? 1 : 2;
    oracle_vec axis;
    oracle_vec_init(axis);
    mpz_set_ui(axis[(k + 1) % 3], 1);
    oracle_cross(v, u, axis);
    oracle_cross(w, u, v);
    oracle_vec_clear(axis);
}

/* The sides of a flat difference of dimension 2 with normal n: along every edge. */
static void take_sides(oracle_place *o, oracle_vec n) {
    oracle_vec m;
    oracle_vec_init(m);
    for (int which = 0; which < 2; which++) {
        const oracle_solid *s = which ? o->q : o->p;
        struct side *e = sides_of(which ? o->b : o->a, s);
        for (uint32_t i = 0; i < s->edge_count; i++) {
            oracle_cross(m, n, e[i].along);
            take_both(o, m);
        }
        free_sides(e, s->edge_count);
    }
    oracle_vec_clear(m);
}

static void take_flat(oracle_place *o, oracle_vec basis[3]) {
    oracle_vec v, w;
    oracle_vec_init(v);
    oracle_vec_init(w);
    if (o->dimension == 2) {
        oracle_cross(v, basis[0], basis[1]);
        take_both(o, v);
        take_sides(o, v);
    }
    if (o->dimension == 1) {
        find_across(basis[0], v, w);
        take_both(o, v);
        take_both(o, w);
        take_both(o, basis[0]);
    }
    for (int k = 0; k < 3 && o->dimension == 0; k++) {
        for (int i = 0; i < 3; i++)
            mpz_set_ui(v[i], i == k);
        take_both(o, v);
    }
    oracle_vec_clear(v);
    oracle_vec_clear(w);
}

static void find_planes(oracle_place *o) {
    oracle_vec basis[3];
    for (int i = 0; i < 3; i++)
        oracle_vec_init(basis[i]);
    o->dimension = find_basis(o, basis);
    if (o->dimension < 3) {
        take_flat(o, basis);
    } else {
        take_facets(o);
        take_edges(o);
    }
    for (int i = 0; i < 3; i++)
        oracle_vec_clear(basis[i]);
}

/* --- making one --- */

oracle_place *oracle_place_make(const oracle_solid *p, const oracle_solid *q, pir_quat rotation) {
    oracle_place *o = oracle_new(1, sizeof *o);
    o->p = p;
    o->q = q;
    oracle_quat_init(o->quat, rotation);
    mpz_init(o->square);
    for (int k = 0; k < 4; k++)
        mpz_addmul(o->square, o->quat[k], o->quat[k]);
    o->unit = p->unit < q->unit ? p->unit : q->unit;
    o->a = oracle_new(p->count, sizeof *o->a);
    o->b = oracle_new(q->count, sizeof *o->b);
    o->near_a = oracle_new(p->count, sizeof *o->near_a);
    o->near_b = oracle_new(q->count, sizeof *o->near_b);
    o->only_p = oracle_new(p->words, sizeof *o->only_p);
    o->only_q = oracle_new(q->words, sizeof *o->only_q);
    oracle_set_put(o->only_p, 0);
    oracle_set_put(o->only_q, 0);
    bring_bodies(o);
    take_near(o);
    find_planes(o);
    oracle_vec_init(o->t);
    oracle_vec_init(o->d);
    mpz_init_set_ui(o->grain, 1);
    o->slack = oracle_new(o->plane_count, sizeof *o->slack);
    o->rate = oracle_new(o->plane_count, sizeof *o->rate);
    for (uint32_t i = 0; i < o->plane_count; i++)
        mpz_inits(o->slack[i], o->rate[i], NULL);
    return o;
}

void oracle_place_free(oracle_place *o) {
    for (uint32_t i = 0; i < o->plane_count; i++) {
        oracle_vec_clear(o->plane[i].normal);
        mpz_clears(o->plane[i].offset, o->slack[i], o->rate[i], NULL);
        free(o->plane[i].p);
        free(o->plane[i].q);
    }
    for (uint32_t i = 0; i < o->p->count; i++)
        oracle_vec_clear(o->a[i]);
    for (uint32_t j = 0; j < o->q->count; j++)
        oracle_vec_clear(o->b[j]);
    oracle_vec *vectors[4] = {&o->first_p, &o->first_q, &o->t, &o->d};
    for (int i = 0; i < 4; i++)
        oracle_vec_clear(*vectors[i]);
    oracle_quat_clear(o->quat);
    mpz_clears(o->square, o->grain, NULL);
    void *blocks[9] = {o->a, o->b, o->near_a, o->near_b, o->only_p, o->only_q, o->plane, o->slack, o->rate};
    for (int i = 0; i < 9; i++)
        free(blocks[i]);
    free(o);
}
