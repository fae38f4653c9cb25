/* SPDX-License-Identifier: MIT */
/*
 * One traversal for both kinds of surfaces. An entry of the stack is a node of a mesh's tree, a leaf there, or a block
 * of a height field's pyramid: its level, column and row in 32 bits.
 *
 * The stack has room for the deepest tree: each node that is left leaves at most three siblings behind.
 */
#include "mesh/query/mesh_walk.h"

#define STACK (PIR_MESH_WIDTH * PIR_MESH_DEPTH)

struct entry {
    uint32_t node;
    double near;
};

struct stack {
    struct entry entry[STACK];
    uint32_t used;
};

pir_status pir_surface_check(pir_surface_ref surface) {
    return surface.mesh || surface.field ? PIR_OK : PIR_ERR_ARGUMENT;
}

/* Pushes children, the nearest last, so that it is popped first. */
static void push(struct stack *stack, const pir_walk *walk, const pir_mesh_boxes *boxes,
                 const uint32_t child[PIR_MESH_WIDTH], int count) {
    double near[PIR_MESH_WIDTH];
    walk->measure(walk->context, boxes, near);
    uint32_t first = stack->used;
    for (int i = 0; i < count; i++) {
        if (!(near[i] <= *walk->most))
            continue;
        uint32_t at = stack->used++;
        for (; at > first && stack->entry[at - 1].near < near[i]; at--)
            stack->entry[at] = stack->entry[at - 1];
        stack->entry[at] = (struct entry){child[i], near[i]};
    }
}

/* --- meshes --- */

static bool look_at_leaf(const pir_trimesh *mesh, const pir_walk *walk, uint32_t leaf) {
    uint32_t start = pir_mesh_leaf_start(leaf), end = start + pir_mesh_leaf_count(leaf);
    for (uint32_t i = start; i < end; i++) {
        uint32_t t = mesh->tree.item[i];
        const uint32_t *c = mesh->corner[t];
        const pir_met_triangle met = {t, {c[0], c[1], c[2]}, pir_trimesh_tri(mesh, t)};
        if (!walk->look(walk->context, &met))
            return false;
    }
    return true;
}

static void walk_mesh(const pir_trimesh *mesh, const pir_walk *walk) {
    struct stack stack;
    stack.used = 1; // the rest is written before it is read
    stack.entry[0] = (struct entry){0, -HUGE_VAL};
    while (stack.used > 0) {
        struct entry entry = stack.entry[--stack.used];
        if (!(entry.near <= *walk->most))
            continue;
        if (pir_mesh_is_leaf(entry.node)) {
            if (!look_at_leaf(mesh, walk, entry.node))
                return;
            continue;
        }
        const pir_mesh_node *node = &mesh->tree.node[entry.node];
        pir_mesh_boxes boxes;
        pir_mesh_read_boxes(node, &boxes);
        push(&stack, walk, &boxes, node->child, node->count);
    }
}

/* --- height fields --- */

static uint32_t block(uint32_t level, uint32_t i, uint32_t j) {
    return level << 28 | j << 14 | i;
}

static bool look_at_cell(const pir_height_field *field, const pir_walk *walk, uint32_t i, uint32_t j) {
    uint32_t cell = j * pir_height_cell_columns(field) + i, from = j * field->columns + i;
    if (pir_height_is_hole(field, cell))
        return true;
    const uint32_t across = from + field->columns + 1;
    for (uint32_t k = 0; k < 2; k++) {
        const pir_met_triangle met = {2 * cell + k,
                                      {from, k == 0 ? from + 1 : across, k == 0 ? across : from + field->columns},
                                      pir_height_tri(field, 2 * cell + k)};
        if (!walk->look(walk->context, &met))
            return false;
    }
    return true;
}

/* The cells of a block of level 0. */
static bool look_at_block(const pir_height_field *field, const pir_walk *walk, uint32_t i, uint32_t j) {
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t x = 2 * i + k % 2, y = 2 * j + k / 2;
        if (x + 1 < field->columns && y + 1 < field->rows && !look_at_cell(field, walk, x, y))
            return false;
    }
    return true;
}

/* Where a block of a level ends along an axis, in samples. */
static uint32_t end_of(uint32_t at, uint32_t level, uint32_t last) {
    uint64_t end = (uint64_t)at << (level + 1);
    return end < last ? (uint32_t)end : last;
}

static void set_block_box(const pir_height_field *field, uint32_t level, uint32_t i, uint32_t j, pir_mesh_boxes *boxes,
                          int child) {
    const pir_height_range *range =
        &field->range[field->level_start[level] + (size_t)j * field->level_columns[level] + i];
    boxes->low[0][child] = pir_float_under((double)end_of(i, level, field->columns - 1) * field->step_x);
    boxes->high[0][child] = pir_float_over((double)end_of(i + 1, level, field->columns - 1) * field->step_x);
    boxes->low[1][child] = pir_float_under((double)end_of(j, level, field->rows - 1) * field->step_y);
    boxes->high[1][child] = pir_float_over((double)end_of(j + 1, level, field->rows - 1) * field->step_y);
    boxes->low[2][child] = range->low;
    boxes->high[2][child] = range->high;
}

static void push_blocks(const pir_height_field *field, const pir_walk *walk, struct stack *stack, uint32_t node) {
    uint32_t level = (node >> 28) - 1, i = 2 * (node & 0x3fff), j = 2 * (node >> 14 & 0x3fff);
    uint32_t child[PIR_MESH_WIDTH];
    pir_mesh_boxes boxes;
    int count = 0;
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t x = i + k % 2, y = j + k / 2;
        if (x >= field->level_columns[level] || y >= field->level_rows[level])
            continue;
        const pir_height_range *range =
            &field->range[field->level_start[level] + (size_t)y * field->level_columns[level] + x];
        if (range->low > range->high)
            continue;
        set_block_box(field, level, x, y, &boxes, count);
        child[count++] = block(level, x, y);
    }
    for (int c = count; c > 0 && c < PIR_MESH_WIDTH; c++)
        for (int k = 0; k < 3; k++) {
            boxes.low[k][c] = boxes.low[k][0];
            boxes.high[k][c] = boxes.high[k][0];
        }
    if (count > 0)
        push(stack, walk, &boxes, child, count);
}

static void walk_field(const pir_height_field *field, const pir_walk *walk) {
    struct stack stack;
    stack.used = 1; // the rest is written before it is read
    stack.entry[0] = (struct entry){block(field->levels - 1, 0, 0), -HUGE_VAL};
    while (stack.used > 0) {
        struct entry entry = stack.entry[--stack.used];
        if (!(entry.near <= *walk->most))
            continue;
        if (entry.node >> 28 != 0)
            push_blocks(field, walk, &stack, entry.node);
        else if (!look_at_block(field, walk, entry.node & 0x3fff, entry.node >> 14 & 0x3fff))
            return;
    }
}

void pir_surface_walk(pir_surface_ref surface, const pir_walk *walk) {
    if (surface.mesh)
        walk_mesh(surface.mesh, walk);
    else
        walk_field(surface.field, walk);
}

pir_tri pir_surface_tri(pir_surface_ref surface, uint32_t triangle) {
    return surface.mesh ? pir_trimesh_tri(surface.mesh, triangle) : pir_height_tri(surface.field, triangle);
}

uint32_t pir_surface_material(pir_surface_ref surface, uint32_t triangle) {
    if (surface.mesh)
        return surface.mesh->material ? surface.mesh->material[triangle] : 0;
    return surface.field->material ? surface.field->material[triangle / 2] : 0;
}

void pir_surface_reach(pir_surface_ref surface, double ret_reach[3]) {
    if (surface.mesh) {
        const pir_mesh_tree *tree = &surface.mesh->tree;
        for (int k = 0; k < 3; k++)
            ret_reach[k] = fmax(fabs((double)tree->low[k]), fabs((double)tree->high[k]));
        return;
    }
    const pir_height_field *field = surface.field;
    ret_reach[0] = field->high.x;
    ret_reach[1] = field->high.y;
    ret_reach[2] = fmax(fabs(field->low.z), fabs(field->high.z));
}
