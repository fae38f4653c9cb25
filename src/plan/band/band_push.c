/* SPDX-License-Identifier: MIT */
/* See band_push.h. */
#include "plan/band/band_push.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_POSES 65536

/* How often weights are moved from one pair to another, and a step is halved that is none; rounds in a unit of work. */
#define ROUNDS      48
#define HALVES      4
#define BISECTS     16
#define WORK_ROUNDS 2

/* How much of two rooms a motion may be long. */
#define ROOM_PART 0.7

/* --- spacing --- */

bool pir_band_row_reserve(pir_band_row *row, uint32_t count) {
    if (count <= row->room)
        return true;
    const uint32_t room = 2 * count + 64;
    pir_band_pose **list[3] = {&row->pose, &row->spare, &row->best};
    for (int i = 0; i < 3; i++) {
        pir_band_pose *grown = realloc(*list[i], room * sizeof *grown);
        if (!grown)
            return false;
        *list[i] = grown;
    }
    row->room = room;
    return true;
}

void pir_band_row_finish(pir_band_row *row) {
    free(row->pose);
    free(row->spare);
    free(row->best);
}

/* The pose in the midst of the motion from one to another; the robot's middle goes straight. */
static pir_band_pose between(const pir_band_bodies *bodies, const pir_band_pose *a, const pir_band_pose *b) {
    double step[PIR_BAND_STEP];
    pir_band_pose pose = *a;
    pir_band_step(bodies, a, b, step);
    const double cosine = a->q[0] * b->q[0] + a->q[1] * b->q[1] + a->q[2] * b->q[2] + a->q[3] * b->q[3];
    for (int k = 0; k < PIR_BAND_STEP; k++)
        step[k] /= k < 3 ? 2 : 1 + fabs(cosine);
    pir_band_move(bodies, step, &pose);
    pose.room = -INFINITY;
    return pose;
}

/* How far two poses are apart; 0 where that is less than their rooms: no vertex moves by more than √2 of a step. */
static double gap_between(const pir_band_bodies *bodies, const pir_band_pose *a, const pir_band_pose *b) {
    double step[PIR_BAND_STEP];
    const double far = pir_band_step(bodies, a, b, step);
    return far < ROOM_PART * (a->room + b->room) ? 0 : far;
}

pir_status pir_band_space(const pir_band_bodies *bodies, double spacing, pir_band_row *row) {
    uint32_t count = 1;
    if (row->count > MOST_POSES)
        return PIR_ERR_LIMIT;
    if (!pir_band_row_reserve(row, 2 * row->count))
        return PIR_ERR_MEMORY;
    row->spare[0] = row->pose[0];
    for (uint32_t i = 1; i < row->count; i++) {
        const pir_band_pose *last = &row->spare[count - 1], *pose = &row->pose[i];
        if (i + 1 < row->count && gap_between(bodies, last, &row->pose[i + 1]) == 0)
            continue;
        if (gap_between(bodies, last, pose) > spacing)
            row->spare[count++] = between(bodies, last, pose);
        row->spare[count++] = *pose;
    }
    pir_band_pose *spaced = row->spare;
    row->spare = row->pose;
    row->pose = spaced;
    row->count = count;
    return PIR_OK;
}

double pir_band_gap(const pir_band_bodies *bodies, const pir_band_row *row) {
    double gap = 0;
    for (uint32_t i = 1; i < row->count; i++)
        gap = fmax(gap, gap_between(bodies, &row->pose[i - 1], &row->pose[i]));
    return gap;
}

/* --- the step that gives most room --- */

/* A mean of pairs: weights, and the mean of their gradients across the band. */
struct mean {
    double weight[PIR_BAND_NEAR], gradient[PIR_BAND_STEP];
};

static double product(const double *a, const double *b) {
    double sum = 0;
    for (int k = 0; k < PIR_BAND_STEP; k++)
        sum += a[k] * b[k];
    return sum;
}

/* The part of weight to be moved to a pair of another distance and gradient that makes the mean's bound least. */
static double part_to_move(const struct mean *mean, double distance, const double *gradient, double most,
                           double length) {
    double low = 0, high = most;
    for (int i = 0; i < BISECTS; i++) {
        const double part = (low + high) / 2;
        double square = 0, slope = 0;
        for (int k = 0; k < PIR_BAND_STEP; k++) {
            const double x = mean->gradient[k] + part * gradient[k];
            square += x * x;
            slope += x * gradient[k];
        }
        if (distance + length * slope / (sqrt(square) + PIR_PLAN_TINY) > 0)
            high = part;
        else
            low = part;
    }
    return low;
}

/*
 * The step of a length after which the least distance is greatest, to first order. Any mean of pairs bounds that by its
 * distance and the length of its gradient; weights are moved from the pair that has most room after the mean's step to
 * the one that has least, until all of some weight have about the same: the bound is reached then. How many rounds it
 * took.
 */
static int best_step(const pir_band_near *near, uint32_t count, double length, double ret_step[PIR_BAND_STEP]) {
    struct mean mean = {0};
    uint32_t first = 0;
    for (uint32_t i = 0; i < count; i++)
        first = near[i].distance < near[first].distance ? i : first;
    mean.weight[first] = 1;
    memcpy(mean.gradient, near[first].gradient, sizeof mean.gradient);
    int round = 0;
    for (; round < ROUNDS; round++) {
        const double size = sqrt(product(mean.gradient, mean.gradient)) + PIR_PLAN_TINY;
        double least = INFINITY, most = -INFINITY, change[PIR_BAND_STEP];
        uint32_t to = 0, from = 0;
        for (uint32_t i = 0; i < count; i++) {
            const double room = near[i].distance + length * product(near[i].gradient, mean.gradient) / size;
            if (room < least) {
                least = room;
                to = i;
            }
            if (mean.weight[i] > 0 && room > most) {
                most = room;
                from = i;
            }
        }
        if (most - least < length * 0x1p-8)
            break;
        for (int k = 0; k < PIR_BAND_STEP; k++)
            change[k] = near[to].gradient[k] - near[from].gradient[k];
        const double part =
            part_to_move(&mean, near[to].distance - near[from].distance, change, mean.weight[from], length);
        mean.weight[from] -= part;
        mean.weight[to] += part;
        if (mean.weight[from] < 0x1p-40)
            mean.weight[from] = 0;
        for (int k = 0; k < PIR_BAND_STEP; k++)
            mean.gradient[k] += part * change[k];
    }
    const double size = sqrt(product(mean.gradient, mean.gradient));
    for (int k = 0; k < PIR_BAND_STEP; k++)
        ret_step[k] = size > 0x1p-30 ? length * mean.gradient[k] / size : 0;
    return round;
}

/* Leaves of gradients what is across the band. */
static void set_across(pir_band_near *near, uint32_t count, const double along[PIR_BAND_STEP]) {
    const double square = product(along, along);
    for (uint32_t i = 0; i < count && square > 0; i++) {
        const double part = product(near[i].gradient, along) / square;
        for (int k = 0; k < PIR_BAND_STEP; k++)
            near[i].gradient[k] -= part * along[k];
    }
}

/* Pushes a pose between two others, or looks at it alone where these are none. */
static pir_status push_pose(pir_band_bodies *bodies, const pir_band_pose *before, const pir_band_pose *after,
                            double length, double reach, pir_band_pose *pose) {
    pir_band_near near[PIR_BAND_NEAR], other[PIR_BAND_NEAR];
    double along[PIR_BAND_STEP], step[PIR_BAND_STEP];
    uint32_t count, others;
    pir_status status = pir_band_look(bodies, pose, reach, 3 * length, near, &count, &pose->room);
    if (status != PIR_OK || count == 0 || !before)
        return status;
    pir_band_step(bodies, before, after, along);
    set_across(near, count, along);
    for (int half = 0; half < HALVES && status == PIR_OK; half++, length /= 2) {
        pir_band_pose moved = *pose;
        bodies->work += (uint64_t)best_step(near, count, length, step) / WORK_ROUNDS;
        pir_band_move(bodies, step, &moved);
        status = pir_band_look(bodies, &moved, reach, 0, other, &others, &moved.room);
        if (status == PIR_OK && moved.room > pose->room) {
            *pose = moved;
            break;
        }
    }
    return status;
}

pir_status pir_band_push_row(pir_band_bodies *bodies, double length, double reach, pir_band_row *row,
                             double *ret_least) {
    pir_status status = PIR_OK;
    *ret_least = INFINITY;
    for (uint32_t i = 0; i < row->count && status == PIR_OK; i++) {
        const bool is_end = i == 0 || i + 1 == row->count;
        const pir_band_pose *pose = &row->pose[i];
        row->spare[i] = *pose;
        // one that has room is not looked at again
        if (pose->room < reach)
            status =
                push_pose(bodies, is_end ? NULL : pose - 1, is_end ? NULL : pose + 1, length, reach, &row->spare[i]);
        *ret_least = fmin(*ret_least, row->spare[i].room);
    }
    pir_band_pose *pushed = row->spare;
    row->spare = row->pose;
    row->pose = pushed;
    return status;
}

void pir_band_row_note(pir_band_row *row) {
    memcpy(row->best, row->pose, row->count * sizeof *row->pose);
    row->bests = row->count;
}

void pir_band_row_restore(pir_band_row *row) {
    memcpy(row->pose, row->best, row->bests * sizeof *row->pose);
    row->count = row->bests;
}
