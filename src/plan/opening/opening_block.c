/* SPDX-License-Identifier: MIT */
/* See opening_block.h. */
#include "plan/opening/opening_block.h"

#include <math.h>

#define CORNERS 4 /* of (a, b) */

/* --- in doubles --- */

static void corner_of(const pir_opening_range *range, int corner, double u[3]) {
    pir_opening_plane(range, corner & 1 ? range->high[0] : range->low[0], corner & 2 ? range->high[1] : range->low[1],
                      u);
}

static void end_at(const pir_opening_body *body, pir_opening_end end, double x[3]) {
    const double *v = body->at[end.vertex], *w = body->at[end.to];
    for (int k = 0; k < 3; k++)
        x[k] = v[k] + ldexp(w[k] - v[k], -(int)end.halvings);
}

/* The vertex that is farthest below a plane, or above. */
static uint32_t farthest(const pir_opening_body *body, const double u[3], int side) {
    uint32_t best = 0;
    for (uint32_t v = 1; v < body->vertices; v++) {
        const double more = pir_opening_height(body, v, u) - pir_opening_height(body, best, u);
        if (side == 0 ? more < 0 : more > 0)
            best = v;
    }
    return best;
}

/*
 * An end near a vertex that is not on its side of all planes of a cell, as near as can be: towards the farthest vertex
 * there. With v + t(w − v), g(w) is to outweigh g(v): t > g(v) / (g(v) − g(w)). False where it cannot.
 */
static bool take_end(const pir_opening_body *body, const pir_opening_range *range, const double u[3], uint32_t vertex,
                     int side, pir_opening_end *ret_end) {
    const uint32_t to = farthest(body, u, side);
    double least = 0, corner[3];
    for (int c = 0; c < CORNERS; c++) {
        corner_of(range, c, corner);
        const double s = side == 0 ? range->low[2] : range->high[2];
        const double g = pir_opening_height(body, vertex, corner) - s, h = pir_opening_height(body, to, corner) - s;
        if (side == 0 ? h >= 0 : h <= 0)
            return false;
        least = fmax(least, g / (g - h));
    }
    int exponent;
    frexp(least, &exponent); // 2^(exponent − 1) ≤ least
    const int halvings = least == 0                               ? PIR_OPENING_MOST_HALVINGS
                         : exponent <= -PIR_OPENING_MOST_HALVINGS ? PIR_OPENING_MOST_HALVINGS
                                                                  : -exponent;
    if (halvings < 0)
        return false;
    *ret_end = (pir_opening_end){vertex, to, (uint32_t)halvings};
    return true;
}

/* The chord that a point is on: an edge, or a short one about a vertex. */
static bool take_chord(const pir_opening_body *body, const pir_opening_range *range, const double u[3], uint32_t of,
                       pir_opening_end end[2]) {
    if (of >= body->edges)
        return take_end(body, range, u, of - body->edges, 0, &end[0]) &&
               take_end(body, range, u, of - body->edges, 1, &end[1]);
    const uint32_t *edge = body->edge[of];
    const bool is_up = body->range[edge[0]][1] < range->low[2];
    for (int side = 0; side < 2; side++)
        end[side] = (pir_opening_end){edge[side == 0 ? !is_up : is_up], edge[side == 0 ? !is_up : is_up], 0};
    return true;
}

/* A chord: where it begins, its way, the middle and half width of λ, that of the axes of the cell by themselves. */
struct chord {
    double from[3], way[3], at[3], middle, half, along[3];
};

/* λ at a plane. */
static double part_of(const struct chord *chord, const double u[3], double s) {
    double g = -s, h = 0;
    for (int k = 0; k < 3; k++) {
        g += u[k] * chord->from[k];
        h += u[k] * chord->way[k];
    }
    return -g / h;
}

static void measure(const pir_opening_body *body, const pir_opening_range *range, const pir_opening_end end[2],
                    struct chord *chord) {
    double most = 0, least = 1, u[3], to[3], middle[3];
    end_at(body, end[0], chord->from);
    end_at(body, end[1], to);
    for (int k = 0; k < 3; k++) {
        chord->way[k] = to[k] - chord->from[k];
        middle[k] = (range->low[k] + range->high[k]) / 2;
    }
    for (int c = 0; c < 2 * CORNERS; c++) {
        corner_of(range, c, u);
        const double l = part_of(chord, u, c & CORNERS ? range->high[2] : range->low[2]);
        most = fmax(most, l);
        least = fmin(least, l);
    }
    chord->middle = (most + least) / 2;
    chord->half = (most - least) / 2;
    for (int k = 0; k < 3; k++) {
        double x[2][3], l[2];
        for (int e = 0; e < 2; e++) {
            for (int i = 0; i < 3; i++)
                x[e][i] = i != k ? middle[i] : e ? range->high[i] : range->low[i];
            pir_opening_plane(range, x[e][0], x[e][1], u);
            l[e] = part_of(chord, u, x[e][2]);
        }
        chord->along[k] = fabs(l[1] - l[0]) / 2;
        chord->at[k] = chord->from[k] + chord->middle * chord->way[k];
    }
}

/* The axis along which a cell is longest, as heights of the body have it. */
static int longest(const pir_opening_body *body, const pir_opening_range *range) {
    const double size[3] = {body->reach * (range->high[0] - range->low[0]),
                            body->reach * (range->high[1] - range->low[1]), 2 * (range->high[2] - range->low[2])};
    return size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
}

/* F − r² less what the tangent loses at most. */
static double tangent(const struct chord *chord, const uint32_t *weight, uint32_t count, double square, int *ret_axis) {
    double mean[3] = {0, 0, 0}, form = -square, loss = 0, by[3] = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            mean[k] += chord[i].at[k] * weight[i] / PIR_OPENING_WEIGHTS;
    for (uint32_t i = 0; i < count; i++) {
        const double w = (double)weight[i] / PIR_OPENING_WEIGHTS;
        double slope = 0;
        for (int k = 0; k < 3; k++) {
            const double x = chord[i].at[k] - mean[k];
            form += w * x * x;
            slope += 2 * w * x * chord[i].way[k];
        }
        loss += fabs(slope) * chord[i].half;
        for (int k = 0; k < 3; k++)
            by[k] += fabs(slope) * chord[i].along[k];
    }
    *ret_axis = by[0] >= by[1] && by[0] >= by[2] ? 0 : by[1] >= by[2] ? 1 : 2;
    return form - loss;
}

/* The least and greatest heights of vertices over the planes of a cell. */
static void measure_vertices(const pir_opening_body *body, const pir_opening_range *range) {
    for (uint32_t v = 0; v < body->vertices; v++) {
        double *h = body->range[v];
        h[0] = INFINITY;
        h[1] = -INFINITY;
        for (int c = 0; c < CORNERS; c++) {
            double u[3];
            corner_of(range, c, u);
            const double height = pir_opening_height(body, v, u);
            h[0] = fmin(h[0], height - body->reach * 0x1p-45); // what is on a plane is not beside it
            h[1] = fmax(h[1], height + body->reach * 0x1p-45);
        }
    }
}

double pir_opening_block_seek(const pir_opening_body *body, const pir_opening_range *range, double square,
                              pir_opening_block *ret_block, int *ret_axis) {
    struct chord chord[3];
    pir_opening_circle circle;
    double u[3];
    pir_opening_plane(range, (range->low[0] + range->high[0]) / 2, (range->low[1] + range->high[1]) / 2, u);
    measure_vertices(body, range);
    pir_opening_body_cuts(body, u, range->low[2], range->high[2], &circle);
    *ret_axis = longest(body, range);
    *ret_block = (pir_opening_block){0};
    uint32_t left = PIR_OPENING_WEIGHTS;
    for (uint32_t i = 0; i < circle.count; i++) {
        double weight = rint(circle.weight[i] * PIR_OPENING_WEIGHTS);
        weight = i + 1 == circle.count ? left : fmax(0, fmin(weight, left));
        left -= (uint32_t)weight;
        if (weight == 0)
            continue;
        const uint32_t n = ret_block->count;
        if (!take_chord(body, range, u, circle.of[i], ret_block->end[n]))
            return -INFINITY;
        ret_block->weight[n] = (uint32_t)weight;
        measure(body, range, ret_block->end[n], &chord[n]);
        ret_block->count++;
    }
    return ret_block->count < 2 ? -INFINITY : tangent(chord, ret_block->weight, ret_block->count, square, ret_axis);
}

/* --- in rationals --- */

/* A chord in rationals: its ends, the range of λ, then its middle and half width, the point there; scratch. */
struct exact_chord {
    mpq_t from[3], to[3], least, most, g[2], t[2], at[3], way[3];
};

static void each_number(struct exact_chord *c, void (*call)(mpq_ptr)) {
    mpq_ptr all[] = {c->from[0], c->from[1], c->from[2], c->to[0], c->to[1], c->to[2], c->least,  c->most,   c->g[0],
                     c->g[1],    c->t[0],    c->t[1],    c->at[0], c->at[1], c->at[2], c->way[0], c->way[1], c->way[2]};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        call(all[i]);
}

static void exact_end(const pir_opening_body *body, pir_opening_end end, mpq_t x[3]) {
    for (int k = 0; k < 3; k++) {
        mpq_sub(x[k], body->exact[end.to][k], body->exact[end.vertex][k]);
        mpq_div_2exp(x[k], x[k], end.halvings);
        mpq_add(x[k], x[k], body->exact[end.vertex][k]);
    }
}

/* u·x − s. */
static void exact_height(struct exact_chord *c, const mpq_t x[3], const double u[3], double s, mpq_t g) {
    mpq_set_d(g, -s);
    for (int k = 0; k < 3; k++) {
        mpq_set_d(c->t[0], u[k]);
        mpq_mul(c->t[0], c->t[0], x[k]);
        mpq_add(g, g, c->t[0]);
    }
}

/* The range of λ; false where an end is not on its side. */
static bool exact_range(const pir_opening_range *range, struct exact_chord *c) {
    double u[3];
    for (int i = 0; i < 2 * CORNERS; i++) {
        const double s = i & CORNERS ? range->high[2] : range->low[2];
        corner_of(range, i, u);
        exact_height(c, (const mpq_t *)c->from, u, s, c->g[0]);
        exact_height(c, (const mpq_t *)c->to, u, s, c->g[1]);
        if (mpq_sgn(c->g[0]) >= 0 || mpq_sgn(c->g[1]) <= 0)
            return false;
        mpq_sub(c->t[0], c->g[0], c->g[1]);
        mpq_div(c->t[0], c->g[0], c->t[0]);
        if (i == 0 || mpq_cmp(c->t[0], c->least) < 0)
            mpq_set(c->least, c->t[0]);
        if (i == 0 || mpq_cmp(c->t[0], c->most) > 0)
            mpq_set(c->most, c->t[0]);
    }
    mpq_add(c->t[0], c->least, c->most);
    mpq_div_2exp(c->t[0], c->t[0], 1);
    mpq_sub(c->most, c->most, c->t[0]);
    mpq_set(c->least, c->t[0]);
    for (int k = 0; k < 3; k++) {
        mpq_sub(c->way[k], c->to[k], c->from[k]);
        mpq_mul(c->at[k], c->way[k], c->least);
        mpq_add(c->at[k], c->at[k], c->from[k]);
    }
    return true;
}

/* Adds to `sum` what a chord has of the tangent, times all weights. */
static void add_tangent(struct exact_chord *c, uint32_t weight, const mpq_t mean[3], mpq_t sum) {
    mpq_ptr slope = c->g[0], w = c->g[1];
    mpq_set_ui(slope, 0, 1);
    mpq_set_ui(w, weight, 1);
    for (int k = 0; k < 3; k++) {
        mpq_sub(c->t[0], c->at[k], mean[k]);
        mpq_mul(c->t[1], c->t[0], c->way[k]);
        mpq_add(slope, slope, c->t[1]);
        mpq_mul(c->t[0], c->t[0], c->t[0]);
        mpq_mul(c->t[0], c->t[0], w);
        mpq_add(sum, sum, c->t[0]);
    }
    mpq_abs(slope, slope);
    mpq_mul(slope, slope, c->most);
    mpq_mul(slope, slope, w);
    mpq_mul_2exp(slope, slope, 1);
    mpq_sub(sum, sum, slope);
}

/* Whether the tangent exceeds the square, of chords whose ranges are known. */
static bool exceeds(const pir_opening_block *block, mpq_srcptr square, struct exact_chord *chord) {
    mpq_t mean[3], sum;
    uint32_t weights = 0;
    mpq_inits(mean[0], mean[1], mean[2], sum, NULL);
    for (uint32_t i = 0; i < block->count; i++) {
        weights += block->weight[i];
        for (int k = 0; k < 3; k++) {
            mpq_set_ui(chord[i].t[0], block->weight[i], 1);
            mpq_mul(chord[i].t[0], chord[i].t[0], chord[i].at[k]);
            mpq_add(mean[k], mean[k], chord[i].t[0]);
        }
    }
    mpq_set_ui(sum, weights > 0 ? weights : 1, 1);
    for (int k = 0; k < 3; k++)
        mpq_div(mean[k], mean[k], sum);
    mpq_mul(sum, sum, square);
    mpq_neg(sum, sum);
    for (uint32_t i = 0; i < block->count; i++)
        add_tangent(&chord[i], block->weight[i], (const mpq_t *)mean, sum);
    const bool does = weights > 0 && mpq_sgn(sum) > 0;
    mpq_clears(mean[0], mean[1], mean[2], sum, NULL);
    return does;
}

bool pir_opening_block_holds(const pir_opening_body *body, const pir_opening_range *range, mpq_srcptr square,
                             const pir_opening_block *block) {
    struct exact_chord chord[3];
    bool holds = true;
    for (uint32_t i = 0; i < block->count; i++)
        each_number(&chord[i], mpq_init);
    for (uint32_t i = 0; i < block->count && holds; i++) {
        exact_end(body, block->end[i][0], chord[i].from);
        exact_end(body, block->end[i][1], chord[i].to);
        holds = exact_range(range, &chord[i]);
    }
    holds = holds && exceeds(block, square, chord);
    for (uint32_t i = 0; i < block->count; i++)
        each_number(&chord[i], mpq_clear);
    return holds;
}
