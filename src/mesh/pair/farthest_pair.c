/* SPDX-License-Identifier: MIT */
/*
 * The farthest two triangles: of two vertices. With d between the middles of two nodes, u and v from there to two
 * points, (d + u - v)^2 is at most d^2 + 2 d (u - v) + (|u| + |v|)^2. That is near the truth for nodes that are small
 * beside their distance. Pairs of nodes that cannot be as far as the best vertices are not looked at.
 */
#include "mesh/pair/pair_descent.h"

#define STACK (3 * 2 * PIR_MESH_DEPTH + PIR_NODE_LANES)

struct farthest_search {
    pir_trimesh_pair *pair;
    uint32_t p, q; /* the best triangles, PIR_TRIANGLE_NONE for none yet */
    uint32_t vertex_p, vertex_q;
    double low, high; /* of their distance */
};

struct farthest_task {
    pir_mesh_item p, q;
    double most;
};

/* --- vertices --- */

/* The sign of the distance of two vertices less that of the best two, exactly. */
static int exact_order(struct farthest_search *f, uint32_t vp, uint32_t vq) {
    pir_mesh_frame *frame = &f->pair->frame;
    const uint32_t used = frame->limbs.used, p[2] = {vp, f->vertex_p}, q[2] = {vq, f->vertex_q};
    pir_int square[2];
    f->pair->counts.exact++;
    for (int i = 0; i < 2; i++) {
        pir_int3 a = pir_mesh_frame_exact(frame, 0, p[i]), b = pir_mesh_frame_exact(frame, 1, q[i]);
        pir_int3 between = pir_num3_sub(&frame->limbs, &a, &b);
        square[i] = pir_num3_dot(&frame->limbs, &between, &between);
    }
    int order = pir_num_compare(&frame->limbs, &square[0], &square[1]);
    frame->limbs.used = used;
    return order;
}

static void consider(struct farthest_search *f, uint32_t p, uint32_t vp, uint32_t q, uint32_t vq, double distance) {
    double error = 4 * f->pair->frame.error;
    bool lower = p < f->p || (p == f->p && q < f->q);
    if (f->p != PIR_TRIANGLE_NONE && distance + error < f->low)
        return;
    int order = 0;
    if (f->p == PIR_TRIANGLE_NONE || distance - error > f->high)
        order = 1;
    else if (vp != f->vertex_p || vq != f->vertex_q)
        order = exact_order(f, vp, vq);
    if (order < 0 || (order == 0 && !lower))
        return;
    f->p = p;
    f->q = q;
    f->vertex_p = vp;
    f->vertex_q = vq;
    f->low = distance - error;
    f->high = distance + error;
}

static void look(struct farthest_search *f, uint32_t p, uint32_t q) {
    f->pair->counts.triangles++;
    pir_corners a = pir_frame_corners(&f->pair->frame, 0, p), b = pir_frame_corners(&f->pair->frame, 1, q);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            consider(f, p, a.id[i], q, b.id[j], pir_vec_length(pir_vec_sub(a.p[i], b.p[j])));
}

static void look_at_leaves(struct farthest_search *f, uint32_t leaf_p, uint32_t leaf_q) {
    const pir_mesh_tree *p = &f->pair->mesh[0]->tree, *q = &f->pair->mesh[1]->tree;
    for (uint32_t i = 0; i < pir_mesh_leaf_count(leaf_p); i++)
        for (uint32_t j = 0; j < pir_mesh_leaf_count(leaf_q); j++)
            look(f, p->item[pir_mesh_leaf_start(leaf_p) + i], q->item[pir_mesh_leaf_start(leaf_q) + j]);
}

/* --- nodes --- */

static pir_vec3 middle_of(const pir_node_lanes *l, int i) {
    return (pir_vec3){(double)l->middle[0][i], (double)l->middle[1][i], (double)l->middle[2][i]};
}

/* How far w leads in a box from its middle. */
static double half_along(const pir_node_lanes *l, int i, pir_vec3 w) {
    return fabs(w.x) * (double)l->half[0][i] + fabs(w.y) * (double)l->half[1][i] + fabs(w.z) * (double)l->half[2][i];
}

/* At least the distance of any two points of two items. */
static double most_of(const pir_trimesh_pair *pair, const pir_node_lanes *p, int i, const pir_node_lanes *q, int j) {
    pir_vec3 between = pir_vec_sub(pir_mesh_frame_apply(&pair->frame, middle_of(p, i)), middle_of(q, j));
    double radii = sqrt((double)pir_lanes_size(p)[i]) + sqrt((double)pir_lanes_size(q)[j]);
    double along = half_along(p, i, pir_mat_apply_transposed(&pair->frame.r, between)) + half_along(q, j, between);
    double length = pir_vec_length(between), square = length * length + 2 * along + radii * radii;
    double most = fmin(sqrt(square), length + radii);
    return most * (1 + 0x1p-20) + (double)pair->floats.error;
}

static struct farthest_task task_of(const pir_trimesh_pair *pair, pir_mesh_item p, pir_mesh_item q) {
    pir_node_lanes a, b;
    pir_node_lanes_set_one(&a, pair->mesh[0], p);
    pir_node_lanes_set_one(&b, pair->mesh[1], q);
    return (struct farthest_task){p, q, most_of(pair, &a, 0, &b, 0)};
}

/* Pushes a pair of items before those that are nearer, so that the farthest is popped first. */
static uint32_t push(struct farthest_search *f, struct farthest_task *stack, uint32_t first, uint32_t used,
                     struct farthest_task task) {
    f->pair->counts.bounds++;
    if (f->p != PIR_TRIANGLE_NONE && task.most < f->low)
        return used;
    uint32_t at = used;
    for (; at > first && stack[at - 1].most > task.most; at--)
        stack[at] = stack[at - 1];
    stack[at] = task;
    return used + 1;
}

static uint32_t divide(struct farthest_search *f, struct farthest_task *stack, uint32_t used,
                       const struct farthest_task *task) {
    const pir_trimesh_pair *pair = f->pair;
    uint32_t child[2] = {pir_item_child(pair->mesh[0], task->p), pir_item_child(pair->mesh[1], task->q)};
    bool of_q =
        pir_mesh_is_leaf(child[0]) ||
        (!pir_mesh_is_leaf(child[1]) && pir_item_size(pair->mesh[1], task->q) > pir_item_size(pair->mesh[0], task->p));
    uint32_t node = of_q ? child[1] : child[0], first = used;
    for (uint32_t i = 0; i < pair->mesh[of_q]->tree.node[node].count; i++) {
        pir_mesh_item item = node * PIR_MESH_WIDTH + i;
        used = push(f, stack, first, used, task_of(pair, of_q ? task->p : item, of_q ? item : task->q));
    }
    return used;
}

static void descend(struct farthest_search *f, pir_mesh_item p, pir_mesh_item q) {
    struct farthest_task stack[STACK];
    uint32_t used = push(f, stack, 0, 0, task_of(f->pair, p, q));
    while (used > 0) {
        struct farthest_task task = stack[--used];
        if (f->p != PIR_TRIANGLE_NONE && task.most < f->low)
            continue;
        uint32_t leaf_p = pir_item_child(f->pair->mesh[0], task.p), leaf_q = pir_item_child(f->pair->mesh[1], task.q);
        if (pir_mesh_is_leaf(leaf_p) && pir_mesh_is_leaf(leaf_q))
            look_at_leaves(f, leaf_p, leaf_q);
        else
            used = divide(f, stack, used, &task);
    }
}

static pir_vec3 vertex_in_world(const pir_trimesh_pair *pair, int side, uint32_t vertex) {
    pir_vec3 x = pair->mesh[side]->vertex[vertex];
    return pir_vec_add(pir_mat_apply(&pair->frame.rotation[side].r, x), pair->frame.pose[side].translation);
}

pir_status pir_trimesh_pair_farthest(pir_trimesh_pair *pair, pir_pose pose_p, pir_pose pose_q,
                                     pir_trimesh_distance *ret_distance) {
    pir_status status = pair && ret_distance ? pir_trimesh_pair_place(pair, pose_p, pose_q, 0) : PIR_ERR_ARGUMENT;
    if (status != PIR_OK)
        return status;
    struct farthest_search f = {.pair = pair, .p = PIR_TRIANGLE_NONE, .q = PIR_TRIANGLE_NONE};
    if (pair->farthest_p != PIR_TRIANGLE_NONE)
        look(&f, pair->farthest_p, pair->farthest_q);
    for (uint32_t i = 0; i < pair->mesh[0]->tree.node[0].count; i++)
        for (uint32_t j = 0; j < pair->mesh[1]->tree.node[0].count; j++)
            descend(&f, i, j);
    pair->farthest_p = f.p;
    pair->farthest_q = f.q;
    pir_vec3 p = vertex_in_world(pair, 0, f.vertex_p), q = vertex_in_world(pair, 1, f.vertex_q);
    *ret_distance = (pir_trimesh_distance){PIR_TRIMESH_APART, pir_vec_length(pir_vec_sub(p, q)), f.p, f.q, p, q};
    return PIR_OK;
}
