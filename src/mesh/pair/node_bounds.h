/* SPDX-License-Identifier: MIT */
/*
 * Lower bounds on the distance of two nodes, by floats, four pairs at a time: how far a direction takes them
 * apart. What bounds a node along a direction is its box, or its slab and its box for the rest of the direction,
 * whichever is less.
 *
 * A bound is less than what floats say by 2^-17 of all lengths that enter: there are below 40 roundings of 2^-24 each.
 */
#ifndef PIR_MESH_PAIR_NODE_BOUNDS_H
#define PIR_MESH_PAIR_NODE_BOUNDS_H

#include "mesh/pair/mesh_frame.h"

#define PIR_NODE_LANES 4

/* Four floats at once, as gcc and clang make of any processor's vectors. */
typedef float pir_node_float4 __attribute__((vector_size(16)));
typedef int32_t pir_int4 __attribute__((vector_size(16)));

#ifdef __clang__
#define PIR_SHUFFLE(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#else
#define PIR_SHUFFLE(a, b, i, j, k, l) __builtin_shuffle(a, b, (pir_int4){i, j, k, l})
#endif

/* Makes columns of rows. */
static inline void pir_lanes_transpose(pir_node_float4 row[4]) {
    const pir_node_float4 a = PIR_SHUFFLE(row[0], row[1], 0, 4, 1, 5), b = PIR_SHUFFLE(row[2], row[3], 0, 4, 1, 5);
    const pir_node_float4 c = PIR_SHUFFLE(row[0], row[1], 2, 6, 3, 7), d = PIR_SHUFFLE(row[2], row[3], 2, 6, 3, 7);
    row[0] = PIR_SHUFFLE(a, b, 0, 1, 4, 5);
    row[1] = PIR_SHUFFLE(a, b, 2, 3, 6, 7);
    row[2] = PIR_SHUFFLE(c, d, 0, 1, 4, 5);
    row[3] = PIR_SHUFFLE(c, d, 2, 3, 6, 7);
}

/* A child of a node: node · 4 + place. */
typedef uint32_t pir_mesh_item;

/* Children by lanes. */
typedef struct pir_node_lanes {
    pir_node_float4 middle[3], half[3];
    pir_node_float4 normal[3], inverse; /* the slab's, and 1 / |normal|² */
    pir_node_float4 low, high;
} pir_node_lanes;

/* Directions in Q's frame, from Q to P, and what they prove. */
typedef struct pir_node_axes {
    pir_node_float4 n[3], bound;
} pir_node_axes;

/* The relative pose in floats, and the middle of P about which motion is measured. */
typedef struct pir_float_frame {
    float r[3][3], t[3], error;
    float about[3];
} pir_float_frame;

void pir_float_frame_set(pir_float_frame *floats, const pir_mesh_frame *frame, pir_vec3 about);

static inline uint32_t pir_item_child(const pir_trimesh *mesh, pir_mesh_item item) {
    return mesh->tree.node[item / PIR_MESH_WIDTH].child[item % PIR_MESH_WIDTH];
}

static inline uint32_t pir_item_least(const pir_trimesh *mesh, pir_mesh_item item) {
    return mesh->tree.node[item / PIR_MESH_WIDTH].least[item % PIR_MESH_WIDTH];
}

/* Lanes of four items, or of one item each; by the children of a node, those without a child like the first. */
void pir_node_lanes_set(pir_node_lanes *lanes, const pir_trimesh *mesh, const pir_mesh_item item[PIR_NODE_LANES]);
void pir_node_lanes_set_one(pir_node_lanes *lanes, const pir_trimesh *mesh, pir_mesh_item item);
void pir_node_lanes_set_node(pir_node_lanes *lanes, const pir_trimesh *mesh, uint32_t node);

/* The bounds that given directions prove: axes->bound. */
void pir_bound_along(const pir_float_frame *frame, const pir_node_lanes *p, const pir_node_lanes *q,
                     pir_node_axes *axes);

/* Tries directions of the nodes' own, and keeps those that prove more. */
void pir_bound_by_nodes(const pir_float_frame *frame, const pir_node_lanes *p, const pir_node_lanes *q,
                        pir_node_axes *axes);

/* The square root of each lane. */
static inline pir_node_float4 pir_lanes_root(pir_node_float4 x) {
    return (pir_node_float4){sqrtf(x[0]), sqrtf(x[1]), sqrtf(x[2]), sqrtf(x[3])};
}

/* How far children of P reach from the middle of P, rounded up; and how large they are, squared. */
pir_node_float4 pir_lanes_reach(const pir_float_frame *frame, const pir_node_lanes *lanes);
pir_node_float4 pir_lanes_size(const pir_node_lanes *lanes);

/* How large an item is, squared. */
float pir_item_size(const pir_trimesh *mesh, pir_mesh_item item);

#endif
