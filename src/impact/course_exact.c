/* SPDX-License-Identifier: MIT */
/*
 * Conditions in integers: all points on one scale, normals as cross products of edges.
 *
 * The numbers are those of course.c up to positive factors.
 */
#include <pirouette/exact.h>

#include <stdlib.h>

#include "base/memory.h"
#include "exact/rotation.h"
#include "impact/course.h"
#include "impact/pair_impact.h"

#define WORK_NUMBERS (sizeof(pir_course_work) / sizeof(mpz_t))

/* --- making --- */

/* A body's rotation with its scale: points are m·v/divisor of the integers v that the polytope has. */
typedef struct turned_body {
    mpz_t m[9], divisor;
} turned_body;

/* A view of an integer, read only, valid while that is. */
static mpz_srcptr viewed(mpz_t view, const pir_int *a) {
    return mpz_roinit_n(view, a->limb, a->size);
}

static void turned_body_init(turned_body *body, const pir_polytope *polytope, pir_quat q) {
    pir_rotation rotation;
    pir_rotation_integers integers;
    mpz_t view, common;
    pir_rotation_set_given(&rotation, q);
    rotation.integers = &integers;
    pir_rotation_make_exact(&rotation);
    mpz_init_set(body->divisor, viewed(view, &integers.norm));
    mpz_init_set(common, body->divisor);
    for (int i = 0; i < 9; i++) {
        mpz_init_set(body->m[i], viewed(view, &integers.m[i / 3][i % 3]));
        mpz_gcd(common, common, body->m[i]);
    }
    mpz_divexact(body->divisor, body->divisor, common);
    mpz_mul(body->divisor, body->divisor, viewed(view, &polytope->scale.den));
    for (int i = 0; i < 9; i++) {
        mpz_divexact(body->m[i], body->m[i], common);
        mpz_mul(body->m[i], body->m[i], viewed(view, &polytope->scale.num));
    }
    mpz_clear(common);
}

static void turned_body_clear(turned_body *body) {
    for (int i = 0; i < 9; i++)
        mpz_clear(body->m[i]);
    mpz_clear(body->divisor);
}

/* dst = x·by, which is an integer. */
static void times_double(mpz_t dst, double x, const mpz_t by) {
    int e;
    mpz_mul_ui(dst, by, (unsigned long)pir_double_split(x, &e));
    if (e >= 0)
        mpz_mul_2exp(dst, dst, (mp_bitcnt_t)e);
    else
        mpz_tdiv_q_2exp(dst, dst, (mp_bitcnt_t)-e);
    if (x < 0)
        mpz_neg(dst, dst);
}

static uint32_t greater(uint32_t a, size_t b) {
    return a > b ? a : (uint32_t)b;
}

/* Room for a body's points: each is a sum of four, three of them products. */
static bool make_block(pir_course *course, int which, const turned_body *body, mpz_t *move) {
    const pir_polytope *polytope = course->body[which];
    uint32_t limbs = 0;
    for (int i = 0; i < 9; i++)
        limbs = greater(limbs, mpz_size(body->m[i]));
    limbs += polytope->exact_vertex.stride;
    for (int j = 0; j < 3; j++)
        limbs = greater(limbs, mpz_size(move[j]));
    return pir_vectors_init(&course->exact.points[which], course->allocator, polytope->vertex_count, limbs + 1);
}

/* Keeps a number as coordinate i of a body's points. */
static void keep_point(pir_course *course, int which, size_t i, const mpz_t at) {
    pir_vectors *block = &course->exact.points[which];
    mp_limb_t *limb = block->limb + i * block->stride;
    const size_t size = mpz_size(at);
    if (size > 0)
        mpn_copyi(limb, mpz_limbs_read(at), (mp_size_t)size);
    mpz_roinit_n(course->exact.point[which][i], limb, mpz_sgn(at) * (mp_size_t)size);
}

/*
 * The points of a body, relative to the pivot, times the common denominator. The matrix is lost. False when out of
 * memory.
 */
static bool make_points(pir_course *course, int which, turned_body *body, const mpz_t common) {
    const pir_polytope *polytope = course->body[which];
    const pir_vec3 t = course->pose[which].translation, pivot = course->pivot;
    mpz_t move[3], factor, at, view;
    mpz_inits(factor, at, NULL);
    mpz_divexact(factor, common, body->divisor);
    for (int i = 0; i < 9; i++)
        mpz_mul(body->m[i], body->m[i], factor);
    for (int j = 0; j < 3; j++) {
        mpz_init(move[j]);
        times_double(move[j], pir_vec_component(t, j), common);
        times_double(factor, pir_vec_component(pivot, j), common);
        mpz_sub(move[j], move[j], factor);
    }
    const bool made = make_block(course, which, body, move);
    for (uint32_t i = 0; made && i < polytope->vertex_count; i++) {
        const pir_int3 v = pir_vertex_exact(polytope, i);
        for (int j = 0; j < 3; j++) {
            mpz_set(at, move[j]);
            for (int k = 0; k < 3; k++)
                if (mpz_sgn(body->m[3 * j + k]) != 0)
                    mpz_addmul(at, body->m[3 * j + k], viewed(view, &v.c[k]));
            keep_point(course, which, 3 * (size_t)i + (size_t)j, at);
        }
    }
    mpz_clears(move[0], move[1], move[2], factor, at, NULL);
    return made;
}

static void make_axis(pir_course *course) {
    pir_course_integers *exact = &course->exact;
    const double u[3] = {course->axis.x, course->axis.y, course->axis.z};
    int low = INT32_MAX;
    for (int k = 0; k < 3; k++)
        low = pir_double_low_bit(u[k]) < low ? pir_double_low_bit(u[k]) : low;
    exact->exponent = course->turns ? low : 0;
    mpz_init_set_ui(exact->square, 0);
    for (int k = 0; k < 3; k++) {
        mpz_init(exact->axis[k]);
        if (!course->turns || u[k] == 0)
            continue;
        int e;
        const uint64_t mantissa = pir_double_split(u[k], &e);
        mpz_set_ui(exact->axis[k], (unsigned long)mantissa);
        if (e >= low)
            mpz_mul_2exp(exact->axis[k], exact->axis[k], (mp_bitcnt_t)(e - low));
        else
            mpz_tdiv_q_2exp(exact->axis[k], exact->axis[k], (mp_bitcnt_t)(low - e));
        if (u[k] < 0)
            mpz_neg(exact->axis[k], exact->axis[k]);
        mpz_addmul(exact->square, exact->axis[k], exact->axis[k]);
    }
}

/* The k of a screw's end. */
static void make_end(pir_course *course) {
    pir_course_integers *exact = &course->exact;
    int e;
    mpz_set_ui(exact->end, (unsigned long)pir_double_split(course->end_kappa, &e));
    e -= exact->exponent;
    exact->end_shift = (mp_bitcnt_t)(e < 0 ? -e : 0);
    mpz_mul_2exp(exact->end, exact->end, (mp_bitcnt_t)(e > 0 ? e : 0));
}

/*
 * Room for comparisons: with coordinates of b bits and an axis of a, normals have 2b + 4, those of sides 3b + 8, their
 * quadratics 4b + 2a + 16. Ends of motions are doubles, of up to 2200 bits in units of k.
 */
static bool make_room(pir_course *course) {
    pir_course_integers *exact = &course->exact;
    size_t b = 1, a = 1;
    for (int which = 0; which < 2; which++)
        for (size_t i = 0; i < 3 * (size_t)course->body[which]->vertex_count; i++)
            b = mpz_sizeinbase(exact->point[which][i], 2) > b ? mpz_sizeinbase(exact->point[which][i], 2) : b;
    for (int k = 0; k < 3; k++) {
        b = mpz_sizeinbase(exact->way[k], 2) > b ? mpz_sizeinbase(exact->way[k], 2) : b;
        a = mpz_sizeinbase(exact->axis[k], 2) > a ? mpz_sizeinbase(exact->axis[k], 2) : a;
    }
    uint32_t limbs = (uint32_t)((4 * b + 2 * a + 16) / GMP_NUMB_BITS + 2);
    const uint32_t least = pir_double_power_limbs(abs(exact->exponent));
    limbs = limbs > least ? limbs : least;
    exact->double_limbs = least;
    const uint32_t room = PIR_QUADRATIC_SCRATCH(limbs) + 3 * limbs;
    exact->limbs = PIR_NEW(course->allocator, mp_limb_t, room);
    exact->scratch = (pir_limbs){exact->limbs, 0, room};
    return exact->limbs != NULL;
}

static void free_integers(pir_course *course) {
    pir_course_integers *exact = &course->exact;
    for (int which = 0; which < 2; which++) {
        pir_vectors_finish(&exact->points[which], course->allocator);
        PIR_FREE(course->allocator, exact->point[which], 3 * (size_t)course->body[which]->vertex_count);
    }
    for (int k = 0; k < 3; k++)
        mpz_clears(exact->way[k], exact->axis[k], exact->root[k], exact->best[k], exact->other[k], NULL);
    mpz_clears(exact->square, exact->end, NULL);
    mpz_t *work = (mpz_t *)&exact->work;
    for (size_t i = 0; i < WORK_NUMBERS; i++)
        mpz_clear(work[i]);
    pir_cubic_clear(&exact->cubic);
    pir_cubic_root_clear(&exact->cubic_root);
    if (exact->limbs != NULL)
        PIR_FREE(course->allocator, exact->limbs, exact->scratch.capacity);
}

/* The exponent of the lowest bit of all translations, the pivot and the way, at most 0. */
static int lowest_bit(const pir_course *course) {
    const pir_vec3 all[] = {course->pose[0].translation, course->pose[1].translation, course->pivot, course->way};
    int low = 0;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++) {
            const int bit = pir_double_low_bit(pir_vec_component(all[i], k));
            low = bit < low ? bit : low;
        }
    return low;
}

/* Makes the points of both bodies and the way, on their common denominator. False when out of memory. */
static bool make_scaled(pir_course *course) {
    turned_body body[2];
    mpz_t common;
    mpz_init_set_ui(common, 1);
    mpz_mul_2exp(common, common, (mp_bitcnt_t)-lowest_bit(course));
    for (int which = 0; which < 2; which++) {
        turned_body_init(&body[which], course->body[which], course->pose[which].rotation);
        mpz_lcm(common, common, body[which].divisor);
    }
    bool made = true;
    for (int which = 0; which < 2; which++) {
        made = made && make_points(course, which, &body[which], common);
        turned_body_clear(&body[which]);
    }
    for (int k = 0; k < 3; k++)
        times_double(course->exact.way[k], pir_vec_component(course->way, k), common);
    mpz_clear(common);
    return made;
}

pir_status pir_course_integers_make(pir_course *course) {
    if (course->has_integers)
        return PIR_OK;
    pir_course_integers *exact = &course->exact;
    exact->limbs = NULL;
    for (int which = 0; which < 2; which++) {
        exact->points[which] = (pir_vectors){0};
        exact->point[which] = PIR_NEW(course->allocator, mpz_t, 3 * (size_t)course->body[which]->vertex_count);
    }
    for (int k = 0; k < 3; k++)
        mpz_inits(exact->way[k], exact->root[k], exact->best[k], exact->other[k], NULL);
    mpz_t *work = (mpz_t *)&exact->work;
    for (size_t i = 0; i < WORK_NUMBERS; i++)
        mpz_init(work[i]);
    make_axis(course);
    mpz_init(exact->end);
    pir_cubic_init(&exact->cubic);
    pir_cubic_root_init(&exact->cubic_root);
    if (course->screws)
        make_end(course);
    const bool made = exact->point[0] != NULL && exact->point[1] != NULL && make_scaled(course) && make_room(course);
    if (!made)
        free_integers(course);
    course->has_integers = made;
    return made ? PIR_OK : PIR_ERR_MEMORY;
}

void pir_course_finish(pir_course *course) {
    for (int which = 0; which < 2; which++) {
        const pir_polytope *body = course->body[which];
        PIR_FREE(course->allocator, course->point[which],
                 (size_t)body->vertex_count + body->facet_count + body->edge_count);
    }
    if (course->has_integers)
        free_integers(course);
}

/* --- conditions --- */

static void add_times(mpz_t dst, const mpz_t a, int by) {
    if (by >= 0)
        mpz_addmul_ui(dst, a, (unsigned long)by);
    else
        mpz_submul_ui(dst, a, (unsigned long)-by);
}

static void dot(mpz_t dst, mpz_t *a, mpz_t *b) {
    mpz_mul(dst, a[0], b[0]);
    mpz_addmul(dst, a[1], b[1]);
    mpz_addmul(dst, a[2], b[2]);
}

/* dst is neither a nor b. */
static void cross(mpz_t *dst, mpz_t *a, mpz_t *b) {
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(dst[k], a[i], b[j]);
        mpz_submul(dst[k], a[j], b[i]);
    }
}

static mpz_t *point_of(const pir_course *course, int which, uint32_t v) {
    return &course->exact.point[which][3 * (size_t)v];
}

static void half_of(const pir_course *course, int which, uint32_t half, mpz_t *dst) {
    const pir_polytope *body = course->body[which];
    mpz_t *a = point_of(course, which, body->origin[half]), *b = point_of(course, which, body->target[half]);
    for (int k = 0; k < 3; k++)
        mpz_sub(dst[k], b[k], a[k]);
}

/* Outwards: of two halfedges of its loop. */
static void normal_of(pir_course *course, int which, uint32_t facet, mpz_t *dst) {
    const pir_polytope *body = course->body[which];
    const uint32_t *loop = &body->loop[body->loop_start[facet]];
    pir_course_work *work = &course->exact.work;
    half_of(course, which, loop[0], work->first);
    half_of(course, which, loop[1], work->second);
    cross(dst, work->first, work->second);
}

/* Adds by·(y·R x). */
static void add_product(pir_course *course, mpz_t *c, mpz_t *x, mpz_t *y, int by) {
    pir_course_integers *exact = &course->exact;
    pir_course_work *work = &exact->work;
    dot(work->x, x, y);
    add_times(c[0], work->x, by);
    if (!course->turns)
        return;
    cross(work->turned, exact->axis, x);
    dot(work->y, work->turned, y);
    add_times(c[1], work->y, 2 * by);
    dot(work->y, exact->axis, x);
    dot(work->z, exact->axis, y);
    mpz_mul(work->y, work->y, work->z);
    add_times(c[2], work->y, 2 * by);
    mpz_mul(work->x, work->x, exact->square);
    add_times(c[2], work->x, -by);
}

/* `rest`: of a screw, what λ = κ₁/κ is multiplied by. */
static void exact_of_plane(pir_course *course, const pir_condition *on, mpz_t c[3], mpz_t *rest) {
    const bool of_q = on->kind == PIR_Q_PLANE || on->kind == PIR_Q_SIDE;
    const bool is_side = on->kind == PIR_Q_SIDE || on->kind == PIR_P_SIDE;
    const int own = of_q;
    const pir_polytope *body = course->body[own];
    const uint32_t face = of_q ? on->q : on->p, v = of_q ? on->p : on->q;
    const uint32_t base = body->origin[is_side ? face : body->loop[body->loop_start[face]]];
    pir_course_work *work = &course->exact.work;
    mpz_t *n = work->a;
    mpz_ptr h = work->h;
    normal_of(course, own, is_side ? body->left[face] : face, n);
    if (is_side) {
        half_of(course, own, face, work->b);
        cross(work->other, work->b, n);
        n = work->other;
    } else {
        for (int k = 0; k < 3; k++)
            mpz_neg(n[k], n[k]);
    }
    if (of_q)
        add_product(course, c, point_of(course, 0, v), n, 1);
    else
        add_product(course, c, n, point_of(course, 1, v), 1);
    dot(h, n, point_of(course, own, base));
    mpz_sub(c[0], c[0], h);
    if (course->turns)
        mpz_submul(c[2], h, course->exact.square);
    dot(h, n, course->exact.way);
    if (!course->turns)
        add_times(c[1], h, of_q ? 1 : -1);
    if (rest && of_q) {
        mpz_set(rest[0], h);
        mpz_mul(rest[2], h, course->exact.square);
    } else if (rest) {
        add_product(course, rest, n, course->exact.way, -1);
    }
}

static void exact_of_edges(pir_course *course, const pir_condition *on, mpz_t c[3], mpz_t *rest) {
    const pir_polytope *p = course->body[0], *q = course->body[1];
    pir_course_work *work = &course->exact.work;
    mpz_t *e = work->a, *f = work->b, *other = work->other;
    half_of(course, 0, p->edge_half[on->p], e);
    half_of(course, 1, q->edge_half[on->q], f);
    if (on->kind == PIR_CROSSING) {
        const int which = on->corner < 2 ? 0 : 1;
        const pir_arc_ends ends = course->body[which]->arc_ends[which == 0 ? on->p : on->q];
        normal_of(course, which, on->corner % 2 == 0 ? ends.from : ends.to, other);
        const int by = on->corner % 2 == 0 ? on->side : -on->side;
        add_product(course, c, which == 0 ? other : e, which == 0 ? f : other, by);
    } else {
        cross(other, point_of(course, 0, p->origin[p->edge_half[on->p]]), e);
        add_product(course, c, other, f, -on->side);
        cross(other, f, point_of(course, 1, q->origin[q->edge_half[on->q]]));
        add_product(course, c, e, other, on->side);
        cross(other, f, course->exact.way);
        if (!course->turns)
            add_product(course, c + 1, e, other, -on->side);
        if (rest)
            add_product(course, rest, e, other, -on->side);
    }
}

static void make_exact(pir_course *course, const pir_condition *on, mpz_t dst[3], mpz_t *rest) {
    course->by_exact++;
    for (int k = 0; k < 3; k++)
        mpz_set_ui(dst[k], 0);
    if (on->kind == PIR_CROSSING || on->kind == PIR_EDGES)
        exact_of_edges(course, on, dst, rest);
    else
        exact_of_plane(course, on, dst, rest);
}

void pir_course_exact(pir_course *course, const pir_condition *on, mpz_t dst[3]) {
    make_exact(course, on, dst, NULL);
}

void pir_course_cubic(pir_course *course, const pir_condition *on, pir_cubic *dst) {
    mpz_t *rest = course->exact.work.rest;
    for (int i = 0; i < 3; i++)
        mpz_set_ui(rest[i], 0);
    make_exact(course, on, dst->c, rest);
    mpz_set_ui(dst->c[3], 0);
    for (int i = 0; i < 3; i++)
        mpz_mul_2exp(dst->c[i], dst->c[i], course->exact.end_shift);
    for (int i = 0; i < 3; i++)
        mpz_addmul(dst->c[i + 1], course->exact.end, rest[i]);
    pir_cubic_trim(dst);
}

pir_quadratic pir_course_view(mpz_t c[3]) {
    pir_quadratic view;
    for (int k = 0; k < 3; k++)
        view.c[k] = (pir_int){(mp_limb_t *)mpz_limbs_read(c[k]), mpz_sgn(c[k]) * (int32_t)mpz_size(c[k]), 0};
    return view;
}

pir_status pir_course_polynomial(pir_course *course, const pir_condition *condition, mpz_t *dst) {
    const pir_status status = pir_course_integers_make(course);
    if (status != PIR_OK)
        return status;
    const int degree = course->screws ? 3 : 2;
    if (course->screws) {
        pir_course_cubic(course, condition, &course->exact.cubic);
        for (int k = 0; k < 4; k++)
            mpz_set(dst[k], course->exact.cubic.c[k]);
    } else {
        pir_course_exact(course, condition, dst);
    }
    if (!course->turns) { // κ is a factor
        mpz_swap(dst[1], dst[2]);
        mpz_swap(dst[0], dst[1]);
    }
    // from k = κ·2^-e to κ
    const int e = course->exact.exponent;
    for (int k = 0; k <= degree; k++)
        mpz_mul_2exp(dst[k], dst[k], (mp_bitcnt_t)(e > 0 ? k * e : (degree - k) * -e));
    mpz_t common;
    mpz_init(common);
    for (int k = 0; k <= degree; k++)
        mpz_gcd(common, common, dst[k]);
    for (int k = 0; k <= degree; k++)
        mpz_divexact(dst[k], dst[k], common);
    mpz_clear(common);
    return PIR_OK;
}

pir_status pir_pair_impact_exact(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                 const pir_exact_motion *motion, pir_exact_impact *ret_impact,
                                 mpz_t *ret_coefficients) {
    if (ret_coefficients == NULL)
        return PIR_ERR_ARGUMENT;
    const pir_status status = pir_pair_impact_run(pair, workspace, input, motion, ret_impact, ret_coefficients);
    if (status != PIR_OK)
        return status;
    const int count = pir_exact_motion_screws(motion) ? 4 : 3;
    int first = 0;
    while (first < count - 1 && mpz_sgn(ret_coefficients[first]) == 0)
        first++;
    if (mpz_sgn(ret_coefficients[first]) < 0)
        for (int k = 0; k < count; k++)
            mpz_neg(ret_coefficients[k], ret_coefficients[k]);
    return PIR_OK;
}
