/* SPDX-License-Identifier: MIT */
/* See divide.h. */
#include "plan/divide.h"

#include <string.h>

#include "base/sort.h"

/* A part that is to be looked at, and the sums that may meet its inside. */
struct task {
    uint32_t node;
    pir_plan_cell cell;
    uint32_t *sum;
    uint32_t sums, room;
};

struct divider {
    pir_plan_cutter *cutter;
    pir_plan_space *space;
    const pir_plan_sums *sums;
    pir_plan_tree *tree;
    struct task *task;
    uint32_t tasks, task_room, most;
    double *score;   /* of the sums of the task at hand */
    double *far;     /* per plane of the sum at hand, how far the cell is beyond it */
    uint32_t *order; /* these planes */
    uint32_t score_room, far_room, order_room;
};

static bool is_farther(void *context, uint32_t a, uint32_t b) {
    const struct divider *d = context;
    return d->far[a] > d->far[b];
}

enum sum_meeting { APART, CUT, COVERS };

static void free_task(struct divider *d, struct task *task) {
    pir_plan_cell_free(d->space, &task->cell);
    pir_plan_free(d->space, task->sum, task->room, sizeof *task->sum);
}

/* Puts a part on the list, with the sums of its parent; the cell is the task's then. */
static void push(struct divider *d, uint32_t node, pir_plan_cell *cell, const uint32_t *sum, uint32_t sums) {
    struct task task = {.node = node, .cell = *cell, .sums = sums};
    if (d->space->status == PIR_OK) {
        task.sum = pir_plan_new(d->space, sums, sizeof *task.sum);
        task.room = sums;
    }
    if (!task.sum || !pir_plan_grow(d->space, (void **)&d->task, &d->task_room, d->tasks + 1, sizeof *d->task)) {
        free_task(d, &task);
        return;
    }
    if (sums > 0)
        memcpy(task.sum, sum, sums * sizeof *sum);
    d->task[d->tasks++] = task;
}

static uint32_t add_node(struct divider *d) {
    pir_plan_tree *tree = d->tree;
    if (tree->node_count >= d->most && d->space->status == PIR_OK)
        d->space->status = PIR_PLAN_ERR_PARTS;
    if (!pir_plan_grow(d->space, (void **)&tree->node, &tree->node_room, tree->node_count + 1, sizeof *tree->node))
        return 0;
    tree->node[tree->node_count] = (pir_plan_node){.child = {PIR_PLAN_NONE, 0}, .face = PIR_PLAN_NONE};
    return tree->node_count++;
}

/* Whether a corner of a sum is strictly inside a cell: then the sum cuts it, for the corner is on its boundary. */
static bool has_corner(struct divider *d, const pir_plan_cell *cell, const pir_plan_sum *sum) {
    bool has = cell->dimension == 3 && sum->corners > 0;
    for (uint32_t h = 0; h < cell->halves && has; h++)
        has = pir_plan_side(d->space, cell->half[h], d->sums->corner[sum->corner]) < 0;
    return has;
}

/* How a sum meets a cell, as far as planes of both tell: a sum that is apart may be said to cut. */
static enum sum_meeting meeting_of(struct divider *d, const pir_plan_cell *cell, const pir_plan_sum *sum) {
    if (!pir_plan_boxes_meet(cell->low, cell->high, sum->low, sum->high))
        return APART;
    if (has_corner(d, cell, sum))
        return CUT;
    bool covers = true;
    for (uint32_t i = 0; i < sum->halves; i++) {
        int least, most;
        pir_plan_cell_sides(d->cutter, cell, d->sums->half[sum->half + i], &least, &most);
        if (least >= 0)
            return APART;
        covers = covers && most <= 0;
    }
    if (covers)
        return COVERS;
    // an open sum beyond a plane that bounds the cell
    for (uint32_t h = 0; h < cell->halves; h++) {
        bool beyond = true;
        for (uint32_t i = 0; i < sum->corners && beyond; i++)
            beyond = pir_plan_side(d->space, cell->half[h], d->sums->corner[sum->corner + i]) >= 0;
        if (beyond)
            return APART;
    }
    return CUT;
}

/* Whether an open sum has a point of a cell. */
static bool meets_inside(struct divider *d, const pir_plan_cell *cell, const pir_plan_sum *sum) {
    const uint32_t *half = &d->sums->half[sum->half];
    const pir_plan_cell *now = cell;
    pir_plan_cell part = {.dimension = -1};
    for (uint32_t i = 0; i < sum->halves && now->points > 0 && d->space->status == PIR_OK; i++) {
        int least, most;
        pir_plan_cell_sides(d->cutter, now, half[i], &least, &most);
        if (most <= 0)
            continue;
        pir_plan_cell next;
        pir_plan_cell_clip(d->cutter, now, half[i], &next);
        if (now == &part)
            pir_plan_cell_free(d->space, &part);
        part = next;
        now = &part;
    }
    // the mean of the points is inside where no plane has them all
    bool meets = now->points > 0;
    for (uint32_t i = 0; i < sum->halves && meets && d->space->status == PIR_OK; i++) {
        int least, most;
        pir_plan_cell_sides(d->cutter, now, half[i], &least, &most);
        meets = least < 0;
    }
    if (now == &part)
        pir_plan_cell_free(d->space, &part);
    return meets;
}

/* How large the part is that boxes of both have in common, for choices: sums that take the most come first. */
static double shared_size(const pir_plan_cell *cell, const pir_plan_sum *sum) {
    double size = 1;
    for (int k = 0; k < 3; k++) {
        const double own = cell->high[k] - cell->low[k];
        const double both = fmin(cell->high[k], sum->high[k]) - fmax(cell->low[k], sum->low[k]);
        size *= own > 0 ? fmax(both / own, 1e-6) : 1;
    }
    return size;
}

/* Lists the planes of a sum by how far the cell is beyond them, the farthest first: they cut off the most. */
static uint32_t order_planes(struct divider *d, const pir_plan_cell *cell, const pir_plan_sum *sum) {
    if (!pir_plan_grow(d->space, (void **)&d->far, &d->far_room, sum->halves, sizeof *d->far) ||
        !pir_plan_grow(d->space, (void **)&d->order, &d->order_room, 2 * sum->halves, sizeof *d->order))
        return 0;
    for (uint32_t i = 0; i < sum->halves; i++) {
        d->order[i] = i;
        d->far[i] = 0;
        for (uint32_t v = 0; v < cell->points; v++)
            d->far[i] = fmax(d->far[i], pir_plan_distance(d->space, d->sums->half[sum->half + i], cell->point[v]));
    }
    pir_sort(d->order, sum->halves, d->order + sum->halves, is_farther, d);
    return sum->halves;
}

/* --- parts --- */

static void set_free(struct divider *d, struct task *task) {
    pir_plan_tree *tree = d->tree;
    if (!pir_plan_grow(d->space, (void **)&tree->cell, &tree->cell_room, tree->cell_count + 1, sizeof *tree->cell))
        return;
    tree->node[task->node].part = PIR_PLAN_FREE;
    tree->node[task->node].by = tree->cell_count;
    tree->cell[tree->cell_count++] = task->cell;
    task->cell = (pir_plan_cell){.dimension = -1};
}

/* Adds faces of a part on the planes of the sum that blocks it. */
static void add_faces(struct divider *d, struct task *task, uint32_t by) {
    const pir_plan_sum *sum = &d->sums->sum[by];
    uint32_t first = PIR_PLAN_NONE, count = 0;
    for (uint32_t i = 0; i < sum->halves && d->space->status == PIR_OK; i++) {
        int least, most;
        const uint32_t half = d->sums->half[sum->half + i];
        pir_plan_cell_sides(d->cutter, &task->cell, half, &least, &most);
        if (most < 0)
            continue;
        const uint32_t node = add_node(d);
        pir_plan_cell face;
        pir_plan_cell_face(d->cutter, &task->cell, half, &face);
        if (d->space->status == PIR_OK) {
            d->tree->node[node].face = i;
            first = count++ == 0 ? node : first;
        }
        push(d, node, &face, task->sum, task->sums);
    }
    d->tree->node[task->node].child[0] = first;
    d->tree->node[task->node].child[1] = count;
}

static void set_blocked(struct divider *d, struct task *task, uint32_t by) {
    d->tree->node[task->node].part = PIR_PLAN_BLOCKED;
    d->tree->node[task->node].by = by;
    if (d->tree->open)
        add_faces(d, task, by);
}

/* Splits the part of a task, which is the half within then; the half beyond is a task of its own. */
static void split(struct divider *d, struct task *task, uint32_t half) {
    pir_plan_cell part[2];
    const uint32_t child[2] = {add_node(d), add_node(d)};
    if (d->space->status != PIR_OK)
        return;
    pir_plan_node *node = &d->tree->node[task->node];
    node->part = PIR_PLAN_SPLIT;
    node->by = half;
    memcpy(node->child, child, sizeof child);
    pir_plan_cell_split(d->cutter, &task->cell, half, &part[0], &part[1]);
    pir_plan_cell_free(d->space, &task->cell);
    task->cell = part[0];
    task->node = child[0];
    push(d, child[1], &part[1], task->sum, task->sums);
}

/* Cuts off all that a sum leaves of a part. The sum blocks the rest. */
static void carve(struct divider *d, struct task *task, uint32_t by) {
    const pir_plan_sum *sum = &d->sums->sum[by];
    const uint32_t count = order_planes(d, &task->cell, sum);
    for (uint32_t i = 0; i < count && d->space->status == PIR_OK; i++) {
        int least, most;
        const uint32_t half = d->sums->half[sum->half + d->order[i]];
        pir_plan_cell_sides(d->cutter, &task->cell, half, &least, &most);
        if (most > 0)
            split(d, task, half);
    }
    if (d->space->status == PIR_OK)
        set_blocked(d, task, by);
}

/* Keeps of the sums of a task those that may meet its inside, with their scores; the first that covers it, or none. */
static uint32_t keep_sums(struct divider *d, struct task *task) {
    uint32_t kept = 0;
    if (!pir_plan_grow(d->space, (void **)&d->score, &d->score_room, task->sums, sizeof *d->score))
        return PIR_PLAN_NONE;
    for (uint32_t i = 0; i < task->sums; i++) {
        const uint32_t sum = task->sum[i];
        const enum sum_meeting how = meeting_of(d, &task->cell, &d->sums->sum[sum]);
        if (how == APART)
            continue;
        task->sum[kept] = sum;
        d->score[kept++] = shared_size(&task->cell, &d->sums->sum[sum]);
        if (how != COVERS)
            continue;
        // sums that were not looked at may still meet faces
        for (uint32_t k = i + 1; k < task->sums; k++)
            task->sum[kept++] = task->sum[k];
        task->sums = kept;
        return sum;
    }
    task->sums = kept;
    return PIR_PLAN_NONE;
}

static void look_at(struct divider *d, struct task *task) {
    const uint32_t by = keep_sums(d, task);
    if (d->space->status != PIR_OK)
        return;
    if (by != PIR_PLAN_NONE) {
        set_blocked(d, task, by);
        return;
    }
    while (task->sums > 0 && d->space->status == PIR_OK) {
        uint32_t best = 0;
        for (uint32_t i = 1; i < task->sums; i++)
            best = d->score[i] > d->score[best] ? i : best;
        if (meets_inside(d, &task->cell, &d->sums->sum[task->sum[best]])) {
            carve(d, task, task->sum[best]);
            return;
        }
        task->sum[best] = task->sum[--task->sums];
        d->score[best] = d->score[task->sums];
    }
    set_free(d, task);
}

/* The numbers of sums from one on. */
static uint32_t *list_sums(pir_plan_space *space, const pir_plan_sums *sums, uint32_t first) {
    uint32_t *list = pir_plan_new(space, sums->count - first, sizeof *list);
    for (uint32_t i = first; i < sums->count && list; i++)
        list[i - first] = i;
    return list;
}

static void run(struct divider *d) {
    pir_plan_space *space = d->space;
    while (d->tasks > 0) {
        struct task task = d->task[--d->tasks];
        if (space->status == PIR_OK)
            look_at(d, &task);
        free_task(d, &task);
    }
    pir_plan_free(space, d->task, d->task_room, sizeof *d->task);
    pir_plan_free(space, d->score, d->score_room, sizeof *d->score);
    pir_plan_free(space, d->far, d->far_room, sizeof *d->far);
    pir_plan_free(space, d->order, d->order_room, sizeof *d->order);
}

void pir_plan_divide(pir_plan_cutter *cutter, const pir_plan_sums *sums, uint32_t most, pir_plan_tree *tree) {
    struct divider d = {.cutter = cutter, .space = cutter->space, .sums = sums, .tree = tree, .most = most};
    pir_plan_space *space = cutter->space;
    pir_plan_cell box;
    uint32_t *all = list_sums(space, sums, 0);
    pir_plan_cell_box(cutter, tree->low, tree->high, &box);
    const uint32_t root = add_node(&d);
    if (space->status == PIR_OK)
        push(&d, root, &box, all, sums->count);
    else
        pir_plan_cell_free(space, &box);
    pir_plan_free(space, all, sums->count, sizeof *all);
    run(&d);
}

void pir_plan_divide_more(pir_plan_cutter *cutter, const pir_plan_sums *sums, uint32_t first, uint32_t most,
                          pir_plan_tree *tree) {
    struct divider d = {.cutter = cutter, .space = cutter->space, .sums = sums, .tree = tree, .most = most};
    pir_plan_space *space = cutter->space;
    pir_plan_cell *cell = tree->cell;
    const uint32_t room = tree->cell_room, nodes = tree->node_count;
    uint32_t *more = list_sums(space, sums, first);
    tree->cell = NULL;
    tree->cell_count = tree->cell_room = 0;
    for (uint32_t i = 0; i < nodes; i++) {
        pir_plan_node *node = &tree->node[i];
        if (node->part != PIR_PLAN_FREE)
            continue;
        node->part = PIR_PLAN_OPEN;
        push(&d, i, &cell[node->by], more, sums->count - first);
    }
    pir_plan_free(space, cell, room, sizeof *cell);
    pir_plan_free(space, more, sums->count - first, sizeof *more);
    run(&d);
}

void pir_plan_tree_finish(pir_plan_space *space, pir_plan_tree *tree) {
    for (uint32_t i = 0; i < tree->cell_count; i++)
        pir_plan_cell_free(space, &tree->cell[i]);
    pir_plan_free(space, tree->cell, tree->cell_room, sizeof *tree->cell);
    pir_plan_free(space, tree->node, tree->node_room, sizeof *tree->node);
    tree->node = NULL;
    tree->cell = NULL;
    tree->node_count = tree->node_room = tree->cell_count = tree->cell_room = 0;
}
