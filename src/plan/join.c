/* SPDX-License-Identifier: MIT */
/* See join.h. */
#include "plan/join.h"

#include "base/sort.h"

static uint32_t root_of(uint32_t *root, uint32_t i) {
    while (root[i] != i)
        i = root[i] = root[root[i]];
    return i;
}

static bool is_tight(const pir_plan_cell *cell, uint32_t point, uint32_t h) {
    return cell->tight[point * cell->words + h / 64] >> h % 64 & 1;
}

/* Whether all points of a cell on one of its planes are beyond another plane, or on it: as far as doubles tell. */
static bool is_wall_beyond(pir_plan_space *space, const pir_plan_cell *cell, uint32_t wall, uint32_t half) {
    uint32_t own = 0;
    while (own < cell->halves && cell->half[own] >> 1 != half >> 1)
        own++;
    for (uint32_t i = 0; i < cell->points; i++) {
        double error;
        if (!is_tight(cell, i, wall) || (own < cell->halves && is_tight(cell, i, own)))
            continue;
        const double far = pir_plan_value(space, half >> 1, cell->point[i], &error);
        if (!((half & 1 ? -far : far) > error))
            return false;
    }
    return true;
}

/* Whether two cells may share a polygon: a plane bounds them from opposite sides, and no other parts what they have
 * there. */
static bool have_wall(pir_plan_space *space, const pir_plan_cell *a, const pir_plan_cell *b) {
    for (uint32_t i = 0; i < a->halves; i++)
        for (uint32_t k = 0; k < b->halves; k++) {
            bool may = a->half[i] == (b->half[k] ^ 1);
            for (uint32_t h = 0; h < b->halves && may; h++)
                may = h == k || !is_wall_beyond(space, a, i, b->half[h]);
            for (uint32_t h = 0; h < a->halves && may; h++)
                may = h == i || !is_wall_beyond(space, b, k, a->half[h]);
            if (may)
                return true;
        }
    return false;
}

/* Whether two cells have three vertices in common, which span a polygon. */
static bool have_three(const pir_plan_cell *a, const pir_plan_cell *b) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < a->points && count < 3; i++)
        for (uint32_t k = 0; k < b->points; k++)
            count += a->point[i] == b->point[k];
    return count >= 3;
}

static void add_joint(pir_plan_space *space, const uint32_t cell[2], uint32_t door, pir_plan_joints *joints) {
    if (!pir_plan_grow(space, (void **)&joints->joint, &joints->room, joints->count + 1, sizeof *joints->joint))
        return;
    joints->joint[joints->count++] = (pir_plan_joint){{cell[0], cell[1]}, door};
    joints->root[root_of(joints->root, cell[0])] = root_of(joints->root, cell[1]);
}

static void join_two(pir_plan_cutter *cutter, const pir_plan_tree *tree, uint32_t a, uint32_t b,
                     pir_plan_joints *joints) {
    pir_plan_space *space = cutter->space;
    const pir_plan_cell *of_a = &tree->cell[a], *of_b = &tree->cell[b];
    const uint32_t cell[2] = {a, b};
    if (root_of(joints->root, a) == root_of(joints->root, b))
        return;
    if (joints->without_doors && have_three(of_a, of_b)) {
        add_joint(space, cell, PIR_PLAN_NONE, joints);
        return;
    }
    if (!tree->open && !have_wall(space, of_a, of_b))
        return;
    pir_plan_cell common;
    pir_plan_cell_common(cutter, of_a, of_b, &common);
    // three vertices span a polygon
    if (common.points >= (tree->open ? 1u : 3u) && space->status == PIR_OK) {
        const uint32_t door =
            joints->without_doors ? PIR_PLAN_NONE : pir_plan_point_mean(space, common.point, common.points);
        add_joint(space, cell, door, joints);
    }
    pir_plan_cell_free(space, &common);
}

/* Cells by their least x. */
static bool is_before(void *context, uint32_t a, uint32_t b) {
    const pir_plan_tree *tree = context;
    return tree->cell[a].low[0] < tree->cell[b].low[0];
}

void pir_plan_join(pir_plan_cutter *cutter, const pir_plan_tree *tree, pir_plan_joints *joints) {
    pir_plan_space *space = cutter->space;
    const uint32_t count = tree->cell_count;
    joints->root = pir_plan_new(space, count, sizeof *joints->root);
    joints->cells = count;
    uint32_t *order = pir_plan_new(space, count, sizeof *order), *active = pir_plan_new(space, count, sizeof *active);
    uint32_t actives = 0;
    for (uint32_t i = 0; i < count && space->status == PIR_OK; i++)
        order[i] = joints->root[i] = i;
    if (space->status == PIR_OK)
        pir_sort(order, count, active, is_before, (void *)tree);
    for (uint32_t i = 0; i < count && space->status == PIR_OK; i++) {
        const pir_plan_cell *own = &tree->cell[order[i]];
        uint32_t kept = 0;
        for (uint32_t k = 0; k < actives && space->status == PIR_OK; k++) {
            const pir_plan_cell *other = &tree->cell[active[k]];
            if (other->high[0] < own->low[0])
                continue;
            if (pir_plan_boxes_meet(own->low, own->high, other->low, other->high))
                join_two(cutter, tree, order[i], active[k], joints);
            active[kept++] = active[k];
        }
        active[kept++] = order[i];
        actives = kept;
    }
    for (uint32_t i = 0; i < count && space->status == PIR_OK; i++)
        joints->root[i] = root_of(joints->root, i);
    pir_plan_free(space, order, count, sizeof *order);
    pir_plan_free(space, active, count, sizeof *active);
}

void pir_plan_joints_finish(pir_plan_space *space, pir_plan_joints *joints) {
    pir_plan_free(space, joints->joint, joints->room, sizeof *joints->joint);
    pir_plan_free(space, joints->root, joints->cells, sizeof *joints->root);
    *joints = (pir_plan_joints){0};
}
