/* SPDX-License-Identifier: MIT */
/*
 * A path is shortened by two moves, tried with the nearest neighbours of each rotation (Johnson and McGeoch, The
 * Traveling Salesman Problem: A Case Study, 1997):
 *
 *     exchange    two steps a–b and c–d become a–c and b–d; what lies between is reversed
 *     shift       up to three successive rotations go elsewhere between two others, as they are or reversed
 *
 * A move that would rewrite more than REACH places is not made, so that the work stays near linear. Passes over all
 * rotations go on while they shorten the path by a hundredth of a percent.
 *
 * Invariants: `place` is the inverse of `order`; each move lowers the length by more than rounding.
 */
#include "cspace/grid/polish.h"

#include <math.h>
#include <stdlib.h>

#include "base/layout.h"
#include "cspace/grid/angle.h"
#include "cspace/grid/quat_tree.h"

#define REACH      30000
#define PASSES     20
#define LEAST_GAIN 1e-9

typedef struct path {
    const pir_quat *unit;
    uint32_t count;
    uint32_t *order, *place, *item;
    uint32_t *neighbour; /* PIR_POLISH_NEIGHBOURS of each, itself among them where there are no more */
    double gained;
} path;

static pir_layout layout_of(path *p) {
    return (pir_layout){{PIR_ROW(p->place, p->count), PIR_ROW(p->item, p->count),
                         PIR_ROW(p->neighbour, (size_t)PIR_POLISH_NEIGHBOURS * p->count)}};
}

/* The chord between two rotations: the length of a step. */
static double step(const path *p, uint32_t a, uint32_t b) {
    double close = fabs(pir_quat_dot(p->unit[a], p->unit[b]));
    return close < 1 ? sqrt(2 - 2 * close) : 0;
}

/* The step between two places of the path. 0 where one is beyond its ends. */
static double step_at(const path *p, int64_t i, int64_t j) {
    if (i < 0 || j < 0 || i >= p->count || j >= p->count)
        return 0;
    return step(p, p->order[i], p->order[j]);
}

static void reverse(path *p, int64_t from, int64_t to) {
    for (; from < to; from++, to--) {
        uint32_t held = p->order[from];
        p->order[from] = p->order[to];
        p->order[to] = held;
        p->place[p->order[from]] = (uint32_t)from;
        p->place[p->order[to]] = (uint32_t)to;
    }
    if (from == to)
        p->place[p->order[from]] = (uint32_t)from;
}

/* Reverses the places from … to when that shortens the path. */
static bool exchange(path *p, int64_t from, int64_t to) {
    if (from > to || to - from > REACH)
        return false;
    double gain =
        step_at(p, from - 1, from) + step_at(p, to, to + 1) - step_at(p, from - 1, to) - step_at(p, from, to + 1);
    if (gain <= LEAST_GAIN)
        return false;
    reverse(p, from, to);
    p->gained += gain;
    return true;
}

/* Tries to make a step between what stands at place i and its neighbour at place j. */
static bool try_exchange(path *p, int64_t i, int64_t j) {
    int64_t low = i < j ? i : j, high = i < j ? j : i;
    return exchange(p, low + 1, high) || exchange(p, low, high - 1);
}

/* Moves the `length` places from `from` on to stand before place `before`, reversed or not, when that gains. */
static bool shift(path *p, int64_t from, int64_t length, int64_t before) {
    int64_t last = from + length - 1;
    if (last >= p->count || (before >= from && before <= last + 1) || llabs(before - from) > REACH)
        return false;
    double closed = step_at(p, from - 1, from) + step_at(p, last, last + 1) - step_at(p, from - 1, last + 1);
    double opened = step_at(p, before - 1, before);
    double as_is = step_at(p, before - 1, from) + step_at(p, last, before) - opened;
    double turned = step_at(p, before - 1, last) + step_at(p, from, before) - opened;
    double gain = closed - fmin(as_is, turned);
    if (gain <= LEAST_GAIN)
        return false;
    // the piece and what it passes change places: all reversed, then each part reversed back
    if (before > last) {
        reverse(p, from, before - 1);
        reverse(p, from, before - 1 - length);
        if (as_is <= turned)
            reverse(p, before - length, before - 1);
    } else {
        reverse(p, before, last);
        reverse(p, before + length, last);
        if (as_is <= turned)
            reverse(p, before, before + length - 1);
    }
    p->gained += gain;
    return true;
}

/* Tries to move the pieces that begin or end at place i beside place j. */
static bool try_shift(path *p, int64_t i, int64_t j) {
    for (int64_t length = 1; length <= 3; length++)
        for (int64_t side = 0; side < 2; side++) {
            int64_t from = side ? i - length + 1 : i;
            if (from >= 0 && (shift(p, from, length, j) || shift(p, from, length, j + 1)))
                return true;
        }
    return false;
}

/* Makes one move that brings a rotation beside a neighbour. */
static bool improve(path *p, uint32_t rotation) {
    for (uint32_t k = 0; k < PIR_POLISH_NEIGHBOURS; k++) {
        uint32_t other = p->neighbour[(size_t)PIR_POLISH_NEIGHBOURS * rotation + k];
        int64_t i = p->place[rotation], j = p->place[other];
        // no move pays whose new step is as long as both old ones
        double new_step = step(p, rotation, other);
        if (new_step >= step_at(p, i - 1, i) && new_step >= step_at(p, i, i + 1))
            return false;
        if (i != j && (try_exchange(p, i, j) || try_shift(p, i, j)))
            return true;
    }
    return false;
}

static void name_neighbours(path *p) {
    pir_quat_tree tree = {p->unit, p->item, p->count};
    pir_quat_tree_build(&tree);
    for (uint32_t i = 0; i < p->count; i++) {
        // itself is the nearest, or one that is equal to it
        pir_near near = {.capacity = PIR_POLISH_NEIGHBOURS + 1};
        pir_quat_tree_nearest(&tree, p->unit[i], NULL, &near);
        uint32_t *neighbour = p->neighbour + (size_t)PIR_POLISH_NEIGHBOURS * i, found = 0;
        for (size_t k = 0; k < near.count && found < PIR_POLISH_NEIGHBOURS; k++)
            if (near.number[k] != i)
                neighbour[found++] = (uint32_t)near.number[k];
        for (; found < PIR_POLISH_NEIGHBOURS; found++)
            neighbour[found] = i;
    }
}

bool pir_polish(const pir_quat *unit, uint32_t count, const pir_allocator *allocator, uint32_t *order) {
    path p = {.unit = unit, .count = count, .order = order};
    pir_layout layout = layout_of(&p);
    bool made = pir_layout_new(allocator, &layout);
    if (made) {
        double length = 0;
        for (uint32_t i = 0; i < count; i++) {
            p.item[i] = i;
            p.place[order[i]] = i;
            length += step_at(&p, (int64_t)i - 1, i);
        }
        name_neighbours(&p);
        for (int pass = 0; pass < PASSES; pass++) {
            p.gained = 0;
            for (uint32_t i = 0; i < count; i++)
                while (improve(&p, i))
                    continue;
            if (p.gained <= 1e-4 * length)
                break;
        }
    }
    pir_layout_free(allocator, &layout);
    return made;
}
