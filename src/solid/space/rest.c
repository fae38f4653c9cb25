/* SPDX-License-Identifier: MIT */
/*
 * See rest.h. Doubles of the rotation are within 31u of it, u = 2^-53, a kept direction is within 2^-49, and the
 * product rounds by 6u: a turned direction is within 2^-47. A turned point, no longer than √3, is within 2^-46. A
 * scale s·2^e, .5 ≤ s < 1, is exact in doubles but for s; the greater of both scales goes into the shift, so that
 * points stay in the cube.
 */
#include "solid/space/rest.h"

#include <math.h>

#include "solid/space/exact.h"

void pir_rest_init(pir_space_rest *rest, pir_space *space) {
    *rest = (pir_space_rest){.space = space, .shift = space->shift, .scale = {1, 1}};
    for (int b = 0; b < 2; b++) {
        for (int k = 0; k < 9; k++)
            mpz_init(rest->matrix[b][k]);
        mpz_init(rest->weight[b]);
        mpz_init(rest->t[b]);
        pir_intern_init(&rest->points_of[b], space, 4);
        pir_intern_init(&rest->directions_of[b], space, 3);
    }
}

void pir_rest_finish(pir_space_rest *rest) {
    pir_space *space = rest->space;
    if (!space)
        return;
    for (int b = 0; b < 2; b++) {
        for (int k = 0; k < 9; k++)
            mpz_clear(rest->matrix[b][k]);
        mpz_clear(rest->weight[b]);
        mpz_clear(rest->t[b]);
        pir_intern_finish(&rest->points_of[b]);
        pir_intern_finish(&rest->directions_of[b]);
    }
    for (uint32_t k = 0; k < rest->number_count; k++) {
        space->bytes -= (size_t)rest->number[k]->_mp_alloc * sizeof(mp_limb_t);
        mpz_clear(rest->number[k]);
    }
    PIR_FREE(&space->allocator, rest->known, PIR_REST_KNOWN);
    pir_space_shrink(space, rest->number, rest->number_room, sizeof *rest->number);
    pir_space_shrink(space, rest->points.item, rest->points.room, sizeof *rest->points.item);
    pir_space_shrink(space, rest->directions.item, rest->directions.room, sizeof *rest->directions.item);
    space->rest = NULL;
    *rest = (pir_space_rest){0};
}

/* Copies numbers of the space; the first of the copies. */
static uint32_t copy_numbers(pir_space_rest *rest, uint32_t from, uint32_t count) {
    const uint32_t first = rest->number_count;
    if (!pir_space_grow(rest->space, (void **)&rest->number, &rest->number_room, first + count, sizeof *rest->number))
        return 0;
    for (uint32_t k = 0; k < count; k++) {
        mpz_ptr copy = rest->number[rest->number_count++];
        mpz_init_set(copy, rest->space->number[from + k]);
        rest->space->bytes += (size_t)copy->_mp_alloc * sizeof(mp_limb_t);
    }
    return first;
}

static uint32_t push(pir_space_rest *rest, pir_rest_list *list, pir_rest_item item) {
    if (!pir_space_grow(rest->space, (void **)&list->item, &list->room, list->count, sizeof *list->item))
        return PIR_SPACE_NONE;
    list->item[list->count] = item;
    return list->count++;
}

void pir_rest_keep_point(pir_space_rest *rest, uint32_t point, int body) {
    pir_space *space = rest->space;
    if (space->point[point].kind == PIR_POINT_TURNED)
        return;
    const uint32_t exact = pir_space_exact_point(space, point);
    if (space->status != PIR_OK)
        return;
    const uint32_t at = copy_numbers(rest, exact, 4);
    pir_space_round_point(space, point);
    pir_space_point *p = &space->point[point];
    const pir_rest_item item = {.x = {p->x[0], p->x[1], p->x[2]},
                                .of = point,
                                .exact = at,
                                .body = (uint32_t)body,
                                .same = pir_intern_add(&rest->points_of[body], exact, rest->points.count)};
    const uint32_t made = push(rest, &rest->points, item);
    p->kind = PIR_POINT_TURNED;
    p->of[0] = made;
}

/* The first item of a body along the line of a direction. */
static uint32_t line_of(pir_space_rest *rest, uint32_t exact, int body) {
    pir_space *space = rest->space;
    const uint32_t key = pir_space_numbers(space, 3);
    if (space->status != PIR_OK)
        return 0;
    int sign = 0;
    for (uint32_t k = 0; k < 3 && sign == 0; k++)
        sign = mpz_sgn(space->number[exact + k]);
    for (uint32_t k = 0; k < 3; k++) {
        mpz_set(space->number[key + k], space->number[exact + k]);
        if (sign < 0)
            mpz_neg(space->number[key + k], space->number[key + k]);
    }
    return pir_intern_add(&rest->directions_of[body], key, rest->directions.count);
}

void pir_rest_keep_direction(pir_space_rest *rest, uint32_t direction, int body) {
    pir_space *space = rest->space;
    const pir_space_direction d = space->direction[direction];
    if (d.rest != PIR_SPACE_NONE || space->status != PIR_OK)
        return;
    const pir_rest_item item = {.x = {d.n[0], d.n[1], d.n[2]},
                                .of = direction,
                                .exact = copy_numbers(rest, d.exact, 3),
                                .body = (uint32_t)body,
                                .same = line_of(rest, d.exact, body),
                                .end = {PIR_SPACE_NONE, PIR_SPACE_NONE}};
    space->direction[direction].rest = push(rest, &rest->directions, item);
}

void pir_rest_keep_edge(pir_space_rest *rest, uint32_t direction, uint32_t a, uint32_t b, int body) {
    pir_rest_keep_point(rest, a, body);
    pir_rest_keep_point(rest, b, body);
    pir_rest_keep_direction(rest, direction, body);
    if (rest->space->status != PIR_OK)
        return;
    pir_rest_item *item = &rest->directions.item[rest->space->direction[direction].rest];
    item->end[0] = rest->space->point[a].of[0];
    item->end[1] = rest->space->point[b].of[0];
}

void pir_rest_settle(pir_space_rest *rest) {
    for (int k = 0; k < 3; k++)
        pir_rest_keep_direction(rest, rest->space->axis[k], 1);
    rest->point_mark = rest->space->point_count;
    rest->direction_mark = rest->space->direction_count;
    rest->plane_mark = rest->space->plane_count;
    rest->known = PIR_ZEROED(&rest->space->allocator, struct pir_rest_known, PIR_REST_KNOWN);
    if (!rest->known && rest->space->status == PIR_OK)
        rest->space->status = PIR_ERR_MEMORY;
    rest->space->rest = rest;
    for (int b = 0; b < 2; b++) {
        pir_intern_finish(&rest->points_of[b]);
        pir_intern_finish(&rest->directions_of[b]);
    }
}

static void set_int(mpz_ptr to, const pir_int *a) {
    mpz_t view;
    mpz_set(to, mpz_roinit_n(view, a->limb, a->size));
}

/* The matrix of a body: M or 1, times its scale, an odd number times a power of two that goes to either side. */
static void set_matrix(pir_space_rest *rest, int body) {
    int exponent;
    const double s = ldexp(frexp(rest->scale[body], &exponent), 53);
    exponent -= 53;
    if (body == 0)
        pir_rotation_make_exact(rest->rotation);
    for (int k = 0; k < 9; k++) {
        if (body == 0)
            set_int(rest->matrix[0][k], &rest->rotation->integers->m[k / 3][k % 3]);
        else
            mpz_set_ui(rest->matrix[1][k], k % 4 == 0);
        mpz_set_d(rest->t[0], s);
        mpz_mul(rest->matrix[body][k], rest->matrix[body][k], rest->t[0]);
        mpz_mul_2exp(rest->matrix[body][k], rest->matrix[body][k], (mp_bitcnt_t)(exponent > 0 ? exponent : 0));
    }
    if (body == 0)
        set_int(rest->weight[0], &rest->rotation->integers->norm);
    else
        mpz_set_ui(rest->weight[1], 1);
    mpz_mul_2exp(rest->weight[body], rest->weight[body], (mp_bitcnt_t)(exponent < 0 ? -exponent : 0));
}

/* ret = r · x · by; `r` is NULL for what does not turn. */
static void apply(double ret[3], const pir_mat3 *r, const double x[3], double by) {
    for (int k = 0; k < 3; k++)
        ret[k] = by * (r ? r->m[k][0] * x[0] + r->m[k][1] * x[1] + r->m[k][2] * x[2] : x[k]);
}

static void turn_doubles(pir_space_rest *rest) {
    pir_space *space = rest->space;
    const int top = ilogb(rest->scale[0] > rest->scale[1] ? rest->scale[0] : rest->scale[1]) + 1;
    const bool plain = rest->scale[0] == 1 && rest->scale[1] == 1;
    const int lower = plain ? 0 : top;
    space->shift = rest->shift + lower;
    const double by[2] = {ldexp(rest->scale[0], -lower), ldexp(rest->scale[1], -lower)};
    for (uint32_t i = 0; i < rest->points.count; i++) {
        const pir_rest_item *item = &rest->points.item[i];
        pir_space_point *p = &space->point[item->of];
        apply(p->x, item->body == 0 ? &rest->rotation->r : NULL, item->x, by[item->body]);
        p->err = 0x1p-46;
        p->exact = PIR_SPACE_NONE;
    }
    for (uint32_t i = 0; i < rest->directions.count; i++) {
        const pir_rest_item *item = &rest->directions.item[i];
        pir_space_direction *d = &space->direction[item->of];
        apply(d->n, item->body == 0 ? &rest->rotation->r : NULL, item->x, 1);
        d->exact = PIR_SPACE_NONE;
    }
}

void pir_rest_turn(pir_space_rest *rest, pir_rotation *rotation, const double scale[2], bool keep) {
    pir_space *space = rest->space;
    rest->rotation = rotation;
    rest->scale[0] = scale[0];
    rest->scale[1] = scale[1];
    space->direction_count = rest->direction_mark;
    if (!keep) {
        space->point_count = rest->point_mark;
        space->plane_count = rest->plane_mark;
        space->spare_points.count = space->spare_planes.count = 0;
    }
    pir_space_begin_frame(space);
    set_matrix(rest, 0);
    set_matrix(rest, 1);
    turn_doubles(rest);
}

/* GMP's arrays are not const here: C17 does not convert those. */
static void multiply(mpz_t *ret, const mpz_t *matrix, mpz_t *x) {
    for (int r = 0; r < 3; r++) {
        mpz_mul(ret[r], matrix[3 * r], x[0]);
        mpz_addmul(ret[r], matrix[3 * r + 1], x[1]);
        mpz_addmul(ret[r], matrix[3 * r + 2], x[2]);
    }
}

void pir_rest_turn_point(const pir_space_rest *rest, uint32_t item, mpz_t *ret) {
    const pir_rest_item *p = &rest->points.item[item];
    multiply(ret, rest->matrix[p->body], rest->number + p->exact);
    mpz_mul(ret[3], rest->weight[p->body], rest->number[p->exact + 3]);
}

void pir_rest_turn_direction(const pir_space_rest *rest, uint32_t item, mpz_t *ret) {
    const pir_rest_item *d = &rest->directions.item[item];
    multiply(ret, rest->matrix[d->body], rest->number + d->exact);
}
