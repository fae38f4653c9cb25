/* SPDX-License-Identifier: MIT */
/* See rigid_hubs.h. */
#include "plan/rigid/rigid_hubs.h"

#include <stdlib.h>
#include <string.h>

#include <pirouette/pair.h>

/* How many translations are tried for a turn between two hubs. */
#define MOST_TRIES 12

/* The arc between two rotations, with the robot's outer pieces over it once they are asked for. */
struct rigid_arc {
    pir_quat end[2];
    pir_plan_pieces outer;
    bool is_made, is_open; /* whether there are outer pieces */
};

static double product(pir_quat a, pir_quat b) {
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

static bool make_arc(pir_rigid_job *job, struct rigid_arc *arc) {
    pir_quat b = arc->end[1];
    if (arc->is_made)
        return arc->is_open;
    arc->is_made = true;
    if (product(arc->end[0], b) < 0)
        b = (pir_quat){-b.x, -b.y, -b.z, -b.w};
    const pir_plan_turns turns = {{arc->end[0], b}, 2};
    // a product that rounding may have made positive is of no use
    const double size = product(arc->end[0], arc->end[0]) * product(b, b), dot = product(arc->end[0], b);
    if (!(dot * dot > 0x1p-10 * size))
        return false;
    const pir_status status = pir_plan_pieces_over(job->question->robot, &turns, true, &arc->outer);
    arc->is_open = status == PIR_OK;
    if (status != PIR_OK && status != PIR_ERR_LIMIT && job->status == PIR_OK)
        job->status = status;
    return arc->is_open;
}

static void box_of(const pir_polytope *piece, pir_vec3 low, double ret_low[3], double ret_high[3]) {
    for (int k = 0; k < 3; k++) {
        ret_low[k] = INFINITY;
        ret_high[k] = -INFINITY;
    }
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++) {
        const pir_vec3 x = pir_polytope_vertex(piece, v);
        const double at[3] = {x.x + low.x, x.y + low.y, x.z + low.z};
        for (int k = 0; k < 3; k++) {
            const double room = fabs(at[k]) * 0x1p-40 + PIR_PLAN_TINY;
            ret_low[k] = fmin(ret_low[k], at[k] - room);
            ret_high[k] = fmax(ret_high[k], at[k] + room);
        }
    }
}

/* Whether two pieces have no point in common, one of them at a translation. */
static bool are_apart(pir_rigid_job *job, pir_polytope *piece, pir_vec3 at, pir_polytope *obstacle) {
    pir_pair *pair = NULL;
    pir_query_result result = {0};
    pir_pair_input input = pir_pair_input_default();
    input.pose_p.translation = at;
    pir_status status = pir_pair_create(piece, obstacle, NULL, &pair);
    if (status == PIR_OK)
        status = pir_pair_overlap(pair, job->workspace, &input, &result);
    pir_pair_destroy(pair);
    if (status != PIR_OK && job->status == PIR_OK)
        job->status = status;
    return status == PIR_OK && result.state == PIR_OUTSIDE;
}

/* Whether the robot, at a translation, meets nothing at all rotations of an arc. */
static bool is_free(pir_rigid_job *job, struct rigid_arc *arc, const double at[3]) {
    const pir_plan_pieces *obstacles = job->question->obstacles;
    if (!make_arc(job, arc))
        return false;
    for (uint32_t i = 0; i < arc->outer.count; i++) {
        const pir_vec3 x = {at[0], at[1], at[2]};
        double low[3], high[3];
        box_of(arc->outer.at[i], x, low, high);
        for (uint32_t k = 0; k < obstacles->count; k++)
            if (pir_plan_boxes_meet(low, high, job->obstacle_box[k][0], job->obstacle_box[k][1]) &&
                !are_apart(job, arc->outer.at[i], x, obstacles->at[k]))
                return false;
    }
    return true;
}

static bool are_joined(pir_rigid_job *job, uint32_t a, uint32_t b) {
    return pir_rigid_root(job->hub_root, a) == pir_rigid_root(job->hub_root, b);
}

/* Joins two hubs, by their numbers, with a turn at a translation. */
static void add_turn(pir_rigid_job *job, const uint32_t leaf[2], const uint32_t hub[2], const double at[3]) {
    if (!pir_rigid_grow(job, (void **)&job->turn, &job->turn_room, job->turns + 1, sizeof *job->turn))
        return;
    job->turn[job->turns++] = (pir_rigid_turn){{leaf[0], leaf[1]}, {hub[0], hub[1]}, {at[0], at[1], at[2]}};
    job->hub_root[pir_rigid_root(job->hub_root, hub[0])] = pir_rigid_root(job->hub_root, hub[1]);
}

static bool add_number(pir_rigid_job *job) {
    if (!pir_rigid_grow(job, (void **)&job->hub_root, &job->hub_room, job->hubs + 1, sizeof *job->hub_root))
        return false;
    job->hub_root[job->hubs] = job->hubs;
    job->hubs++;
    return true;
}

/* How many leaves one touches, and which these are. */
static uint32_t touches_of(const pir_rigid_job *job, uint32_t leaf) {
    return job->leaf[pir_rigid_first(job, leaf)].touches;
}

static uint32_t touched_by(const pir_rigid_job *job, uint32_t leaf, uint32_t touch) {
    return job->leaf[pir_rigid_first(job, leaf)].touch[touch].other ^ pir_rigid_image(job, leaf);
}

/* The part of the inner ones that a hub is in is a choice that doubles make. */
static void place_hub(const pir_rigid_job *job, uint32_t leaf, pir_rigid_hub *hub) {
    const pir_box_parts *inner = &job->leaf[pir_rigid_first(job, leaf)].inner;
    double at[3];
    pir_symmetries_place(&job->question->symmetries, pir_rigid_image(job, leaf), hub->at, at);
    hub->in = PIR_PLAN_NONE;
    for (uint32_t i = 0; i < inner->cells && hub->in == PIR_PLAN_NONE; i++)
        if (pir_box_cell_has(inner, &inner->cell[i], at))
            hub->in = inner->cell[i].part;
}

/* A new hub of a leaf. */
static pir_rigid_hub *add_hub(pir_rigid_job *job, uint32_t leaf, const double at[3]) {
    pir_rigid_leaf *own = &job->leaf[leaf];
    if (!pir_rigid_grow(job, (void **)&own->hub, &own->hub_room, own->hubs + 1, sizeof *own->hub) || !add_number(job))
        return NULL;
    pir_rigid_hub *hub = &own->hub[own->hubs++];
    *hub = (pir_rigid_hub){{at[0], at[1], at[2]}, job->hubs - 1, PIR_PLAN_NONE};
    place_hub(job, leaf, hub);
    return hub;
}

static void mean_of(const pir_box_parts *parts, const pir_box_cell *cell, double ret[3]) {
    for (int k = 0; k < 3; k++) {
        ret[k] = 0;
        for (uint32_t v = 0; v < cell->points; v++)
            ret[k] += parts->x[cell->first + v][k] / cell->points;
    }
}

/* Translations that two cells have in common: the mean of one, and points between that and its corners. */
static uint32_t list_tries(const pir_box_parts *a, const pir_box_cell *own, const pir_box_parts *b,
                           const pir_box_cell *other, uint32_t count, double (*tries)[3]) {
    double mean[3];
    mean_of(a, own, mean);
    if (count < MOST_TRIES && pir_box_cell_has(b, other, mean))
        memcpy(tries[count++], mean, sizeof mean);
    for (uint32_t v = 0; v < own->points && count < MOST_TRIES; v++) {
        double x[3];
        for (int k = 0; k < 3; k++)
            x[k] = mean[k] + 0.75 * (a->x[own->first + v][k] - mean[k]);
        if (pir_box_cell_has(b, other, x))
            memcpy(tries[count++], x, sizeof x);
    }
    return count;
}

/* Whether the part of a full leaf, by its number, has a translation. */
static bool part_has(const pir_rigid_leaf *leaf, uint32_t part, const double at[3]) {
    for (uint32_t i = 0; i < leaf->middle.cells; i++)
        if (leaf->middle.cell[i].part == part && pir_box_cell_has(&leaf->middle, &leaf->middle.cell[i], at))
            return true;
    return false;
}

/* The cells of a division by their parts, in order: those of a part begin at its first one. Boxes have the parts. */
struct part_list {
    const pir_box_parts *of;
    uint32_t *first, *cell;
    double (*box)[2][3];
};

static void close_list(struct part_list *list) {
    free(list->first);
    free(list->cell);
    free(list->box);
}

static void add_to_box(const pir_box_cell *cell, double box[2][3]) {
    for (int k = 0; k < 3; k++) {
        box[0][k] = fmin(box[0][k], cell->low[k]);
        box[1][k] = fmax(box[1][k], cell->high[k]);
    }
}

static bool open_list(pir_rigid_job *job, const pir_box_parts *parts, struct part_list *list) {
    *list = (struct part_list){parts, calloc((size_t)parts->parts + 2, sizeof *list->first),
                               calloc((size_t)parts->cells + 1, sizeof *list->cell),
                               calloc((size_t)parts->parts + 1, sizeof *list->box)};
    if (!list->first || !list->cell || !list->box) {
        job->status = PIR_ERR_MEMORY;
        return false;
    }
    for (uint32_t p = 0; p < parts->parts; p++)
        for (int k = 0; k < 3; k++) {
            list->box[p][0][k] = INFINITY;
            list->box[p][1][k] = -INFINITY;
        }
    for (uint32_t i = 0; i < parts->cells; i++) {
        list->first[parts->cell[i].part + 2]++;
        add_to_box(&parts->cell[i], list->box[parts->cell[i].part]);
    }
    for (uint32_t p = 2; p < parts->parts + 2; p++)
        list->first[p] += list->first[p - 1];
    for (uint32_t i = 0; i < parts->cells; i++)
        list->cell[list->first[parts->cell[i].part + 1]++] = i;
    return true;
}

/* Translations that parts of two divisions have in common. */
static uint32_t list_common(const struct part_list *own, uint32_t part, const struct part_list *other,
                            uint32_t other_part, double (*tries)[3]) {
    uint32_t count = 0;
    double(*of)[3] = own->box[part], (*of_other)[3] = other->box[other_part];
    if (!pir_plan_boxes_meet(of[0], of[1], of_other[0], of_other[1]))
        return 0;
    for (uint32_t i = own->first[part]; i < own->first[part + 1]; i++)
        for (uint32_t k = other->first[other_part]; k < other->first[other_part + 1] && count < MOST_TRIES; k++) {
            const pir_box_cell *a = &own->of->cell[own->cell[i]], *b = &other->of->cell[other->cell[k]];
            if (!pir_plan_boxes_meet(a->low, a->high, b->low, b->high))
                continue;
            const uint32_t half = count + (MOST_TRIES - count + 1) / 2;
            count = list_tries(own->of, a, other->of, b, count, tries);
            count = count > half ? half : count;
            count = list_tries(other->of, b, own->of, a, count, tries);
        }
    return count;
}

/* Tries to join two hubs of two leaves, each by its place in the list of its leaf. */
static void join_hubs(pir_rigid_job *job, const uint32_t leaf[2], const uint32_t hub[2],
                      const struct part_list middle[2], struct rigid_arc *arc) {
    const pir_rigid_leaf *own = &job->leaf[leaf[0]], *other = &job->leaf[leaf[1]];
    const bool is_part[2] = {own->is_full && hub[0] < own->middle.parts,
                             other->is_full && hub[1] < other->middle.parts};
    const uint32_t node[2] = {own->hub[hub[0]].node, other->hub[hub[1]].node};
    double tries[MOST_TRIES][3];
    uint32_t count = 0;
    if (is_part[0] && is_part[1])
        count = list_common(&middle[0], hub[0], &middle[1], hub[1], tries);
    else if (is_part[0] && part_has(own, hub[0], other->hub[hub[1]].at))
        memcpy(tries[count++], other->hub[hub[1]].at, sizeof *tries);
    else if (is_part[1] && part_has(other, hub[1], own->hub[hub[0]].at))
        memcpy(tries[count++], own->hub[hub[0]].at, sizeof *tries);
    for (uint32_t i = 0; i < count && job->status == PIR_OK; i++)
        if (is_free(job, arc, tries[i])) {
            add_turn(job, leaf, node, tries[i]);
            return;
        }
}

static struct rigid_arc arc_between(const pir_rigid_leaf *a, const pir_rigid_leaf *b) {
    return (struct rigid_arc){.end = {pir_rotation_box_middle(a->box), pir_rotation_box_middle(b->box)}};
}

static void join_leaves(pir_rigid_job *job, uint32_t a, uint32_t b) {
    struct rigid_arc arc = arc_between(&job->leaf[a], &job->leaf[b]);
    struct part_list middle[2] = {{0}};
    const bool good =
        open_list(job, &job->leaf[a].middle, &middle[0]) && open_list(job, &job->leaf[b].middle, &middle[1]);
    for (uint32_t i = 0; i < job->leaf[a].hubs && good; i++)
        for (uint32_t k = 0; k < job->leaf[b].hubs && job->status == PIR_OK; k++) {
            const uint32_t leaf[2] = {a, b}, hub[2] = {i, k};
            if (!are_joined(job, job->leaf[a].hub[i].node, job->leaf[b].hub[k].node))
                join_hubs(job, leaf, hub, middle, &arc);
        }
    close_list(&middle[0]);
    close_list(&middle[1]);
    pir_plan_pieces_over_free(&arc.outer);
}

/* Gives a leaf hubs of another that an end reaches and it lacks, where the robot can turn on the spot. */
static void take_hubs(pir_rigid_job *job, uint32_t leaf, uint32_t from) {
    struct rigid_arc arc = arc_between(&job->leaf[leaf], &job->leaf[from]);
    const uint32_t leaves[2] = {leaf, from};
    for (uint32_t i = 0; i < job->leaf[from].hubs && job->status == PIR_OK; i++) {
        const pir_rigid_hub *hub = &job->leaf[from].hub[i];
        bool has = !are_joined(job, hub->node, PIR_RIGID_START) && !are_joined(job, hub->node, PIR_RIGID_GOAL);
        for (uint32_t k = 0; k < job->leaf[leaf].hubs && !has; k++)
            has = are_joined(job, job->leaf[leaf].hub[k].node, hub->node);
        if (has || !is_free(job, &arc, hub->at))
            continue;
        const pir_rigid_hub *own = add_hub(job, leaf, hub->at);
        const uint32_t node[2] = {own ? own->node : 0, hub->node};
        if (own)
            add_turn(job, leaves, node, hub->at);
    }
    pir_plan_pieces_over_free(&arc.outer);
}

/* Tries to join an end with the hubs of a leaf that has its rotation. */
static void join_end(pir_rigid_job *job, uint32_t end, uint32_t leaf) {
    const pir_rigid_leaf *own = &job->leaf[leaf];
    const double *at = job->question->at[end];
    if (!own->is_full || !pir_rotation_box_has(own->box, job->question->rotation[end]))
        return;
    struct rigid_arc arc = {.end = {job->question->rotation[end], pir_rotation_box_middle(own->box)}};
    for (uint32_t i = 0; i < own->middle.parts && job->status == PIR_OK; i++) {
        const uint32_t leaves[2] = {PIR_PLAN_NONE, leaf}, node[2] = {end, own->hub[i].node};
        if (!are_joined(job, node[0], node[1]) && part_has(own, i, at) && is_free(job, &arc, at))
            add_turn(job, leaves, node, at);
    }
    pir_plan_pieces_over_free(&arc.outer);
}

void pir_rigid_hubs_begin(pir_rigid_job *job) {
    const pir_plan_pieces *obstacles = job->question->obstacles;
    job->obstacle_box = calloc((size_t)obstacles->count + 1, sizeof *job->obstacle_box);
    if (!job->obstacle_box)
        job->status = PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < obstacles->count && job->status == PIR_OK; i++)
        box_of(obstacles->at[i], (pir_vec3){0, 0, 0}, job->obstacle_box[i][0], job->obstacle_box[i][1]);
    for (uint32_t i = 0; i < PIR_RIGID_ENDS; i++)
        if (!add_number(job))
            return;
    job->status = pir_workspace_create(NULL, &job->workspace);
}

void pir_rigid_hubs_inherit(pir_rigid_job *job) {
    for (uint32_t i = job->first_new; i < job->leaves; i++)
        for (uint32_t h = 0; h < job->leaf[i].hubs; h++)
            place_hub(job, i, &job->leaf[i].hub[h]);
    for (uint32_t i = job->first_new; i < job->leaves && job->status == PIR_OK; i++)
        if (job->leaf[i].parent != PIR_PLAN_NONE)
            take_hubs(job, i, job->leaf[i].parent);
    for (uint32_t i = job->first_new; i < job->leaves && job->status == PIR_OK; i++)
        for (uint32_t t = 0; t < touches_of(job, i) && job->status == PIR_OK; t++)
            take_hubs(job, i, touched_by(job, i, t));
}

/* Has the parts of a full leaf be its first hubs; those that it had are joined with the parts that have them. */
static void set_parts(pir_rigid_job *job, uint32_t leaf) {
    pir_rigid_leaf *own = &job->leaf[leaf];
    pir_rigid_hub *old = own->hub;
    const uint32_t olds = own->hubs;
    own->hub = NULL;
    own->hubs = own->hub_room = 0;
    for (uint32_t p = 0; p < own->middle.parts && job->status == PIR_OK; p++)
        for (uint32_t i = 0; i < own->middle.cells; i++)
            if (own->middle.cell[i].part == p) {
                double mean[3];
                mean_of(&own->middle, &own->middle.cell[i], mean);
                add_hub(job, leaf, mean);
                break;
            }
    for (uint32_t i = 0; i < olds && job->status == PIR_OK; i++)
        for (uint32_t p = 0; p < own->middle.parts; p++)
            if (part_has(own, p, old[i].at)) {
                const uint32_t leaves[2] = {leaf, leaf}, node[2] = {old[i].node, own->hub[p].node};
                if (!are_joined(job, node[0], node[1]))
                    add_turn(job, leaves, node, old[i].at);
                break;
            }
    free(old);
}

void pir_rigid_hubs_join(pir_rigid_job *job) {
    for (uint32_t n = 0; n < job->listed && job->status == PIR_OK; n++)
        if (job->leaf[job->list[n]].is_full)
            set_parts(job, job->list[n]);
    for (uint32_t n = 0; n < job->listed && job->status == PIR_OK; n++) {
        const uint32_t i = job->list[n];
        if (job->leaf[i].parent != PIR_PLAN_NONE)
            join_leaves(job, i, job->leaf[i].parent);
        for (uint32_t t = 0; t < touches_of(job, i) && job->status == PIR_OK; t++)
            join_leaves(job, i, touched_by(job, i, t));
        for (uint32_t end = 0; end < PIR_RIGID_ENDS && job->status == PIR_OK; end++)
            join_end(job, end, i);
    }
}

void pir_rigid_hubs_finish(pir_rigid_job *job) {
    pir_workspace_destroy(job->workspace);
    free(job->obstacle_box);
    free(job->hub_root);
    free(job->turn);
}
