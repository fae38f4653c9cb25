/* SPDX-License-Identifier: MIT */
/* See box_parts.h. */
#include "plan/rigid/box_parts.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "plan/rigid/point_sets.h"

pir_status pir_box_division_open(const pir_rigid_question *question, pir_box_division *division) {
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    memset(division, 0, sizeof *division);
    pir_plan_space_init(&division->space, &allocator, question->memory);
    division->cutter.space = &division->space;
    memcpy(division->tree.low, question->low, sizeof question->low);
    memcpy(division->tree.high, question->high, sizeof question->high);
    return division->space.status;
}

pir_status pir_box_division_add(const pir_rigid_question *question, const pir_plan_pieces *made, uint32_t first,
                                pir_box_division *division) {
    const uint32_t obstacles = question->wide->count, old = division->sums.count;
    for (uint32_t i = first; i < made->count; i++) {
        const pir_status status = pir_plan_sums_add(&division->space, made->at[i], made->body[i] / obstacles,
                                                    made->body[i] % obstacles, &division->sums);
        if (status != PIR_OK)
            return status;
    }
    if (division->tree.node_count == 0)
        pir_plan_divide(&division->cutter, &division->sums, question->most_parts, &division->tree);
    else
        pir_plan_divide_more(&division->cutter, &division->sums, old, question->most_parts, &division->tree);
    return division->space.status;
}

pir_status pir_box_division_join(bool with_doors, pir_box_division *division) {
    pir_plan_joints_finish(&division->space, &division->joints);
    division->joints.without_doors = !with_doors;
    pir_plan_join(&division->cutter, &division->tree, &division->joints);
    return division->space.status;
}

pir_status pir_box_division_make(const pir_rigid_question *question, const pir_plan_pieces *robot, bool with_doors,
                                 pir_box_division *division) {
    const pir_quat none = {0, 0, 0, 1};
    pir_status status = pir_box_division_open(question, division);
    if (status == PIR_OK)
        status = pir_plan_sums_make(&division->space, robot, question->obstacles, none, &division->sums);
    if (status == PIR_OK) {
        pir_plan_divide(&division->cutter, &division->sums, question->most_parts, &division->tree);
        status = division->space.status;
    }
    return status == PIR_OK ? pir_box_division_join(with_doors, division) : status;
}

void pir_box_division_finish(pir_box_division *division) {
    pir_plan_joints_finish(&division->space, &division->joints);
    pir_plan_tree_finish(&division->space, &division->tree);
    pir_plan_sums_finish(&division->space, &division->sums);
    pir_plan_cutter_finish(&division->cutter);
    pir_plan_space_finish(&division->space);
}

uint32_t pir_box_division_cell_at(pir_box_division *division, uint32_t point) {
    if (division->space.status != PIR_OK ||
        pir_plan_sums_at(&division->space, &division->sums, point, false) != PIR_PLAN_NONE)
        return PIR_PLAN_NONE;
    for (uint32_t i = 0; i < division->tree.cell_count; i++)
        if (pir_plan_cell_has(&division->space, &division->tree.cell[i], point))
            return i;
    return PIR_PLAN_NONE;
}

/* Parts are numbered by their first cells. */
pir_status pir_box_parts_keep(const pir_box_division *division, pir_box_parts *parts) {
    *parts = (pir_box_parts){0};
    const pir_plan_tree *tree = &division->tree;
    uint32_t points = 0;
    for (uint32_t i = 0; i < tree->cell_count; i++)
        points += tree->cell[i].points;
    parts->x = calloc(points > 0 ? points : 1, sizeof *parts->x);
    parts->cell = calloc(tree->cell_count > 0 ? tree->cell_count : 1, sizeof *parts->cell);
    parts->nodes = tree->node_count;
    if (!parts->x || !parts->cell)
        return PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < tree->cell_count; i++) {
        const pir_plan_cell *from = &tree->cell[i];
        pir_box_cell *to = &parts->cell[parts->cells++];
        *to = (pir_box_cell){.first = parts->points, .points = from->points};
        memcpy(to->low, from->low, sizeof to->low);
        memcpy(to->high, from->high, sizeof to->high);
        for (uint32_t v = 0; v < from->points; v++) {
            const pir_plan_point *p = &division->space.point[from->point[v]];
            memcpy(parts->x[parts->points++], p->at, sizeof *parts->x);
            parts->room = fmax(parts->room, p->room);
        }
        to->part = parts->parts;
        for (uint32_t k = 0; k < i && to->part == parts->parts; k++)
            if (division->joints.root[k] == division->joints.root[i])
                to->part = parts->cell[k].part;
        parts->parts += to->part == parts->parts;
    }
    return PIR_OK;
}

void pir_box_parts_finish(pir_box_parts *parts) {
    free(parts->x);
    free(parts->cell);
    *parts = (pir_box_parts){0};
}

pir_status pir_box_parts_image(const pir_box_parts *parts, const pir_symmetries *symmetries, uint32_t number,
                               pir_box_parts *ret_image) {
    *ret_image = *parts;
    ret_image->x = calloc(parts->points > 0 ? parts->points : 1, sizeof *ret_image->x);
    ret_image->cell = calloc(parts->cells > 0 ? parts->cells : 1, sizeof *ret_image->cell);
    if (!ret_image->x || !ret_image->cell)
        return PIR_ERR_MEMORY;
    for (uint32_t v = 0; v < parts->points; v++)
        pir_symmetries_place(symmetries, number, parts->x[v], ret_image->x[v]);
    for (uint32_t i = 0; i < parts->cells; i++) {
        pir_box_cell *to = &ret_image->cell[i];
        double low[3], high[3];
        *to = parts->cell[i];
        pir_symmetries_place(symmetries, number, to->low, low);
        pir_symmetries_place(symmetries, number, to->high, high);
        for (int k = 0; k < 3; k++) {
            to->low[k] = fmin(low[k], high[k]);
            to->high[k] = fmax(low[k], high[k]);
        }
    }
    return PIR_OK;
}

size_t pir_box_parts_size(const pir_box_parts *parts) {
    return parts->points * sizeof *parts->x + parts->cells * sizeof *parts->cell;
}

/* --- bytes --- */

/* Parts begin with this, cells follow, then their points. */
struct packed_parts {
    double room;
    uint32_t cells, points, parts, nodes;
};

struct packed_cell {
    double low[3], high[3];
    uint32_t points, part;
};

bool pir_box_parts_pack(const pir_box_parts *parts, pir_bytes *bytes) {
    const struct packed_parts all = {parts->room, parts->cells, parts->points, parts->parts, parts->nodes};
    const pir_allocator a = pir_allocator_or_default(NULL);
    const size_t of_points = parts->points * sizeof *parts->x;
    if (!pir_bytes_reserve(bytes, &a, sizeof all + parts->cells * sizeof(struct packed_cell) + of_points))
        return false;
    memcpy(bytes->data + bytes->used, &all, sizeof all);
    bytes->used += sizeof all;
    for (uint32_t i = 0; i < parts->cells; i++) {
        const pir_box_cell *cell = &parts->cell[i];
        struct packed_cell packed = {.points = cell->points, .part = cell->part};
        memcpy(packed.low, cell->low, sizeof packed.low);
        memcpy(packed.high, cell->high, sizeof packed.high);
        memcpy(bytes->data + bytes->used, &packed, sizeof packed);
        bytes->used += sizeof packed;
    }
    if (of_points > 0)
        memcpy(bytes->data + bytes->used, parts->x, of_points);
    bytes->used += of_points;
    return true;
}

bool pir_box_parts_unpack(const pir_bytes *bytes, pir_box_parts *parts) {
    struct packed_parts all;
    *parts = (pir_box_parts){0};
    if (bytes->used < sizeof all)
        return false;
    memcpy(&all, bytes->data, sizeof all);
    const size_t of_cells = all.cells * sizeof(struct packed_cell), of_points = all.points * sizeof *parts->x;
    if (bytes->used != sizeof all + of_cells + of_points || all.parts > all.cells)
        return false;
    parts->x = calloc(all.points > 0 ? all.points : 1, sizeof *parts->x);
    parts->cell = calloc(all.cells > 0 ? all.cells : 1, sizeof *parts->cell);
    bool good = parts->x && parts->cell;
    const uint8_t *at = bytes->data + sizeof all;
    for (uint32_t i = 0; i < all.cells && good; i++, at += sizeof(struct packed_cell)) {
        struct packed_cell packed;
        pir_box_cell *cell = &parts->cell[i];
        memcpy(&packed, at, sizeof packed);
        good = packed.points <= all.points - parts->points && packed.part < all.parts;
        *cell = (pir_box_cell){.first = parts->points, .points = packed.points, .part = packed.part};
        memcpy(cell->low, packed.low, sizeof cell->low);
        memcpy(cell->high, packed.high, sizeof cell->high);
        parts->points += good ? packed.points : 0;
    }
    if (good && of_points > 0)
        memcpy(parts->x, at, of_points);
    parts->room = all.room;
    parts->cells = all.cells;
    parts->parts = all.parts;
    parts->nodes = all.nodes;
    return good && parts->points == all.points;
}

static const double (*points_of(const pir_box_parts *parts, const pir_box_cell *cell))[3] {
    return (const double(*)[3])(parts->x + cell->first);
}

bool pir_box_cells_meet(const pir_box_parts *a, const pir_box_cell *of_a, const pir_box_parts *b,
                        const pir_box_cell *of_b, double ret_shared[3]) {
    return pir_plan_boxes_meet(of_a->low, of_a->high, of_b->low, of_b->high) &&
           !pir_points_apart(points_of(a, of_a), of_a->points, points_of(b, of_b), of_b->points, a->room + b->room,
                             ret_shared);
}

bool pir_box_cell_has(const pir_box_parts *parts, const pir_box_cell *cell, const double x[3]) {
    const double own[1][3] = {{x[0], x[1], x[2]}};
    return pir_plan_boxes_meet(x, x, cell->low, cell->high) &&
           !pir_points_apart(own, 1, points_of(parts, cell), cell->points, parts->room, NULL);
}
