/* SPDX-License-Identifier: MIT */
/* See way.h. */
#include "plan/way.h"

#include <string.h>

/* Ends the job because of a contradiction. */
static void give_up(pir_plan_space *space) {
    if (space->status == PIR_OK)
        space->status = PIR_ERR_INTERNAL;
}

/* --- cells in a row --- */

/* Joints of each cell in a row, and the joint by which each cell was reached. */
struct joint_search {
    uint32_t *start, *joint, *by, *queue;
};

/* Lists the joints of each cell. */
static void list_joints(const pir_plan_joints *joints, struct joint_search *s) {
    for (uint32_t i = 0; i < joints->count; i++)
        for (int k = 0; k < 2; k++)
            s->start[joints->joint[i].cell[k] + 1]++;
    for (uint32_t c = 0; c < joints->cells; c++)
        s->start[c + 1] += s->start[c];
    for (uint32_t i = 0; i < joints->count; i++)
        for (int k = 0; k < 2; k++)
            s->joint[s->start[joints->joint[i].cell[k]]++] = i;
    for (uint32_t c = joints->cells; c > 0; c--)
        s->start[c] = s->start[c - 1];
    s->start[0] = 0;
}

/* Reaches cells from `last` until `first` is reached. */
static bool reach(const pir_plan_joints *joints, struct joint_search *s, uint32_t first, uint32_t last) {
    uint32_t done = 0, count = 0;
    memset(s->by, 0xff, joints->cells * sizeof *s->by);
    s->queue[count++] = last;
    while (done < count && s->queue[done] != first) {
        const uint32_t cell = s->queue[done++];
        for (uint32_t i = s->start[cell]; i < s->start[cell + 1]; i++) {
            const pir_plan_joint *joint = &joints->joint[s->joint[i]];
            const uint32_t other = joint->cell[joint->cell[0] == cell];
            if (other == last || s->by[other] != PIR_PLAN_NONE)
                continue;
            s->by[other] = s->joint[i];
            s->queue[count++] = other;
        }
    }
    return done < count;
}

static void add_point(pir_plan_space *space, pir_plan_way *way, uint32_t point) {
    if (pir_plan_grow(space, (void **)&way->point, &way->room, way->count + 1, sizeof *way->point))
        way->point[way->count++] = point;
}

/* With closed sums the sides of a cell are blocked in part, so the way goes through its middle. */
static void add_middle(pir_plan_space *space, const pir_plan_cell *cell, bool open, pir_plan_way *way) {
    if (!open && space->status == PIR_OK)
        add_point(space, way, pir_plan_point_mean(space, cell->point, cell->points));
}

static void list_points(pir_plan_space *space, const pir_plan_tree *tree, const pir_plan_joints *joints,
                        const uint32_t cell[2], const uint32_t end[2], pir_plan_way *way) {
    struct joint_search s = {.start = pir_plan_new(space, joints->cells + (size_t)2, sizeof(uint32_t)),
                             .joint = pir_plan_new(space, 2 * (size_t)joints->count, sizeof(uint32_t)),
                             .by = pir_plan_new(space, joints->cells, sizeof(uint32_t)),
                             .queue = pir_plan_new(space, joints->cells, sizeof(uint32_t))};
    if (space->status == PIR_OK) {
        list_joints(joints, &s);
        if (!reach(joints, &s, cell[0], cell[1]))
            give_up(space);
    }
    add_point(space, way, end[0]);
    for (uint32_t now = cell[0]; space->status == PIR_OK;) {
        add_middle(space, &tree->cell[now], tree->open, way);
        if (now == cell[1])
            break;
        const pir_plan_joint *joint = &joints->joint[s.by[now]];
        add_point(space, way, joint->door);
        now = joint->cell[joint->cell[0] == now];
    }
    add_point(space, way, end[1]);
    pir_plan_free(space, s.start, joints->cells + (size_t)2, sizeof(uint32_t));
    pir_plan_free(space, s.joint, 2 * (size_t)joints->count, sizeof(uint32_t));
    pir_plan_free(space, s.by, joints->cells, sizeof(uint32_t));
    pir_plan_free(space, s.queue, joints->cells, sizeof(uint32_t));
}

/* --- motions --- */

static bool is_free(pir_plan_space *space, const pir_plan_sums *sums, uint32_t from, uint32_t to, bool open) {
    return pir_plan_sums_along(space, sums, from, to, open) == PIR_PLAN_NONE;
}

/* Rounds the points but for the ends; takes roundings back where a motion is not free with them. */
static void round_points(pir_plan_space *space, const pir_plan_sums *sums, const pir_plan_tree *tree,
                         pir_plan_way *way) {
    if (!pir_plan_grow(space, (void **)&way->exact, &way->exact_room, way->count, sizeof *way->exact))
        return;
    memcpy(way->exact, way->point, way->count * sizeof *way->point);
    for (uint32_t i = 1; i + 1 < way->count && space->status == PIR_OK; i++) {
        double x[3];
        for (int k = 0; k < 3; k++)
            x[k] = fmin(fmax(space->point[way->point[i]].at[k], tree->low[k]), tree->high[k]);
        if (isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]))
            way->point[i] = pir_plan_point_at(space, x);
    }
    for (uint32_t i = 0; i + 1 < way->count && space->status == PIR_OK;) {
        if (is_free(space, sums, way->point[i], way->point[i + 1], tree->open)) {
            i++;
            continue;
        }
        if (way->point[i] == way->exact[i] && way->point[i + 1] == way->exact[i + 1])
            give_up(space);
        way->point[i] = way->exact[i];
        way->point[i + 1] = way->exact[i + 1];
        i -= i > 0; // the motion before it ends elsewhere now
    }
}

/* Leaves out points between which a straight motion is free, trying far ones first. */
static void shorten(pir_plan_space *space, const pir_plan_sums *sums, bool open, pir_plan_way *way) {
    uint32_t kept = 1;
    for (uint32_t i = 0; i + 1 < way->count && space->status == PIR_OK;) {
        uint32_t step = way->count - 1 - i;
        while (step > 1 && !is_free(space, sums, way->point[i], way->point[i + step], open))
            step = step > 8 ? step - step / 4 : step - 1;
        i += step;
        way->point[kept++] = way->point[i];
    }
    if (space->status == PIR_OK)
        way->count = kept;
}

void pir_plan_way_make(pir_plan_cutter *cutter, const pir_plan_sums *sums, const pir_plan_tree *tree,
                       const pir_plan_joints *joints, const uint32_t cell[2], const uint32_t end[2],
                       pir_plan_way *way) {
    pir_plan_space *space = cutter->space;
    list_points(space, tree, joints, cell, end, way);
    if (space->status == PIR_OK)
        round_points(space, sums, tree, way);
    uint32_t before = UINT32_MAX;
    while (space->status == PIR_OK && way->count < before) {
        before = way->count;
        shorten(space, sums, tree->open, way);
    }
    // readers of the way ask for integers
    for (uint32_t i = 0; i < way->count && space->status == PIR_OK; i++)
        pir_plan_point_exact(space, way->point[i]);
    for (uint32_t i = 0; i + 1 < way->count && space->status == PIR_OK; i++)
        if (!is_free(space, sums, way->point[i], way->point[i + 1], tree->open))
            give_up(space);
}

void pir_plan_way_finish(pir_plan_space *space, pir_plan_way *way) {
    pir_plan_free(space, way->point, way->room, sizeof *way->point);
    pir_plan_free(space, way->exact, way->exact_room, sizeof *way->exact);
    *way = (pir_plan_way){0};
}
