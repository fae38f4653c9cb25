/* SPDX-License-Identifier: MIT */
/*
 * See opening_body.h. The smallest circle is found point by point: a point outside of the circle so far is on that of
 * all points up to it (Welzl, Smallest enclosing disks, 1991).
 */
#include "plan/opening/opening_body.h"

#include <math.h>
#include <stdlib.h>

#include <pirouette/exact.h>

pir_status pir_opening_body_make(const pir_polytope *piece, pir_opening_body *ret_body) {
    pir_opening_body b = {.vertices = pir_polytope_vertex_count(piece), .edges = pir_polytope_edge_count(piece)};
    b.at = calloc(b.vertices + 1, sizeof *b.at);
    b.exact = calloc(b.vertices + 1, sizeof *b.exact);
    b.edge = calloc(b.edges + 1, sizeof *b.edge);
    b.spot = calloc(2 * (size_t)b.edges + b.vertices + 1, sizeof *b.spot);
    b.range = calloc(b.vertices + 1, sizeof *b.range);
    b.of = calloc(2 * (size_t)b.edges + b.vertices + 1, sizeof *b.of);
    const bool good = b.at && b.exact && b.edge && b.spot && b.range && b.of;
    double most = 0;
    for (uint32_t v = 0; v < b.vertices && good; v++) {
        const pir_vec3 x = pir_polytope_vertex(piece, v);
        const double at[3] = {x.x, x.y, x.z};
        for (int k = 0; k < 3; k++) {
            mpq_init(b.exact[v][k]);
            b.at[v][k] = at[k];
        }
        pir_polytope_vertex_exact(piece, v, b.exact[v]);
        most = fmax(most, fabs(at[0]) + fabs(at[1]) + fabs(at[2]));
    }
    for (uint32_t e = 0; e < b.edges && good; e++)
        pir_polytope_edge(piece, e, b.edge[e]);
    int exponent;
    frexp(most, &exponent);
    b.reach = ldexp(1, exponent + 1); // of sizes that are rounded, so with room
    *ret_body = b;
    if (good)
        return PIR_OK;
    if (!b.exact)
        ret_body->vertices = 0;
    pir_opening_body_finish(ret_body);
    return PIR_ERR_MEMORY;
}

void pir_opening_body_shrink(pir_opening_body *body, const mpq_t point[3], uint32_t halvings) {
    mpq_t way;
    mpq_init(way);
    for (uint32_t v = 0; v < body->vertices; v++)
        for (int k = 0; k < 3; k++) {
            mpq_sub(way, point[k], body->exact[v][k]);
            mpq_div_2exp(way, way, halvings);
            mpq_add(body->exact[v][k], body->exact[v][k], way);
            body->at[v][k] = mpq_get_d(body->exact[v][k]);
        }
    mpq_clear(way);
}

void pir_opening_body_finish(pir_opening_body *body) {
    for (uint32_t v = 0; v < body->vertices; v++)
        for (int k = 0; k < 3 && body->exact; k++)
            if (mpq_denref(body->exact[v][k])->_mp_d)
                mpq_clear(body->exact[v][k]);
    free(body->at);
    free(body->exact);
    free(body->edge);
    free(body->spot);
    free(body->range);
    free(body->of);
    *body = (pir_opening_body){0};
}

/* --- the smallest circle --- */

/* A circle by its middle and two or three of the points. */
struct round {
    double x, y, square;
    uint32_t count, of[3];
    double weight[3];
};

static bool is_outside(const struct round *c, const double p[2]) {
    const double x = p[0] - c->x, y = p[1] - c->y;
    return x * x + y * y > c->square * (1 + 0x1p-40);
}

static struct round round_two(const double (*p)[2], uint32_t i, uint32_t j) {
    const double x = (p[i][0] + p[j][0]) / 2, y = (p[i][1] + p[j][1]) / 2;
    const double dx = p[i][0] - x, dy = p[i][1] - y;
    return (struct round){x, y, dx * dx + dy * dy, 2, {i, j, 0}, {.5, .5, 0}};
}

/* The circle through three points; that of two where they are nearly on a line. */
static struct round round_three(const double (*p)[2], uint32_t i, uint32_t j, uint32_t k) {
    const double a[2] = {p[j][0] - p[i][0], p[j][1] - p[i][1]}, b[2] = {p[k][0] - p[i][0], p[k][1] - p[i][1]};
    const double aa = a[0] * a[0] + a[1] * a[1], bb = b[0] * b[0] + b[1] * b[1];
    const double twice = 2 * (a[0] * b[1] - a[1] * b[0]);
    if (fabs(twice) <= 0x1p-40 * (aa + bb))
        return round_two(p, j, k);
    const double x = (aa * b[1] - bb * a[1]) / twice, y = (bb * a[0] - aa * b[0]) / twice;
    // the middle as a mean of the corners
    const double v = 2 * (x * b[1] - y * b[0]) / twice, w = 2 * (a[0] * y - a[1] * x) / twice;
    return (struct round){p[i][0] + x, p[i][1] + y, x * x + y * y, 3, {i, j, k}, {1 - v - w, v, w}};
}

/* The smallest circle of the points before `count` that has two points on it. */
static struct round round_with_two(const double (*p)[2], uint32_t count, uint32_t i, uint32_t j) {
    struct round c = round_two(p, i, j);
    for (uint32_t k = 0; k < count; k++)
        if (is_outside(&c, p[k]))
            c = round_three(p, i, j, k);
    return c;
}

static struct round round_with_one(const double (*p)[2], uint32_t count, uint32_t i) {
    struct round c = round_two(p, i, 0);
    for (uint32_t j = 1; j < count; j++)
        if (is_outside(&c, p[j]))
            c = round_with_two(p, j, i, j);
    return c;
}

static struct round round_all(const double (*p)[2], uint32_t count) {
    struct round c = round_two(p, 0, 1);
    for (uint32_t i = 2; i < count; i++)
        if (is_outside(&c, p[i]))
            c = round_with_one(p, i, i);
    return c;
}

/* Two directions in a plane, at a right angle, of length 1. */
static void directions(const double u[3], double e[2][3]) {
    const int k = fabs(u[0]) <= fabs(u[1]) && fabs(u[0]) <= fabs(u[2]) ? 0 : fabs(u[1]) <= fabs(u[2]) ? 1 : 2;
    e[0][k] = 0;
    e[0][(k + 1) % 3] = -u[(k + 2) % 3];
    e[0][(k + 2) % 3] = u[(k + 1) % 3];
    for (int i = 0; i < 3; i++)
        e[1][i] = u[(i + 1) % 3] * e[0][(i + 2) % 3] - u[(i + 2) % 3] * e[0][(i + 1) % 3];
    for (int d = 0; d < 2; d++) {
        const double size = 1 / sqrt(e[d][0] * e[d][0] + e[d][1] * e[d][1] + e[d][2] * e[d][2]);
        for (int i = 0; i < 3; i++)
            e[d][i] *= size;
    }
}

/* Adds the point on an edge, at a part of its length. */
static void add_spot(const pir_opening_body *body, const double e[2][3], const uint32_t end[2], double part,
                     uint32_t of, uint32_t *count) {
    double *spot = body->spot[*count];
    spot[0] = spot[1] = 0;
    for (int c = 0; c < 3; c++) {
        const double from = body->at[end[0]][c], x = from + part * (body->at[end[1]][c] - from);
        spot[0] += x * e[0][c];
        spot[1] += x * e[1][c];
    }
    body->of[(*count)++] = of;
}

double pir_opening_body_cut(const pir_opening_body *body, const double u[3], double s) {
    double e[2][3];
    uint32_t count = 0;
    directions(u, e);
    for (uint32_t v = 0; v < body->vertices; v++)
        body->range[v][0] = pir_opening_height(body, v, u) - s;
    for (uint32_t i = 0; i < body->edges; i++) {
        const double g = body->range[body->edge[i][0]][0], h = body->range[body->edge[i][1]][0];
        if ((g < 0) != (h < 0))
            add_spot(body, (const double(*)[3])e, body->edge[i], g / (g - h), i, &count);
    }
    return count < 3 ? 0 : round_all((const double(*)[2])body->spot, count).square;
}

/* Where an edge may meet planes of a cell: from one part of its length to another; false where it does not. */
static bool span_of(const pir_opening_body *body, const uint32_t end[2], const double (*corner)[3], const double s[2],
                    double ret_part[2]) {
    bool is_below = false, is_above = false;
    ret_part[0] = 1;
    ret_part[1] = 0;
    for (int c = 0; c < 8; c++) {
        const double g = pir_opening_height(body, end[0], corner[c / 2]) - s[c % 2];
        const double h = pir_opening_height(body, end[1], corner[c / 2]) - s[c % 2];
        const double part = (g < 0) != (h < 0) ? g / (g - h) : fabs(g) < fabs(h) ? 0 : 1;
        is_below = is_below || g < 0 || h < 0;
        is_above = is_above || g >= 0 || h >= 0;
        ret_part[0] = fmin(ret_part[0], part);
        ret_part[1] = fmax(ret_part[1], part);
    }
    return is_below && is_above;
}

double pir_opening_body_most(const pir_opening_body *body, const double u[3], const double (*corner)[3],
                             const double s[2]) {
    double e[2][3], part[2];
    uint32_t count = 0;
    directions(u, e);
    for (uint32_t i = 0; i < body->edges; i++)
        if (span_of(body, body->edge[i], corner, s, part))
            for (int k = 0; k < 2; k++)
                add_spot(body, (const double(*)[3])e, body->edge[i], part[k], i, &count);
    return count < 3 ? 0 : round_all((const double(*)[2])body->spot, count).square;
}

void pir_opening_body_cuts(const pir_opening_body *body, const double u[3], double low, double high,
                           pir_opening_circle *ret_circle) {
    double e[2][3];
    uint32_t count = 0;
    directions(u, e);
    for (uint32_t i = 0; i < body->edges; i++) {
        const uint32_t *end = body->edge[i];
        const double *a = body->range[end[0]], *b = body->range[end[1]];
        if ((a[1] < low && b[0] > high) || (b[1] < low && a[0] > high)) {
            const double g = a[0] + a[1] - low - high, h = b[0] + b[1] - low - high;
            add_spot(body, (const double(*)[3])e, end, g / (g - h), i, &count);
        }
    }
    for (uint32_t v = 0; v < body->vertices; v++)
        if (body->range[v][1] >= low && body->range[v][0] <= high)
            add_spot(body, (const double(*)[3])e, (const uint32_t[2]){v, v}, 0, body->edges + v, &count);
    *ret_circle = (pir_opening_circle){0};
    if (count < 2)
        return;
    const struct round c = round_all((const double(*)[2])body->spot, count);
    ret_circle->square = c.square;
    ret_circle->count = c.count;
    for (uint32_t i = 0; i < c.count; i++) {
        ret_circle->of[i] = body->of[c.of[i]];
        ret_circle->weight[i] = c.weight[i];
    }
}

void pir_opening_body_disc(const double n[3], const pir_opening_polygon *polygon, uint32_t count,
                           double ret_middle[3]) {
    double e[2][3], size = 0, height = 0;
    uint32_t corners = 0;
    directions(n, e);
    for (uint32_t i = 0; i < count; i++)
        corners += polygon[i].count;
    double(*spot)[2] = calloc(corners + 1, sizeof *spot);
    corners = 0;
    for (uint32_t i = 0; i < count && spot; i++)
        for (uint32_t c = 0; c < polygon[i].count; c++, corners++)
            for (int k = 0; k < 3; k++) {
                const double x = mpq_get_d(polygon[i].at[c][k]);
                spot[corners][0] += x * e[0][k];
                spot[corners][1] += x * e[1][k];
                height += i == 0 && c == 0 ? x * n[k] : 0;
            }
    // any middle serves
    const struct round c = spot ? round_all((const double(*)[2])spot, corners) : (struct round){0};
    for (int k = 0; k < 3; k++)
        size += n[k] * n[k];
    for (int k = 0; k < 3; k++)
        ret_middle[k] = c.x * e[0][k] + c.y * e[1][k] + height / size * n[k];
    free(spot);
}
