/* SPDX-License-Identifier: MIT */
/* The tree of quat_tree.h. */
#include "cspace/grid/quat_tree.h"

#include "cspace/grid/angle.h"

static double component(pir_quat q, uint32_t axis) {
    return axis == 0 ? q.x : axis == 1 ? q.y : axis == 2 ? q.z : q.w;
}

/* --- building --- */

static void swap(uint32_t *item, uint32_t a, uint32_t b) {
    uint32_t held = item[a];
    item[a] = item[b];
    item[b] = held;
}

/* Whether item a stands before item b by a component, and by number where that is equal. */
static bool before(const pir_quat_tree *tree, uint32_t axis, uint32_t a, uint32_t b) {
    double x = component(tree->unit[a], axis), y = component(tree->unit[b], axis);
    return x < y || (x == y && a < b);
}

/* Brings the item that belongs there to `middle` of [from, to), what is less before it (Hoare's selection). */
static void select_middle(pir_quat_tree *tree, uint32_t axis, uint32_t from, uint32_t to, uint32_t middle) {
    uint32_t *item = tree->item;
    while (to - from > 1) {
        // the middle one of three as the pivot, at the front
        uint32_t a = from, b = from + (to - from) / 2, c = to - 1;
        if (before(tree, axis, item[b], item[a]))
            swap(item, a, b);
        if (before(tree, axis, item[c], item[b]))
            swap(item, b, c);
        if (before(tree, axis, item[b], item[a]))
            swap(item, a, b);
        swap(item, from, b);
        uint32_t pivot = item[from], kept = from;
        for (uint32_t k = from + 1; k < to; k++)
            if (before(tree, axis, item[k], pivot))
                swap(item, ++kept, k);
        swap(item, from, kept);
        if (kept == middle)
            return;
        if (kept < middle)
            from = kept + 1;
        else
            to = kept;
    }
}

static void build(pir_quat_tree *tree, uint32_t from, uint32_t to, uint32_t depth) {
    if (to - from < 2)
        return;
    uint32_t middle = from + (to - from) / 2;
    select_middle(tree, depth % 4, from, to, middle);
    build(tree, from, middle, depth + 1);
    build(tree, middle + 1, to, depth + 1);
}

void pir_quat_tree_build(pir_quat_tree *tree) {
    build(tree, 0, tree->count, 0);
}

/* --- searching --- */

struct tree_search {
    const pir_quat_tree *tree;
    pir_quat unit;
    bool opposite; /* the second of two searches, for −q: a product of 0 was seen by the first */
    const pir_tree_filter *filter;
    pir_near *near;
};

static void offer(const struct tree_search *search, uint32_t item) {
    double close = pir_quat_dot(search->unit, search->tree->unit[item]);
    if (search->opposite ? close <= 0 : close < 0)
        return;
    if (!search->filter || search->filter->group[item] != search->filter->other_than)
        pir_near_offer(search->near, close, item);
}

static void descend(const struct tree_search *search, uint32_t from, uint32_t to, uint32_t depth) {
    while (from < to) {
        uint32_t middle = from + (to - from) / 2, item = search->tree->item[middle];
        offer(search, item);
        double beyond = component(search->unit, depth % 4) - component(search->tree->unit[item], depth % 4);
        depth++;
        if (beyond < 0)
            descend(search, from, middle, depth);
        else
            descend(search, middle + 1, to, depth);
        // chords on the sphere: |q − r|² = 2 − 2 q·r, no less than the distance from the plane that divides,
        // squared
        if (beyond * beyond > 2 - 2 * pir_near_least(search->near) + 1e-12)
            return;
        if (beyond < 0)
            from = middle + 1;
        else
            to = middle;
    }
}

void pir_quat_tree_nearest(const pir_quat_tree *tree, pir_quat unit, const pir_tree_filter *filter, pir_near *near) {
    struct tree_search search = {tree, unit, false, filter, near};
    descend(&search, 0, tree->count, 0);
    search.unit = (pir_quat){-unit.x, -unit.y, -unit.z, -unit.w};
    search.opposite = true;
    descend(&search, 0, tree->count, 0);
}
