/* SPDX-License-Identifier: MIT */
/* A list of rotations: its order, and its tree. */
#include "cspace/grid/list.h"

#include <pirouette/grid.h>

#include "base/layout.h"
#include "cspace/grid/angle.h"
#include "cspace/grid/chain.h"

static pir_layout layout_of(pir_list *list) {
    return (pir_layout){{PIR_ROW(list->given, list->count), PIR_ROW(list->unit, list->count),
                         PIR_ROW(list->source, list->count), PIR_ROW(list->item, list->count)}};
}

/* The order of visiting, to list->source; `unit` is in the order given here. */
static bool put_order(pir_list *list, bool keep_order, const pir_allocator *allocator) {
    if (!keep_order)
        return pir_chain_make(list->unit, list->count, allocator, list->source);
    for (uint32_t i = 0; i < list->count; i++)
        list->source[i] = i;
    return true;
}

static double mean_nearest_turn(const pir_list *list) {
    double sum = 0;
    for (uint32_t i = 0; i < list->count && list->count > 1; i++) {
        pir_near near = {.capacity = 2};
        pir_list_nearest(list, list->unit[i], &near);
        uint64_t other = near.number[near.number[0] == i ? 1 : 0];
        sum += pir_grid_turn(list->unit[i], list->unit[other]);
    }
    return sum / list->count;
}

bool pir_list_init(pir_list *list, const pir_quat *rotations, uint32_t count, bool keep_order,
                   const pir_allocator *allocator) {
    *list = (pir_list){.count = count};
    pir_layout layout = layout_of(list);
    bool made = pir_layout_new(allocator, &layout);
    for (uint32_t i = 0; made && i < count; i++)
        list->unit[i] = pir_quat_unit(rotations[i]);
    if (!made || !put_order(list, keep_order, allocator)) {
        pir_layout_free(allocator, &layout);
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        list->given[i] = rotations[list->source[i]];
        list->unit[i] = pir_quat_unit(list->given[i]);
        list->item[i] = i;
    }
    pir_quat_tree tree = {list->unit, list->item, count};
    pir_quat_tree_build(&tree);
    list->spacing = mean_nearest_turn(list);
    return true;
}

void pir_list_finish(pir_list *list, const pir_allocator *allocator) {
    pir_layout layout = layout_of(list);
    pir_layout_free(allocator, &layout);
}

void pir_list_nearest(const pir_list *list, pir_quat unit, pir_near *near) {
    pir_quat_tree tree = {list->unit, list->item, list->count};
    pir_quat_tree_nearest(&tree, unit, NULL, near);
}
