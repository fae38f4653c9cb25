/* SPDX-License-Identifier: MIT */
/* See join.h. */
#include "plan/join.h"

#include "base/sort.h"

static uint32_t root_of(uint32_t *root, uint32_t i) {
    while (root[i] != i)
        i = root[i] = root[root[i]];
    return i;
}

/* Whether two cells can share a polygon: a plane bounds them from opposite sides. */
static bool have_wall(const pir_plan_cell *a, const pir_plan_cell *b) {
    for (uint32_t i = 0; i < a->halves; i++)
        for (uint32_t k = 0; k < b->halves; k++)
            if (a->half[i] == (b->half[k] ^ 1))
                return true;
    return false;
}

static void join_two(pir_plan_cutter *cutter, const pir_plan_tree *tree, uint32_t a, uint32_t b,
                     pir_plan_joints *joints) {
    pir_plan_space *space = cutter->space;
    const uint32_t of_a = root_of(joints->root, a), of_b = root_of(joints->root, b);
    if (of_a == of_b || (!tree->open && !have_wall(&tree->cell[a], &tree->cell[b])))
        return;
    pir_plan_cell common;
    pir_plan_cell_common(cutter, &tree->cell[a], &tree->cell[b], &common);
    // three vertices span a polygon
    if (common.points >= (tree->open ? 1u : 3u) && space->status == PIR_OK &&
        pir_plan_grow(space, (void **)&joints->joint, &joints->room, joints->count + 1, sizeof *joints->joint)) {
        const uint32_t door =
            joints->without_doors ? PIR_PLAN_NONE : pir_plan_point_mean(space, common.point, common.points);
        joints->joint[joints->count++] = (pir_plan_joint){{a, b}, door};
        joints->root[of_a] = of_b;
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
