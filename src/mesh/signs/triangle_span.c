/* SPDX-License-Identifier: MIT */
/*
 * Distances of triangles: all pairs of edges (Ericson, Real-Time Collision Detection, 2005, section 5.1.9) and all
 * vertices over faces; of these the nearest. What comes out is checked, not trusted.
 *
 * Errors. Coordinates are off by at most E. A difference of two is off by 2E, and a rounding, which is below E. So
 * with M the longest difference, a dot product of two is off by less than 8·E·M, a determinant of three by
 * 32·E·M², and one that has k factors by less than 2^(k+3)·E·M^(k−1). Signs below these bounds are not certain.
 */
#include "mesh/signs/triangle_span.h"

/* A length whose square may have lost its bits, and one below which products of four may have. */
#define UNDERFLOW 0x1p-500
#define SHORT     0x1p-200

/* The features whose nearest points are known: numbers of corners of a and of b. */
struct found_features {
    double square;
    pir_vec3 a, b;
    int at[2][3], count[2];
};

static double clamp01(double x) {
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* An edge's point at `t`: an end of it, or its inside. */
static void set_feature(struct found_features *found, int side, int from, int to, double t) {
    found->count[side] = t > 0 && t < 1 ? 2 : 1;
    found->at[side][0] = t < 1 ? from : to;
    found->at[side][1] = to;
}

/* --- nearest points --- */

static void try_edges(const pir_corners *a, const pir_corners *b, int i, int j, struct found_features *best) {
    int i1 = (i + 1) % a->count, j1 = (j + 1) % b->count;
    pir_vec3 e = pir_vec_sub(a->p[i1], a->p[i]), f = pir_vec_sub(b->p[j1], b->p[j]);
    pir_vec3 w = pir_vec_sub(a->p[i], b->p[j]);
    double ee = pir_vec_dot(e, e), ff = pir_vec_dot(f, f), ef = pir_vec_dot(e, f);
    double ew = pir_vec_dot(e, w), fw = pir_vec_dot(f, w), den = ee * ff - ef * ef;
    double s = den > 0 ? clamp01((ef * fw - ew * ff) / den) : 0;
    double t = ff > 0 ? (ef * s + fw) / ff : 0;
    if (t < 0 || t > 1 || !(ff > 0)) {
        t = clamp01(t);
        s = ee > 0 ? clamp01((t * ef - ew) / ee) : 0;
    }
    pir_vec3 x = s < 1 ? pir_vec_add(a->p[i], pir_vec_scale(e, s)) : a->p[i1];
    pir_vec3 y = t < 1 ? pir_vec_add(b->p[j], pir_vec_scale(f, t)) : b->p[j1];
    pir_vec3 between = pir_vec_sub(x, y);
    double square = pir_vec_dot(between, between);
    if (square < best->square) {
        *best = (struct found_features){.square = square, .a = x, .b = y};
        set_feature(best, 0, i, i1, s);
        set_feature(best, 1, j, j1, t);
    }
}

/* The corners of `points` over the face of `face`; `side` is whose the points are. */
static void try_face(const pir_corners *points, const pir_corners *face, int side, struct found_features *best) {
    const pir_vec3 *p = face->p;
    pir_vec3 n = pir_vec_cross(pir_vec_sub(p[1], p[0]), pir_vec_sub(p[2], p[0]));
    double nn = pir_vec_dot(n, n);
    if (!(nn > 0))
        return;
    pir_vec3 in[3];
    for (int k = 0; k < 3; k++)
        in[k] = pir_vec_cross(n, pir_vec_sub(p[(k + 1) % 3], p[k]));
    for (int i = 0; i < points->count; i++) {
        pir_vec3 v = points->p[i], to = pir_vec_sub(v, p[0]);
        double height = pir_vec_dot(to, n), square = height * height / nn;
        if (!(square < best->square) || pir_vec_dot(in[0], to) < 0 || pir_vec_dot(in[1], pir_vec_sub(v, p[1])) < 0 ||
            pir_vec_dot(in[2], pir_vec_sub(v, p[2])) < 0)
            continue;
        pir_vec3 foot = pir_vec_sub(v, pir_vec_scale(n, height / nn));
        *best = (struct found_features){square, side == 0 ? v : foot, side == 0 ? foot : v, {{0}}, {0}};
        best->count[side] = 1;
        best->at[side][0] = i;
        best->count[1 - side] = 3;
        for (int k = 0; k < 3; k++)
            best->at[1 - side][k] = k;
    }
}

static struct found_features find_nearest(const pir_corners *a, const pir_corners *b) {
    struct found_features best = {.square = HUGE_VAL};
    for (int i = 0; i < a->count; i++)
        for (int j = 0; j < b->count; j++)
            try_edges(a, b, i, j, &best);
    if (b->count == 3)
        try_face(a, b, 0, &best);
    if (a->count == 3)
        try_face(b, a, 1, &best);
    return best;
}

/* --- certainty --- */

/* The longest difference of two corners of either, at most doubled. */
static double longest(const pir_corners *a, const pir_corners *b) {
    double most = 0;
    for (int i = 0; i < a->count; i++)
        for (int k = 0; k < 3; k++)
            most = fmax(most, pir_vec_length(pir_vec_sub(a->p[i], k < b->count ? b->p[k] : a->p[k % a->count])));
    for (int k = 0; k < b->count; k++)
        most = fmax(most, pir_vec_length(pir_vec_sub(b->p[k], a->p[0])));
    return 2 * most;
}

/* A direction from b to a across both features, as a polynomial in the corners, and how many factors it has. */
static pir_vec3 across(const pir_corners *a, const pir_corners *b, const struct found_features *found,
                       int *ret_factors) {
    pir_vec3 w = pir_vec_sub(a->p[found->at[0][0]], b->p[found->at[1][0]]), n = w;
    int ca = found->count[0], cb = found->count[1];
    *ret_factors = 1;
    if (ca == 3 || cb == 3) {
        const pir_corners *face = ca == 3 ? a : b;
        n = pir_vec_cross(pir_vec_sub(face->p[1], face->p[0]), pir_vec_sub(face->p[2], face->p[0]));
        *ret_factors = 2;
    } else if (ca == 2 && cb == 2) {
        n = pir_vec_cross(pir_vec_sub(a->p[found->at[0][1]], a->p[found->at[0][0]]),
                          pir_vec_sub(b->p[found->at[1][1]], b->p[found->at[1][0]]));
        *ret_factors = 2;
    } else if (ca == 2 || cb == 2) {
        pir_vec3 e = ca == 2 ? pir_vec_sub(a->p[found->at[0][1]], a->p[found->at[0][0]])
                             : pir_vec_sub(b->p[found->at[1][1]], b->p[found->at[1][0]]);
        n = pir_vec_sub(pir_vec_scale(w, pir_vec_dot(e, e)), pir_vec_scale(e, pir_vec_dot(w, e)));
        *ret_factors = 3;
    }
    return n;
}

/* 2^(factors + 3) · E · M^(factors − 1), and twice that. */
static double bound_of(int factors, double error, double m) {
    double bound = error * (double)(16 << factors);
    for (int k = 1; k < factors; k++)
        bound *= m;
    return bound;
}

static bool is_used(const struct found_features *found, int side, int corner) {
    for (int k = 0; k < found->count[side]; k++)
        if (found->at[side][k] == corner)
            return true;
    return false;
}

/* Whether the corners that are not of the feature are behind it, strictly, as seen along n. */
static bool others_are_behind(const pir_corners *c, const struct found_features *found, int side, pir_vec3 n,
                              double bound) {
    for (int i = 0; i < c->count; i++)
        if (!is_used(found, side, i) && !(pir_vec_dot(n, pir_vec_sub(c->p[i], c->p[found->at[side][0]])) > bound))
            return false;
    return true;
}

/* Whether the foot of a vertex on an edge is within it, strictly. */
static bool foot_is_within(pir_vec3 v, pir_vec3 p, pir_vec3 q, double error, double m) {
    pir_vec3 e = pir_vec_sub(q, p);
    double bound = bound_of(2, error, m);
    return pir_vec_dot(e, pir_vec_sub(v, p)) > bound && pir_vec_dot(e, pir_vec_sub(q, v)) > bound;
}

static bool feet_are_within(const pir_corners *a, const pir_corners *b, const struct found_features *found,
                            double error, double m) {
    const int *ia = found->at[0], *ib = found->at[1];
    int ca = found->count[0], cb = found->count[1];
    if (ca == 1 && cb == 1)
        return true;
    if (ca == 3 || cb == 3) {
        const pir_corners *face = ca == 3 ? a : b;
        pir_vec3 v = ca == 3 ? b->p[ib[0]] : a->p[ia[0]];
        pir_vec3 n = pir_vec_cross(pir_vec_sub(face->p[1], face->p[0]), pir_vec_sub(face->p[2], face->p[0]));
        for (int k = 0; k < 3; k++) {
            pir_vec3 in = pir_vec_cross(n, pir_vec_sub(face->p[(k + 1) % 3], face->p[k]));
            if (!(pir_vec_dot(in, pir_vec_sub(v, face->p[k])) > bound_of(4, error, m)))
                return false;
        }
        return true;
    }
    if (ca == 1)
        return foot_is_within(a->p[ia[0]], b->p[ib[0]], b->p[ib[1]], error, m);
    if (cb == 1)
        return foot_is_within(b->p[ib[0]], a->p[ia[0]], a->p[ia[1]], error, m);
    pir_vec3 e = pir_vec_sub(a->p[ia[1]], a->p[ia[0]]), f = pir_vec_sub(b->p[ib[1]], b->p[ib[0]]);
    pir_vec3 w = pir_vec_sub(a->p[ia[0]], b->p[ib[0]]);
    double ee = pir_vec_dot(e, e), ff = pir_vec_dot(f, f), ef = pir_vec_dot(e, f);
    double ew = pir_vec_dot(e, w), fw = pir_vec_dot(f, w), den = ee * ff - ef * ef;
    double s = ef * fw - ew * ff, t = ee * fw - ef * ew, bound = bound_of(4, error, m);
    return s > bound && den - s > bound && t > bound && den - t > bound;
}

/* Whether the features found are those that hold the nearest points of the exact triangles: the nearest points of their
 * lines or planes are within them, and all else is behind. */
static bool is_certain(const pir_corners *a, const pir_corners *b, const struct found_features *found, double error) {
    double m = longest(a, b);
    if (m < SHORT)
        return false;
    int factors;
    pir_vec3 n = across(a, b, found, &factors), w = pir_vec_sub(a->p[found->at[0][0]], b->p[found->at[1][0]]);
    double bound = bound_of(factors + 1, error, m), along = pir_vec_dot(n, w);
    if (fabs(along) <= bound)
        return false;
    n = along < 0 ? pir_vec_scale(n, -1) : n;
    return feet_are_within(a, b, found, error, m) && others_are_behind(a, found, 0, n, bound) &&
           others_are_behind(b, found, 1, pir_vec_scale(n, -1), bound);
}

static pir_feature_ids ids_of(const pir_corners *c, const struct found_features *found, int side) {
    pir_feature_ids ids = {{UINT32_MAX, UINT32_MAX, UINT32_MAX}};
    for (int k = 0; k < found->count[side]; k++) {
        uint32_t id = c->id[found->at[side][k]];
        int at = k;
        for (; at > 0 && ids.id[at - 1] > id; at--)
            ids.id[at] = ids.id[at - 1];
        ids.id[at] = id;
    }
    return ids;
}

/* --- meeting --- */

/* Whether the edge from p to q certainly goes through the face; *ret_point is where. */
static bool pierces(pir_vec3 p, pir_vec3 q, const pir_corners *face, double bound, pir_vec3 *ret_point) {
    pir_vec3 x[3], d = pir_vec_sub(q, p);
    for (int k = 0; k < 3; k++)
        x[k] = pir_vec_sub(face->p[k], p);
    pir_vec3 n = pir_vec_cross(pir_vec_sub(face->p[1], face->p[0]), pir_vec_sub(face->p[2], face->p[0]));
    double from = pir_vec_dot(n, x[0]), to = pir_vec_dot(n, pir_vec_sub(face->p[0], q));
    if (!((from > bound && to < -bound) || (from < -bound && to > bound)))
        return false;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        double around = pir_vec_dot(d, pir_vec_cross(x[k], x[(k + 1) % 3]));
        least = fmin(least, around);
        most = fmax(most, around);
    }
    *ret_point = pir_vec_add(p, pir_vec_scale(d, from / (from - to)));
    return least > bound || most < -bound;
}

static bool meet_certainly(const pir_corners *a, const pir_corners *b, double error, pir_vec3 *ret_point) {
    if (a->count < 3 || b->count < 3)
        return false;
    double m = longest(a, b), bound = bound_of(3, error, m);
    if (m < SHORT)
        return false;
    for (int i = 0; i < 3; i++)
        if (pierces(a->p[i], a->p[(i + 1) % 3], b, bound, ret_point) ||
            pierces(b->p[i], b->p[(i + 1) % 3], a, bound, ret_point))
            return true;
    return false;
}

/* How far a is from b along a unit direction. */
static double gap_along(const pir_corners *a, const pir_corners *b, pir_vec3 n) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < a->count; i++)
        low = fmin(low, pir_vec_dot(n, pir_vec_sub(a->p[i], b->p[0])));
    for (int j = 0; j < b->count; j++)
        high = fmax(high, pir_vec_dot(n, pir_vec_sub(b->p[j], b->p[0])));
    return low - high;
}

pir_span pir_triangle_span(const pir_corners *a, const pir_corners *b, double error) {
    struct found_features found = find_nearest(a, b);
    pir_vec3 between = pir_vec_sub(found.a, found.b);
    double distance = pir_vec_length(between), slack = 16 * error + UNDERFLOW;
    pir_span span = {.high = distance + slack, .point_a = found.a, .point_b = found.b};
    if (distance > slack) {
        double gap = gap_along(a, b, pir_vec_scale(between, 1 / distance)) * (1 - 0x1p-48) - slack;
        span.low = gap > 0 ? gap : 0;
    }
    if (span.low > 0) {
        span.certain = is_certain(a, b, &found, error);
        span.a = ids_of(a, &found, 0);
        span.b = ids_of(b, &found, 1);
        return span;
    }
    pir_vec3 point;
    if (meet_certainly(a, b, error, &point)) {
        span.meets = true;
        span.point_a = span.point_b = point;
        span.high = 0;
    }
    return span;
}
