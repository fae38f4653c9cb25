/* SPDX-License-Identifier: MIT */
/*
 * The nearest point of a hull to the origin, after Wolfe 1976 (Finding the nearest point in a polytope): a corral of at
 * most four points whose affine hull has its nearest point within their hull; points are added that are nearer to the
 * origin along it, and dropped where the affine nearest point is outside.
 */
#include "plan/rigid/point_sets.h"

#include <math.h>
#include <string.h>

#define STEPS 64

/* Over what rounding can be, relative to the sizes of the products of a gap: that is below 40·2^-53. */
#define MARGIN 0x1p-44
#define CORRAL 4

struct corral {
    double x[CORRAL][3], weight[CORRAL];
    const double *a[CORRAL]; /* the points of the first set that x are from */
    int count;
    double near[3]; /* Σ weight·x */
};

struct point_sets {
    const double (*a)[3], (*b)[3];
    uint32_t count_a, count_b;
    double room;
};

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Weights of the affine hull's nearest point: of the sum 1, and all x alike along it. False where x are dependent. */
static bool affine_nearest(const struct corral *c, double weight[CORRAL]) {
    double m[CORRAL + 1][CORRAL + 2];
    const int n = c->count + 1;
    for (int i = 0; i < n; i++)
        for (int k = 0; k <= n; k++) {
            const bool is_edge = i == c->count || k == c->count;
            m[i][k] = k == n ? i == c->count : is_edge ? i != k : dot(c->x[i], c->x[k]);
        }
    for (int p = 0; p < n; p++) {
        int best = p;
        for (int i = p + 1; i < n; i++)
            best = fabs(m[i][p]) > fabs(m[best][p]) ? i : best;
        if (m[best][p] == 0)
            return false;
        for (int k = 0; k <= n; k++) {
            const double swapped = m[p][k];
            m[p][k] = m[best][k];
            m[best][k] = swapped;
        }
        for (int i = 0; i < n; i++) {
            const double by = i == p ? 0 : m[i][p] / m[p][p];
            for (int k = p; k <= n; k++)
                m[i][k] -= by * m[p][k];
        }
    }
    for (int i = 0; i < c->count; i++)
        weight[i] = m[i][n] / m[i][i];
    return true;
}

static void drop_empty(struct corral *c) {
    int kept = 0;
    for (int i = 0; i < c->count; i++) {
        if (!(c->weight[i] > 0))
            continue;
        memmove(c->x[kept], c->x[i], sizeof c->x[i]);
        c->a[kept] = c->a[i];
        c->weight[kept++] = c->weight[i];
    }
    c->count = kept;
}

/* Moves to the nearest point of the hull of the corral, and keeps what that is between. */
static bool settle(struct corral *c) {
    for (int round = 0; round <= CORRAL; round++) {
        double to[CORRAL], part = 1;
        if (c->count == 0 || !affine_nearest(c, to))
            return false;
        for (int i = 0; i < c->count; i++)
            if (to[i] <= 0)
                part = fmin(part, c->weight[i] / (c->weight[i] - to[i]));
        for (int i = 0; i < c->count; i++) {
            const double w = c->weight[i] + part * (to[i] - c->weight[i]);
            c->weight[i] = to[i] <= 0 && w < 0x1p-40 ? 0 : w;
        }
        if (part >= 1)
            break;
        drop_empty(c);
    }
    drop_empty(c);
    for (int k = 0; k < 3; k++) {
        c->near[k] = 0;
        for (int i = 0; i < c->count; i++)
            c->near[k] += c->weight[i] * c->x[i][k];
    }
    return c->count > 0;
}

/* The point of a set that is farthest against a direction. */
static uint32_t lowest(const double (*x)[3], uint32_t count, const double way[3]) {
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const double s = dot(x[i], way);
        best = s < least ? i : best;
        least = fmin(least, s);
    }
    return best;
}

/* A bound on the sums of sizes of products with v. */
static double largest(const double (*x)[3], uint32_t count, const double v[3]) {
    double most = 0;
    for (uint32_t i = 0; i < count; i++)
        most = fmax(most, fabs(v[0] * x[i][0]) + fabs(v[1] * x[i][1]) + fabs(v[2] * x[i][2]));
    return most;
}

/* Adds the point of the difference of both sets that is lowest along the way from the origin; 1 where a plane across
 * that way is between the sets, −1 where nothing more is found. */
static int step_nearer(const struct point_sets *sets, struct corral *c) {
    const double *v = c->near, back[3] = {-v[0], -v[1], -v[2]};
    const double *low = sets->a[lowest(sets->a, sets->count_a, v)];
    const double *high = sets->b[lowest(sets->b, sets->count_b, back)];
    double added[3];
    for (int k = 0; k < 3; k++)
        added[k] = low[k] - high[k];
    const double gap = dot(v, added);
    if (gap > 0 && gap > (largest(sets->a, sets->count_a, v) + largest(sets->b, sets->count_b, v)) * MARGIN +
                             sets->room * (fabs(v[0]) + fabs(v[1]) + fabs(v[2])))
        return 1;
    const double length = dot(v, v);
    if (!(length > 0) || gap > length * (1 - 0x1p-30) || c->count == CORRAL)
        return -1;
    memcpy(c->x[c->count], added, sizeof added);
    c->a[c->count] = low;
    c->weight[c->count++] = 0;
    return settle(c) ? 0 : -1;
}

bool pir_points_apart(const double (*a)[3], uint32_t count_a, const double (*b)[3], uint32_t count_b, double room,
                      double ret_shared[3]) {
    const struct point_sets sets = {a, b, count_a, count_b, room};
    struct corral c = {.count = 1, .weight = {1}, .a = {a[0]}};
    int found = 0;
    for (int k = 0; k < 3; k++)
        c.near[k] = c.x[0][k] = a[0][k] - b[0][k];
    for (int step = 0; step < STEPS && found == 0; step++)
        found = step_nearer(&sets, &c);
    for (int k = 0; k < 3 && ret_shared; k++) {
        ret_shared[k] = 0;
        for (int i = 0; i < c.count; i++)
            ret_shared[k] += c.weight[i] * c.a[i][k];
    }
    return found > 0;
}
