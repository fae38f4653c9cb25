/* SPDX-License-Identifier: MIT */
/* Pieces and triangles in the way of a box: see swept_pieces.h. */
#include "scene/query/swept_pieces.h"

/* Nodes that wait; where there are more, the rest is visited without an order. */
#define STACK 48

struct waiting {
    uint32_t node[STACK];
    double enter[STACK]; /* when the box comes to the node's */
    uint32_t count;
};

static pir_status look_at_leaf(const pir_swept_search *search, const pir_tree_node *leaf) {
    pir_scene_piece *piece = &search->probe->scene->bodies.piece[leaf->child[1]];
    return pir_probe_meets(search->probe, piece->body) ? search->look(search->context, piece) : PIR_OK;
}

/* Looks at the leaves below a node, in the order of the tree. */
static pir_status look_below(const pir_swept_search *search, uint32_t top) {
    const pir_tree *tree = &search->probe->scene->tree;
    const uint32_t end = pir_tree_beyond(tree, top);
    pir_status status = PIR_OK;
    for (uint32_t n = top; n != end && status == PIR_OK;) {
        const pir_tree_node *node = &tree->node[n];
        const bool meets = pir_swept_enters(search->swept, node->box.low, node->box.high) <= *search->until;
        if (meets && node->child[0] != PIR_TREE_NONE) {
            n = node->child[0];
            continue;
        }
        status = meets ? look_at_leaf(search, node) : PIR_OK;
        n = pir_tree_beyond(tree, n);
    }
    return status;
}

/* The child of a node that comes first, the other waits; PIR_TREE_NONE where it comes to neither. */
static uint32_t first_child(const pir_swept_search *search, const pir_tree_node *node, struct waiting *waiting) {
    const pir_tree_node *at = search->probe->scene->tree.node, *a = &at[node->child[0]], *b = &at[node->child[1]];
    const double to_a = pir_swept_enters(search->swept, a->box.low, a->box.high),
                 to_b = pir_swept_enters(search->swept, b->box.low, b->box.high), until = *search->until;
    const int first = to_b < to_a;
    const double sooner = first ? to_b : to_a, later = first ? to_a : to_b;
    if (!(sooner <= until))
        return PIR_TREE_NONE;
    if (later <= until) {
        waiting->node[waiting->count] = node->child[1 - first];
        waiting->enter[waiting->count++] = later;
    }
    return node->child[first];
}

static uint32_t next_waiting(const pir_swept_search *search, struct waiting *waiting) {
    while (waiting->count > 0)
        if (waiting->enter[--waiting->count] <= *search->until)
            return waiting->node[waiting->count];
    return PIR_TREE_NONE;
}

pir_status pir_swept_pieces(const pir_swept_search *search) {
    const pir_tree *tree = &search->probe->scene->tree;
    struct waiting waiting;
    pir_status status = PIR_OK;
    waiting.count = 0; // the rest is written before it is read
    uint32_t n = tree->node ? tree->root : PIR_TREE_NONE;
    while (n != PIR_TREE_NONE && status == PIR_OK) {
        const pir_tree_node *node = &tree->node[n];
        const bool is_leaf = node->child[0] == PIR_TREE_NONE;
        if (!is_leaf && waiting.count < STACK) {
            n = first_child(search, node, &waiting);
        } else {
            status = is_leaf ? look_at_leaf(search, node) : look_below(search, n);
            n = PIR_TREE_NONE;
        }
        if (n == PIR_TREE_NONE)
            n = next_waiting(search, &waiting);
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

void pir_swept_triangles(const pir_scene_body *body, pir_swept_walk *walk) {
    const pir_surface_ref surface = pir_body_surface_of(body);
    const pir_walk_box bounds = pir_surface_bounds(surface);
    pir_walk_box part;
    if (pir_swept_part(&walk->swept, &bounds, *walk->until, &part))
        pir_surface_walk(surface, &(pir_walk){measure, look, walk, walk->until, &part});
}
