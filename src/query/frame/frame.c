/* SPDX-License-Identifier: MIT */
/*
 * The frame that queries compute in: bodies about their middles, scaled by a power of two.
 *
 * Differences of vertices are taken in exact integers and rounded once, so a body 1e7 away from its origin is known as well as one at it;
 * the distance of the two middles is kept in double-double, and so is the translation's.
 */
#include "query/query.h"

#include <limits.h>
#include <stdlib.h>

#include "polytope/polytope.h"

/* Bodies and translations farther from their origins than this, in units of the frame, are refused: the arithmetic would overflow. */
#define FARTHEST 0x1p400

/* What double-double may be off by in a placement, relative to how far from their origins the bodies and the translation are: sixteen times over. */
#define FAR_ERROR 0x1p-96

/* a · num/den as m · 2^*ret_exponent. */
static double scaled(const pir_int *a, const pir_scale *scale, int *ret_exponent) {
    int e, num, den;
    double m = pir_int_to_double(a, &e);
    double n = pir_int_to_double(&scale->num, &num), d = pir_int_to_double(&scale->den, &den);
    *ret_exponent = e + num - den;
    return m * (n / d);
}

/* Component k of vertex v less vertex 0, as m · 2^*ret_exponent, through `room` of a vertex's limbs and one. */
static double from_first(const pir_polytope *p, uint32_t v, int k, mp_limb_t *room, int *ret_exponent) {
    pir_int3 a = pir_vertex_exact(p, v), o = pir_vertex_exact(p, 0);
    pir_int difference = {room, 0, p->exact_vertex.stride + 1};
    pir_int_sub(&difference, &a.c[k], &o.c[k]);
    return scaled(&difference, &p->scale, ret_exponent);
}

/* The greatest exponent of any difference from vertex 0; INT_MIN for a point. */
static int top_exponent(const pir_polytope *p, mp_limb_t *room) {
    int top = INT_MIN;
    for (uint32_t v = 1; v < p->vertex_count; v++)
        for (int k = 0; k < 3; k++) {
            int e;
            if (from_first(p, v, k, room, &e) != 0 && e > top)
                top = e;
        }
    return top;
}

/* What is left of an exact coordinate when its nearest double is taken off. */
static double remainder_of(const pir_polytope *p, const pir_int *a, double nearest) {
    mpq_t exact, rounded;
    mpq_inits(exact, rounded, NULL);
    pir_scale_to_rational(exact, a, &p->scale);
    mpq_set_d(rounded, nearest);
    mpq_sub(exact, exact, rounded);
    double rest = mpq_get_d(exact);
    mpq_clears(exact, rounded, NULL);
    return rest;
}

static double component(pir_vec3 v, int k) {
    return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

/* The vertices of one operand about the middle of its bounds, its size and its middle; false when that is too far away. */
static bool place_body(const pir_query *query, const pir_polytope *p, mp_limb_t *room, pir_vec3 *vertices,
                       double *ret_size, pir_dd3 *ret_centre) {
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        double c[3];
        for (int k = 0; k < 3; k++) {
            int e;
            c[k] = from_first(p, v, k, room, &e);
            c[k] = c[k] != 0 ? ldexp(c[k], e - query->exponent) : 0;
            low[k] = fmin(low[k], c[k]);
            high[k] = fmax(high[k], c[k]);
        }
        vertices[v] = (pir_vec3){c[0], c[1], c[2]};
    }
    pir_vec3 middle = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])};
    double square = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        vertices[v] = pir_vec_sub(vertices[v], middle);
        square = fmax(square, pir_vec_dot(vertices[v], vertices[v]));
    }
    *ret_size = sqrt(square) * (1 + 0x1p-48);
    pir_int3 first = pir_vertex_exact(p, 0);
    for (int k = 0; k < 3; k++) {
        double nearest = component(p->vertex[0], k), away = ldexp(nearest, -query->exponent);
        if (!(fabs(away) < FARTHEST))
            return false;
        double rest = ldexp(remainder_of(p, &first.c[k], nearest), -query->exponent);
        ret_centre->c[k] = pir_dd_add((pir_dd){away, rest}, (pir_dd){component(middle, k), 0});
    }
    return true;
}

/* The facets' offsets; returns the body's swing: see planes.c. */
static double set_offsets(const pir_polytope *p, const pir_vec3 *vertices, double size, double *h) {
    double inner = p->dimension == 3 ? size : 0;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        h[f] = pir_vec_dot(p->normal[f], vertices[p->origin[p->loop[p->loop_start[f]]]]);
        inner = fmin(inner, fmax(0, h[f] - 0x1p-46 * size));
    }
    return sqrt(size * size - inner * inner) * (1 + 0x1p-40) + 0x1p-40 * size;
}

void pir_frame_finish(pir_query *query) {
    const pir_allocator *a = &query->allocator;
    PIR_FREE(a, query->vp, query->p->vertex_count);
    PIR_FREE(a, query->vq, query->q->vertex_count);
    PIR_FREE(a, query->hp, query->p->facet_count);
    PIR_FREE(a, query->hq, query->q->facet_count);
}

bool pir_frame_init(pir_query *query) {
    const pir_polytope *p = query->p, *q = query->q;
    const pir_allocator *a = &query->allocator;
    query->vp = PIR_NEW(a, pir_vec3, p->vertex_count);
    query->vq = PIR_NEW(a, pir_vec3, q->vertex_count);
    query->hp = PIR_NEW(a, double, p->facet_count);
    query->hq = PIR_NEW(a, double, q->facet_count);
    return query->vp && query->vq && query->hp && query->hq;
}

/*
 * Two points have no size. Where they are so near the origin, or so far from it, that squares would lose digits, their
 * coordinates give the unit.
 */
static int exponent_of_points(pir_vec3 p, pir_vec3 q) {
    double most = fmax(fmax(fmax(fabs(p.x), fabs(p.y)), fabs(p.z)), fmax(fmax(fabs(q.x), fabs(q.y)), fabs(q.z)));
    int e;
    frexp(most, &e);
    return abs(e) > 300 ? e : 0;
}

pir_status pir_frame_fill(pir_query *query) {
    const pir_polytope *p = query->p, *q = query->q;
    // the scratch of exact signs is far more than a vertex and two limbs
    mp_limb_t *room = query->scratch.base;
    int top_p = top_exponent(p, room), top_q = top_exponent(q, room);
    query->exponent = top_p > top_q ? top_p : top_q;
    if (query->exponent == INT_MIN)
        query->exponent = exponent_of_points(p->vertex[0], q->vertex[0]);
    bool normal = query->exponent > -1000 && query->exponent < 1000;
    query->up = normal ? ldexp(1, query->exponent) : 0;
    query->down = normal ? ldexp(1, -query->exponent) : 0;
    bool fits = place_body(query, p, room, query->vp, &query->size_p, &query->centre_p) &&
                place_body(query, q, room, query->vq, &query->size_q, &query->centre_q);
    if (!fits)
        return PIR_ERR_LIMIT;
    pir_landmarks_set(p, query->landmarks_p);
    pir_landmarks_set(q, query->landmarks_q);
    query->swing_p = set_offsets(p, query->vp, query->size_p, query->hp);
    query->swing_q = set_offsets(q, query->vq, query->size_q, query->hq);
    return PIR_OK;
}

/* --- the rotation --- */

/* R = M(q)/|q|² in double-double, off by a few 2^-104. */
void pir_frame_make_fine(pir_query *query) {
    if (query->has_fine)
        return;
    int top;
    double largest = fmax(fmax(fabs(query->at.x), fabs(query->at.y)), fmax(fabs(query->at.z), fabs(query->at.w)));
    frexp(largest, &top);
    const double c[4] = {ldexp(query->at.x, -top), ldexp(query->at.y, -top), ldexp(query->at.z, -top),
                         ldexp(query->at.w, -top)};
    pir_dd square[4], norm = {0, 0};
    for (int k = 0; k < 4; k++) {
        square[k] = pir_dd_two_product(c[k], c[k]);
        norm = pir_dd_add(norm, square[k]);
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        pir_dd diagonal = pir_dd_sub(pir_dd_add(square[3], square[i]), pir_dd_add(square[j], square[k]));
        query->r_fine[i].c[i] = pir_dd_divide(diagonal, norm);
        pir_dd both = pir_dd_two_product(2 * c[i], c[j]), turn = pir_dd_two_product(2 * c[3], c[k]);
        query->r_fine[i].c[j] = pir_dd_divide(pir_dd_sub(both, turn), norm);
        query->r_fine[j].c[i] = pir_dd_divide(pir_dd_add(both, turn), norm);
    }
    query->has_fine = true;
}

static bool same(pir_quat a, pir_quat b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

/* The offset of the frame: Q's middle plus P's, rotated. Near middles need no more than doubles. */
static void set_offset(pir_query *query) {
    pir_vec3 near = pir_dd3_round(query->centre_p);
    double far = fabs(near.x) + fabs(near.y) + fabs(near.z);
    if (far == 0) {
        query->offset = query->centre_q;
        return;
    }
    if (far <= 4 * (query->size_p + query->size_q)) {
        query->offset = pir_dd3_add_vec(query->centre_q, pir_mat_apply(&query->r, near));
        return;
    }
    pir_frame_make_fine(query);
    for (int i = 0; i < 3; i++) {
        pir_dd sum = query->centre_q.c[i];
        for (int j = 0; j < 3; j++)
            sum = pir_dd_add(sum, pir_dd_mul(query->r_fine[i].c[j], query->centre_p.c[j]));
        query->offset.c[i] = sum;
    }
}

void pir_frame_follow(pir_query *query) {
    const pir_rotation *now = pir_sum_exact_rotation(query->sum);
    if (query->followed && same(now->given, query->at))
        return;
    query->followed = true;
    query->at = now->given;
    query->r = now->r;
    query->has_fine = false;
    set_offset(query);
    query->exact.made = false;
    query->stamp++;
    query->planes.used = 0;
}

static double taxicab(pir_vec3 v) {
    return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

pir_status pir_frame_place(pir_query *query, pir_vec3 translation, pir_placement *ret_placement) {
    if (!pir_vec_is_finite(translation))
        return PIR_ERR_NOT_FINITE;
    pir_vec3 t = pir_vec_scale(translation, query->down);
    if (query->down == 0)
        t = (pir_vec3){ldexp(translation.x, -query->exponent), ldexp(translation.y, -query->exponent),
                       ldexp(translation.z, -query->exponent)};
    if (!(fabs(t.x) < FARTHEST && fabs(t.y) < FARTHEST && fabs(t.z) < FARTHEST))
        return PIR_ERR_LIMIT;
    ret_placement->translation = translation;
    ret_placement->fine = pir_dd3_add_vec(pir_dd3_negate(query->offset), t);
    ret_placement->x = pir_dd3_round(ret_placement->fine);
    ret_placement->reach = query->size_p + query->size_q + sqrt(pir_vec_dot(ret_placement->x, ret_placement->x));
    double far = taxicab(t) + taxicab(pir_dd3_round(query->centre_p)) + taxicab(pir_dd3_round(query->centre_q));
    ret_placement->error = PIR_SLACK_BOUND * ret_placement->reach + FAR_ERROR * far;
    return PIR_OK;
}

pir_vec3 pir_frame_world(const pir_query *query, pir_vec3 y) {
    pir_vec3 w = pir_dd3_round(pir_dd3_add_vec(query->centre_q, y));
    return (pir_vec3){pir_frame_length(query, w.x), pir_frame_length(query, w.y), pir_frame_length(query, w.z)};
}
