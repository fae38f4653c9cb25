/* SPDX-License-Identifier: MIT */
/* Points of simplices nearest to 0, and distances by them: see core_simplex.h. */
#include "scene/world/core_simplex.h"

/* A point of a simplex: which corners hold it, their weights, and its square. */
struct held_point {
    int corner[3], count;
    double part[3], square;
};

static pir_vec3 point_of(const pir_core_simplex *s, const struct held_point *n) {
    pir_vec3 v = pir_vec_scale(s->corner[n->corner[0]].w, n->part[0]);
    for (int k = 1; k < n->count; k++)
        v = pir_vec_add(v, pir_vec_scale(s->corner[n->corner[k]].w, n->part[k]));
    return v;
}

static struct held_point at_corner(int i) {
    return (struct held_point){.corner = {i}, .count = 1, .part = {1}};
}

/* A point between two corners, at a part of the way that is over / under. */
static struct held_point between(int i, int j, double over, double under) {
    const double t = over / under;
    return (struct held_point){.corner = {i, j}, .count = 2, .part = {1 - t, t}};
}

static struct held_point on_edge(const pir_core_simplex *s, int i, int j) {
    const pir_vec3 a = s->corner[i].w, e = pir_vec_sub(s->corner[j].w, a);
    const double along = -pir_vec_dot(a, e), square = pir_vec_dot(e, e);
    return !(along > 0) ? at_corner(i) : !(along < square) ? at_corner(j) : between(i, j, along, square);
}

static void keep_nearer(const pir_core_simplex *s, struct held_point made, struct held_point *best) {
    const pir_vec3 v = point_of(s, &made);
    made.square = pir_vec_dot(v, v);
    if (made.square < best->square)
        *best = made;
}

/* The best of the edges of a triangle that is hardly more than a segment. */
static struct held_point on_edges(const pir_core_simplex *s, int i, int j, int k) {
    struct held_point best = {.square = HUGE_VAL};
    keep_nearer(s, on_edge(s, i, j), &best);
    keep_nearer(s, on_edge(s, j, k), &best);
    keep_nearer(s, on_edge(s, i, k), &best);
    return best;
}

static struct held_point on_triangle(const pir_core_simplex *s, int i, int j, int k) {
    const pir_vec3 a = s->corner[i].w, b = s->corner[j].w, c = s->corner[k].w, ab = pir_vec_sub(b, a),
                   ac = pir_vec_sub(c, a);
    const double d1 = -pir_vec_dot(ab, a), d2 = -pir_vec_dot(ac, a);
    if (d1 <= 0 && d2 <= 0)
        return at_corner(i);
    const double d3 = -pir_vec_dot(ab, b), d4 = -pir_vec_dot(ac, b);
    if (d3 >= 0 && d4 <= d3)
        return at_corner(j);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 > 0 && d3 < 0)
        return between(i, j, d1, d1 - d3);
    const double d5 = -pir_vec_dot(ab, c), d6 = -pir_vec_dot(ac, c);
    if (d6 >= 0 && d5 <= d6)
        return at_corner(k);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 > 0 && d6 < 0)
        return between(i, k, d2, d2 - d6);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 > 0 && d5 - d6 > 0)
        return between(j, k, d4 - d3, (d4 - d3) + (d5 - d6));
    if (!(va > 0 && vb > 0 && vc > 0))
        return on_edges(s, i, j, k);
    const double by = 1 / (va + vb + vc), v = vb * by, w = vc * by;
    return (struct held_point){.corner = {i, j, k}, .count = 3, .part = {1 - v - w, v, w}};
}

/* The last corner is new: the nearest point is on a triangle that has it. */
static struct held_point on_tetrahedron(const pir_core_simplex *s) {
    struct held_point best = {.square = HUGE_VAL};
    keep_nearer(s, on_triangle(s, 3, 0, 1), &best);
    keep_nearer(s, on_triangle(s, 3, 1, 2), &best);
    keep_nearer(s, on_triangle(s, 3, 0, 2), &best);
    return best;
}

pir_vec3 pir_core_simplex_solve(pir_core_simplex *s) {
    const struct held_point n = s->count == 1   ? at_corner(0)
                                : s->count == 2 ? on_edge(s, 0, 1)
                                : s->count == 3 ? on_triangle(s, 0, 1, 2)
                                                : on_tetrahedron(s);
    const pir_vec3 v = point_of(s, &n);
    pir_core_corner left[3];
    for (int k = 0; k < n.count; k++) {
        left[k] = s->corner[n.corner[k]];
        left[k].part = n.part[k];
    }
    for (int k = 0; k < n.count; k++)
        s->corner[k] = left[k];
    s->count = n.count;
    return v;
}

/* --- distances --- */

pir_core_supports pir_core_supports_along(const pir_vec3 *point, uint32_t count, const pir_vec3 *corner, pir_vec3 n) {
    pir_core_supports s = {0, 0, 0};
    double least = pir_vec_dot(n, point[0]), most = pir_vec_dot(n, corner[0]);
    for (uint32_t i = 1; i < count; i++) {
        const double height = pir_vec_dot(n, point[i]);
        s.a = height < least ? i : s.a;
        least = height < least ? height : least;
    }
    for (uint32_t k = 1; k < 3; k++) {
        const double height = pir_vec_dot(n, corner[k]);
        s.b = height > most ? k : s.b;
        most = height > most ? height : most;
    }
    s.gap = least - most;
    return s;
}

/* Steps of a distance; few take more than six. */
#define MOST_STEPS 24

double pir_core_gap(const pir_vec3 *point, uint32_t count, const pir_vec3 *corner, double enough) {
    pir_core_simplex simplex = {.corner = {{pir_vec_sub(point[0], corner[0]), 1, 0, 0}}, .count = 1};
    double best = -HUGE_VAL;
    for (int step = 0; step < MOST_STEPS && best < enough; step++) {
        const pir_vec3 v = pir_core_simplex_solve(&simplex);
        const double d = sqrt(pir_vec_dot(v, v));
        if (!(d > 0))
            break;
        const pir_core_supports s = pir_core_supports_along(point, count, corner, pir_vec_scale(v, 1 / d));
        best = s.gap > best ? s.gap : best;
        if (pir_core_simplex_has(&simplex, s.a, s.b))
            break;
        simplex.corner[simplex.count++] = (pir_core_corner){pir_vec_sub(point[s.a], corner[s.b]), 1, s.a, s.b};
    }
    return best;
}
