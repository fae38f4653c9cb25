/* SPDX-License-Identifier: MIT */
/*
 * Relative poses of meshes.
 *
 * Errors, u = 2^-53: each rotation is within 31u of the exact one in Frobenius norm, their product so within 72u with
 * its own rounding; a vertex turned by it is off by another 6u of its length; the translation by u for the difference,
 * 31u and 6u for turning it, of the lengths of both. A sum rounds once more. All is below 2^-46 of `size`.
 */
#include "mesh/pair/mesh_frame.h"

#include <stdlib.h>

/* Limbs of the stack, by those of an exact coordinate: six corners are made with below 40 each, then compared. */
#define STACK_LIMBS(coordinate) (560 * (coordinate) + 2000)

/* --- room --- */

static void widen(double x, int *top, int *low) {
    int exponent;
    if (x == 0)
        return;
    (void)frexp(x, &exponent);
    *top = exponent > *top ? exponent : *top;
    exponent = pir_double_low_bit(x);
    *low = exponent < *low ? exponent : *low;
}

/* Limbs of an entry of M(q), and of |q|²: sums of four products of components. */
static uint32_t matrix_limbs(pir_quat q) {
    int top = INT32_MIN, low = INT32_MAX;
    widen(q.x, &top, &low);
    widen(q.y, &top, &low);
    widen(q.z, &top, &low);
    widen(q.w, &top, &low);
    return (2 * (uint32_t)(top - low) + 3) / GMP_NUMB_BITS + 1;
}

static int low_exponent(const pir_mesh_frame *frame, const pir_pose *p, const pir_pose *q) {
    int low = 0;
    const int bits[4] = {frame->mesh[0]->low_bit, frame->mesh[1]->low_bit, pir_vec_low_bit(p->translation),
                         pir_vec_low_bit(q->translation)};
    for (int i = 0; i < 4; i++)
        low = bits[i] < low ? bits[i] : low;
    return low;
}

static bool reserve(pir_mesh_frame *frame, const pir_allocator *allocator, uint32_t coordinate) {
    if (coordinate <= frame->coordinate)
        return true;
    uint32_t old = frame->limbs.capacity, room = STACK_LIMBS(coordinate);
    mp_limb_t *base = PIR_RESIZE(allocator, frame->limbs.base, old, room);
    if (!base)
        return false;
    frame->limbs = (pir_limbs){base, 0, room};
    frame->coordinate = coordinate;
    return true;
}

void pir_mesh_frame_finish(pir_mesh_frame *frame, const pir_allocator *allocator) {
    PIR_FREE(allocator, frame->limbs.base, frame->limbs.capacity);
}

/* --- poses --- */

static pir_status check(const pir_pose *pose) {
    pir_vec3 t = pose->translation;
    if (!pir_vec_is_finite(t))
        return PIR_ERR_NOT_FINITE;
    return fabs(t.x) <= PIR_MESH_FARTHEST && fabs(t.y) <= PIR_MESH_FARTHEST && fabs(t.z) <= PIR_MESH_FARTHEST
               ? PIR_OK
               : PIR_ERR_LIMIT;
}

/* r and t from both rotations. */
static void set_doubles(pir_mesh_frame *frame) {
    const pir_mat3 *p = &frame->rotation[0].r, *q = &frame->rotation[1].r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            frame->r.m[i][j] = q->m[0][i] * p->m[0][j] + q->m[1][i] * p->m[1][j] + q->m[2][i] * p->m[2][j];
    pir_vec3 tp = frame->pose[0].translation, tq = frame->pose[1].translation;
    frame->t = pir_mat_apply_transposed(q, pir_vec_sub(tp, tq));
    frame->size = frame->reach[0] + frame->reach[1] + pir_vec_length(tp) + pir_vec_length(tq);
    frame->error = 0x1p-46 * frame->size;
}

pir_status pir_mesh_frame_set(pir_mesh_frame *frame, const pir_allocator *allocator, pir_pose pose_p, pir_pose pose_q,
                              double length) {
    pir_rotation rotation[2];
    const pir_pose pose[2] = {pose_p, pose_q};
    for (int i = 0; i < 2; i++) {
        pir_status status = pir_rotation_set(&rotation[i], pose[i].rotation);
        if (status == PIR_OK)
            status = check(&pose[i]);
        if (status != PIR_OK)
            return status;
    }
    uint32_t p = matrix_limbs(pose_p.rotation), q = matrix_limbs(pose_q.rotation);
    int exponent = low_exponent(frame, &pose[0], &pose[1]), low = pir_double_low_bit(length);
    exponent = low < exponent ? low : exponent;
    // a coordinate is at most 2^60, a difference of two twice that
    if (!reserve(frame, allocator, p + q + pir_double_limbs(64, exponent) + 3))
        return PIR_ERR_MEMORY;
    for (int i = 0; i < 2; i++) {
        frame->pose[i] = pose[i];
        frame->rotation[i] = rotation[i];
        frame->rotation[i].integers = &frame->integers[i];
    }
    frame->exponent = exponent;
    frame->has_integers = false;
    set_doubles(frame);
    return PIR_OK;
}

pir_vec3 pir_mesh_frame_world(const pir_mesh_frame *frame, pir_vec3 x) {
    return pir_vec_add(pir_mat_apply(&frame->rotation[1].r, x), frame->pose[1].translation);
}

/* --- exact numbers --- */

static void make_integers(pir_mesh_frame *frame) {
    for (int i = 0; i < 2 && !frame->has_integers; i++)
        pir_rotation_make_exact(&frame->rotation[i]);
    frame->has_integers = true;
}

static pir_int3 multiply(pir_limbs *limbs, const pir_rotation_integers *by, bool transposed, const pir_int3 *v) {
    pir_int3 r;
    for (int i = 0; i < 3; i++) {
        const pir_int3 row = {{transposed ? by->m[0][i] : by->m[i][0], transposed ? by->m[1][i] : by->m[i][1],
                               transposed ? by->m[2][i] : by->m[i][2]}};
        r.c[i] = pir_num3_dot(limbs, &row, v);
    }
    return r;
}

pir_int3 pir_mesh_frame_exact(pir_mesh_frame *frame, int side, uint32_t vertex) {
    make_integers(frame);
    pir_limbs *limbs = &frame->limbs;
    const pir_rotation_integers *p = &frame->integers[0], *q = &frame->integers[1];
    pir_int3 x = pir_num3_doubles(limbs, frame->mesh[side]->vertex[vertex], frame->exponent);
    if (side == 1) {
        pir_int norm = pir_num_mul(limbs, &p->norm, &q->norm);
        return pir_num3_scale(limbs, &x, &norm);
    }
    pir_int3 tp = pir_num3_doubles(limbs, frame->pose[0].translation, frame->exponent);
    pir_int3 tq = pir_num3_doubles(limbs, frame->pose[1].translation, frame->exponent);
    pir_int3 t = pir_num3_sub(limbs, &tp, &tq), moved = pir_num3_scale(limbs, &t, &p->norm);
    pir_int3 turned = multiply(limbs, p, false, &x), in_world = pir_num3_add(limbs, &turned, &moved);
    return multiply(limbs, q, true, &in_world);
}

pir_int pir_mesh_frame_exact_length(pir_mesh_frame *frame, double length) {
    make_integers(frame);
    pir_limbs *limbs = &frame->limbs;
    pir_int x = pir_num_double(limbs, length, frame->exponent);
    pir_int norm = pir_num_mul(limbs, &frame->integers[0].norm, &frame->integers[1].norm);
    return pir_num_mul(limbs, &x, &norm);
}

void pir_mesh_frame_square(pir_mesh_frame *frame, uint32_t p, uint32_t q, pir_exact_square *ret_square) {
    uint32_t used = frame->limbs.used;
    pir_int3 a[3], b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = pir_mesh_frame_exact(frame, 0, frame->mesh[0]->corner[p][k]);
        b[k] = pir_mesh_frame_exact(frame, 1, frame->mesh[1]->corner[q][k]);
    }
    pir_exact_distance(&frame->limbs, a, b, ret_square);
    frame->limbs.used = used;
}
