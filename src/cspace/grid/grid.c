/* SPDX-License-Identifier: MIT */
/* Grids of three kinds behind one handle. */
#include <math.h>

#include <pirouette/grid.h>

#include "base/memory.h"
#include "base/vec.h"
#include "cspace/grid/angle.h"
#include "cspace/grid/hopf_lookup.h"
#include "cspace/grid/list.h"
#include "cspace/grid/nearby.h"
#include "cspace/grid/turns.h"

struct pir_grid {
    pir_allocator allocator;
    pir_grid_info info;
    union {
        pir_turns turns;
        struct {
            pir_hopf hopf;
            pir_hopf_lookup lookup;
        };
        pir_list list;
    };
};

static pir_grid *grid_new(const pir_allocator *given, pir_grid_kind kind) {
    pir_allocator allocator = pir_allocator_or_default(given);
    pir_grid *grid = PIR_ZEROED(&allocator, pir_grid, 1);
    if (grid) {
        grid->allocator = allocator;
        grid->info.kind = kind;
    }
    return grid;
}

static void grid_free(pir_grid *grid) {
    pir_allocator allocator = grid->allocator;
    PIR_FREE(&allocator, grid, 1);
}

pir_status pir_grid_axis(pir_vec3 axis, uint64_t steps, const pir_allocator *allocator, pir_grid **ret_grid) {
    if (!ret_grid || steps == 0)
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(axis))
        return PIR_ERR_NOT_FINITE;
    if (axis.x == 0 && axis.y == 0 && axis.z == 0)
        return PIR_ERR_ARGUMENT;
    if (steps > PIR_GRID_STEPS_MAX)
        return PIR_ERR_LIMIT;
    pir_grid *grid = grid_new(allocator, PIR_GRID_AXIS);
    if (!grid)
        return PIR_ERR_MEMORY;
    pir_quat unit = pir_quat_unit((pir_quat){axis.x, axis.y, axis.z, 0});
    grid->turns = (pir_turns){{unit.x, unit.y, unit.z}, steps};
    grid->info.axis = axis;
    grid->info.count = steps;
    grid->info.spacing = steps == 1 ? 0 : PIR_FULL_TURN / (double)steps;
    *ret_grid = grid;
    return PIR_OK;
}

pir_status pir_grid_hopf(uint32_t level, const pir_allocator *allocator, pir_grid **ret_grid) {
    if (!ret_grid)
        return PIR_ERR_ARGUMENT;
    if (level > PIR_GRID_LEVEL_MAX)
        return PIR_ERR_LIMIT;
    pir_grid *grid = grid_new(allocator, PIR_GRID_HOPF);
    if (!grid)
        return PIR_ERR_MEMORY;
    bool made = pir_hopf_init(&grid->hopf, level, &grid->allocator);
    if (made && !pir_hopf_lookup_init(&grid->lookup, &grid->hopf, &grid->allocator)) {
        pir_hopf_finish(&grid->hopf, &grid->allocator);
        made = false;
    }
    if (!made) {
        grid_free(grid);
        return PIR_ERR_MEMORY;
    }
    grid->info.level = level;
    grid->info.count = (uint64_t)grid->hopf.pixels * grid->hopf.around;
    grid->info.spacing = PIR_FULL_TURN / grid->hopf.around;
    *ret_grid = grid;
    return PIR_OK;
}

static pir_status check_rotations(const pir_quat *rotations, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!pir_quat_is_rotation(rotations[i]))
            return rotations[i].x == 0 && rotations[i].y == 0 && rotations[i].z == 0 && rotations[i].w == 0
                       ? PIR_ERR_ZERO_QUATERNION
                       : PIR_ERR_NOT_FINITE;
    return PIR_OK;
}

pir_status pir_grid_list(const pir_quat *rotations, size_t count, bool keep_order, const pir_allocator *allocator,
                         pir_grid **ret_grid) {
    if (!ret_grid || (!rotations && count > 0))
        return PIR_ERR_ARGUMENT;
    if (count == 0)
        return PIR_ERR_EMPTY;
    if (count > PIR_GRID_LIST_MAX)
        return PIR_ERR_LIMIT;
    pir_status status = check_rotations(rotations, count);
    if (status != PIR_OK)
        return status;
    pir_grid *grid = grid_new(allocator, PIR_GRID_LIST);
    if (!grid)
        return PIR_ERR_MEMORY;
    if (!pir_list_init(&grid->list, rotations, (uint32_t)count, keep_order != 0, &grid->allocator)) {
        grid_free(grid);
        return PIR_ERR_MEMORY;
    }
    grid->info.count = count;
    grid->info.spacing = grid->list.spacing;
    *ret_grid = grid;
    return PIR_OK;
}

void pir_grid_destroy(pir_grid *grid) {
    if (!grid)
        return;
    if (grid->info.kind == PIR_GRID_HOPF) {
        pir_hopf_lookup_finish(&grid->lookup, &grid->hopf, &grid->allocator);
        pir_hopf_finish(&grid->hopf, &grid->allocator);
    } else if (grid->info.kind == PIR_GRID_LIST) {
        pir_list_finish(&grid->list, &grid->allocator);
    }
    grid_free(grid);
}

pir_grid_info pir_grid_get_info(const pir_grid *grid) {
    return grid->info;
}

pir_quat pir_grid_rotation(const pir_grid *grid, uint64_t number) {
    switch (grid->info.kind) {
    case PIR_GRID_AXIS:
        return pir_turns_rotation(&grid->turns, number);
    case PIR_GRID_HOPF:
        return pir_hopf_rotation(&grid->hopf, number);
    default:
        return grid->list.given[number];
    }
}

uint64_t pir_grid_cell(const pir_grid *grid, uint64_t number) {
    switch (grid->info.kind) {
    case PIR_GRID_AXIS:
        return number;
    case PIR_GRID_HOPF:
        return pir_hopf_cell(&grid->hopf, number);
    default:
        return grid->list.source[number];
    }
}

pir_grid_nearby pir_grid_nearest_to(const pir_grid *grid, pir_quat rotation, pir_quat unit) {
    pir_grid_nearby nearby = {0, {0, 0, 0, 1}};
    if (grid->info.kind == PIR_GRID_HOPF &&
        pir_hopf_look_up(&grid->lookup, &grid->hopf, unit, &nearby.number, &nearby.unit))
        return nearby;
    pir_grid_nearest(grid, rotation, 1, &nearby.number);
    nearby.unit = pir_quat_unit(pir_grid_rotation(grid, nearby.number));
    return nearby;
}

size_t pir_grid_nearest(const pir_grid *grid, pir_quat rotation, size_t most, uint64_t *ret_numbers) {
    if (!pir_quat_is_rotation(rotation) || most == 0)
        return 0;
    pir_quat unit = pir_quat_unit(rotation), nearest;
    if (grid->info.kind == PIR_GRID_HOPF && most == 1 &&
        pir_hopf_look_up(&grid->lookup, &grid->hopf, unit, ret_numbers, &nearest))
        return 1;
    pir_near near = {.capacity = most < PIR_NEAR_MAX ? most : PIR_NEAR_MAX};
    switch (grid->info.kind) {
    case PIR_GRID_AXIS:
        pir_turns_nearest(&grid->turns, unit, &near);
        break;
    case PIR_GRID_HOPF:
        pir_hopf_nearest(&grid->hopf, unit, &near);
        break;
    default:
        pir_list_nearest(&grid->list, unit, &near);
    }
    for (size_t k = 0; k < near.count; k++)
        ret_numbers[k] = near.number[k];
    return near.count;
}

pir_grid_turns pir_grid_get_turns(const pir_grid *grid) {
    pir_grid_turns turns = {0, 0};
    double sum = 0;
    pir_quat before = pir_grid_rotation(grid, 0);
    for (uint64_t i = 1; i < grid->info.count; i++) {
        pir_quat next = pir_grid_rotation(grid, i);
        double turn = pir_grid_turn(before, next);
        sum += turn;
        turns.most = fmax(turns.most, turn);
        before = next;
    }
    if (grid->info.count > 1)
        turns.mean = sum / (double)(grid->info.count - 1);
    return turns;
}
