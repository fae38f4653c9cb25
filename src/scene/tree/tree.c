/* SPDX-License-Identifier: MIT */
/* A tree of boxes: see tree.h. Nothing here recurses, so that no shape of the tree is too deep. */
#include "scene/tree/tree.h"

static bool is_leaf(const pir_tree_node *node) {
    return node->child[0] == PIR_TREE_NONE;
}

bool pir_tree_reserve(pir_tree *tree, const pir_allocator *allocator, uint32_t leaves) {
    if (!tree->node)
        tree->root = tree->unused = PIR_TREE_NONE;
    uint32_t need = leaves > 0 ? 2 * leaves - 1 : 0, old = tree->capacity;
    if (need <= old)
        return true;
    uint32_t capacity = need > 2 * old ? need : 2 * old;
    pir_tree_node *node = PIR_RESIZE(allocator, tree->node, old, capacity);
    if (!node)
        return false;
    tree->node = node;
    tree->capacity = capacity;
    for (uint32_t n = capacity; n-- > old;) {
        node[n].parent = tree->unused;
        tree->unused = n;
    }
    return true;
}

void pir_tree_finish(pir_tree *tree, const pir_allocator *allocator) {
    PIR_FREE(allocator, tree->node, tree->capacity);
}

static uint32_t take(pir_tree *tree) {
    uint32_t n = tree->unused;
    tree->unused = tree->node[n].parent;
    return n;
}

static void give_back(pir_tree *tree, uint32_t n) {
    tree->node[n].parent = tree->unused;
    tree->unused = n;
}

/* --- where a leaf goes --- */

/* The cost of a leaf below a child: the least growth of the areas there. */
static float cost_below(const pir_tree *tree, uint32_t child, const pir_box *box) {
    const pir_tree_node *node = &tree->node[child];
    float joint = pir_box_joint_area(&node->box, box);
    return is_leaf(node) ? joint : joint - pir_box_area(&node->box);
}

/* The node that a leaf becomes the sibling of. */
static uint32_t sibling_for(const pir_tree *tree, const pir_box *box) {
    uint32_t n = tree->root;
    while (!is_leaf(&tree->node[n])) {
        const pir_tree_node *node = &tree->node[n];
        float joint = pir_box_joint_area(&node->box, box), inherited = joint - pir_box_area(&node->box);
        float first = cost_below(tree, node->child[0], box) + inherited;
        float second = cost_below(tree, node->child[1], box) + inherited;
        if (joint < first && joint < second)
            break;
        n = node->child[second < first];
    }
    return n;
}

/* --- rotations --- */

static void set_child(pir_tree *tree, uint32_t parent, int side, uint32_t child) {
    tree->node[parent].child[side] = child;
    tree->node[child].parent = parent;
}

/* Gives n the box that it has to have; whether that is another. */
static bool fit(pir_tree *tree, uint32_t n) {
    pir_tree_node *node = &tree->node[n];
    pir_box before = node->box;
    node->box = pir_box_join(&tree->node[node->child[0]].box, &tree->node[node->child[1]].box);
    return !pir_box_holds(&before, &node->box) || !pir_box_holds(&node->box, &before);
}

/* Exchanges a child of n with a grandchild on the other side, where that makes the other child smaller. */
static void rotate(pir_tree *tree, uint32_t n) {
    const pir_tree_node *node = &tree->node[n];
    float best = 0;
    int best_side = -1, best_grandchild = 0;
    for (int side = 0; side < 2; side++) {
        const pir_tree_node *child = &tree->node[node->child[side]], *other = &tree->node[node->child[1 - side]];
        if (is_leaf(other))
            continue;
        float area = pir_box_area(&other->box);
        for (int g = 0; g < 2; g++) {
            float gain = area - pir_box_joint_area(&child->box, &tree->node[other->child[1 - g]].box);
            if (gain > best) {
                best = gain;
                best_side = side;
                best_grandchild = g;
            }
        }
    }
    if (best_side < 0)
        return;
    uint32_t child = node->child[best_side], other = node->child[1 - best_side];
    uint32_t grandchild = tree->node[other].child[best_grandchild];
    set_child(tree, n, best_side, grandchild);
    set_child(tree, other, best_grandchild, child);
    fit(tree, other);
}

/* Boxes from n up, as far as they change. */
static void fit_upward(pir_tree *tree, uint32_t n) {
    while (n != PIR_TREE_NONE && fit(tree, n)) {
        rotate(tree, n);
        n = tree->node[n].parent;
    }
}

/* Puts `child` in the place that `old` has below `parent`. */
static void replace(pir_tree *tree, uint32_t parent, uint32_t old, uint32_t child) {
    if (parent == PIR_TREE_NONE) {
        tree->root = child;
        tree->node[child].parent = PIR_TREE_NONE;
    } else {
        set_child(tree, parent, tree->node[parent].child[1] == old, child);
    }
}

uint32_t pir_tree_insert(pir_tree *tree, const pir_box *box, uint32_t item) {
    uint32_t leaf = take(tree);
    tree->node[leaf] = (pir_tree_node){*box, PIR_TREE_NONE, {PIR_TREE_NONE, item}};
    tree->leaves++;
    if (tree->root == PIR_TREE_NONE) {
        tree->root = leaf;
        return leaf;
    }
    uint32_t sibling = sibling_for(tree, box), parent = take(tree);
    tree->node[parent].box = *box; // until its children are there
    replace(tree, tree->node[sibling].parent, sibling, parent);
    set_child(tree, parent, 0, sibling);
    set_child(tree, parent, 1, leaf);
    fit(tree, parent);
    rotate(tree, parent);
    fit_upward(tree, tree->node[parent].parent);
    return leaf;
}

void pir_tree_remove(pir_tree *tree, uint32_t leaf) {
    uint32_t parent = tree->node[leaf].parent;
    tree->leaves--;
    give_back(tree, leaf);
    if (parent == PIR_TREE_NONE) {
        tree->root = PIR_TREE_NONE;
        return;
    }
    uint32_t sibling = tree->node[parent].child[tree->node[parent].child[0] == leaf];
    uint32_t above = tree->node[parent].parent;
    replace(tree, above, parent, sibling);
    give_back(tree, parent);
    fit_upward(tree, above);
}

/* --- traversal --- */

uint32_t pir_tree_beyond(const pir_tree *tree, uint32_t n) {
    uint32_t parent = tree->node[n].parent;
    while (parent != PIR_TREE_NONE && tree->node[parent].child[1] == n) {
        n = parent;
        parent = tree->node[n].parent;
    }
    return parent == PIR_TREE_NONE ? PIR_TREE_NONE : tree->node[parent].child[1];
}

/* The first leaf that meets the box, of n and those below it and after it. */
static uint32_t find_from(const pir_tree *tree, const pir_box *box, uint32_t n) {
    while (n != PIR_TREE_NONE) {
        const pir_tree_node *node = &tree->node[n];
        if (!pir_box_meets(&node->box, box))
            n = pir_tree_beyond(tree, n);
        else if (is_leaf(node))
            return n;
        else
            n = node->child[0];
    }
    return PIR_TREE_NONE;
}

uint32_t pir_tree_first(const pir_tree *tree, const pir_box *box) {
    return tree->node ? find_from(tree, box, tree->root) : PIR_TREE_NONE;
}

uint32_t pir_tree_next(const pir_tree *tree, const pir_box *box, uint32_t leaf) {
    return find_from(tree, box, pir_tree_beyond(tree, leaf));
}

bool pir_tree_is_valid(const pir_tree *tree) {
    uint32_t nodes = 0, leaves = 0;
    for (uint32_t n = tree->node ? tree->root : PIR_TREE_NONE; n != PIR_TREE_NONE;) {
        const pir_tree_node *node = &tree->node[n];
        if (++nodes > tree->capacity)
            return false;
        if (is_leaf(node)) {
            leaves++;
            n = pir_tree_beyond(tree, n);
            continue;
        }
        pir_box all = pir_box_join(&tree->node[node->child[0]].box, &tree->node[node->child[1]].box);
        if (!pir_box_holds(&all, &node->box) || !pir_box_holds(&node->box, &all) ||
            tree->node[node->child[0]].parent != n || tree->node[node->child[1]].parent != n)
            return false;
        n = node->child[0];
    }
    return leaves == tree->leaves && nodes == (leaves > 0 ? 2 * leaves - 1 : 0);
}
