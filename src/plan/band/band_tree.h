/* SPDX-License-Identifier: MIT */
/* Two trees of free poses, one from each end; see band_tree.c. */
#ifndef PIR_PLAN_BAND_TREE_H
#define PIR_PLAN_BAND_TREE_H

#include "plan/band/band_push.h"

struct pir_band_node;

/* Begin as zeros. */
typedef struct pir_band_trees {
    struct pir_band_node *node[2]; /* of `room` each, from malloc; first the end, each after the one it grew from */
    uint32_t count[2], room[2];
    uint32_t turn;
    uint64_t seed;
} pir_band_trees;

void pir_band_trees_finish(pir_band_trees *trees);

/*
 * Grows the trees from two free poses, the same in each call, until they meet; `ret_met` is then the node of each at
 * one pose. PIR_ERR_EMPTY where they do not with `work` distances, or have too many nodes.
 */
pir_status pir_band_trees_grow(pir_band_bodies *bodies, const pir_band_pose end[2], uint64_t work,
                               pir_band_trees *trees, uint32_t ret_met[2]);

/* The poses from end to end by way of the nodes that met, as a row. */
pir_status pir_band_trees_way(const pir_band_trees *trees, const uint32_t met[2], pir_band_row *row);

#endif
