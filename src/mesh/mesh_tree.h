/* SPDX-License-Identifier: MIT */
/*
 * The static tree of a mesh: four children a node, their boxes in steps of the node's own, rounded outward. Beside its
 * box a child has a slab, the space between two planes across the mean normal of its triangles, which a patch of a
 * smooth surface fills better than a box along the axes.
 *
 * Invariants
 *   - Every item is in one leaf; a leaf has 1 to 4 of them, next to each other in `item`.
 *   - A child's box and slab hold all corners of the triangles below it; `least` is the lowest of their numbers.
 *   - No path from the root is longer than PIR_MESH_DEPTH nodes.
 */
#ifndef PIR_MESH_MESH_TREE_H
#define PIR_MESH_MESH_TREE_H

#include "base/memory.h"
#include "base/vec.h"

#define PIR_MESH_DEPTH 64
#define PIR_MESH_WIDTH 4
/* Triangles of a leaf, at most. */
#define PIR_MESH_LEAF 4

/* No child. */
#define PIR_MESH_NO_CHILD UINT32_MAX

typedef struct pir_mesh_node {
    float origin[3];
    int8_t exponent[3]; /* a step along an axis is 2^exponent */
    uint8_t count;      /* of children */
    uint8_t low[3][PIR_MESH_WIDTH], high[3][PIR_MESH_WIDTH];
    uint32_t child[PIR_MESH_WIDTH]; /* a node, or a leaf: see pir_mesh_is_leaf */
    uint32_t least[PIR_MESH_WIDTH];
    int8_t normal[3][PIR_MESH_WIDTH];                          /* of the slab, of any length but 0 */
    float slab_low[PIR_MESH_WIDTH], slab_high[PIR_MESH_WIDTH]; /* normal · x is between these */
} pir_mesh_node;

typedef struct pir_mesh_tree {
    pir_mesh_node *node;
    uint32_t *item; /* triangles, leaf by leaf */
    uint32_t node_count, item_count;
    float low[3], high[3]; /* around all */
} pir_mesh_tree;

/* Boxes of a node's children, and of those alone. */
typedef struct pir_mesh_boxes {
    float low[3][PIR_MESH_WIDTH], high[3][PIR_MESH_WIDTH];
} pir_mesh_boxes;

static inline bool pir_mesh_is_leaf(uint32_t child) {
    return child >> 31;
}

static inline uint32_t pir_mesh_leaf_start(uint32_t child) {
    return child << 1 >> 3;
}

static inline uint32_t pir_mesh_leaf_count(uint32_t child) {
    return (child & 3) + 1;
}

/* 2^exponent, -126 ≤ exponent ≤ 127. */
static inline float pir_mesh_step(int exponent) {
    uint32_t bits = (uint32_t)(exponent + 127) << 23;
    float step;
    __builtin_memcpy(&step, &bits, sizeof step);
    return step;
}

/* The one way in which a bound is read, so that what the builder has checked holds. */
static inline float pir_mesh_bound(const pir_mesh_node *node, int axis, uint8_t steps) {
    return node->origin[axis] + (float)steps * pir_mesh_step(node->exponent[axis]);
}

static inline void pir_mesh_read_boxes(const pir_mesh_node *node, pir_mesh_boxes *ret_boxes) {
    for (int k = 0; k < 3; k++) {
        float origin = node->origin[k], step = pir_mesh_step(node->exponent[k]);
        for (int i = 0; i < PIR_MESH_WIDTH; i++) {
            ret_boxes->low[k][i] = origin + (float)node->low[k][i] * step;
            ret_boxes->high[k][i] = origin + (float)node->high[k][i] * step;
        }
    }
}

/* The greatest float not above x, and the least not below it; |x| is at most 2^61. */
static inline float pir_float_under(double x) {
    float f = (float)x;
    return (double)f > x ? nextafterf(f, -HUGE_VALF) : f;
}

static inline float pir_float_over(double x) {
    float f = (float)x;
    return (double)f < x ? nextafterf(f, HUGE_VALF) : f;
}

/* Floats below and above x by less than a few roundings, without a branch; |x| is at most 2^61. */
static inline float pir_mesh_below(double x) {
    return (float)(x - fabs(x) * 0x1p-23 - 0x1p-148);
}

static inline float pir_mesh_above(double x) {
    return (float)(x + fabs(x) * 0x1p-23 + 0x1p-148);
}

/* The triangles that a tree is made of. */
typedef struct pir_mesh_source {
    const pir_vec3 *vertex;
    const uint32_t (*corner)[3];
} pir_mesh_source;

/*
 * Makes the tree of the triangles `item[0 .. count)`, count > 0, whose array it takes over and brings into its order.
 * False when out of memory: the array is still the caller's then.
 */
bool pir_mesh_tree_make(pir_mesh_tree *tree, const pir_allocator *allocator, const pir_mesh_source *source,
                        uint32_t *item, uint32_t count);
void pir_mesh_tree_finish(pir_mesh_tree *tree, const pir_allocator *allocator);

/* Whether the invariants hold: for tests. */
bool pir_mesh_tree_is_valid(const pir_mesh_tree *tree, const pir_mesh_source *source);

#endif
