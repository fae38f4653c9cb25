/* SPDX-License-Identifier: MIT */
/*
 * Trees of free poses grow from both ends, in turns: one toward a random pose, the other toward what that has reached.
 *
 * - The root of a tree is its end; each other node has the pose it grew from before it.
 * - The motion from there is shorter than a part of the rooms of both, so it is free as far as doubles tell.
 * - Random numbers are the same in each run.
 *
 * A step goes toward its target as far as the distances near, to first order, stay what is kept: where the robot would
 * meet an obstacle it slides along. That leads it through passages that few straight motions go through.
 *
 * Source: Kuffner and LaValle, RRT-Connect: an efficient approach to single-query path planning, 2000.
 */
#include "plan/band/band_tree.h"

#include <math.h>
#include <stdlib.h>

/* A step at most, the distance that sliding keeps, and a step at least, in parts of the robot's radius. */
#define STRIDE (1 / 8.0)
#define KEPT   (1 / 64.0)
#define LEAST  (1 / 1024.0)

/* How much of two rooms a step may be long, and of itself it has to come nearer; how often it is halved for that. */
#define ROOM_PART 0.7
#define NEARER    (1 / 8.0)
#define HALVES    4

/* The most nodes of a tree, steps of a walk, rounds through distances that a step keeps; nodes in a unit of work. */
#define MOST_NODES 65536
#define MOST_STEPS 400
#define ROUNDS     8
#define WORK_NODES 16

struct pir_band_node {
    pir_band_pose pose;
    uint32_t before;
};

/* --- nodes --- */

void pir_band_trees_finish(pir_band_trees *trees) {
    free(trees->node[0]);
    free(trees->node[1]);
}

static pir_status add_node(pir_band_trees *trees, int side, const pir_band_pose *pose, uint32_t before) {
    if (trees->count[side] == MOST_NODES)
        return PIR_ERR_EMPTY;
    if (trees->count[side] == trees->room[side]) {
        const uint32_t room = 2 * trees->room[side] + 256;
        struct pir_band_node *grown = realloc(trees->node[side], room * sizeof *grown);
        if (!grown)
            return PIR_ERR_MEMORY;
        trees->node[side] = grown;
        trees->room[side] = room;
    }
    trees->node[side][trees->count[side]++] = (struct pir_band_node){*pose, before};
    return PIR_OK;
}

static uint32_t nearest_node(pir_band_bodies *bodies, const pir_band_trees *trees, int side,
                             const pir_band_pose *target) {
    double nearest = INFINITY, step[PIR_BAND_STEP];
    uint32_t at = 0;
    for (uint32_t i = 0; i < trees->count[side]; i++) {
        const double far = pir_band_step(bodies, &trees->node[side][i].pose, target, step);
        if (far < nearest) {
            nearest = far;
            at = i;
        }
    }
    bodies->work += 1 + trees->count[side] / WORK_NODES;
    return at;
}

/* --- walks --- */

static double product(const double *a, const double *b) {
    double sum = 0;
    for (int k = 0; k < PIR_BAND_STEP; k++)
        sum += a[k] * b[k];
    return sum;
}

/* Bends a step such that distances do not become less, to first order, where they are less than what is kept. */
static void slide(const pir_band_near *near, uint32_t count, double kept, double *step) {
    for (int round = 0; round < ROUNDS; round++)
        for (uint32_t i = 0; i < count; i++) {
            const double *gradient = near[i].gradient, distance = near[i].distance;
            const double lack = fmin(kept, distance) - distance - product(gradient, step);
            for (int k = 0; k < PIR_BAND_STEP && lack > 0; k++)
                step[k] += lack / product(gradient, gradient) * gradient[k];
        }
}

/* Moves a pose by a step toward a target; PIR_ERR_EMPTY where there is none. */
static pir_status take_step(pir_band_bodies *bodies, const pir_band_pose *target, pir_band_pose *pose) {
    const double stride = bodies->radius * STRIDE;
    pir_band_near near[PIR_BAND_NEAR];
    double step[PIR_BAND_STEP], taken[PIR_BAND_STEP], least;
    uint32_t count = 0;
    pir_status status = PIR_OK;
    bodies->work++;
    const double far = pir_band_step(bodies, pose, target, step);
    for (int k = 0; k < PIR_BAND_STEP; k++)
        step[k] *= fmin(1, stride / far);
    if (pose->room < stride) {
        status = pir_band_look(bodies, pose, 2 * stride, 2 * stride, near, &count, &least);
        slide(near, count, fmin(bodies->radius * KEPT, pose->room), step);
    }
    for (int half = 0; half < HALVES && status == PIR_OK; half++) {
        pir_band_pose moved = *pose;
        pir_band_move(bodies, step, &moved);
        const double length = pir_band_step(bodies, pose, &moved, taken);
        if (length < bodies->radius * LEAST)
            break;
        status = pir_band_look(bodies, &moved, 2 * stride, 0, near, &count, &moved.room);
        if (status == PIR_OK && length < ROOM_PART * (pose->room + moved.room) &&
            pir_band_step(bodies, &moved, target, taken) < far - length * NEARER) {
            *pose = moved;
            return PIR_OK;
        }
        for (int k = 0; k < PIR_BAND_STEP; k++)
            step[k] /= 2;
    }
    return status == PIR_OK ? PIR_ERR_EMPTY : status;
}

/* Walks from the nearest node toward a target, and adds nodes; the last one, and whether it is at the target. */
static pir_status walk(pir_band_bodies *bodies, pir_band_trees *trees, int side, const pir_band_pose *target,
                       uint32_t *ret_last, bool *ret_is_there) {
    uint32_t at = nearest_node(bodies, trees, side, target);
    pir_band_pose pose = trees->node[side][at].pose;
    pir_status status = PIR_OK;
    double step[PIR_BAND_STEP];
    *ret_is_there = false;
    for (int i = 0; i < MOST_STEPS && !*ret_is_there; i++) {
        status = take_step(bodies, target, &pose);
        if (status != PIR_OK)
            break;
        status = add_node(trees, side, &pose, at);
        if (status != PIR_OK)
            return status;
        at = trees->count[side] - 1;
        *ret_is_there = pir_band_step(bodies, &pose, target, step) < bodies->radius * 0x1p-20;
    }
    *ret_last = at;
    return status == PIR_ERR_EMPTY ? PIR_OK : status;
}

/* --- trees --- */

static double uniform(uint64_t *seed) {
    *seed = *seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(*seed >> 11) * 0x1p-53;
}

static pir_band_pose random_pose(const pir_band_bodies *bodies, uint64_t *seed) {
    pir_band_pose pose = {.room = -INFINITY};
    double square;
    do {
        square = 0;
        for (int k = 0; k < 4; k++) {
            pose.q[k] = 2 * uniform(seed) - 1;
            square += pose.q[k] * pose.q[k];
        }
    } while (square > 1 || square < 0x1p-10);
    for (int k = 0; k < 4; k++)
        pose.q[k] /= sqrt(square);
    for (int k = 0; k < 3; k++)
        pose.t[k] = bodies->low[k] + uniform(seed) * (bodies->high[k] - bodies->low[k]);
    return pose;
}

/* Makes the ends the roots. */
static pir_status plant(pir_band_bodies *bodies, const pir_band_pose end[2], pir_band_trees *trees) {
    pir_status status = PIR_OK;
    for (int side = 0; side < 2 && status == PIR_OK; side++) {
        pir_band_near near[PIR_BAND_NEAR];
        pir_band_pose pose = end[side];
        uint32_t count;
        status = pir_band_look(bodies, &pose, 2 * bodies->radius * STRIDE, 0, near, &count, &pose.room);
        if (status == PIR_OK)
            status = add_node(trees, side, &pose, 0);
    }
    return status;
}

pir_status pir_band_trees_grow(pir_band_bodies *bodies, const pir_band_pose end[2], uint64_t work,
                               pir_band_trees *trees, uint32_t ret_met[2]) {
    const uint64_t begin = bodies->work;
    pir_status status = trees->count[0] == 0 ? plant(bodies, end, trees) : PIR_OK;
    while (status == PIR_OK && bodies->work - begin < work) {
        const int side = trees->turn++ & 1;
        const uint32_t had = trees->count[side];
        const pir_band_pose target = random_pose(bodies, &trees->seed);
        bool is_there;
        status = walk(bodies, trees, side, &target, &ret_met[side], &is_there);
        if (status != PIR_OK || trees->count[side] == had)
            continue;
        const pir_band_pose last = trees->node[side][ret_met[side]].pose;
        status = walk(bodies, trees, 1 - side, &last, &ret_met[1 - side], &is_there);
        if (status == PIR_OK && is_there)
            return PIR_OK;
    }
    return status == PIR_OK ? PIR_ERR_EMPTY : status;
}

pir_status pir_band_trees_way(const pir_band_trees *trees, const uint32_t met[2], pir_band_row *row) {
    uint32_t count[2];
    for (int side = 0; side < 2; side++) {
        count[side] = 1;
        for (uint32_t at = met[side]; at > 0; at = trees->node[side][at].before)
            count[side]++;
    }
    row->count = count[0] + count[1];
    if (!pir_band_row_reserve(row, row->count))
        return PIR_ERR_MEMORY;
    for (int side = 0; side < 2; side++) {
        uint32_t at = met[side];
        for (uint32_t i = 0; i < count[side]; i++, at = trees->node[side][at].before)
            row->pose[side ? count[0] + i : count[0] - 1 - i] = trees->node[side][at].pose;
    }
    return PIR_OK;
}
