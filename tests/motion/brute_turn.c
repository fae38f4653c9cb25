/* SPDX-License-Identifier: MIT */
/* Critical angles by brute force: see brute_turn.h. */
#include "brute_turn.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>

typedef struct vector {
    mpz_t c[3];
} vector;

/* A body in integers: vertices on one scale, normals, edges. */
typedef struct body {
    uint32_t vertices, facets, edges;
    vector *vertex, *normal, *edge;
} body;

typedef struct bodies_turn {
    body body[2];
    vector axis; /* on one scale with κ */
    mpz_t quat[4];
    mpz_t unit; /* κ = 1 on the scale of the axis */
} bodies_turn;

/* --- vectors --- */

static vector *new_vectors(uint32_t count) {
    vector *v = malloc((count + 1) * sizeof *v);
    for (uint32_t i = 0; v && i < count; i++)
        mpz_inits(v[i].c[0], v[i].c[1], v[i].c[2], NULL);
    if (!v)
        abort();
    return v;
}

static void free_vectors(vector *v, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        mpz_clears(v[i].c[0], v[i].c[1], v[i].c[2], NULL);
    free(v);
}

static void subtract(vector *to, const vector *a, const vector *b) {
    for (int k = 0; k < 3; k++)
        mpz_sub(to->c[k], a->c[k], b->c[k]);
}

static void cross(vector *to, const vector *a, const vector *b) {
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(to->c[k], a->c[i], b->c[j]);
        mpz_submul(to->c[k], a->c[j], b->c[i]);
    }
}

static void dot(mpz_t to, const vector *a, const vector *b) {
    mpz_mul(to, a->c[0], b->c[0]);
    mpz_addmul(to, a->c[1], b->c[1]);
    mpz_addmul(to, a->c[2], b->c[2]);
}

static bool is_zero(const vector *a) {
    return mpz_sgn(a->c[0]) == 0 && mpz_sgn(a->c[1]) == 0 && mpz_sgn(a->c[2]) == 0;
}

/* --- bodies --- */

/* Doubles times a power of two that makes them integers; returns its exponent. */
static int whole(const double *from, int count, mpz_t *to) {
    int shift = 0;
    mpf_t x;
    mpf_init2(x, 4096);
    for (;; shift += 32) {
        bool done = true;
        for (int k = 0; k < count; k++) {
            mpf_set_d(x, from[k]);
            mpf_mul_2exp(x, x, (mp_bitcnt_t)shift);
            done = done && mpf_integer_p(x);
            mpz_set_f(to[k], x);
        }
        if (done)
            break;
    }
    mpf_clear(x);
    return shift;
}

static void read_vertices(const pir_polytope *p, bool reflected, body *b) {
    mpq_t c[3];
    mpz_t scale;
    mpq_inits(c[0], c[1], c[2], NULL);
    mpz_init_set_ui(scale, 1);
    for (uint32_t v = 0; v < b->vertices; v++) {
        pir_polytope_vertex_exact(p, v, c);
        for (int k = 0; k < 3; k++)
            mpz_lcm(scale, scale, mpq_denref(c[k]));
    }
    for (uint32_t v = 0; v < b->vertices; v++) {
        pir_polytope_vertex_exact(p, v, c);
        for (int k = 0; k < 3; k++) {
            mpz_t *to = &b->vertex[v].c[k];
            mpz_divexact(*to, scale, mpq_denref(c[k]));
            mpz_mul(*to, *to, mpq_numref(c[k]));
            if (reflected)
                mpz_neg(*to, *to);
        }
    }
    mpz_clear(scale);
    mpq_clears(c[0], c[1], c[2], NULL);
}

static void read_body(const pir_polytope *p, bool reflected, body *b) {
    *b =
        (body){pir_polytope_vertex_count(p), pir_polytope_facet_count(p), pir_polytope_edge_count(p), NULL, NULL, NULL};
    b->vertex = new_vectors(b->vertices);
    b->normal = new_vectors(b->facets);
    b->edge = new_vectors(b->edges);
    read_vertices(p, reflected, b);
    vector *side = new_vectors(2);
    for (uint32_t f = 0; f < b->facets; f++) {
        uint32_t corner[BRUTE_VERTICES];
        pir_polytope_facet(p, f, corner);
        subtract(&side[0], &b->vertex[corner[1]], &b->vertex[corner[0]]);
        subtract(&side[1], &b->vertex[corner[2]], &b->vertex[corner[1]]);
        // seen from outside of a reflected body, its corners are clockwise
        cross(&b->normal[f], &side[reflected], &side[!reflected]);
    }
    for (uint32_t e = 0; e < b->edges; e++) {
        uint32_t end[2];
        pir_polytope_edge(p, e, end);
        subtract(&b->edge[e], &b->vertex[end[1]], &b->vertex[end[0]]);
    }
    free_vectors(side, 2);
}

static void clear_body(body *b) {
    free_vectors(b->vertex, b->vertices);
    free_vectors(b->normal, b->facets);
    free_vectors(b->edge, b->edges);
}

/* --- rotations --- */

/* M(q) for q = (axis·den, num·unit)·quat, at κ = num/den. */
static void matrix_at(const bodies_turn *t, const mpz_t num, const mpz_t den, mpz_t m[3][3], mpz_t norm) {
    mpz_t a[4], q[4], x;
    mpz_init(x);
    for (int k = 0; k < 4; k++)
        mpz_inits(a[k], q[k], NULL);
    for (int k = 0; k < 3; k++)
        mpz_mul(a[k], t->axis.c[k], den);
    mpz_mul(a[3], t->unit, num);
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(q[k], a[3], t->quat[k]);
        mpz_addmul(q[k], a[k], t->quat[3]);
        mpz_addmul(q[k], a[i], t->quat[j]);
        mpz_submul(q[k], a[j], t->quat[i]);
    }
    mpz_mul(q[3], a[3], t->quat[3]);
    for (int k = 0; k < 3; k++)
        mpz_submul(q[3], a[k], t->quat[k]);
    mpz_set_ui(norm, 0);
    for (int k = 0; k < 4; k++)
        mpz_addmul(norm, q[k], q[k]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int k = 3 - i - j;
            mpz_mul(x, q[i], q[j]);
            if (i == j)
                mpz_addmul(x, q[3], q[3]);
            else if (j == (i + 1) % 3)
                mpz_submul(x, q[3], q[k]);
            else
                mpz_addmul(x, q[3], q[k]);
            mpz_mul_2exp(m[i][j], x, 1);
            if (i == j)
                mpz_sub(m[i][j], m[i][j], norm);
        }
    for (int k = 0; k < 4; k++)
        mpz_clears(a[k], q[k], NULL);
    mpz_clear(x);
}

static void apply(mpz_t m[3][3], const vector *v, vector *to) {
    for (int i = 0; i < 3; i++) {
        mpz_mul(to->c[i], m[i][0], v->c[0]);
        mpz_addmul(to->c[i], m[i][1], v->c[1]);
        mpz_addmul(to->c[i], m[i][2], v->c[2]);
    }
}

static void init_matrix(mpz_t m[3][3]) {
    for (int i = 0; i < 9; i++)
        mpz_init(m[i / 3][i % 3]);
}

static void clear_matrix(mpz_t m[3][3]) {
    for (int i = 0; i < 9; i++)
        mpz_clear(m[i / 3][i % 3]);
}

/* --- the facets of a sum --- */

static int compare_facets(const void *left, const void *right) {
    const brute_facet *a = left, *b = right;
    if (a->p != b->p)
        return a->p < b->p ? -1 : 1;
    return a->q < b->q ? -1 : a->q > b->q;
}

static uint64_t farthest(const vector *vertex, uint32_t count, const vector *normal) {
    uint64_t face = 0;
    mpz_t most, s;
    mpz_inits(most, s, NULL);
    for (uint32_t v = 0; v < count; v++) {
        dot(s, &vertex[v], normal);
        const int order = face == 0 ? 1 : mpz_cmp(s, most);
        if (order > 0) {
            face = 0;
            mpz_set(most, s);
        }
        if (order >= 0)
            face |= (uint64_t)1 << v;
    }
    mpz_clears(most, s, NULL);
    return face;
}

/* Vertices where they are, and the normal of facet 0 of a polygon. */
typedef struct operand_at {
    const vector *at;
    uint32_t count;
    const vector *flat; /* NULL for a body with an inside */
} operand_at;

/* Whether the sides of two faces together span a plane. */
static bool spans(const vector *p, uint64_t of_p, const vector *q, uint64_t of_q) {
    vector *v = new_vectors(3);
    bool has_first = false, plane = false;
    for (int k = 0; k < 2; k++) {
        const vector *at = k == 0 ? p : q;
        const uint64_t face = k == 0 ? of_p : of_q;
        const int base = __builtin_ctzll(face);
        for (int i = base + 1; i < BRUTE_VERTICES && !plane; i++) {
            if (!(face >> i & 1))
                continue;
            subtract(&v[has_first], &at[i], &at[base]);
            if (has_first) {
                cross(&v[2], &v[0], &v[1]);
                plane = !is_zero(&v[2]);
            }
            has_first = true;
        }
    }
    free_vectors(v, 3);
    return plane;
}

/* Both sides of a polygon have the same vertices: the one whose facet is number 0 has bit 62, the other one bit 63. */
static uint64_t side_of(uint64_t face, const operand_at *of, const vector *normal) {
    if (!of->flat || __builtin_popcountll(face) != (int)of->count)
        return 0;
    mpz_t s;
    mpz_init(s);
    dot(s, of->flat, normal);
    const int sign = mpz_sgn(s);
    mpz_clear(s);
    return (uint64_t)1 << (sign > 0 ? 62 : 63);
}

static void add_facet(brute_facets *facets, const operand_at *p, const operand_at *q, const vector *normal) {
    if (is_zero(normal))
        return;
    const uint64_t of_p = farthest(p->at, p->count, normal), of_q = farthest(q->at, q->count, normal);
    const brute_facet facet = {of_p | side_of(of_p, p, normal), of_q | side_of(of_q, q, normal)};
    for (size_t i = 0; i < facets->count; i++)
        if (facets->at[i].p == facet.p && facets->at[i].q == facet.q)
            return;
    if (!spans(p->at, of_p, q->at, of_q))
        return;
    if (facets->count == facets->room) {
        facets->room = 2 * facets->room + 64;
        facets->at = realloc(facets->at, facets->room * sizeof *facets->at);
    }
    facets->at[facets->count++] = facet;
}

static void facets_at(const bodies_turn *t, const mpz_t num, const mpz_t den, brute_facets *facets) {
    const body *p = &t->body[0], *q = &t->body[1];
    mpz_t m[3][3], norm;
    init_matrix(m);
    mpz_init(norm);
    matrix_at(t, num, den, m, norm);
    vector *turned = new_vectors(p->vertices), *still = new_vectors(q->vertices), *work = new_vectors(2);
    for (uint32_t v = 0; v < p->vertices; v++)
        apply(m, &p->vertex[v], &turned[v]);
    for (uint32_t v = 0; v < q->vertices; v++)
        for (int k = 0; k < 3; k++)
            mpz_mul(still[v].c[k], q->vertex[v].c[k], norm);
    vector *flat = new_vectors(1);
    apply(m, &p->normal[0], flat);
    const operand_at of_p = {turned, p->vertices, p->facets == 2 ? flat : NULL},
                     of_q = {still, q->vertices, q->facets == 2 ? &q->normal[0] : NULL};
    *facets = (brute_facets){NULL, 0, 0};
    for (uint32_t f = 0; f < p->facets; f++) {
        apply(m, &p->normal[f], &work[0]);
        add_facet(facets, &of_p, &of_q, &work[0]);
    }
    for (uint32_t f = 0; f < q->facets; f++)
        add_facet(facets, &of_p, &of_q, &q->normal[f]);
    for (uint32_t e = 0; e < p->edges; e++) {
        apply(m, &p->edge[e], &work[0]);
        for (uint32_t d = 0; d < q->edges; d++) {
            cross(&work[1], &work[0], &q->edge[d]);
            add_facet(facets, &of_p, &of_q, &work[1]);
            for (int k = 0; k < 3; k++)
                mpz_neg(work[1].c[k], work[1].c[k]);
            add_facet(facets, &of_p, &of_q, &work[1]);
        }
    }
    qsort(facets->at, facets->count, sizeof *facets->at, compare_facets);
    free_vectors(flat, 1);
    free_vectors(turned, p->vertices);
    free_vectors(still, q->vertices);
    free_vectors(work, 2);
    mpz_clear(norm);
    clear_matrix(m);
}

/* --- roots --- */

typedef struct roots {
    mpz_t *at;
    size_t count, room;
} roots;

static void add_root(roots *r, const mpz_t num, const mpz_t den) {
    if (r->count == r->room) {
        r->room = 2 * r->room + 256;
        r->at = realloc(r->at, r->room * sizeof *r->at);
    }
    mpz_init(r->at[r->count]);
    mpz_fdiv_q(r->at[r->count++], num, den);
}

/* The real roots of c0·κ² + c1·κ + c2. */
static void add_roots(roots *r, mpz_t c[3]) {
    mpz_t a, b, d;
    mpz_inits(a, b, d, NULL);
    if (mpz_sgn(c[0]) == 0 && mpz_sgn(c[1]) != 0) {
        mpz_neg(a, c[2]);
        mpz_mul_2exp(a, a, BRUTE_BITS);
        add_root(r, a, c[1]);
    } else if (mpz_sgn(c[0]) != 0) {
        mpz_mul(d, c[1], c[1]);
        mpz_mul(a, c[0], c[2]);
        mpz_submul_ui(d, a, 4);
        if (mpz_sgn(d) >= 0) {
            const bool is_double = mpz_sgn(d) == 0;
            mpz_mul_2exp(d, d, 2 * BRUTE_BITS);
            mpz_sqrt(d, d);
            mpz_mul_2exp(b, c[1], BRUTE_BITS);
            mpz_neg(b, b);
            mpz_mul_2exp(a, c[0], 1);
            mpz_add(b, b, d);
            add_root(r, b, a);
            mpz_submul_ui(b, d, 2);
            if (!is_double)
                add_root(r, b, a);
        }
    }
    mpz_clears(a, b, d, NULL);
}

/* s at κ = 0, 1 and −1 gives its coefficients; twice those, to stay whole. */
static void add_quadratic(roots *r, mpz_t m[3][3][3], const vector *of_p, const vector *of_q) {
    vector *x = new_vectors(1);
    mpz_t s[3], c[3];
    for (int n = 0; n < 3; n++) {
        mpz_inits(s[n], c[n], NULL);
        apply(m[n], of_p, x);
        dot(s[n], x, of_q);
    }
    mpz_mul_2exp(c[2], s[0], 1);
    mpz_add(c[0], s[1], s[2]);
    mpz_sub(c[0], c[0], c[2]);
    mpz_sub(c[1], s[1], s[2]);
    add_roots(r, c);
    for (int n = 0; n < 3; n++)
        mpz_clears(s[n], c[n], NULL);
    free_vectors(x, 1);
}

static int falling(const void *a, const void *b) {
    return mpz_cmp(*(const mpz_t *)b, *(const mpz_t *)a);
}

static void find_roots(const bodies_turn *t, roots *r) {
    const body *p = &t->body[0], *q = &t->body[1];
    mpz_t m[3][3][3], num, den, norm;
    mpz_inits(num, norm, NULL);
    mpz_init_set_ui(den, 1);
    *r = (roots){NULL, 0, 0};
    for (int n = 0; n < 3; n++) {
        init_matrix(m[n]);
        mpz_set_si(num, n == 2 ? -1 : n);
        matrix_at(t, num, den, m[n], norm);
    }
    for (uint32_t f = 0; f < p->facets; f++)
        for (uint32_t e = 0; e < q->edges; e++)
            add_quadratic(r, m, &p->normal[f], &q->edge[e]);
    for (uint32_t e = 0; e < p->edges; e++)
        for (uint32_t f = 0; f < q->facets; f++)
            add_quadratic(r, m, &p->edge[e], &q->normal[f]);
    qsort(r->at, r->count, sizeof *r->at, falling);
    // roots that are one are told once
    size_t kept = 0;
    for (size_t i = 0; i < r->count; i++) {
        if (kept > 0)
            mpz_sub(num, r->at[kept - 1], r->at[i]);
        if (kept > 0 && mpz_sizeinbase(num, 2) <= BRUTE_BITS - BRUTE_SAME)
            continue;
        mpz_swap(r->at[kept++], r->at[i]);
    }
    for (size_t i = kept; i < r->count; i++)
        mpz_clear(r->at[i]);
    r->count = kept;
    for (int n = 0; n < 3; n++)
        clear_matrix(m[n]);
    mpz_clears(num, den, norm, NULL);
}

/* --- events --- */

/* A κ between roots i − 1 and i: the middle; before the first and behind the last one it is one away. */
static void sample(const roots *r, size_t i, mpz_t num, mpz_t den) {
    mpz_set_ui(den, 1);
    mpz_mul_2exp(den, den, BRUTE_BITS);
    if (i == 0)
        mpz_add(num, r->at[0], den);
    else if (i == r->count)
        mpz_sub(num, r->at[i - 1], den);
    else
        mpz_add(num, r->at[i - 1], r->at[i]);
    if (i > 0 && i < r->count)
        mpz_mul_2exp(den, den, 1);
    // the middle of two roots far apart needs few bits
    mpz_t bit, rounded;
    mpz_inits(bit, rounded, NULL);
    if (i > 0 && i < r->count) {
        mpz_sub(bit, r->at[i - 1], r->at[i]);
        const mp_bitcnt_t drop = mpz_sizeinbase(bit, 2) > 12 ? mpz_sizeinbase(bit, 2) - 12 : 0;
        mpz_fdiv_q_2exp(num, num, drop);
        if (drop <= BRUTE_BITS + 1)
            mpz_fdiv_q_2exp(den, den, drop);
        else {
            mpz_set_ui(den, 1);
            mpz_mul_2exp(num, num, drop - BRUTE_BITS - 1);
        }
    }
    mpz_clears(bit, rounded, NULL);
}

void brute_turn_make(const pir_polytope *p, const pir_polytope *q, pir_quat start, pir_vec3 axis, bool difference,
                     brute_turn *ret_turn) {
    bodies_turn t;
    roots r;
    mpz_t c[4], num, den;
    mpz_inits(c[0], c[1], c[2], c[3], num, den, t.unit, NULL);
    mpz_inits(t.quat[0], t.quat[1], t.quat[2], t.quat[3], t.axis.c[0], t.axis.c[1], t.axis.c[2], NULL);
    const double quat[4] = {start.x, start.y, start.z, start.w}, u[3] = {axis.x, axis.y, axis.z};
    whole(quat, 4, t.quat);
    mpz_set_ui(t.unit, 1);
    mpz_mul_2exp(t.unit, t.unit, (mp_bitcnt_t)whole(u, 3, t.axis.c));
    read_body(p, difference, &t.body[0]);
    read_body(q, false, &t.body[1]);
    find_roots(&t, &r);
    *ret_turn = (brute_turn){calloc(r.count + 1, sizeof *ret_turn->event), 0};
    brute_facets before = {NULL, 0, 0};
    for (size_t i = 0; r.count > 0 && i <= r.count; i++) {
        brute_facets after;
        sample(&r, i, num, den);
        facets_at(&t, num, den, &after);
        const bool same = after.count == before.count &&
                          (after.count == 0 || memcmp(after.at, before.at, after.count * sizeof *after.at) == 0);
        if (i == 0 || same) {
            free(before.at);
        } else {
            brute_event *event = &ret_turn->event[ret_turn->count++];
            mpz_init_set(event->low, r.at[i - 1]);
            event->before = before;
            event->after = (brute_facets){malloc(after.count * sizeof *after.at), after.count, after.count};
            memcpy(event->after.at, after.at, after.count * sizeof *after.at);
        }
        before = after;
    }
    free(before.at);
    for (size_t i = 0; i < r.count; i++)
        mpz_clear(r.at[i]);
    free(r.at);
    clear_body(&t.body[0]);
    clear_body(&t.body[1]);
    mpz_clears(c[0], c[1], c[2], c[3], num, den, t.unit, NULL);
    mpz_clears(t.quat[0], t.quat[1], t.quat[2], t.quat[3], t.axis.c[0], t.axis.c[1], t.axis.c[2], NULL);
}

void brute_turn_clear(brute_turn *turn) {
    for (size_t i = 0; i < turn->count; i++) {
        mpz_clear(turn->event[i].low);
        free(turn->event[i].before.at);
        free(turn->event[i].after.at);
    }
    free(turn->event);
}
