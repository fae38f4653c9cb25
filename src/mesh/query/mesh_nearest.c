/* SPDX-License-Identifier: MIT */
/*
 * The nearest point of a surface. Doubles bound the distance of each triangle; of two whose bounds overlap, the same
 * feature says that they are as near, and exact squares decide the rest.
 */
#include <string.h>

#include "mesh/query/mesh_walk.h"
#include "mesh/signs/exact_distance.h"
#include "mesh/signs/triangle_span.h"

/* Limbs of a coordinate, 2^60 down to 2^-1074; of a square's parts; of all that is computed. */
#define COORDINATE (1136 / GMP_NUMB_BITS + 3)
#define SQUARE     PIR_EXACT_SQUARE_LIMBS(COORDINATE)
#define WORK       PIR_EXACT_WORK_LIMBS(COORDINATE)

struct mesh_nearest {
    pir_surface_ref surface;
    pir_vec3 point;
    double error; /* of a coordinate: see pir_triangle_span */
    double cutoff;
    uint32_t best; /* PIR_TRIANGLE_NONE: the cutoff is to be beaten */
    pir_span span;
    double most;
};

/* An exact square, and the room of its parts. */
struct square {
    pir_exact_square square;
    mp_limb_t room[2][SQUARE];
};

static void init_square(struct square *s) {
    s->square.num = (pir_int){s->room[0], 0, SQUARE};
    s->square.den = (pir_int){s->room[1], 0, SQUARE};
}

static double at(pir_vec3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* A lower bound on the distance of each box: a few roundings less than what doubles say. */
static void measure(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    const struct mesh_nearest *n = context;
    double square[PIR_MESH_WIDTH] = {0, 0, 0, 0};
    for (int k = 0; k < 3; k++) {
        double x = at(n->point, k);
        for (int i = 0; i < PIR_MESH_WIDTH; i++) {
            double under = (double)boxes->low[k][i] - x, over = x - (double)boxes->high[k][i];
            double away = under > over ? under : over;
            square[i] += away > 0 ? away * away : 0;
        }
    }
    for (int i = 0; i < PIR_MESH_WIDTH; i++)
        ret_near[i] = sqrt(square[i]) * (1 - 0x1p-48);
}

static pir_span span_of(const struct mesh_nearest *n, const pir_met_triangle *met) {
    pir_corners a = {{met->tri.p[0], met->tri.p[1], met->tri.p[2]}, {met->id[0], met->id[1], met->id[2]}, 3};
    pir_corners b = {{n->point, n->point, n->point}, {0, 0, 0}, 1};
    return pir_triangle_span(&a, &b, n->error);
}

static int low_bit(const struct mesh_nearest *n, const pir_tri *tri, const pir_tri *other) {
    int low = pir_vec_low_bit(n->point);
    for (int k = 0; k < 3; k++) {
        int a = pir_vec_low_bit(tri->p[k]), b = pir_vec_low_bit(other->p[k]);
        low = a < low ? a : low;
        low = b < low ? b : low;
    }
    return low;
}

static void square_of(const struct mesh_nearest *n, const pir_tri *tri, int exponent, pir_limbs *limbs,
                      struct square *s) {
    uint32_t used = limbs->used;
    pir_int3 a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = pir_num3_doubles(limbs, tri->p[k], exponent);
        b[k] = pir_num3_doubles(limbs, n->point, exponent);
    }
    init_square(s);
    pir_exact_distance(limbs, a, b, &s->square);
    limbs->used = used;
}

/* The sign of the distance of one triangle less that of another, exactly. */
static int order_of(const struct mesh_nearest *n, const pir_tri *tri, const pir_tri *other) {
    mp_limb_t room[WORK];
    pir_limbs limbs = {room, 0, WORK};
    struct square mine, others;
    int exponent = low_bit(n, tri, other);
    square_of(n, tri, exponent, &limbs, &mine);
    square_of(n, other, exponent, &limbs, &others);
    return pir_exact_square_order(&limbs, &mine.square, &others.square);
}

/* Whether a triangle is within the cutoff, exactly. */
static bool is_within(const struct mesh_nearest *n, const pir_tri *tri) {
    mp_limb_t room[WORK];
    pir_limbs limbs = {room, 0, WORK};
    struct square mine;
    int exponent = low_bit(n, tri, tri), low = pir_double_low_bit(n->cutoff);
    exponent = low < exponent ? low : exponent;
    square_of(n, tri, exponent, &limbs, &mine);
    pir_int cutoff = pir_num_double(&limbs, n->cutoff, exponent), square = pir_num_mul(&limbs, &cutoff, &cutoff);
    pir_int scaled = pir_num_mul(&limbs, &square, &mine.square.den);
    return pir_num_compare(&limbs, &mine.square.num, &scaled) <= 0;
}

static bool is_better(const struct mesh_nearest *n, const pir_met_triangle *met, const pir_span *span) {
    if (n->best == PIR_TRIANGLE_NONE)
        return span->high <= n->cutoff || (span->low <= n->cutoff && is_within(n, &met->tri));
    if (span->high < n->span.low)
        return true;
    if (pir_same_features(span, &n->span))
        return met->number < n->best;
    pir_tri other = pir_surface_tri(n->surface, n->best);
    int order = order_of(n, &met->tri, &other);
    return order < 0 || (order == 0 && met->number < n->best);
}

/* Whether the direction to the best point so far shows a triangle to be farther than that. */
static bool is_behind(const struct mesh_nearest *n, const pir_tri *tri) {
    pir_vec3 to = pir_vec_sub(n->span.point_a, n->point);
    double square = pir_vec_dot(to, to), least = HUGE_VAL;
    if (n->best == PIR_TRIANGLE_NONE || !(square > 0x1p-900))
        return false;
    for (int k = 0; k < 3; k++) {
        double along = pir_vec_dot(to, pir_vec_sub(tri->p[k], n->point));
        least = along < least ? along : least;
    }
    return least / sqrt(square) * (1 - 0x1p-48) - 16 * n->error > n->most;
}

static bool look(void *context, const pir_met_triangle *met) {
    struct mesh_nearest *n = context;
    if (is_behind(n, &met->tri))
        return true;
    pir_span span = span_of(n, met);
    if (span.low <= n->most && is_better(n, met, &span)) {
        n->best = met->number;
        n->span = span;
        n->most = span.high < n->most ? span.high : n->most;
    }
    return true;
}

pir_status pir_surface_nearest_point(pir_surface_ref surface, pir_vec3 point, double cutoff,
                                     pir_surface_nearest *ret_nearest) {
    if (!ret_nearest || pir_surface_check(surface) != PIR_OK || cutoff < 0)
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(point) || isnan(cutoff))
        return PIR_ERR_NOT_FINITE;
    if (fabs(point.x) > PIR_MESH_FARTHEST || fabs(point.y) > PIR_MESH_FARTHEST || fabs(point.z) > PIR_MESH_FARTHEST)
        return PIR_ERR_LIMIT;
    double reach[3], size = 0;
    pir_surface_reach(surface, reach);
    for (int k = 0; k < 3; k++)
        size = fmax(size, fmax(reach[k], fabs(at(point, k))));
    // what is farther than any surface can be is no cutoff
    double farthest = fmin(cutoff, 0x1p63);
    struct mesh_nearest n = {.surface = surface,
                             .point = point,
                             .error = 0x1p-49 * size,
                             .cutoff = farthest,
                             .best = PIR_TRIANGLE_NONE,
                             .most = farthest};
    pir_surface_walk(surface, &(pir_walk){measure, look, &n, &n.most, NULL});
    *ret_nearest = (pir_surface_nearest){.triangle = n.best};
    if (n.best == PIR_TRIANGLE_NONE)
        return PIR_OK;
    pir_vec3 away = pir_vec_sub(n.span.point_a, point);
    ret_nearest->material = pir_surface_material(surface, n.best);
    ret_nearest->distance = sqrt(pir_vec_dot(away, away));
    ret_nearest->point = n.span.point_a;
    return PIR_OK;
}
