/* SPDX-License-Identifier: MIT */
/*
 * Carried features. The hull of a ball (b, r) in D and a point s of D is the union over λ in [0, 1] of the balls of
 * radius (1 − λ)·r about b + λ(s − b). So t is in it when, for some λ,
 *
 *     |t − b − λ(s − b)| + e ≤ (1 − λ)·r,
 *
 * and e, a bound on how far t, b and s are off, keeps this true for the exact points: an s off by e moves the ball of
 * λ by λ·e. Any λ will do; the best is found by setting a derivative to 0.
 *
 * Points s are corners of the sum of the two faces, and the points of its triangles where the ray from b through t
 * meets their planes, brought into the triangle: a mean of corners with weights that are not negative, wherever
 * rounding has put it.
 */
#include "cspace/answer/carry.h"

#include <math.h>

/* The most corners of a face that are looked at. */
#define CORNERS 64

static pir_vec3 difference_point(const pir_carrying *c, pir_vec3 p, pir_vec3 q) {
    return pir_vec_sub(q, pir_mat_apply(&c->turned->a, p));
}

bool pir_carry_covers(const pir_carrying *c, pir_vec3 point) {
    const double r = c->radius;
    pir_vec3 x = pir_vec_sub(c->turned->t, c->centre), w = pir_vec_sub(point, c->centre);
    double ww = pir_vec_dot(w, w), xw = pir_vec_dot(x, w), lambda = 0;
    if (r * r < ww) {
        double across = fmax(0, pir_vec_dot(x, x) - xw * xw / ww);
        lambda = fmax(0, fmin(1, (xw - r * sqrt(across / (1 - r * r / ww))) / ww));
    }
    pir_vec3 away = pir_vec_sub(x, pir_vec_scale(w, lambda));
    return sqrt(pir_vec_dot(away, away)) + c->error <= (1 - lambda) * r;
}

/* --- the sum of two faces --- */

/* Corners of a face, in order round a facet. */
typedef struct face_corners {
    uint32_t count;
    pir_vec3 at[CORNERS];
} face_corners;

static void corners_of(const pir_polytope *polytope, pir_feature feature, face_corners *ret) {
    uint32_t vertex[CORNERS];
    ret->count = 0;
    if (feature.kind == PIR_FEATURE_VERTEX) {
        vertex[0] = feature.index;
        ret->count = 1;
    } else if (feature.kind == PIR_FEATURE_EDGE) {
        pir_polytope_edge(polytope, feature.index, vertex);
        ret->count = 2;
    } else if (feature.kind == PIR_FEATURE_FACET && pir_polytope_facet_size(polytope, feature.index) <= CORNERS) {
        pir_polytope_facet(polytope, feature.index, vertex);
        ret->count = pir_polytope_facet_size(polytope, feature.index);
    }
    for (uint32_t k = 0; k < ret->count; k++)
        ret->at[k] = pir_polytope_vertex(polytope, vertex[k]);
}

/* Whether the ball and a triangle of points of D cover t. */
static bool triangle_covers(const pir_carrying *c, pir_vec3 s0, pir_vec3 s1, pir_vec3 s2) {
    pir_vec3 x = pir_vec_sub(c->turned->t, c->centre);
    pir_vec3 a = pir_vec_sub(s0, c->centre), b = pir_vec_sub(s1, c->centre), d = pir_vec_sub(s2, c->centre);
    // x as a sum of the three corners, up to a factor: the weights of the point where the ray meets the plane
    double w0 = pir_vec_dot(x, pir_vec_cross(b, d)), w1 = pir_vec_dot(x, pir_vec_cross(d, a));
    double w2 = pir_vec_dot(x, pir_vec_cross(a, b));
    if (w0 + w1 + w2 < 0) {
        w0 = -w0;
        w1 = -w1;
        w2 = -w2;
    }
    w0 = fmax(w0, 0);
    w1 = fmax(w1, 0);
    w2 = fmax(w2, 0);
    double sum = w0 + w1 + w2;
    if (!(sum > 0) || !isfinite(sum))
        return false;
    pir_vec3 mean = pir_vec_add(pir_vec_scale(a, w0 / sum), pir_vec_scale(b, w1 / sum));
    return pir_carry_covers(c, pir_vec_add(c->centre, pir_vec_add(mean, pir_vec_scale(d, w2 / sum))));
}

/* The triangles from the first of `count` points of D, which stand in order round a polygon. */
static bool polygon_covers(const pir_carrying *c, const pir_vec3 *at, uint32_t count) {
    if (count == 1)
        return pir_carry_covers(c, at[0]);
    if (count == 2)
        return triangle_covers(c, at[0], at[1], at[1]) || pir_carry_covers(c, at[0]) || pir_carry_covers(c, at[1]);
    for (uint32_t k = 1; k + 1 < count; k++)
        if (triangle_covers(c, at[0], at[k], at[k + 1]))
            return true;
    return false;
}

static bool faces_cover(const pir_carrying *c, pir_witness faces) {
    face_corners p, q;
    pir_vec3 at[CORNERS];
    corners_of(c->p->polytope, faces.p, &p);
    corners_of(c->q->polytope, faces.q, &q);
    if (p.count == 0 || q.count == 0)
        return false;
    if (p.count == 2 && q.count == 2) {
        static const uint8_t round[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        for (int k = 0; k < 4; k++)
            at[k] = difference_point(c, p.at[round[k][0]], q.at[round[k][1]]);
        return polygon_covers(c, at, 4);
    }
    // the larger face at each corner of the smaller one
    const bool of_p = p.count >= q.count;
    const face_corners *large = of_p ? &p : &q, *small = of_p ? &q : &p;
    for (uint32_t i = 0; i < small->count; i++) {
        for (uint32_t k = 0; k < large->count; k++)
            at[k] = of_p ? difference_point(c, large->at[k], small->at[i])
                         : difference_point(c, small->at[i], large->at[k]);
        if (polygon_covers(c, at, large->count))
            return true;
    }
    return false;
}

/* --- directions --- */

/* The vertex least along a direction, and how far along. */
static double least_along(const pir_polytope *polytope, pir_vec3 direction, pir_vec3 *ret_vertex) {
    *ret_vertex = pir_polytope_vertex(polytope, 0);
    double least = pir_vec_dot(*ret_vertex, direction);
    for (uint32_t v = 1; v < pir_polytope_vertex_count(polytope); v++) {
        pir_vec3 at = pir_polytope_vertex(polytope, v);
        double along = pir_vec_dot(at, direction);
        if (along < least) {
            least = along;
            *ret_vertex = at;
        }
    }
    return least;
}

/* Tries a direction: whether it separates, and whether the corner of D farthest along it covers t. */
static void try_direction(const pir_carrying *c, pir_vec3 n, pir_proof *proof) {
    double length = sqrt(pir_vec_dot(n, n));
    if (!(length > 0) || !isfinite(length))
        return;
    n = pir_vec_scale(n, 1 / length);
    pir_vec3 p, q;
    double low = least_along(c->p->polytope, pir_mat_apply_transposed(&c->turned->a, n), &p);
    double high = -least_along(c->q->polytope, pir_vec_scale(n, -1), &q);
    double gap = low + pir_vec_dot(n, c->turned->t) - high - c->error;
    if (gap > 0) {
        proof->gap = proof->free ? fmax(proof->gap, gap) : gap;
        proof->free = true;
    } else if (!proof->blocked && c->radius > 0) {
        proof->blocked = pir_carry_covers(c, difference_point(c, p, q));
    }
}

void pir_carry(const pir_carrying *c, const pir_mat3 *slice, pir_witness faces, pir_vec3 normal, pir_proof *proof) {
    // the normal as it is, as Q's facets keep it, and turned with P
    try_direction(c, normal, proof);
    pir_vec3 turned = pir_mat_apply(&c->turned->a, pir_mat_apply_transposed(slice, normal));
    if (!proof->free && !proof->blocked)
        try_direction(c, turned, proof);
    if (!proof->free && !proof->blocked && faces.p.kind == PIR_FEATURE_EDGE && faces.q.kind == PIR_FEATURE_EDGE) {
        face_corners p, q;
        corners_of(c->p->polytope, faces.p, &p);
        corners_of(c->q->polytope, faces.q, &q);
        pir_vec3 e = pir_mat_apply(&c->turned->a, pir_vec_sub(p.at[1], p.at[0])), g = pir_vec_sub(q.at[1], q.at[0]);
        pir_vec3 across = pir_vec_cross(e, g);
        try_direction(c, pir_vec_scale(across, pir_vec_dot(across, normal) < 0 ? -1 : 1), proof);
    }
    if (!proof->free && !proof->blocked && c->radius > 0)
        proof->blocked = faces_cover(c, faces);
}
