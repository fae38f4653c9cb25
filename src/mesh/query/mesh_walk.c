/* SPDX-License-Identifier: MIT */
/*
 * One traversal for both kinds of surfaces. An entry of the stack is a node of a mesh's tree, a leaf there, or a block
 * of a height field: of level 0 a cell, of level l + 1 a block of level l of the pyramid. A walk of a field begins with
 * the four blocks, or fewer, of the lowest level at which so few hold all of the box that it is kept within.
 *
 * The stack has room for the deepest tree: each node that is left leaves at most three siblings behind.
 */
#include "mesh/query/mesh_walk.h"

#define STACK (PIR_MESH_WIDTH * PIR_MESH_DEPTH)

/* Columns of cells have numbers below 2^15. */
#define COLUMN_BITS 15

struct entry {
    double near;
    uint32_t node; /* or column and row */
    uint32_t level;
};

struct stack {
    struct entry entry[STACK];
    uint32_t used;
};

void pir_walk_box_measure(const pir_walk_box *box, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    for (int i = 0; i < PIR_MESH_WIDTH; i++)
        ret_near[i] = 0;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < PIR_MESH_WIDTH; i++)
            if ((double)boxes->low[k][i] > box->high[k] || (double)boxes->high[k][i] < box->low[k])
                ret_near[i] = HUGE_VAL;
}

/* Whether the span of three numbers meets an interval. */
static bool spans_meet(double a, double b, double c, double low, double high) {
    return (a <= high || b <= high || c <= high) && (a >= low || b >= low || c >= low);
}

bool pir_walk_box_meets(const pir_walk_box *box, const pir_tri *tri) {
    const pir_vec3 *p = tri->p;
    return spans_meet(p[0].z, p[1].z, p[2].z, box->low[2], box->high[2]) &&
           spans_meet(p[0].x, p[1].x, p[2].x, box->low[0], box->high[0]) &&
           spans_meet(p[0].y, p[1].y, p[2].y, box->low[1], box->high[1]);
}

pir_status pir_surface_check(pir_surface_ref surface) {
    return surface.mesh || surface.field ? PIR_OK : PIR_ERR_ARGUMENT;
}

/* Pushes children, the nearest last, so that it is popped first. */
static void push(struct stack *stack, const pir_walk *walk, const pir_mesh_boxes *boxes,
                 const struct entry child[PIR_MESH_WIDTH], int count) {
    double near[PIR_MESH_WIDTH];
    walk->measure(walk->context, boxes, near);
    uint32_t first = stack->used;
    for (int i = 0; i < count; i++) {
        if (!(near[i] <= *walk->most))
            continue;
        uint32_t at = stack->used++;
        for (; at > first && stack->entry[at - 1].near < near[i]; at--)
            stack->entry[at] = stack->entry[at - 1];
        stack->entry[at] = (struct entry){near[i], child[i].node, child[i].level};
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
    stack.entry[0] = (struct entry){-HUGE_VAL, 0, 0};
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
        struct entry child[PIR_MESH_WIDTH];
        pir_mesh_read_boxes(node, &boxes);
        for (int i = 0; i < PIR_MESH_WIDTH; i++)
            child[i].node = node->child[i];
        push(&stack, walk, &boxes, child, node->count);
    }
}

/* --- height fields --- */

/* The two triangles of a cell. */
static bool look_at_cell(const pir_height_field *field, const pir_walk *walk, uint32_t i, uint32_t j) {
    const uint32_t cell = j * pir_height_cell_columns(field) + i, from = j * field->columns + i, right = from + 1,
                   above = from + field->columns, across = above + 1;
    const pir_vec3 a = pir_height_sample(field, i, j), b = pir_height_sample(field, i + 1, j),
                   c = pir_height_sample(field, i + 1, j + 1), d = pir_height_sample(field, i, j + 1);
    const pir_met_triangle first = {2 * cell, {from, right, across}, {{a, b, c}}},
                           second = {2 * cell + 1, {from, across, above}, {{a, c, d}}};
    return walk->look(walk->context, &first) && walk->look(walk->context, &second);
}

static pir_height_range range_of_cell(const pir_height_field *field, uint32_t i, uint32_t j) {
    const double a = pir_height_sample(field, i, j).z, b = pir_height_sample(field, i + 1, j).z,
                 c = pir_height_sample(field, i, j + 1).z, d = pir_height_sample(field, i + 1, j + 1).z;
    const double low_ab = a < b ? a : b, low_cd = c < d ? c : d, high_ab = a < b ? b : a, high_cd = c < d ? d : c;
    return (pir_height_range){pir_mesh_below(low_ab < low_cd ? low_ab : low_cd),
                              pir_mesh_above(high_ab > high_cd ? high_ab : high_cd)};
}

/* The heights in a block; whether it is more than holes. */
static bool range_of(const pir_height_field *field, uint32_t level, uint32_t i, uint32_t j,
                     pir_height_range *ret_range) {
    if (level > 0) {
        const uint32_t l = level - 1;
        *ret_range = field->range[field->level_start[l] + (size_t)j * field->level_columns[l] + i];
        return ret_range->low <= ret_range->high;
    }
    if (pir_height_is_hole(field, j * pir_height_cell_columns(field) + i))
        return false;
    *ret_range = range_of_cell(field, i, j);
    return true;
}

/* Where a block of a level ends along an axis, in samples. */
static uint32_t end_of(uint32_t at, uint32_t level, uint32_t last) {
    const uint64_t end = (uint64_t)at << level;
    return end < last ? (uint32_t)end : last;
}

/* Blocks of a level: columns and rows from the first to the last, at most two of each. */
struct blocks {
    uint32_t level, i[2], j[2];
};

/* The sides of at most two columns or rows of blocks, rounded outward. */
struct block_sides {
    float low[2], high[2];
};

static struct block_sides sides_of(const uint32_t at[2], uint32_t level, uint32_t last, double step) {
    struct block_sides sides;
    for (int k = 0; k < 2; k++) {
        sides.low[k] = pir_mesh_below((double)end_of(at[k], level, last) * step);
        sides.high[k] = pir_mesh_above((double)end_of(at[k] + 1, level, last) * step);
    }
    return sides;
}

static void set_box(pir_mesh_boxes *boxes, int child, const float low[3], const float high[3]) {
    for (int k = 0; k < 3; k++) {
        boxes->low[k][child] = low[k];
        boxes->high[k][child] = high[k];
    }
}

static void push_blocks(const pir_height_field *field, const pir_walk *walk, struct stack *stack,
                        const struct blocks *blocks) {
    const struct block_sides x = sides_of(blocks->i, blocks->level, field->columns - 1, field->step_x),
                             y = sides_of(blocks->j, blocks->level, field->rows - 1, field->step_y);
    struct entry child[PIR_MESH_WIDTH];
    pir_mesh_boxes boxes = {{{0}}, {{0}}};
    pir_height_range range;
    int count = 0;
    for (uint32_t b = 0; b <= blocks->j[1] - blocks->j[0]; b++)
        for (uint32_t a = 0; a <= blocks->i[1] - blocks->i[0]; a++) {
            const uint32_t i = blocks->i[a], j = blocks->j[b];
            if (!range_of(field, blocks->level, i, j, &range))
                continue;
            set_box(&boxes, count, (float[3]){x.low[a], y.low[b], range.low},
                    (float[3]){x.high[a], y.high[b], range.high});
            child[count++] = (struct entry){0, j << COLUMN_BITS | i, blocks->level};
        }
    if (count > 0)
        push(stack, walk, &boxes, child, count);
}

static uint32_t lesser(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

/* The blocks that a block is made of. */
static struct blocks blocks_of(const pir_height_field *field, const struct entry *entry) {
    const uint32_t level = entry->level - 1, i = 2 * (entry->node & ((1u << COLUMN_BITS) - 1)),
                   j = 2 * (entry->node >> COLUMN_BITS);
    const uint32_t columns = level > 0 ? field->level_columns[level - 1] : field->columns - 1,
                   rows = level > 0 ? field->level_rows[level - 1] : field->rows - 1;
    return (struct blocks){level, {i, lesser(i + 1, columns - 1)}, {j, lesser(j + 1, rows - 1)}};
}

/*
 * The first and the last of so many cells that an interval along an axis meets; false where it meets none. A quotient
 * below 2^16 is off by less than 2^-36.
 */
static bool cells_between(double low, double high, double step, uint32_t cells, uint32_t ret_cells[2]) {
    const double first = low / step - 0x1p-30, last = high / step + 0x1p-30;
    if (!(last >= 0 && first <= cells))
        return false;
    ret_cells[0] = first > 0 ? lesser((uint32_t)first, cells - 1) : 0;
    ret_cells[1] = last < cells ? (uint32_t)last : cells - 1;
    return true;
}

/* Where a walk begins; false where it has nothing to look at. */
static bool first_blocks(const pir_height_field *field, const pir_walk_box *within, struct blocks *ret_blocks) {
    *ret_blocks = (struct blocks){field->levels, {0, 0}, {0, 0}};
    if (!within)
        return true;
    uint32_t i[2], j[2], level = 0;
    if (within->low[2] > field->high.z || within->high[2] < field->low.z ||
        !cells_between(within->low[0], within->high[0], field->step_x, field->columns - 1, i) ||
        !cells_between(within->low[1], within->high[1], field->step_y, field->rows - 1, j))
        return false;
    while ((i[1] >> level) - (i[0] >> level) > 1 || (j[1] >> level) - (j[0] >> level) > 1)
        level++;
    *ret_blocks = (struct blocks){level, {i[0] >> level, i[1] >> level}, {j[0] >> level, j[1] >> level}};
    return true;
}

static void walk_field(const pir_height_field *field, const pir_walk *walk) {
    struct stack stack;
    struct blocks blocks;
    stack.used = 0; // the rest is written before it is read
    if (!first_blocks(field, walk->within, &blocks))
        return;
    push_blocks(field, walk, &stack, &blocks);
    while (stack.used > 0) {
        const struct entry entry = stack.entry[--stack.used];
        if (!(entry.near <= *walk->most))
            continue;
        if (entry.level > 0) {
            blocks = blocks_of(field, &entry);
            push_blocks(field, walk, &stack, &blocks);
        } else if (!look_at_cell(field, walk, entry.node & ((1u << COLUMN_BITS) - 1), entry.node >> COLUMN_BITS)) {
            return;
        }
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

pir_met_triangle pir_surface_met(pir_surface_ref surface, uint32_t triangle) {
    pir_met_triangle met = {triangle, {0, 0, 0}, pir_surface_tri(surface, triangle)};
    if (surface.mesh) {
        for (int k = 0; k < 3; k++)
            met.id[k] = surface.mesh->corner[triangle][k];
        return met;
    }
    const uint32_t cell = triangle / 2, columns = pir_height_cell_columns(surface.field);
    const uint32_t from = cell / columns * surface.field->columns + cell % columns,
                   across = from + surface.field->columns + 1;
    met.id[0] = from;
    met.id[1] = triangle % 2 == 0 ? from + 1 : across;
    met.id[2] = triangle % 2 == 0 ? across : across - 1;
    return met;
}

uint32_t pir_surface_material(pir_surface_ref surface, uint32_t triangle) {
    if (surface.mesh)
        return surface.mesh->material ? surface.mesh->material[triangle] : 0;
    return surface.field->material ? surface.field->material[triangle / 2] : 0;
}

pir_walk_box pir_surface_bounds(pir_surface_ref surface) {
    pir_walk_box box;
    if (surface.mesh) {
        for (int k = 0; k < 3; k++) {
            box.low[k] = surface.mesh->tree.low[k];
            box.high[k] = surface.mesh->tree.high[k];
        }
        return box;
    }
    const pir_height_field *field = surface.field;
    return (pir_walk_box){{field->low.x, field->low.y, field->low.z}, {field->high.x, field->high.y, field->high.z}};
}

void pir_surface_reach(pir_surface_ref surface, double ret_reach[3]) {
    const pir_walk_box box = pir_surface_bounds(surface);
    for (int k = 0; k < 3; k++)
        ret_reach[k] = pir_greater(fabs(box.low[k]), fabs(box.high[k]));
}
