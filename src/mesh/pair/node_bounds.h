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

/* Fills one lane, or all by the children of a node; lanes without a child are like the first. */
void pir_lane_set(pir_node_lanes *lanes, int lane, const pir_trimesh *mesh, pir_mesh_item item);
void pir_node_lanes_set_node(pir_node_lanes *lanes, const pir_trimesh *mesh, uint32_t node);

/* Lanes that are all like one. */
void pir_node_lanes_repeat(pir_node_lanes *lanes, const pir_node_lanes *from, int lane);

/* The bounds that given directions prove: axes->bound. */
void pir_bound_along(const pir_float_frame *frame, const pir_node_lanes *p, const pir_node_lanes *q,
                     pir_node_axes *axes);

/* Tries directions of the nodes' own, and keeps those that prove more. */
void pir_bound_by_nodes(const pir_float_frame *frame, const pir_node_lanes *p, const pir_node_lanes *q,
                        pir_node_axes *axes);

/* How far a child of P reaches from the middle of P, rounded up; and how large it is, squared. */
float pir_lane_reach(const pir_float_frame *frame, const pir_node_lanes *lanes, int lane);
float pir_lane_size(const pir_node_lanes *lanes, int lane);

#endif
