/* SPDX-License-Identifier: MIT */
/*
 * See identity.h. A plane of the sum has a normal of one body and holds a vertex of the other added to a plane of that
 * body; or it holds an edge of each, two lines. A wall of a polygon holds one line. So what two planes have in common
 * at every rotation is a line of one body with a vertex of the other, and which it is tells their definitions.
 *
 *     by normal n of body B, through p + q           holds p' + q where n·p' = n·p, p' of B
 *     by edges d of B, e of the other, through p + q  holds p' + q' where p' is on p + td, q' on q + se
 *     wall along d of B, through p + q               holds p' + q where p' is on p + td
 */
#include "solid/space/identity.h"

#include <math.h>

#include "solid/space/exact.h"
#include "solid/space/rest.h"

/* A vertex of the sum: of[b] is a point of body b at rest. */
struct sum_vertex {
    uint32_t of[2];
};

enum plane_kind { UNKNOWN, BY_NORMAL, BY_EDGES, WALL };

struct sum_plane {
    enum plane_kind kind;
    int body;              /* of the normal, or of the wall's direction */
    uint32_t direction[2]; /* the normal or direction first; by edges: per body */
    struct sum_vertex through;
};

/* A line of one body, through a point of it, with a vertex of the other. */
struct sum_line {
    int body;
    uint32_t direction;
    struct sum_vertex through;
};

/* --- at rest --- */

static const pir_rest_item *point_at(const pir_space *space, uint32_t item) {
    return &space->rest->points.item[item];
}

static const pir_rest_item *direction_at(const pir_space *space, uint32_t item) {
    return &space->rest->directions.item[item];
}

static bool same_point(const pir_space *space, uint32_t a, uint32_t b) {
    return point_at(space, a)->same == point_at(space, b)->same;
}

/* b − a exactly, times a positive number, into three numbers of scratch. */
static void exact_way(pir_space *space, mpz_t *ret, uint32_t a, uint32_t b) {
    mpz_t *x = space->rest->number + point_at(space, a)->exact, *y = space->rest->number + point_at(space, b)->exact;
    for (int k = 0; k < 3; k++) {
        mpz_mul(ret[k], y[k], x[3]);
        mpz_submul(ret[k], x[k], y[3]);
    }
}

/* Doubles at rest are within 2^-49, of points no longer than √3: what is farther from 0 than this is not 0. */
#define REST_ZERO 0x1p-44

/* Where an answer about a direction and two points of one body is kept, or about two directions; NULL where their
 * numbers are too great for a key. */
static struct pir_rest_known *known_at(const pir_space *space, unsigned question, uint32_t direction, uint32_t a,
                                       uint32_t b, uint64_t *ret_key) {
    if ((direction | a | b) >> 20)
        return NULL;
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    *ret_key = (uint64_t)question << 60 | (uint64_t)direction << 40 | (uint64_t)low << 20 | high;
    return &space->rest->known[(*ret_key * 0x9e3779b97f4a7c15u) >> 40 & (PIR_REST_KNOWN - 1)];
}

/* Questions, from 1 on: two bodies have their own numbers for `same`, so that each has its own questions. */
enum { LEVEL = 1, ALONG = 3, ACROSS = 5 };

/* Whether the way from a to b is at right angles to a direction of that body. */
static bool level(pir_space *space, uint32_t direction, uint32_t a, uint32_t b) {
    if (same_point(space, a, b))
        return true;
    const double *n = direction_at(space, direction)->x, *x = point_at(space, a)->x, *y = point_at(space, b)->x;
    if (fabs(n[0] * (y[0] - x[0]) + n[1] * (y[1] - x[1]) + n[2] * (y[2] - x[2])) > REST_ZERO)
        return false;
    uint64_t key = 0;
    const pir_rest_item *of = direction_at(space, direction);
    struct pir_rest_known *known =
        known_at(space, LEVEL + of->body, of->same, point_at(space, a)->same, point_at(space, b)->same, &key);
    if (known && known->key == key)
        return known->holds;
    mpz_t *t = space->t;
    exact_way(space, t, a, b);
    pir_numbers_dot(t[3], space->rest->number + of->exact, t, 3);
    const bool holds = mpz_sgn(t[3]) == 0;
    if (known)
        *known = (struct pir_rest_known){key, holds};
    return holds;
}

/* Whether the way from a to b leads along a direction, either way. */
static bool along(pir_space *space, uint32_t direction, uint32_t a, uint32_t b) {
    if (same_point(space, a, b))
        return true;
    const double *d = direction_at(space, direction)->x, *x = point_at(space, a)->x, *y = point_at(space, b)->x;
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        if (fabs(d[i] * (y[j] - x[j]) - d[j] * (y[i] - x[i])) > REST_ZERO)
            return false;
    }
    uint64_t key = 0;
    const pir_rest_item *of = direction_at(space, direction);
    struct pir_rest_known *known =
        known_at(space, ALONG + of->body, of->same, point_at(space, a)->same, point_at(space, b)->same, &key);
    if (known && known->key == key)
        return known->holds;
    mpz_t *t = space->t;
    exact_way(space, t, a, b);
    pir_numbers_cross(t + 3, space->rest->number + of->exact, t);
    const bool holds = mpz_sgn(t[3]) == 0 && mpz_sgn(t[4]) == 0 && mpz_sgn(t[5]) == 0;
    if (known)
        *known = (struct pir_rest_known){key, holds};
    return holds;
}

static bool parallel(const pir_space *space, uint32_t a, uint32_t b) {
    return direction_at(space, a)->same == direction_at(space, b)->same;
}

/* Whether two directions of a body are at right angles. */
static bool across(pir_space *space, uint32_t a, uint32_t b) {
    const double *x = direction_at(space, a)->x, *y = direction_at(space, b)->x;
    if (fabs(x[0] * y[0] + x[1] * y[1] + x[2] * y[2]) > REST_ZERO)
        return false;
    uint64_t key = 0;
    const pir_rest_item *of = direction_at(space, a), *with = direction_at(space, b);
    struct pir_rest_known *known = known_at(space, ACROSS + of->body, 0, of->same, with->same, &key);
    if (known && known->key == key)
        return known->holds;
    pir_numbers_dot(space->t[0], space->rest->number + of->exact, space->rest->number + with->exact, 3);
    const bool holds = mpz_sgn(space->t[0]) == 0;
    if (known)
        *known = (struct pir_rest_known){key, holds};
    return holds;
}

/* --- definitions --- */

/* The vertex that two points add up to, one of each body; false for others. */
static bool pair_of(const pir_space *space, uint32_t a, uint32_t b, struct sum_vertex *ret) {
    const pir_space_point *p = &space->point[a], *q = &space->point[b];
    if (p->kind != PIR_POINT_TURNED || q->kind != PIR_POINT_TURNED)
        return false;
    const uint32_t of_a = point_at(space, p->of[0])->body;
    if (point_at(space, q->of[0])->body == of_a)
        return false;
    ret->of[of_a] = p->of[0];
    ret->of[1 - of_a] = q->of[0];
    return true;
}

static bool sum_of(const pir_space *space, uint32_t point, struct sum_vertex *ret) {
    const pir_space_point *p = &space->point[point];
    return p->kind == PIR_POINT_SUM && pair_of(space, p->of[0], p->of[1], ret);
}

static struct sum_plane plane_at(const pir_space *space, uint32_t plane) {
    const pir_space_plane *f = &space->plane[plane];
    struct sum_plane ret = {.kind = UNKNOWN};
    const uint32_t first = space->direction[f->direction[0]].rest;
    if (first == PIR_SPACE_NONE)
        return ret;
    ret.body = (int)direction_at(space, first)->body;
    if (f->point[1] == PIR_SPACE_NONE) {
        ret.direction[0] = first;
        ret.kind = f->direction[1] != PIR_SPACE_NONE && sum_of(space, f->point[0], &ret.through) ? WALL : UNKNOWN;
        return ret;
    }
    if (!pair_of(space, f->point[0], f->point[1], &ret.through))
        return ret;
    if (f->direction[1] == PIR_SPACE_NONE) {
        ret.direction[0] = first;
        ret.kind = BY_NORMAL;
        return ret;
    }
    const uint32_t second = space->direction[f->direction[1]].rest;
    if (second == PIR_SPACE_NONE || (int)direction_at(space, second)->body == ret.body)
        return ret;
    ret.direction[ret.body] = first;
    ret.direction[1 - ret.body] = second;
    ret.kind = BY_EDGES;
    return ret;
}

/* --- incidences --- */

static bool holds_pair(pir_space *space, const struct sum_plane *f, struct sum_vertex v) {
    const int b = f->body;
    switch (f->kind) {
    case BY_NORMAL:
        return same_point(space, v.of[1 - b], f->through.of[1 - b]) &&
               level(space, f->direction[0], v.of[b], f->through.of[b]);
    case WALL:
        return same_point(space, v.of[1 - b], f->through.of[1 - b]) &&
               along(space, f->direction[0], v.of[b], f->through.of[b]);
    case BY_EDGES:
        return along(space, f->direction[0], v.of[0], f->through.of[0]) &&
               along(space, f->direction[1], v.of[1], f->through.of[1]);
    case UNKNOWN:
        break;
    }
    return false;
}

/* Whether a plane has the direction of a line in it. */
static bool has_direction(pir_space *space, const struct sum_plane *f, const struct sum_line *line) {
    if (f->kind == BY_NORMAL)
        return f->body == line->body && across(space, f->direction[0], line->direction);
    if (f->kind == WALL)
        return f->body == line->body && parallel(space, f->direction[0], line->direction);
    return f->kind == BY_EDGES && parallel(space, f->direction[line->body], line->direction);
}

static bool holds_line(pir_space *space, const struct sum_plane *f, const struct sum_line *line) {
    return has_direction(space, f, line) && holds_pair(space, f, line->through);
}

/* A vertex of two edges' lines of one body, where that is an end of one of them. */
static bool common_point(pir_space *space, const uint32_t edge[2], const uint32_t at[2], uint32_t *ret) {
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 3; i++) {
            const uint32_t point = i < 2 ? direction_at(space, edge[k])->end[i] : at[k];
            if (point != PIR_SPACE_NONE && along(space, edge[1 - k], at[1 - k], point) &&
                along(space, edge[k], at[k], point)) {
                *ret = point;
                return true;
            }
        }
    return false;
}

/* The line along an edge of f's that another plane holds too. */
static bool line_by_edge(pir_space *space, const struct sum_plane *f, const struct sum_plane *g, struct sum_line *ret) {
    for (int b = 0; b < 2; b++) {
        *ret = (struct sum_line){b, f->direction[b], f->through};
        if (!has_direction(space, g, ret))
            continue;
        if (g->kind != BY_EDGES)
            ret->through.of[1 - b] = g->through.of[1 - b];
        else if (!common_point(space, (const uint32_t[]){f->direction[1 - b], g->direction[1 - b]},
                               (const uint32_t[]){f->through.of[1 - b], g->through.of[1 - b]}, &ret->through.of[1 - b]))
            continue;
        if (holds_pair(space, f, ret->through) && holds_pair(space, g, ret->through))
            return true;
    }
    return false;
}

/* The line that two planes have in common at every rotation, as far as it is along an edge or a wall. */
static bool common_line(pir_space *space, const struct sum_plane *f, const struct sum_plane *g, struct sum_line *ret) {
    if (f->kind == UNKNOWN || g->kind == UNKNOWN)
        return false;
    for (int k = 0; k < 2; k++) {
        const struct sum_plane *wall = k == 0 ? f : g, *other = k == 0 ? g : f;
        if (wall->kind != WALL)
            continue;
        *ret = (struct sum_line){wall->body, wall->direction[0], wall->through};
        return holds_line(space, other, ret);
    }
    if (f->kind == BY_EDGES)
        return line_by_edge(space, f, g, ret);
    return g->kind == BY_EDGES && line_by_edge(space, g, f, ret);
}

/* n·p of a plane by normal at rest, into t[3], with the normal times its weight in t[0..2]. */
static void rest_plane(pir_space *space, mpz_t *t, const struct sum_plane *f) {
    mpz_t *n = space->rest->number + direction_at(space, f->direction[0])->exact;
    mpz_t *p = space->rest->number + point_at(space, f->through.of[f->body])->exact;
    for (int k = 0; k < 3; k++)
        mpz_mul(t[k], n[k], p[3]);
    pir_numbers_dot(t[3], n, p, 3);
}

/* Whether three planes by normals of one body, with one vertex of the other, have a line in common: all determinants of
 * three of their four columns are 0. */
static bool share_line(pir_space *space, const struct sum_plane *const f[3]) {
    for (int i = 0; i < 3; i++)
        if (f[i]->kind != BY_NORMAL || f[i]->body != f[0]->body ||
            !same_point(space, f[i]->through.of[1 - f[0]->body], f[0]->through.of[1 - f[0]->body]))
            return false;
    const double *a = direction_at(space, f[0]->direction[0])->x, *b = direction_at(space, f[1]->direction[0])->x;
    const double *c = direction_at(space, f[2]->direction[0])->x;
    if (fabs(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
             a[2] * (b[0] * c[1] - b[1] * c[0])) > REST_ZERO)
        return false;
    mpz_t *t = space->t;
    for (int i = 0; i < 3; i++)
        rest_plane(space, t + 4 * i, f[i]);
    for (int left = 0; left < 4; left++) {
        // the columns but one
        int column[3];
        for (int k = 0, at = 0; k < 4; k++)
            if (k != left)
                column[at++] = k;
        mpz_set_ui(t[12], 0);
        for (int k = 0; k < 3; k++) {
            const int i = column[(k + 1) % 3], j = column[(k + 2) % 3];
            mpz_mul(t[13], t[4 + i], t[8 + j]);
            mpz_submul(t[13], t[4 + j], t[8 + i]);
            mpz_addmul(t[12], t[13], t[column[k]]);
        }
        if (mpz_sgn(t[12]) != 0)
            return false;
    }
    return true;
}

static bool same_plane(pir_space *space, const struct sum_plane *f, const struct sum_plane *g) {
    if (f->kind == UNKNOWN || f->kind == WALL || f->kind != g->kind)
        return false;
    if (f->kind == BY_EDGES)
        return parallel(space, f->direction[0], g->direction[0]) && parallel(space, f->direction[1], g->direction[1]) &&
               holds_pair(space, f, g->through);
    return f->body == g->body && parallel(space, f->direction[0], g->direction[0]) && holds_pair(space, f, g->through);
}

/* Whether a line that h holds, along an edge of its own or its wall, is where f and g meet. */
static bool own_line_is_meet(pir_space *space, const struct sum_plane *h, const struct sum_plane *f,
                             const struct sum_plane *g) {
    if (h->kind == WALL) {
        const struct sum_line line = {h->body, h->direction[0], h->through};
        return holds_line(space, f, &line) && holds_line(space, g, &line);
    }
    for (int b = 0; b < 2 && h->kind == BY_EDGES; b++) {
        struct sum_line line = {b, h->direction[b], h->through};
        line.through.of[1 - b] = f->through.of[1 - b];
        if (holds_pair(space, h, line.through) && holds_line(space, f, &line) && holds_line(space, g, &line))
            return true;
    }
    return false;
}

/* Whether h holds the line where f and g meet. */
static bool holds_meet(pir_space *space, const struct sum_plane *h, const struct sum_plane *f,
                       const struct sum_plane *g) {
    struct sum_line line;
    if (same_plane(space, h, f) || same_plane(space, h, g) ||
        share_line(space, (const struct sum_plane *const[]){f, g, h}))
        return true;
    if (f->kind != UNKNOWN && g->kind != UNKNOWN && own_line_is_meet(space, h, f, g))
        return true;
    return common_line(space, f, g, &line) && holds_line(space, h, &line);
}

/* Whether three planes and h hold a vertex of the sum: one of h's own, or an end of what the others hold. */
static bool share_vertex(pir_space *space, const struct sum_plane *h, const struct sum_plane f[3]) {
    const struct sum_plane *all[4] = {h, &f[0], &f[1], &f[2]};
    uint32_t point[2][12];
    uint32_t count[2] = {0, 0};
    for (int i = 0; i < 4; i++)
        for (int b = 0; b < 2 && all[i]->kind != UNKNOWN; b++) {
            point[b][count[b]++] = all[i]->through.of[b];
            const bool edge = all[i]->kind == BY_EDGES || (all[i]->kind == WALL && all[i]->body == b);
            const pir_rest_item *d = direction_at(space, all[i]->direction[all[i]->kind == BY_EDGES ? b : 0]);
            for (int k = 0; k < 2 && edge; k++)
                if (d->end[k] != PIR_SPACE_NONE)
                    point[b][count[b]++] = d->end[k];
        }
    for (uint32_t i = 0; i < count[0]; i++)
        for (uint32_t j = 0; j < count[1]; j++) {
            const struct sum_vertex v = {{point[0][i], point[1][j]}};
            if (holds_pair(space, h, v) && holds_pair(space, &f[0], v) && holds_pair(space, &f[1], v) &&
                holds_pair(space, &f[2], v))
                return true;
        }
    return false;
}

static bool holds(pir_space *space, const struct sum_plane *h, uint32_t point) {
    const pir_space_point *p = &space->point[point];
    struct sum_vertex v;
    if (h->kind == UNKNOWN)
        return false;
    if (p->kind == PIR_POINT_SUM)
        return sum_of(space, point, &v) && holds_pair(space, h, v);
    if (p->kind != PIR_POINT_MEET)
        return false;
    struct sum_plane f[3];
    for (int k = 0; k < 3; k++)
        f[k] = plane_at(space, p->of[k]);
    for (int k = 0; k < 3; k++)
        if (holds_meet(space, h, &f[k], &f[(k + 1) % 3]))
            return true;
    return share_vertex(space, h, f);
}

/* --- all --- */

bool pir_identity_holds(pir_space *space, uint32_t plane, uint32_t point) {
    if (!space->rest)
        return false;
    const struct sum_plane f = plane_at(space, plane);
    return holds(space, &f, point);
}

bool pir_identity_of_points(pir_space *space, uint32_t a, uint32_t b) {
    struct sum_vertex v, w;
    if (!space->rest)
        return false;
    if (space->point[a].kind != PIR_POINT_MEET) {
        const uint32_t swap = a;
        a = b;
        b = swap;
    }
    if (space->point[a].kind != PIR_POINT_MEET)
        return sum_of(space, a, &v) && sum_of(space, b, &w) && same_point(space, v.of[0], w.of[0]) &&
               same_point(space, v.of[1], w.of[1]);
    for (int k = 0; k < 3; k++) {
        const uint32_t plane = space->point[a].of[k];
        const pir_space_point *q = &space->point[b];
        if (q->kind == PIR_POINT_MEET && (q->of[0] == plane || q->of[1] == plane || q->of[2] == plane))
            continue;
        if (!pir_identity_holds(space, plane, b))
            return false;
    }
    return true;
}

bool pir_identity_of_planes(pir_space *space, uint32_t f, uint32_t g) {
    if (!space->rest)
        return false;
    const struct sum_plane a = plane_at(space, f), b = plane_at(space, g);
    return same_plane(space, &a, &b);
}

bool pir_identity_of_lines(pir_space *space, const uint32_t f[2], const uint32_t g[2]) {
    if (!space->rest)
        return false;
    const struct sum_plane a[2] = {plane_at(space, f[0]), plane_at(space, f[1])};
    for (int k = 0; k < 2; k++) {
        const struct sum_plane h = plane_at(space, g[k]);
        if (g[k] != f[0] && g[k] != f[1] && (h.kind == UNKNOWN || !holds_meet(space, &h, &a[0], &a[1])))
            return false;
    }
    return true;
}

bool pir_identity_of_way(pir_space *space, uint32_t direction, uint32_t a, uint32_t b) {
    return along(space, space->direction[direction].rest, space->point[a].of[0], space->point[b].of[0]);
}
