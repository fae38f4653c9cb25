/* SPDX-License-Identifier: MIT */
/*
 * A k-d tree of unit quaternions, for the nearest rotations of a list.
 *
 * `item` is a permutation of the list. The middle of a range is its root; of what stands before it no component
 * `depth mod 4` is greater, of what stands behind none is less. q and −q are one rotation, so both are sought.
 */
#ifndef PIR_CSPACE_GRID_QUAT_TREE_H
#define PIR_CSPACE_GRID_QUAT_TREE_H

#include <pirouette/base.h>

#include "cspace/grid/near.h"

typedef struct pir_quat_tree {
    const pir_quat *unit; /* borrowed */
    uint32_t *item;
    uint32_t count;
} pir_quat_tree;

/* Which items are sought: all with a group other than that of the one asked for; NULL for all. */
typedef struct pir_tree_filter {
    const uint32_t *group;
    uint32_t other_than;
} pir_tree_filter;

/* Orders `item`, count numbers of `unit`, into a tree. O(n log n) expected. */
void pir_quat_tree_build(pir_quat_tree *tree);

/* Fills `near`, which is empty. */
void pir_quat_tree_nearest(const pir_quat_tree *tree, pir_quat unit, const pir_tree_filter *filter, pir_near *near);

#endif
