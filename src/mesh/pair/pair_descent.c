/* SPDX-License-Identifier: MIT */
/* Descents from the roots, and the search for the lowest two triangles that meet, which is one. */
#include "mesh/pair/pair_descent.h"

#define STACK (3 * 2 * PIR_MESH_DEPTH + PIR_NODE_LANES)

struct descent_task {
    pir_mesh_item p, q;
    float n[3];
};

struct descent_tasks {
    struct descent_task task[STACK];
    uint32_t used;
};

static uint32_t child_of(const pir_trimesh_pair *pair, int side, pir_mesh_item item) {
    return pir_item_child(pair->mesh[side], item);
}

/* Whether a pair of items has lower triangles than another: it is looked at first. */
static bool is_before(const pir_trimesh_pair *pair, const struct descent_task *a, const struct descent_task *b) {
    uint32_t ap = pir_item_least(pair->mesh[0], a->p), bp = pir_item_least(pair->mesh[0], b->p);
    return ap < bp || (ap == bp && pir_item_least(pair->mesh[1], a->q) < pir_item_least(pair->mesh[1], b->q));
}

static void push(const pir_trimesh_pair *pair, struct descent_tasks *tasks, uint32_t first,
                 const struct descent_task *task) {
    uint32_t at = tasks->used++;
    for (; at > first && is_before(pair, &tasks->task[at - 1], task); at--)
        tasks->task[at] = tasks->task[at - 1];
    tasks->task[at] = *task;
}

/* Pushes those of four pairs of items that may be within the distance. */
static void sort_lanes(pir_trimesh_pair *pair, const pir_pair_descent *d, struct descent_tasks *tasks,
                       const pir_node_lanes *p, const pir_node_lanes *q, struct descent_task *lane) {
    pir_node_axes axes;
    for (int i = 0; i < PIR_NODE_LANES; i++)
        for (int k = 0; k < 3; k++)
            axes.n[k][i] = lane[i].n[k];
    pir_bound_along(&pair->floats, p, q, &axes);
    pir_bound_by_nodes(&pair->floats, p, q, &axes);
    uint32_t first = tasks->used;
    for (int i = 0; i < PIR_NODE_LANES; i++) {
        if (lane[i].p == PIR_MESH_NO_CHILD || (double)axes.bound[i] > d->within ||
            (d->skip && d->skip(d->context, lane[i].p, lane[i].q)))
            continue;
        pair->counts.bounds++;
        for (int k = 0; k < 3; k++)
            lane[i].n[k] = axes.n[k][i];
        push(pair, tasks, first, &lane[i]);
    }
}

/* The children of the larger item that is no leaf, against the other. */
static void divide(pir_trimesh_pair *pair, const pir_pair_descent *d, struct descent_tasks *tasks,
                   const struct descent_task *task) {
    pir_node_lanes lanes[2];
    const pir_mesh_item item[2] = {task->p, task->q};
    int side = pir_item_size(pair->mesh[0], item[0]) >= pir_item_size(pair->mesh[1], item[1]) ? 0 : 1;
    if (pir_mesh_is_leaf(child_of(pair, side, item[side])))
        side = 1 - side;
    uint32_t node = child_of(pair, side, item[side]);
    pir_node_lanes_set_node(&lanes[side], pair->mesh[side], node);
    pir_node_lanes_set_one(&lanes[1 - side], pair->mesh[1 - side], item[1 - side]);
    struct descent_task lane[PIR_NODE_LANES];
    for (int i = 0; i < PIR_NODE_LANES; i++) {
        lane[i] = *task;
        *(side == 0 ? &lane[i].p : &lane[i].q) = node * PIR_MESH_WIDTH + (uint32_t)i;
        if (i >= pair->mesh[side]->tree.node[node].count)
            lane[i].p = PIR_MESH_NO_CHILD;
    }
    sort_lanes(pair, d, tasks, &lanes[0], &lanes[1], lane);
}

static void work(pir_trimesh_pair *pair, const pir_pair_descent *d, struct descent_tasks *tasks) {
    while (tasks->used > 0) {
        struct descent_task task = tasks->task[--tasks->used];
        if (d->skip && d->skip(d->context, task.p, task.q))
            continue;
        const uint32_t leaf[2] = {child_of(pair, 0, task.p), child_of(pair, 1, task.q)};
        if (pir_mesh_is_leaf(leaf[0]) && pir_mesh_is_leaf(leaf[1]))
            d->look(d->context, leaf, (pir_vec3){(double)task.n[0], (double)task.n[1], (double)task.n[2]});
        else
            divide(pair, d, tasks, &task);
    }
}

void pir_pair_descend(pir_trimesh_pair *pair, const pir_pair_descent *descent) {
    const uint8_t of_p = pair->mesh[0]->tree.node[0].count, of_q = pair->mesh[1]->tree.node[0].count;
    for (uint32_t i = 0; i < of_p; i++) {
        struct descent_tasks tasks;
        tasks.used = 0; // the rest is written before it is read
        struct descent_task lane[PIR_NODE_LANES];
        pir_node_lanes p, q;
        pir_node_lanes_set_one(&p, pair->mesh[0], i);
        pir_node_lanes_set_node(&q, pair->mesh[1], 0);
        for (uint32_t j = 0; j < PIR_NODE_LANES; j++)
            lane[j] = (struct descent_task){j < of_q ? i : PIR_MESH_NO_CHILD, j, {1, 0, 0}};
        sort_lanes(pair, descent, &tasks, &p, &q, lane);
        work(pair, descent, &tasks);
    }
}

/* --- the lowest two that are as near --- */

static bool cannot_be_lower(const void *context, pir_mesh_item p, pir_mesh_item q) {
    const pir_trimesh_pair *pair = context;
    const pir_best_pair *best = &pair->best;
    uint32_t least = pir_item_least(pair->mesh[0], p);
    return least > best->p || (least == best->p && pir_item_least(pair->mesh[1], q) >= best->q);
}

static void look_at_lower(void *context, const uint32_t leaf[2], pir_vec3 n) {
    pir_trimesh_pair *pair = context;
    double gap;
    (void)pir_leaf_pair_consider(&pair->best, &pair->frame, leaf, &n, &gap, &pair->counts);
}

void pir_lowest_pair_find(pir_trimesh_pair *pair, double within) {
    pir_pair_descend(pair, &(pir_pair_descent){within, cannot_be_lower, look_at_lower, pair});
}
