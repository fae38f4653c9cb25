/* SPDX-License-Identifier: MIT */
/* See band_bodies.h. */
#include "plan/band/band_bodies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/sweep.h>

/* The most pairs of pieces: each keeps some KB. */
#define MOST_PAIRS 8192

static void list_of(pir_vec3 v, double ret[3]) {
    ret[0] = v.x;
    ret[1] = v.y;
    ret[2] = v.z;
}

static double length_of(const double x[3]) {
    return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

static pir_band_box box_of(const pir_polytope *piece) {
    pir_band_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++) {
        double x[3];
        list_of(pir_polytope_vertex(piece, v), x);
        for (int k = 0; k < 3; k++) {
            box.low[k] = fmin(box.low[k], x[k]);
            box.high[k] = fmax(box.high[k], x[k]);
        }
    }
    return box;
}

/* The ball about the middle of a piece's box; the one about the origin has it with room for rounding. */
static pir_band_ball ball_of(const pir_polytope *piece) {
    const pir_band_box box = box_of(piece);
    pir_band_ball ball = {.radius = 0};
    for (int k = 0; k < 3; k++)
        ball.at[k] = box.low[k] / 2 + box.high[k] / 2;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++) {
        double x[3];
        list_of(pir_polytope_vertex(piece, v), x);
        ball.arm = fmax(ball.arm, length_of(x) * (1 + 0x1p-40) + PIR_PLAN_TINY);
        for (int k = 0; k < 3; k++)
            x[k] -= ball.at[k];
        ball.radius = fmax(ball.radius, length_of(x));
    }
    return ball;
}

static pir_status open_pairs(const pir_plan_pieces *robot, const pir_plan_pieces *obstacles, pir_band_pairs *pairs) {
    pairs->robots = robot->count;
    pairs->obstacles = obstacles->count;
    if ((uint64_t)robot->count * obstacles->count > MOST_PAIRS)
        return PIR_ERR_LIMIT;
    pairs->pair = calloc((size_t)robot->count * obstacles->count + 1, sizeof(pir_pair *));
    pairs->ball = calloc((size_t)robot->count + 1, sizeof *pairs->ball);
    pairs->box = calloc((size_t)obstacles->count + 1, sizeof *pairs->box);
    if (!pairs->pair || !pairs->ball || !pairs->box)
        return PIR_ERR_MEMORY;
    pir_status status = PIR_OK;
    for (uint32_t i = 0; i < robot->count; i++)
        pairs->ball[i] = ball_of(robot->at[i]);
    for (uint32_t k = 0; k < obstacles->count; k++)
        pairs->box[k] = box_of(obstacles->at[k]);
    for (uint32_t i = 0; i < robot->count; i++)
        for (uint32_t k = 0; k < obstacles->count && status == PIR_OK; k++)
            status =
                pir_pair_create(robot->at[i], obstacles->at[k], NULL, &pairs->pair[(size_t)i * obstacles->count + k]);
    return status;
}

static void close_pairs(pir_band_pairs *pairs) {
    for (size_t i = 0; pairs->pair && i < (size_t)pairs->robots * pairs->obstacles; i++)
        pir_pair_destroy(pairs->pair[i]);
    free(pairs->pair);
    free(pairs->ball);
    free(pairs->box);
}

/* The middle of the robot's box, and how far its balls reach about it. */
static void measure_robot(const pir_plan_pieces *robot, pir_band_bodies *bodies) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < robot->count; i++) {
        const pir_band_box box = box_of(robot->at[i]);
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], box.low[k]);
            high[k] = fmax(high[k], box.high[k]);
        }
    }
    for (int k = 0; k < 3; k++)
        bodies->middle[k] = low[k] / 2 + high[k] / 2;
    for (uint32_t i = 0; i < robot->count; i++) {
        double x[3];
        for (int k = 0; k < 3; k++)
            x[k] = bodies->push.ball[i].at[k] - bodies->middle[k];
        bodies->radius = fmax(bodies->radius, length_of(x) + bodies->push.ball[i].radius);
    }
}

pir_status pir_band_bodies_open(const pir_band_question *question, pir_band_bodies *bodies) {
    *bodies = (pir_band_bodies){.low = question->low, .high = question->high};
    pir_status status = pir_workspace_create(NULL, &bodies->workspace);
    if (status == PIR_OK)
        status = open_pairs(question->robot, question->wide, &bodies->push);
    if (status == PIR_OK)
        status = open_pairs(question->robot, question->obstacles, &bodies->prove);
    if (status == PIR_OK)
        measure_robot(question->robot, bodies);
    return status;
}

void pir_band_bodies_finish(pir_band_bodies *bodies) {
    close_pairs(&bodies->push);
    close_pairs(&bodies->prove);
    pir_workspace_destroy(bodies->workspace);
}

/* --- distances --- */

/* A vector of the robot, turned. */
static void turned(const double q[4], const double v[3], double ret[3]) {
    const double c[3] = {q[1] * v[2] - q[2] * v[1], q[2] * v[0] - q[0] * v[2], q[0] * v[1] - q[1] * v[0]};
    const double d[3] = {q[1] * c[2] - q[2] * c[1], q[2] * c[0] - q[0] * c[2], q[0] * c[1] - q[1] * c[0]};
    for (int k = 0; k < 3; k++)
        ret[k] = v[k] + 2 * (q[3] * c[k] + d[k]);
}

static bool is_beyond(const pir_band_box *box, const double x[3], double reach) {
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double beside = fmax(fmax(box->low[k] - x[k], x[k] - box->high[k]), 0);
        square += beside * beside;
    }
    return square > reach * reach;
}

/* Adds a pair within reach; where there is no room for more, in the place of the one that is farthest. */
static void add_near(const pir_band_near *near, pir_band_near *list, uint32_t *count) {
    uint32_t at = *count;
    if (at < PIR_BAND_NEAR) {
        (*count)++;
    } else {
        at = 0;
        for (uint32_t i = 1; i < PIR_BAND_NEAR; i++)
            at = list[i].distance > list[at].distance ? i : at;
        if (list[at].distance <= near->distance)
            return;
    }
    list[at] = *near;
}

static pir_band_near near_of(const pir_query_result *result, const double middle[3], double radius) {
    double n[3], p[3];
    list_of(result->normal, n);
    list_of(result->point_p, p);
    for (int k = 0; k < 3; k++)
        p[k] = (p[k] - middle[k]) / radius;
    return (pir_band_near){
        result->distance,
        {n[0], n[1], n[2], p[1] * n[2] - p[2] * n[1], p[2] * n[0] - p[0] * n[2], p[0] * n[1] - p[1] * n[0]}};
}

pir_status pir_band_look(pir_band_bodies *bodies, const pir_band_pose *pose, double reach, double more,
                         pir_band_near *ret_near, uint32_t *ret_count, double *ret_least) {
    const pir_band_pairs *pairs = &bodies->push;
    const double *q = pose->q, *t = pose->t;
    pir_pair_input input = pir_pair_input_default();
    pir_status status = PIR_OK;
    double middle[3];
    turned(q, bodies->middle, middle);
    for (int k = 0; k < 3; k++)
        middle[k] += t[k];
    input.pose_p = (pir_pose){{q[0], q[1], q[2], q[3]}, {t[0], t[1], t[2]}};
    *ret_count = 0;
    *ret_least = reach;
    for (uint32_t i = 0; i < pairs->robots; i++) {
        double x[3];
        turned(q, pairs->ball[i].at, x);
        for (int k = 0; k < 3; k++)
            x[k] += t[k];
        for (uint32_t k = 0; k < pairs->obstacles && status == PIR_OK; k++) {
            pir_query_result result = {0};
            input.cutoff = fmax(fmin(reach, *ret_least + more), 0);
            if (is_beyond(&pairs->box[k], x, input.cutoff + pairs->ball[i].radius))
                continue;
            status = pir_pair_signed_distance(pairs->pair[(size_t)i * pairs->obstacles + k], bodies->workspace, &input,
                                              &result);
            bodies->work++;
            if (status != PIR_OK || result.outcome == PIR_BEYOND_CUTOFF)
                continue;
            const pir_band_near near = near_of(&result, middle, bodies->radius);
            add_near(&near, ret_near, ret_count);
            *ret_least = fmin(*ret_least, result.distance);
        }
    }
    return status;
}

/* --- steps --- */

static void make_unit(double q[4]) {
    const double size = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; k++)
        q[k] /= size;
}

void pir_band_move(const pir_band_bodies *bodies, const double step[PIR_BAND_STEP], pir_band_pose *pose) {
    const double *p = pose->q, far = 2 * bodies->radius;
    const double w[3] = {step[3] / far, step[4] / far, step[5] / far};
    double before[3], after[3];
    double q[4] = {p[0] + w[0] * p[3] + w[1] * p[2] - w[2] * p[1], p[1] + w[1] * p[3] + w[2] * p[0] - w[0] * p[2],
                   p[2] + w[2] * p[3] + w[0] * p[1] - w[1] * p[0], p[3] - w[0] * p[0] - w[1] * p[1] - w[2] * p[2]};
    make_unit(q);
    turned(pose->q, bodies->middle, before);
    turned(q, bodies->middle, after);
    memcpy(pose->q, q, sizeof q);
    for (int k = 0; k < 3; k++)
        pose->t[k] = fmin(fmax(pose->t[k] + step[k] + before[k] - after[k], bodies->low[k]), bodies->high[k]);
}

double pir_band_step(const pir_band_bodies *bodies, const pir_band_pose *from, const pir_band_pose *to,
                     double ret_step[PIR_BAND_STEP]) {
    const double *p = from->q, *q = to->q;
    double before[3], after[3], square = 0;
    const double cosine = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
    const double far = cosine < 0 ? -2 * bodies->radius : 2 * bodies->radius;
    turned(p, bodies->middle, before);
    turned(q, bodies->middle, after);
    for (int k = 0; k < 3; k++)
        ret_step[k] = to->t[k] + after[k] - from->t[k] - before[k];
    ret_step[3] = far * (q[0] * p[3] - q[3] * p[0] - q[1] * p[2] + q[2] * p[1]);
    ret_step[4] = far * (q[1] * p[3] - q[3] * p[1] - q[2] * p[0] + q[0] * p[2]);
    ret_step[5] = far * (q[2] * p[3] - q[3] * p[2] - q[0] * p[1] + q[1] * p[0]);
    for (int k = 0; k < PIR_BAND_STEP; k++)
        square += ret_step[k] * ret_step[k];
    return sqrt(square);
}

/* --- proof --- */

/*
 * Whether a piece may come to an obstacle: each point of it is within its arm of the translation, which is between its
 * ends; the sweep has translations rounded by less than the room.
 */
static bool may_meet(const pir_band_ball *ball, const pir_band_box *box, const double a[3], const double b[3]) {
    for (int k = 0; k < 3; k++) {
        const double room = ball->arm + (ball->arm + fabs(a[k]) + fabs(b[k])) * 0x1p-40;
        if (fmin(a[k], b[k]) - room > box->high[k] || fmax(a[k], b[k]) + room < box->low[k])
            return false;
    }
    return true;
}

pir_status pir_band_prove(pir_band_bodies *bodies, const pir_pose *from, const pir_pose *to, bool *ret_free) {
    const pir_band_pairs *pairs = &bodies->prove;
    pir_pair_input end[2] = {pir_pair_input_default(), pir_pair_input_default()};
    pir_status status = PIR_OK;
    double a[3], b[3];
    end[0].pose_p = *from;
    end[1].pose_p = *to;
    list_of(from->translation, a);
    list_of(to->translation, b);
    *ret_free = true;
    for (uint32_t i = 0; i < pairs->robots; i++)
        for (uint32_t k = 0; k < pairs->obstacles && status == PIR_OK && *ret_free; k++) {
            pir_sweep_result sweep;
            if (!may_meet(&pairs->ball[i], &pairs->box[k], a, b))
                continue;
            status = pir_pair_sweep(pairs->pair[(size_t)i * pairs->obstacles + k], bodies->workspace, &end[0], &end[1],
                                    0, &sweep);
            bodies->work += status == PIR_OK ? sweep.queries : 0;
            *ret_free = status == PIR_OK && sweep.outcome == PIR_SWEEP_FREE;
        }
    return status;
}
