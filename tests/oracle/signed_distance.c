/* SPDX-License-Identifier: MIT */
/*
 * See signed_distance.h.
 *
 * A candidate is a direction of which the gap, or two features of which the distance, may be the answer. At poses that
 * are settled, most are ruled out by doubles: theirs is worse than the best by more than the tolerance SIEVE, or the
 * foot is off the feature by as much. Rounding of doubles, at sizes up to 100, and motions of 2^-50 are below 1e-6 of
 * that. Directions of edges that are parallel to 1e-3 stay.
 */
#include "oracle/signed_distance.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define BITS 320

#define SIEVE 1e-6

typedef mpf_t vec[3];

struct body {
    uint32_t vertices, edges, triangles, facets;
    vec *own, *at; /* in body coordinates, in the world */
    uint32_t (*edge)[2], (*triangle)[3];
    uint32_t *facet; /* its first triangle */
};

enum kind { FACET_P, FACET_Q, ACROSS, VERTICES, ON_EDGE_P, ON_EDGE_Q, OVER_P, OVER_Q, CROSSING };

/* A candidate, of features i and j: of P's body first, of ON_EDGE and OVER the edge or triangle second. */
struct item {
    enum kind kind;
    uint32_t i, j;
};

struct items {
    struct item *item;
    uint32_t count;
};

struct oracle_signed {
    struct body p, q;
    struct items all, near; /* `near` where poses are settled */
    pir_pose settled[2];
    bool is_settled;
    mpf_t m[3][3];
    mpf_t quat[4], turn[4], product[4];
    vec e, d, n, r, s;
    mpf_t a, b, c, f, g, best, low, high;
    mpf_t x, y; /* of dot and cross alone */
};

void oracle_signed_init(mpf_t x) {
    mpf_init2(x, BITS);
}

/* --- vectors --- */

static void init_vec(vec v) {
    for (int k = 0; k < 3; k++)
        oracle_signed_init(v[k]);
}

static void clear_vec(vec v) {
    for (int k = 0; k < 3; k++)
        mpf_clear(v[k]);
}

static void dot(oracle_signed *o, mpf_t r, vec a, vec b) {
    mpf_mul(o->x, a[0], b[0]);
    for (int k = 1; k < 3; k++) {
        mpf_mul(o->y, a[k], b[k]);
        mpf_add(o->x, o->x, o->y);
    }
    mpf_set(r, o->x);
}

static void subtract(vec r, vec a, vec b) {
    for (int k = 0; k < 3; k++)
        mpf_sub(r[k], a[k], b[k]);
}

/* r is neither a nor b. */
static void cross(oracle_signed *o, vec r, vec a, vec b) {
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpf_mul(o->x, a[i], b[j]);
        mpf_mul(o->y, a[j], b[i]);
        mpf_sub(r[k], o->x, o->y);
    }
}

/* r = a + s·b. */
static void along(oracle_signed *o, vec r, vec a, mpf_t s, vec b) {
    for (int k = 0; k < 3; k++) {
        mpf_mul(o->x, s, b[k]);
        mpf_add(r[k], a[k], o->x);
    }
}

/* Whether a number is 0 but for rounding. */
static bool is_nothing(oracle_signed *o, mpf_t x) {
    mpf_set_ui(o->x, 1);
    mpf_div_2exp(o->x, o->x, 220);
    mpf_abs(o->y, x);
    return mpf_cmp(o->y, o->x) < 0;
}

/* --- bodies --- */

static void init_body(struct body *body, const pir_polytope *p) {
    body->vertices = pir_polytope_vertex_count(p);
    body->edges = pir_polytope_edge_count(p);
    body->facets = pir_polytope_facet_count(p);
    body->own = malloc(sizeof *body->own * body->vertices);
    body->at = malloc(sizeof *body->at * body->vertices);
    for (uint32_t v = 0; v < body->vertices; v++) {
        const pir_vec3 c = pir_polytope_vertex(p, v);
        const double at[3] = {c.x, c.y, c.z};
        init_vec(body->own[v]);
        init_vec(body->at[v]);
        for (int k = 0; k < 3; k++)
            mpf_set_d(body->own[v][k], at[k]);
    }
    body->edge = malloc(sizeof *body->edge * (body->edges + 1));
    for (uint32_t e = 0; e < body->edges; e++)
        pir_polytope_edge(p, e, body->edge[e]);
    uint32_t room = 0;
    for (uint32_t f = 0; f < body->facets; f++)
        room += pir_polytope_facet_size(p, f);
    body->triangle = malloc(sizeof *body->triangle * (room + 1));
    body->facet = malloc(sizeof *body->facet * (body->facets + 1));
    body->triangles = 0;
    uint32_t *corner = malloc(sizeof *corner * (room + 1));
    for (uint32_t f = 0; f < body->facets; f++) {
        body->facet[f] = body->triangles;
        pir_polytope_facet(p, f, corner);
        for (uint32_t i = 1; i + 1 < pir_polytope_facet_size(p, f); i++) {
            uint32_t *t = body->triangle[body->triangles++];
            t[0] = corner[0];
            t[1] = corner[i];
            t[2] = corner[i + 1];
        }
    }
    free(corner);
}

static void clear_body(struct body *body) {
    for (uint32_t v = 0; v < body->vertices; v++) {
        clear_vec(body->own[v]);
        clear_vec(body->at[v]);
    }
    free(body->own);
    free(body->at);
    free(body->edge);
    free(body->triangle);
    free(body->facet);
}

static void add_items(struct items *items, enum kind kind, uint32_t i_count, uint32_t j_count) {
    for (uint32_t i = 0; i < i_count; i++)
        for (uint32_t j = 0; j < j_count; j++)
            items->item[items->count++] = (struct item){kind, i, j};
}

static void init_items(oracle_signed *o) {
    const struct body *p = &o->p, *q = &o->q;
    const size_t features =
        2 + p->vertices + p->edges + p->triangles + p->facets + q->vertices + q->edges + q->triangles + q->facets;
    o->all = (struct items){malloc(sizeof *o->all.item * features * features), 0};
    add_items(&o->all, FACET_P, p->facets, 1);
    add_items(&o->all, FACET_Q, q->facets, 1);
    add_items(&o->all, ACROSS, p->edges, q->edges);
    add_items(&o->all, VERTICES, p->vertices, q->vertices);
    add_items(&o->all, ON_EDGE_P, q->vertices, p->edges);
    add_items(&o->all, ON_EDGE_Q, p->vertices, q->edges);
    add_items(&o->all, OVER_P, q->vertices, p->triangles);
    add_items(&o->all, OVER_Q, p->vertices, q->triangles);
    add_items(&o->all, CROSSING, p->edges, q->edges);
    o->near = (struct items){malloc(sizeof *o->all.item * (o->all.count + 1)), 0};
    o->is_settled = false;
}

#define NUMBERS(o)                                                                                                     \
    { o->a, o->b, o->c, o->f, o->g, o->best, o->low, o->high, o->x, o->y }

oracle_signed *oracle_signed_make(const pir_polytope *p, const pir_polytope *q) {
    oracle_signed *o = malloc(sizeof *o);
    init_body(&o->p, p);
    init_body(&o->q, q);
    init_items(o);
    for (int i = 0; i < 3; i++)
        init_vec(o->m[i]);
    for (int k = 0; k < 4; k++) {
        oracle_signed_init(o->quat[k]);
        oracle_signed_init(o->turn[k]);
        oracle_signed_init(o->product[k]);
    }
    vec *vectors[] = {&o->e, &o->d, &o->n, &o->r, &o->s};
    for (int i = 0; i < 5; i++)
        init_vec(*vectors[i]);
    mpf_ptr numbers[] = NUMBERS(o);
    for (int i = 0; i < 10; i++)
        oracle_signed_init(numbers[i]);
    return o;
}

void oracle_signed_free(oracle_signed *o) {
    clear_body(&o->p);
    clear_body(&o->q);
    free(o->all.item);
    free(o->near.item);
    for (int i = 0; i < 3; i++)
        clear_vec(o->m[i]);
    for (int k = 0; k < 4; k++) {
        mpf_clear(o->quat[k]);
        mpf_clear(o->turn[k]);
        mpf_clear(o->product[k]);
    }
    vec *vectors[] = {&o->e, &o->d, &o->n, &o->r, &o->s};
    for (int i = 0; i < 5; i++)
        clear_vec(*vectors[i]);
    mpf_ptr numbers[] = NUMBERS(o);
    for (int i = 0; i < 10; i++)
        mpf_clear(numbers[i]);
    free(o);
}

/* --- poses --- */

/* product = turn · quat; components x, y, z, w. */
static void multiply(oracle_signed *o) {
    static const int factor[4][4] = {{3, 2, 1, 0}, {2, 3, 0, 1}, {1, 0, 3, 2}, {0, 1, 2, 3}};
    static const int sign[4][4] = {{1, 1, -1, 1}, {-1, 1, 1, 1}, {1, -1, 1, 1}, {-1, -1, -1, 1}};
    // component i is the sum over k of sign · turn[k] · quat[factor]
    for (int i = 0; i < 4; i++) {
        mpf_set_ui(o->product[i], 0);
        for (int k = 0; k < 4; k++) {
            mpf_mul(o->x, o->turn[k], o->quat[factor[i][k]]);
            if (sign[i][k] > 0)
                mpf_add(o->product[i], o->product[i], o->x);
            else
                mpf_sub(o->product[i], o->product[i], o->x);
        }
    }
}

/* The rotation matrix of the product. */
static void set_matrix(oracle_signed *o) {
    mpf_t *q = o->product;
    mpf_set_ui(o->a, 0);
    for (int k = 0; k < 4; k++) {
        mpf_mul(o->x, q[k], q[k]);
        mpf_add(o->a, o->a, o->x);
    }
    mpf_ui_div(o->a, 2, o->a);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            // 2 (q_i q_j ∓ w q_k) / |q|², and on the diagonal 2 (q_i² + w²) / |q|² − 1
            const int k = 3 - i - j;
            mpf_mul(o->b, q[i], q[j]);
            mpf_mul(o->c, q[3], i == j ? q[3] : q[k]);
            if (i == j || (i + 1) % 3 != j)
                mpf_add(o->b, o->b, o->c);
            else
                mpf_sub(o->b, o->b, o->c);
            mpf_mul(o->m[i][j], o->b, o->a);
            if (i == j)
                mpf_sub_ui(o->m[i][j], o->m[i][j], 1);
        }
}

static void place(oracle_signed *o, struct body *body, const pir_pose *pose, const double motion[6], int exponent) {
    const double quat[4] = {pose->rotation.x, pose->rotation.y, pose->rotation.z, pose->rotation.w};
    const double moved[3] = {pose->translation.x, pose->translation.y, pose->translation.z};
    for (int k = 0; k < 4; k++) {
        mpf_set_d(o->quat[k], quat[k]);
        mpf_set_d(o->turn[k], k < 3 ? motion[3 + k] : 1);
        if (k < 3)
            mpf_div_2exp(o->turn[k], o->turn[k], (mp_bitcnt_t)(1 - exponent));
    }
    multiply(o);
    set_matrix(o);
    for (uint32_t v = 0; v < body->vertices; v++)
        for (int k = 0; k < 3; k++) {
            dot(o, body->at[v][k], o->m[k], body->own[v]);
            mpf_set_d(o->a, moved[k]);
            mpf_add(body->at[v][k], body->at[v][k], o->a);
            mpf_set_d(o->a, motion[k]);
            mpf_div_2exp(o->a, o->a, (mp_bitcnt_t)-exponent);
            mpf_add(body->at[v][k], body->at[v][k], o->a);
        }
}

/* --- the greatest gap along a direction: the depth, where all are negative --- */

/* Least and greatest n·v of a body. */
static void extent(oracle_signed *o, struct body *body, mpf_t low, mpf_t high) {
    for (uint32_t v = 0; v < body->vertices; v++) {
        dot(o, o->a, o->n, body->at[v]);
        if (v == 0 || mpf_cmp(o->a, low) < 0)
            mpf_set(low, o->a);
        if (v == 0 || mpf_cmp(o->a, high) > 0)
            mpf_set(high, o->a);
    }
}

/* Offers the gaps along n and −n, n of any length but 0. */
static void offer_direction(oracle_signed *o, bool *any) {
    dot(o, o->f, o->n, o->n);
    if (is_nothing(o, o->f))
        return;
    mpf_sqrt(o->f, o->f);
    extent(o, &o->p, o->low, o->high);
    extent(o, &o->q, o->b, o->c);
    mpf_sub(o->low, o->low, o->c);
    mpf_sub(o->b, o->b, o->high);
    mpf_div(o->low, o->low, o->f);
    mpf_div(o->b, o->b, o->f);
    if (mpf_cmp(o->b, o->low) > 0)
        mpf_set(o->low, o->b);
    if (!*any || mpf_cmp(o->low, o->best) > 0)
        mpf_set(o->best, o->low);
    *any = true;
}

static void offer_facet(oracle_signed *o, struct body *body, uint32_t f, bool *any) {
    const uint32_t *t = body->triangle[body->facet[f]];
    subtract(o->e, body->at[t[1]], body->at[t[0]]);
    subtract(o->d, body->at[t[2]], body->at[t[0]]);
    cross(o, o->n, o->e, o->d);
    offer_direction(o, any);
}

static void offer_across(oracle_signed *o, const uint32_t i[2], const uint32_t j[2], bool *any) {
    subtract(o->e, o->p.at[i[1]], o->p.at[i[0]]);
    subtract(o->d, o->q.at[j[1]], o->q.at[j[0]]);
    cross(o, o->n, o->e, o->d);
    offer_direction(o, any);
}

/* The greatest gap, in best. False where no two edges span a plane. */
static bool greatest_gap(oracle_signed *o, const struct items *items) {
    bool any = false;
    for (uint32_t k = 0; k < items->count; k++) {
        const struct item *t = &items->item[k];
        if (t->kind == FACET_P)
            offer_facet(o, &o->p, t->i, &any);
        else if (t->kind == FACET_Q)
            offer_facet(o, &o->q, t->i, &any);
        else if (t->kind == ACROSS)
            offer_across(o, o->p.edge[t->i], o->q.edge[t->j], &any);
    }
    return any;
}

/* --- the least distance of two features, squared, in best --- */

/* Offers the length of r. */
static void offer_length(oracle_signed *o, bool *any) {
    dot(o, o->a, o->r, o->r);
    if (!*any || mpf_cmp(o->a, o->best) < 0)
        mpf_set(o->best, o->a);
    *any = true;
}

/* A vertex and the inside of an edge. */
static void offer_foot_on_edge(oracle_signed *o, vec x, vec from, vec to, bool *any) {
    subtract(o->e, to, from);
    subtract(o->r, x, from);
    dot(o, o->b, o->r, o->e);
    dot(o, o->c, o->e, o->e);
    if (mpf_sgn(o->b) <= 0 || mpf_cmp(o->b, o->c) >= 0)
        return;
    mpf_div(o->b, o->b, o->c);
    mpf_neg(o->b, o->b);
    along(o, o->r, o->r, o->b, o->e);
    offer_length(o, any);
}

/* A vertex and a triangle over which it is. */
static void offer_foot_on_triangle(oracle_signed *o, vec x, vec at[3], bool *any) {
    subtract(o->e, at[1], at[0]);
    subtract(o->d, at[2], at[0]);
    cross(o, o->n, o->e, o->d);
    for (int k = 0; k < 3; k++) {
        subtract(o->e, at[(k + 1) % 3], at[k]);
        subtract(o->r, x, at[k]);
        cross(o, o->d, o->e, o->r);
        dot(o, o->b, o->d, o->n);
        // on the side that two triangles of a facet share, it is over both
        if (mpf_sgn(o->b) < 0 && !is_nothing(o, o->b))
            return;
    }
    subtract(o->r, x, at[0]);
    dot(o, o->b, o->r, o->n);
    dot(o, o->c, o->n, o->n);
    mpf_div(o->b, o->b, o->c);
    for (int k = 0; k < 3; k++)
        mpf_mul(o->r[k], o->b, o->n[k]);
    offer_length(o, any);
}

/* The insides of two edges, not parallel. */
static void offer_crossing(oracle_signed *o, const uint32_t i[2], const uint32_t j[2], bool *any) {
    subtract(o->e, o->p.at[i[1]], o->p.at[i[0]]);
    subtract(o->d, o->q.at[j[1]], o->q.at[j[0]]);
    cross(o, o->n, o->e, o->d);
    dot(o, o->c, o->n, o->n);
    if (is_nothing(o, o->c))
        return;
    // r + λ e − μ d is across both: λ = (d × r)·n / n·n, μ = (e × r)·n / n·n
    subtract(o->r, o->p.at[i[0]], o->q.at[j[0]]);
    cross(o, o->s, o->d, o->r);
    dot(o, o->f, o->s, o->n);
    cross(o, o->s, o->e, o->r);
    dot(o, o->g, o->s, o->n);
    if (mpf_sgn(o->f) <= 0 || mpf_cmp(o->f, o->c) >= 0 || mpf_sgn(o->g) <= 0 || mpf_cmp(o->g, o->c) >= 0)
        return;
    dot(o, o->b, o->r, o->n);
    mpf_div(o->b, o->b, o->c);
    for (int k = 0; k < 3; k++)
        mpf_mul(o->r[k], o->b, o->n[k]);
    offer_length(o, any);
}

static void offer_vertex(oracle_signed *o, vec x, const struct body *to, const struct item *item, bool *any) {
    if (item->kind == ON_EDGE_P || item->kind == ON_EDGE_Q) {
        const uint32_t *edge = to->edge[item->j];
        offer_foot_on_edge(o, x, to->at[edge[0]], to->at[edge[1]], any);
        return;
    }
    vec at[3];
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            *at[k][c] = *to->at[to->triangle[item->j][k]][c];
    offer_foot_on_triangle(o, x, at, any);
}

static void least_distance(oracle_signed *o, const struct items *items) {
    bool any = false;
    for (uint32_t k = 0; k < items->count; k++) {
        const struct item *t = &items->item[k];
        if (t->kind == VERTICES) {
            subtract(o->r, o->p.at[t->i], o->q.at[t->j]);
            offer_length(o, &any);
        } else if (t->kind == ON_EDGE_P || t->kind == OVER_P) {
            offer_vertex(o, o->q.at[t->i], &o->p, t, &any);
        } else if (t->kind == ON_EDGE_Q || t->kind == OVER_Q) {
            offer_vertex(o, o->p.at[t->i], &o->q, t, &any);
        } else if (t->kind == CROSSING) {
            offer_crossing(o, o->p.edge[t->i], o->q.edge[t->j], &any);
        }
    }
    mpf_sqrt(o->best, o->best);
}

/* --- candidates, by doubles --- */

typedef struct spot {
    double c[3];
} spot;

static spot less(spot a, spot b) {
    return (spot){{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}};
}

static double times(spot a, spot b) {
    return a.c[0] * b.c[0] + a.c[1] * b.c[1] + a.c[2] * b.c[2];
}

static spot across(spot a, spot b) {
    return (spot){
        {a.c[1] * b.c[2] - a.c[2] * b.c[1], a.c[2] * b.c[0] - a.c[0] * b.c[2], a.c[0] * b.c[1] - a.c[1] * b.c[0]}};
}

static spot spot_of(vec v) {
    return (spot){{mpf_get_d(v[0]), mpf_get_d(v[1]), mpf_get_d(v[2])}};
}

static spot edge_of(const struct body *body, uint32_t e) {
    return less(spot_of(body->at[body->edge[e][1]]), spot_of(body->at[body->edge[e][0]]));
}

static spot normal_of(const struct body *body, uint32_t t) {
    const uint32_t *v = body->triangle[t];
    const spot a = spot_of(body->at[v[0]]);
    return across(less(spot_of(body->at[v[1]]), a), less(spot_of(body->at[v[2]]), a));
}

/* The gap along a direction, whichever way. */
static double gap_along(const oracle_signed *o, spot n) {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int k = 0; k < 2; k++) {
        const struct body *body = k ? &o->q : &o->p;
        for (uint32_t v = 0; v < body->vertices; v++) {
            const double h = times(n, spot_of(body->at[v])) / sqrt(times(n, n));
            low[k] = fmin(low[k], h);
            high[k] = fmax(high[k], h);
        }
    }
    return fmax(low[0] - high[1], low[1] - high[0]);
}

/* Whether a number is from 0 to `most`, or nearly. */
static bool is_within(double x, double most) {
    return x > -SIEVE && x < most + SIEVE;
}

static double distance_to_edge(spot x, const struct body *to, uint32_t e, bool *ret_over) {
    const spot r = less(x, spot_of(to->at[to->edge[e][0]])), d = edge_of(to, e);
    const double b = times(r, d), c = times(d, d);
    *ret_over = is_within(b, c);
    return sqrt(fmax(0, times(r, r) - b * b / c));
}

static double distance_to_triangle(spot x, const struct body *to, uint32_t t, bool *ret_over) {
    const uint32_t *v = to->triangle[t];
    const spot n = normal_of(to, t);
    *ret_over = true;
    for (int k = 0; k < 3; k++) {
        const spot a = spot_of(to->at[v[k]]), b = spot_of(to->at[v[(k + 1) % 3]]);
        *ret_over = *ret_over && times(across(less(b, a), less(x, a)), n) > -SIEVE;
    }
    return fabs(times(less(x, spot_of(to->at[v[0]])), n)) / sqrt(times(n, n));
}

static double distance_across(const oracle_signed *o, uint32_t i, uint32_t j, spot n, bool *ret_over) {
    const spot e = edge_of(&o->p, i), d = edge_of(&o->q, j);
    const spot r = less(spot_of(o->p.at[o->p.edge[i][0]]), spot_of(o->q.at[o->q.edge[j][0]]));
    const double c = times(n, n);
    *ret_over = is_within(times(across(d, r), n), c) && is_within(times(across(e, r), n), c);
    return fabs(times(r, n)) / sqrt(c);
}

static bool is_direction(const struct item *item) {
    return item->kind <= ACROSS;
}

/* A candidate's gap, or minus its distance; HUGE_VAL where it stays whatever that is, −HUGE_VAL where it is none. */
static double value_of(oracle_signed *o, const struct item *t) {
    bool over = true;
    double value = 0;
    spot n = {{1, 0, 0}};
    if (t->kind == ACROSS || t->kind == CROSSING)
        n = across(edge_of(&o->p, t->i), edge_of(&o->q, t->j));
    else if (t->kind == FACET_P || t->kind == FACET_Q)
        n = normal_of(t->kind == FACET_P ? &o->p : &o->q, (t->kind == FACET_P ? &o->p : &o->q)->facet[t->i]);
    if (times(n, n) < SIEVE)
        return HUGE_VAL;
    if (is_direction(t))
        return gap_along(o, n);
    const struct body *to = t->kind == ON_EDGE_P || t->kind == OVER_P ? &o->p : &o->q;
    const spot x = t->kind == CROSSING ? n : spot_of((to == &o->p ? &o->q : &o->p)->at[t->i]);
    if (t->kind == VERTICES) {
        const spot r = less(x, spot_of(o->q.at[t->j]));
        value = sqrt(times(r, r));
    } else if (t->kind == CROSSING) {
        value = distance_across(o, t->i, t->j, n, &over);
    } else {
        value = (t->kind == ON_EDGE_P || t->kind == ON_EDGE_Q ? distance_to_edge : distance_to_triangle)(x, to, t->j,
                                                                                                         &over);
    }
    return over ? -value : -HUGE_VAL;
}

void oracle_signed_settle(oracle_signed *o, const pir_pose *pose_p, const pir_pose *pose_q) {
    static const double still[6];
    place(o, &o->p, pose_p, still, 0);
    place(o, &o->q, pose_q, still, 0);
    double *value = malloc(sizeof *value * (o->all.count + 1)), best[2] = {-HUGE_VAL, -HUGE_VAL};
    for (uint32_t k = 0; k < o->all.count; k++) {
        value[k] = value_of(o, &o->all.item[k]);
        double *most = &best[is_direction(&o->all.item[k])];
        *most = value[k] < HUGE_VAL ? fmax(*most, value[k]) : *most;
    }
    // the gap decides alone between bodies that overlap, the distance between others
    const bool no_gap = best[1] > SIEVE, no_distance = best[1] < -SIEVE && best[1] > -HUGE_VAL;
    o->near.count = 0;
    for (uint32_t k = 0; k < o->all.count; k++) {
        const bool direction = is_direction(&o->all.item[k]);
        if (!(direction ? no_gap : no_distance) && value[k] > best[direction] - SIEVE)
            o->near.item[o->near.count++] = o->all.item[k];
    }
    free(value);
    o->settled[0] = *pose_p;
    o->settled[1] = *pose_q;
    o->is_settled = true;
}

static bool is_settled_at(const oracle_signed *o, const pir_pose *pose_p, const pir_pose *pose_q, int exponent) {
    return o->is_settled && exponent <= -50 && memcmp(&o->settled[0], pose_p, sizeof *pose_p) == 0 &&
           memcmp(&o->settled[1], pose_q, sizeof *pose_q) == 0;
}

void oracle_signed_distance(oracle_signed *o, const pir_pose *pose_p, const pir_pose *pose_q, const double motion[12],
                            int exponent, mpf_t ret_distance) {
    const struct items *items = is_settled_at(o, pose_p, pose_q, exponent) ? &o->near : &o->all;
    place(o, &o->p, pose_p, motion, exponent);
    place(o, &o->q, pose_q, motion + 6, exponent);
    // of a flat difference the gaps along n and −n are not both negative but for rounding
    const bool inside = greatest_gap(o, items) && mpf_sgn(o->best) < 0 && !is_nothing(o, o->best);
    if (!inside)
        least_distance(o, items);
    mpf_set(ret_distance, o->best);
}
