/* SPDX-License-Identifier: MIT */
/* Pieces and triangles in the way of a box: see swept_pieces.h. */
#include "scene/query/swept_pieces.h"

struct traversal {
    const pir_tree *tree;
    const pir_swept_box *swept;
    int axis; /* along which it goes most */
};

/* Which child of a node the box comes to first, by their middles along the axis that it goes along most. */
static int first_of(const struct traversal *by, const pir_tree_node *node) {
    const pir_box *a = &by->tree->node[node->child[0]].box, *b = &by->tree->node[node->child[1]].box;
    const int k = by->axis;
    const bool is_lower = a->low[k] + a->high[k] < b->low[k] + b->high[k];
    return is_lower == by->swept->down[k];
}

/* Children that a traversal goes to first, by their depths: below the last of them that is child 0. */
struct ways_down {
    uint64_t first;
    uint32_t depth;
};

static int first_at(const struct ways_down *down, uint32_t depth) {
    return depth < 64 && (down->first >> depth & 1);
}

/* The child of a node that comes first. */
static uint32_t descend(const struct traversal *by, struct ways_down *down, const pir_tree_node *node) {
    if (down->depth < 64)
        down->first = (down->first & ~(UINT64_C(1) << down->depth)) | (uint64_t)first_of(by, node) << down->depth;
    return node->child[first_at(down, down->depth++)];
}

/* The node after n and all below it. */
static uint32_t go_beyond(const pir_tree *tree, struct ways_down *down, uint32_t n) {
    for (uint32_t parent = tree->node[n].parent; parent != PIR_TREE_NONE; parent = tree->node[n].parent) {
        const uint32_t *child = tree->node[parent].child;
        const int first = first_at(down, down->depth - 1);
        if (child[first] == n)
            return child[1 - first];
        n = parent;
        down->depth--;
    }
    return PIR_TREE_NONE;
}

pir_status pir_swept_pieces(const pir_swept_search *search) {
    pir_scene *scene = search->probe->scene;
    const pir_swept_box *swept = search->swept;
    struct traversal by = {&scene->tree, swept, 0};
    struct ways_down down = {0, 0};
    pir_status status = PIR_OK;
    uint32_t n = by.tree->node ? by.tree->root : PIR_TREE_NONE;
    for (int k = 1; k < 3; k++)
        by.axis = fabs(swept->way[k]) > fabs(swept->way[by.axis]) ? k : by.axis;
    while (n != PIR_TREE_NONE && status == PIR_OK && *search->until >= 0) {
        const pir_tree_node *node = &by.tree->node[n];
        if (pir_swept_meets(swept, node->box.low, node->box.high, *search->until)) {
            if (node->child[0] != PIR_TREE_NONE) {
                n = descend(&by, &down, node);
                continue;
            }
            pir_scene_piece *piece = &scene->bodies.piece[node->child[1]];
            if (pir_probe_meets(search->probe, piece->body))
                status = search->look(search->context, piece);
        }
        n = go_beyond(by.tree, &down, n);
    }
    return status;
}

static void measure(const void *context, const pir_mesh_boxes *boxes, double ret_near[PIR_MESH_WIDTH]) {
    pir_swept_times(&((const pir_swept_walk *)context)->swept, boxes, ret_near);
}

static bool look(void *context, const pir_met_triangle *met) {
    const pir_swept_walk *walk = context;
    return walk->look(walk->context, met);
}

void pir_swept_triangles(const pir_scene_body *body, const pir_swept_walk *walk) {
    const pir_surface_ref surface = pir_body_surface_of(body);
    const pir_walk_box bounds = pir_surface_bounds(surface);
    pir_swept_walk by = *walk;
    pir_walk_box part;
    if (pir_swept_part(&walk->swept, &bounds, *walk->until, &part))
        pir_surface_walk(surface, &(pir_walk){measure, look, &by, walk->until, &part});
}
