/* SPDX-License-Identifier: MIT */
/* Exact orientation of integer points behind a double filter. The proof of its bound stands in orient.h. */
#include "polytope/hull/orient.h"

#include <math.h>

/* dst = point p − point a. */
static void difference(const pir_points *points, pir_int3 *dst, uint32_t p, uint32_t a) {
    pir_int3 vp = pir_vectors_at(points->exact, pir_points_source(points, p)),
             va = pir_vectors_at(points->exact, pir_points_source(points, a));
    for (int k = 0; k < 3; k++)
        pir_int_sub(&dst->c[k], &vp.c[k], &va.c[k]);
}

/*
 * Fills `near` along one axis: differences from the first point as mantissa and exponent, then all by the greatest
 * exponent.
 */
static void approximate_axis(pir_points *points, int axis, double *mantissa, int *exponent) {
    uint32_t count = points->exact->count, mark = points->scratch.used;
    pir_int3 d = pir_int3_take(&points->scratch, points->exact->stride + 1);
    int top = 0;
    bool any = false;
    for (uint32_t p = 0; p < count; p++) {
        difference(points, &d, p, 0);
        mantissa[p] = pir_int_to_double(&d.c[axis], &exponent[p]);
        if (mantissa[p] != 0 && (!any || exponent[p] > top)) {
            top = exponent[p];
            any = true;
        }
    }
    points->scratch.used = mark;
    for (uint32_t p = 0; p < count; p++) {
        double x = mantissa[p] != 0 ? ldexp(mantissa[p], exponent[p] - top) : 0;
        *(axis == 0 ? &points->near[p].x : axis == 1 ? &points->near[p].y : &points->near[p].z) = x;
    }
}

/* Doubles of all points on all axes; false when out of memory. */
static bool approximate(pir_points *points, const pir_allocator *allocator) {
    uint32_t count = points->exact->count;
    double *mantissa = PIR_NEW(allocator, double, count);
    int *exponent = PIR_NEW(allocator, int, count);
    bool done = mantissa && exponent;
    for (int axis = 0; done && axis < 3; axis++)
        approximate_axis(points, axis, mantissa, exponent);
    PIR_FREE(allocator, mantissa, count);
    PIR_FREE(allocator, exponent, count);
    return done;
}

/* A power of two as a product, so that each factor is a normal number. */
struct power {
    double one, other;
};

/* The power of two that brings a magnitude below 1, and near it. */
static struct power power_below(double most) {
    int top;
    frexp(most, &top);
    return (struct power){ldexp(1, -(top / 2)), ldexp(1, -(top - top / 2))};
}

static double times(double x, struct power power) {
    return x * power.one * power.other;
}

/*
 * Fills `near` from doubles: a difference rounds once, by 2^-53 of itself, and scaling rounds only what is below
 * 2^-1022 of the greatest. False where a difference may overflow.
 */
static bool approximate_doubles(pir_points *points, const pir_vec3 *doubles) {
    uint32_t count = points->exact->count;
    pir_vec3 most = {0, 0, 0};
    for (uint32_t p = 0; p < count; p++) {
        pir_vec3 d = pir_vec_sub(doubles[p], doubles[0]);
        most = (pir_vec3){fmax(most.x, fabs(d.x)), fmax(most.y, fabs(d.y)), fmax(most.z, fabs(d.z))};
        points->near[p] = d;
    }
    if (!pir_vec_is_finite(most))
        return false;
    struct power x = power_below(most.x), y = power_below(most.y), z = power_below(most.z);
    for (uint32_t p = 0; p < count; p++) {
        pir_vec3 d = points->near[p];
        points->near[p] = (pir_vec3){times(d.x, x), times(d.y, y), times(d.z, z)};
    }
    return true;
}

bool pir_points_init(pir_points *points, const pir_allocator *allocator, const pir_vectors *exact,
                     const pir_vec3 *doubles) {
    /*
     * With d = stride + 1 limbs for a difference, pir_orient_exact, which takes most, holds three differences (9 d),
     * their cross product (3 (2 d + 1)), a dot product (3 d + 2), and on the way to it one product of a component of
     * each (3 d + 1): 21 d + 6.
     */
    uint32_t limbs = 21 * (exact->stride + 1) + 6;
    *points = (pir_points){.exact = exact};
    points->near = PIR_NEW(allocator, pir_vec3, exact->count);
    points->scratch = (pir_limbs){PIR_NEW(allocator, mp_limb_t, limbs), 0, limbs};
    bool done = points->near && points->scratch.base;
    if (done && !(doubles && approximate_doubles(points, doubles)))
        done = approximate(points, allocator);
    if (!done)
        pir_points_finish(points, allocator);
    return done;
}

void pir_points_finish(pir_points *points, const pir_allocator *allocator) {
    if (!points->exact)
        return;
    PIR_FREE(allocator, points->near, points->exact->count);
    PIR_FREE(allocator, points->source, points->exact->count);
    PIR_FREE(allocator, points->scratch.base, points->scratch.capacity);
    *points = (pir_points){0};
}

pir_hull_plane pir_plane_through(const pir_points *points, uint32_t a, uint32_t b, uint32_t c) {
    pir_vec3 origin = points->near[a];
    pir_vec3 ab = pir_vec_sub(points->near[b], origin), ac = pir_vec_sub(points->near[c], origin);
    return (pir_hull_plane){origin, pir_vec_cross(ab, ac)};
}

int pir_orient_exact(pir_points *points, uint32_t a, uint32_t b, uint32_t c, uint32_t p) {
    pir_limbs *scratch = &points->scratch;
    uint32_t mark = scratch->used, limbs = points->exact->stride + 1;
    pir_int3 ab = pir_int3_take(scratch, limbs), ac = pir_int3_take(scratch, limbs), ap = pir_int3_take(scratch, limbs);
    difference(points, &ab, b, a);
    difference(points, &ac, c, a);
    difference(points, &ap, p, a);
    pir_int3 normal = pir_int3_take(scratch, 2 * limbs + 1);
    pir_int3_cross(&normal, &ab, &ac, scratch);
    pir_int height = pir_limbs_take(scratch, 3 * limbs + 2);
    pir_int3_dot(&height, &normal, &ap, scratch);
    scratch->used = mark;
    return pir_int_sign(&height);
}

int pir_orient(pir_points *points, uint32_t a, uint32_t b, uint32_t c, uint32_t p) {
    pir_hull_plane plane = pir_plane_through(points, a, b, c);
    double height = pir_plane_height(&plane, points, p);
    if (fabs(height) > PIR_ORIENT_BOUND)
        return height > 0 ? 1 : -1;
    return pir_orient_exact(points, a, b, c, p);
}

int pir_turn(pir_points *points, int axis, uint32_t a, uint32_t b, uint32_t c) {
    // the filter: a component of the plane's normal, whose error is below 49·2^-53
    double near = pir_vec_component(pir_plane_through(points, a, b, c).normal, axis);
    if (fabs(near) > 0x1p-47)
        return near > 0 ? 1 : -1;
    pir_limbs *scratch = &points->scratch;
    uint32_t mark = scratch->used, limbs = points->exact->stride + 1;
    pir_int3 ab = pir_int3_take(scratch, limbs), ac = pir_int3_take(scratch, limbs);
    difference(points, &ab, b, a);
    difference(points, &ac, c, a);
    int i = (axis + 1) % 3, j = (axis + 2) % 3;
    pir_int turn = pir_limbs_take(scratch, 2 * limbs + 1);
    pir_int_mul(&turn, &ab.c[i], &ac.c[j]);
    pir_int_sub_mul(&turn, &ab.c[j], &ac.c[i], scratch);
    scratch->used = mark;
    return pir_int_sign(&turn);
}

int pir_steepest_axis(pir_points *points, uint32_t a, uint32_t b, uint32_t c) {
    pir_hull_plane plane = pir_plane_through(points, a, b, c);
    double n[3] = {fabs(plane.normal.x), fabs(plane.normal.y), fabs(plane.normal.z)};
    int best = n[0] >= n[1] && n[0] >= n[2] ? 0 : n[1] >= n[2] ? 1 : 2;
    for (int k = 0; k < 3; k++)
        if (pir_turn(points, (best + k) % 3, a, b, c) != 0)
            return (best + k) % 3;
    return -1;
}

bool pir_collinear(pir_points *points, uint32_t a, uint32_t b, uint32_t c) {
    return pir_steepest_axis(points, a, b, c) < 0;
}
