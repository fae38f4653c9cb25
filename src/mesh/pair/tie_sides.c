/* SPDX-License-Identifier: MIT */
/* Which items of two trees lie behind the nearest vertices: signs of corners, from the leaves up. */
#include "mesh/pair/tie_sides.h"

static size_t item_count(const pir_mesh_frame *frame, int side) {
    return (size_t)frame->mesh[side]->tree.node_count * PIR_MESH_WIDTH;
}

size_t pir_tie_sides_bytes(const pir_tie_sides *sides, const pir_mesh_frame *frame) {
    return sides->is_behind[0] ? item_count(frame, 0) + item_count(frame, 1) : 0;
}

void pir_tie_sides_finish(pir_tie_sides *sides, const pir_mesh_frame *frame, const pir_allocator *allocator) {
    for (int side = 0; side < 2; side++)
        PIR_FREE(allocator, sides->is_behind[side], item_count(frame, side));
}

static pir_vec3 place(const pir_mesh_frame *frame, int side, uint32_t vertex) {
    pir_vec3 x = frame->mesh[side]->vertex[vertex];
    return side == 0 ? pir_mesh_frame_apply(frame, x) : x;
}

/* The sum of the magnitudes, at least the length. */
static double size_of(pir_vec3 v) {
    return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

/* Exactly: the sign of (a − b) · (x − the side's own of the two). */
static int exact_sign(const pir_tie_sides *sides, pir_mesh_frame *frame, int side, uint32_t vertex) {
    uint32_t used = frame->limbs.used;
    pir_int3 a = pir_mesh_frame_exact(frame, 0, sides->vertex[0]), b = pir_mesh_frame_exact(frame, 1, sides->vertex[1]);
    pir_int3 x = pir_mesh_frame_exact(frame, side, vertex), way = pir_num3_sub(&frame->limbs, &a, &b);
    pir_int3 from = pir_num3_sub(&frame->limbs, &x, side == 0 ? &a : &b);
    pir_int along = pir_num3_dot(&frame->limbs, &way, &from);
    frame->limbs.used = used;
    return pir_int_sign(&along);
}

/* Whether a vertex lies behind its side's of the two, or beside it. */
static bool is_vertex_behind(const pir_tie_sides *sides, pir_mesh_frame *frame, int side, uint32_t vertex) {
    if (vertex == sides->vertex[side])
        return true;
    const pir_vec3 at[2] = {place(frame, 0, sides->vertex[0]), place(frame, 1, sides->vertex[1])};
    pir_vec3 way = pir_vec_sub(at[0], at[1]), from = pir_vec_sub(place(frame, side, vertex), at[side]);
    // each difference is within 2·√3 of `error`
    double along = pir_vec_dot(way, from), bound = 8 * frame->error * (size_of(way) + size_of(from));
    int sign = along > bound ? 1 : along < -bound ? -1 : exact_sign(sides, frame, side, vertex);
    return side == 0 ? sign >= 0 : sign <= 0;
}

static bool is_leaf_behind(const pir_tie_sides *sides, pir_mesh_frame *frame, int side, uint32_t leaf) {
    const pir_trimesh *mesh = frame->mesh[side];
    const uint32_t start = pir_mesh_leaf_start(leaf), end = start + pir_mesh_leaf_count(leaf);
    for (uint32_t i = start; i < end; i++)
        for (int k = 0; k < 3; k++)
            if (!is_vertex_behind(sides, frame, side, mesh->corner[mesh->tree.item[i]][k]))
                return false;
    return true;
}

/* From the last node to the first: nodes stand after their parents. */
static void fill(pir_tie_sides *sides, pir_mesh_frame *frame, int side) {
    const pir_mesh_tree *tree = &frame->mesh[side]->tree;
    uint8_t *is_behind = sides->is_behind[side];
    for (uint32_t n = tree->node_count; n-- > 0;)
        for (uint32_t i = 0; i < tree->node[n].count; i++) {
            const uint32_t child = tree->node[n].child[i];
            bool behind = pir_mesh_is_leaf(child) ? is_leaf_behind(sides, frame, side, child) : child > n;
            for (uint32_t j = 0; behind && !pir_mesh_is_leaf(child) && j < tree->node[child].count; j++)
                behind = is_behind[child * PIR_MESH_WIDTH + j];
            is_behind[n * PIR_MESH_WIDTH + i] = behind;
        }
}

bool pir_tie_sides_make(pir_tie_sides *sides, pir_mesh_frame *frame, const pir_allocator *allocator,
                        const uint32_t vertex[2]) {
    for (int side = 0; side < 2; side++) {
        if (!sides->is_behind[side])
            sides->is_behind[side] = PIR_ZEROED(allocator, uint8_t, item_count(frame, side));
        if (!sides->is_behind[side])
            return false;
        sides->vertex[side] = vertex[side];
    }
    for (int side = 0; side < 2; side++)
        fill(sides, frame, side);
    sides->made = true;
    return true;
}
