/* SPDX-License-Identifier: MIT */
/*
 * A binary tree of boxes that changes: leaves are put in where the surface area grows least, and nodes on the way up
 * are rotated where that makes a box smaller (after Kopta et al., I3D 2012; the heuristic of Goldsmith and Salmon,
 * IEEE CG&A 7(5), 1987).
 *
 * Invariants
 *   - A node has two children, and its box is that of its children joined; or it is a leaf, and has an item.
 *   - With n leaves there are 2 n − 1 nodes in use.
 *
 * The findings of a traversal depend on the leaves alone, their order on the history of the tree.
 */
#ifndef PIR_SCENE_TREE_TREE_H
#define PIR_SCENE_TREE_TREE_H

#include "base/memory.h"
#include "scene/tree/box.h"

#define PIR_TREE_NONE UINT32_MAX

typedef struct pir_tree_node {
    pir_box box;
    uint32_t parent;   /* of a node that is not in use: the next such node */
    uint32_t child[2]; /* of a leaf: PIR_TREE_NONE, and its item */
} pir_tree_node;

typedef struct pir_tree {
    pir_tree_node *node;
    uint32_t capacity, root, unused;
    uint32_t leaves;
} pir_tree;

/* A tree without leaves, of zeros, is made ready by this; and room for so many leaves. False when out of memory. */
bool pir_tree_reserve(pir_tree *tree, const pir_allocator *allocator, uint32_t leaves);
void pir_tree_finish(pir_tree *tree, const pir_allocator *allocator);

/* Puts a leaf in, for which there is room; the node that it is. */
uint32_t pir_tree_insert(pir_tree *tree, const pir_box *box, uint32_t item);

void pir_tree_remove(pir_tree *tree, uint32_t leaf);

/* The first leaf whose box meets `box`, and the one after `leaf`; PIR_TREE_NONE where there is none. */
uint32_t pir_tree_first(const pir_tree *tree, const pir_box *box);
uint32_t pir_tree_next(const pir_tree *tree, const pir_box *box, uint32_t leaf);

/* The node that comes after n and all below it in the order of a traversal; PIR_TREE_NONE at its end. */
uint32_t pir_tree_beyond(const pir_tree *tree, uint32_t n);

/* Whether both invariants hold: for tests. */
bool pir_tree_is_valid(const pir_tree *tree);

static inline uint32_t pir_tree_item(const pir_tree *tree, uint32_t leaf) {
    return tree->node[leaf].child[1];
}

#endif
