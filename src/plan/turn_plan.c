/* SPDX-License-Identifier: MIT */
/* See turn_plan.h. */
#include "plan/turn_plan.h"

#include <stdlib.h>

#include "base/memory.h"
#include "plan/join.h"
#include "plan/plan_write.h"
#include "plan/turn_bodies.h"

#define PI 3.14159265358979323846

/* A joint of two cells, numbered through all arcs, at a door. */
struct link {
    uint32_t cell[2], door;
};

/* One division: of all arcs, for inner or outer pieces. */
struct layers {
    pir_plan_space space;
    pir_plan_cutter cutter;
    const pir_turn_question *question;
    bool outer;
    uint32_t arcs;
    pir_plan_pieces *turned; /* per arc; `body` is which piece of the robot each is of */
    pir_plan_sums *sums;
    pir_plan_tree *tree;
    uint32_t *first; /* per arc, its first cell; one more */
    uint32_t *root;
    struct link *link;
    uint32_t root_room, link_room, links, parts;
};

static uint32_t root_of(struct layers *l, uint32_t i) {
    while (l->root[i] != i)
        i = l->root[i] = l->root[l->root[i]];
    return i;
}

static void add_link(struct layers *l, uint32_t a, uint32_t b, uint32_t door) {
    if (!pir_plan_grow(&l->space, (void **)&l->link, &l->link_room, l->links + 1, sizeof *l->link))
        return;
    l->link[l->links++] = (struct link){{a, b}, door};
    l->root[root_of(l, a)] = root_of(l, b);
}

/* Where an arc begins. Of outer pieces every second one is a single angle. */
static double angle_at(const struct layers *l, uint32_t arc) {
    return l->outer ? arc / 2 * (2 * PI / (l->arcs / 2)) : arc * (2 * PI / l->arcs);
}

static pir_quat turn_by(const struct layers *l, double angle) {
    const double *u = l->question->axis, s = sin(angle / 2);
    return (pir_quat){s * u[0], s * u[1], s * u[2], cos(angle / 2)};
}

/* An arc that has an angle, given as a part of a full turn; the single angle where there is one. */
static uint32_t arc_with(const struct layers *l, double part) {
    const double at = part * (l->outer ? l->arcs / 2 : l->arcs);
    const uint32_t arc = (uint32_t)at;
    return l->outer ? 2 * arc + (at > arc) : arc;
}

static pir_status add_sums(struct layers *l, uint32_t arc) {
    const pir_plan_pieces *robot = l->question->robot;
    const double ends[2] = {angle_at(l, arc), angle_at(l, arc + 1)};
    const pir_plan_turns turn = {{turn_by(l, ends[0]), turn_by(l, ends[1])}, ends[0] < ends[1] ? 2 : 1};
    pir_plan_pieces *turned = &l->turned[arc];
    pir_status status = pir_plan_pieces_over(robot, &turn, l->outer, turned);
    const pir_quat none = {0, 0, 0, 1};
    if (status == PIR_OK && turned->count > 0)
        status = pir_plan_sums_make(&l->space, turned, l->question->obstacles, none, &l->sums[arc]);
    return status;
}

static pir_status add_arc(struct layers *l, uint32_t arc) {
    pir_plan_tree *tree = &l->tree[arc];
    pir_plan_joints joints = {.without_doors = !l->outer};
    pir_status status = add_sums(l, arc);
    if (status != PIR_OK)
        return status;
    for (int k = 0; k < 3; k++) {
        tree->low[k] = l->question->low[k];
        tree->high[k] = l->question->high[k];
    }
    if (l->parts >= l->question->most_parts)
        return PIR_PLAN_ERR_PARTS;
    pir_plan_divide(&l->cutter, &l->sums[arc], l->question->most_parts - l->parts, tree);
    l->parts += tree->node_count;
    if (l->space.status == PIR_OK)
        pir_plan_join(&l->cutter, tree, &joints);
    const uint32_t first = l->first[arc], end = first + tree->cell_count;
    l->first[arc + 1] = end;
    if (pir_plan_grow(&l->space, (void **)&l->root, &l->root_room, end, sizeof *l->root)) {
        for (uint32_t i = first; i < end; i++)
            l->root[i] = i;
        for (uint32_t i = 0; i < joints.count && l->space.status == PIR_OK; i++)
            add_link(l, first + joints.joint[i].cell[0], first + joints.joint[i].cell[1], joints.joint[i].door);
    }
    pir_plan_joints_finish(&l->space, &joints);
    return l->space.status;
}

static bool is_free(struct layers *l, uint32_t arc, uint32_t point) {
    return pir_plan_sums_at(&l->space, &l->sums[arc], point, false) == PIR_PLAN_NONE;
}

/* Joins two cells of successive arcs: of outer pieces where a point in both is free. */
static void join_across(struct layers *l, uint32_t a, uint32_t i, uint32_t b, uint32_t k) {
    const pir_plan_cell *own = &l->tree[a].cell[i], *other = &l->tree[b].cell[k];
    const uint32_t left = l->first[a] + i, right = l->first[b] + k;
    if (root_of(l, left) == root_of(l, right) || !pir_plan_boxes_meet(own->low, own->high, other->low, other->high))
        return;
    pir_plan_cell common;
    pir_plan_cell_common(&l->cutter, own, other, &common);
    if (l->space.status == PIR_OK && common.points >= (l->outer ? 4u : 1u)) {
        const uint32_t door = l->outer ? pir_plan_point_mean(&l->space, common.point, common.points) : PIR_PLAN_NONE;
        if (!l->outer || (is_free(l, a, door) && is_free(l, b, door)))
            add_link(l, left, right, door);
    }
    pir_plan_cell_free(&l->space, &common);
}

static pir_status join_arcs(struct layers *l) {
    for (uint32_t a = 0; a < l->arcs; a++) {
        const uint32_t b = (a + 1) % l->arcs;
        for (uint32_t i = 0; i < l->tree[a].cell_count; i++)
            for (uint32_t k = 0; k < l->tree[b].cell_count && l->space.status == PIR_OK; k++)
                join_across(l, a, i, b, k);
    }
    return l->space.status;
}

/* A cell that has an end; PIR_PLAN_NONE where pieces of this division meet there. */
static uint32_t cell_at(struct layers *l, uint32_t arc, uint32_t point) {
    if (!is_free(l, arc, point))
        return PIR_PLAN_NONE;
    for (uint32_t i = 0; i < l->tree[arc].cell_count; i++)
        if (pir_plan_cell_has(&l->space, &l->tree[arc].cell[i], point))
            return l->first[arc] + i;
    return PIR_PLAN_NONE;
}

static uint32_t arc_of(const struct layers *l, uint32_t cell) {
    uint32_t arc = 0;
    while (l->first[arc + 1] <= cell)
        arc++;
    return arc;
}

/* By which link each cell is reached from another, over the forest of links. */
static uint32_t *reach(struct layers *l, uint32_t from, uint32_t to) {
    const uint32_t count = l->first[l->arcs];
    uint32_t *by = malloc(count * sizeof *by);
    for (uint32_t i = 0; by && i < count; i++)
        by[i] = PIR_PLAN_NONE;
    for (bool changed = true; by && changed && by[to] == PIR_PLAN_NONE;) {
        changed = false;
        for (uint32_t i = 0; i < l->links; i++)
            for (int s = 0; s < 2; s++) {
                const uint32_t a = l->link[i].cell[s], b = l->link[i].cell[1 - s];
                if ((a == from || by[a] != PIR_PLAN_NONE) && b != from && by[b] == PIR_PLAN_NONE) {
                    by[b] = i;
                    changed = true;
                }
            }
    }
    return by;
}

/* A step to a rounded point within an arc, from the step before; false where it is not free. */
static bool add_step(struct layers *l, uint32_t point, uint32_t arc, pir_turn_result *path) {
    pir_turn_step *step = &path->step[path->steps];
    for (int k = 0; k < 3; k++)
        step->at[k] = l->space.point[point].at[k];
    step->low = angle_at(l, arc);
    step->high = angle_at(l, arc + 1);
    const uint32_t before = pir_plan_point_at(&l->space, path->steps > 0 ? step[-1].at : step->at);
    const uint32_t here = pir_plan_point_at(&l->space, step->at);
    path->steps++;
    return l->space.status == PIR_OK &&
           pir_plan_sums_along(&l->space, &l->sums[arc], before, here, false) == PIR_PLAN_NONE;
}

/* A motion within a cell: through its middle where the straight one runs along what blocks. */
static bool add_motion(struct layers *l, uint32_t cell, uint32_t point, pir_turn_result *path) {
    const uint32_t arc = arc_of(l, cell);
    if (add_step(l, point, arc, path))
        return true;
    path->steps--;
    const pir_plan_cell *own = &l->tree[arc].cell[cell - l->first[arc]];
    const uint32_t middle = pir_plan_point_mean(&l->space, own->point, own->points);
    return l->space.status == PIR_OK && add_step(l, middle, arc, path) && add_step(l, point, arc, path);
}

static pir_status make_path(struct layers *l, const uint32_t cell[2], const uint32_t end[2], pir_turn_result *ret) {
    pir_turn_result path = {.answer = PIR_TURN_PLAN_PATH, .arcs = l->arcs / 2, .parts = l->parts};
    uint32_t *by = reach(l, cell[1], cell[0]), at = cell[0];
    path.step = malloc((2 * (size_t)l->links + 4) * sizeof *path.step);
    bool good = by && path.step && add_step(l, end[0], arc_of(l, at), &path);
    while (good && at != cell[1]) {
        const struct link *link = &l->link[by[at]];
        good = add_motion(l, at, link->door, &path);
        at = link->cell[link->cell[0] == at];
    }
    good = good && add_motion(l, at, end[1], &path);
    const bool has_room = by && path.step;
    free(by);
    if (good)
        *ret = path;
    else
        free(path.step);
    return has_room ? l->space.status : PIR_ERR_MEMORY;
}

static void finish(struct layers *l) {
    for (uint32_t a = 0; a < l->arcs; a++) {
        if (l->tree)
            pir_plan_tree_finish(&l->space, &l->tree[a]);
        if (l->sums)
            pir_plan_sums_finish(&l->space, &l->sums[a]);
    }
    pir_plan_free(&l->space, l->link, l->link_room, sizeof *l->link);
    pir_plan_free(&l->space, l->root, l->root_room, sizeof *l->root);
    for (uint32_t a = 0; l->turned && a < l->arcs; a++)
        pir_plan_pieces_over_free(&l->turned[a]);
    free(l->turned);
    free(l->first);
    free(l->sums);
    free(l->tree);
    pir_plan_cutter_finish(&l->cutter);
    pir_plan_space_finish(&l->space);
}

/* --- the proof --- */

/* A member: sine and cosine of half the angle, of a part of a full turn; about 1 long, which no reader relies on. */
static void put_turn(pir_plan_writer *w, const char *name, double part) {
    const double s = part == 1 ? 0 : sin(PI * part), c = part == 1 ? -1 : cos(PI * part);
    const double turn[2] = {s, c};
    fprintf(w->file, "%s", name);
    pir_plan_put_doubles(w, turn, 2);
}

static void put_question(pir_plan_writer *w, const struct layers *l) {
    const pir_turn_question *q = l->question;
    const struct {
        const char *name;
        const double *x;
    } member[] = {{"{\"turns\": 1,\n \"axis\": ", q->axis},
                  {",\n \"low\": ", q->low},
                  {",\n \"high\": ", q->high},
                  {",\n \"from\": ", q->from},
                  {",\n \"to\": ", q->to}};
    for (int i = 0; i < 5; i++) {
        fputs(member[i].name, w->file);
        pir_plan_put_doubles(w, member[i].x, 3);
    }
    put_turn(w, ",\n \"from_turn\": ", q->from_turn);
    put_turn(w, ",\n \"to_turn\": ", q->to_turn);
    pir_plan_put_pieces(w, "robot", q->robot);
    pir_plan_put_pieces(w, "obstacles", q->obstacles);
}

static uint32_t most_corners(const struct layers *l) {
    const uint32_t own = pir_plan_most_corners(l->question->robot);
    const uint32_t other = pir_plan_most_corners(l->question->obstacles);
    uint32_t most = own > other ? own : other;
    for (uint32_t a = 0; a < l->arcs; a++) {
        const uint32_t turned = pir_plan_most_corners(&l->turned[a]);
        most = turned > most ? turned : most;
    }
    return most;
}

/* Writes that there is no path: `start` is the root of the cells that are connected with the start. */
static pir_status write_proof(struct layers *l, uint32_t start) {
    for (uint32_t i = 0; i < l->first[l->arcs]; i++)
        l->root[i] = root_of(l, i);
    pir_plan_writer w = {.file = l->question->proof, .space = &l->space, .start = start};
    w.corner = calloc(most_corners(l), sizeof *w.corner);
    if (!w.corner)
        return PIR_ERR_MEMORY;
    mpq_init(w.x);
    put_question(&w, l);
    fputs(",\n \"arcs\": [", w.file);
    for (uint32_t a = 0; a < l->arcs; a++) {
        w.sums = &l->sums[a];
        w.tree = &l->tree[a];
        w.root = l->root + l->first[a];
        put_turn(&w, a == 0 ? "\n {\"begin\": " : ",\n {\"begin\": ", a / (double)l->arcs);
        put_turn(&w, ", \"end\": ", (a + 1) / (double)l->arcs);
        pir_plan_put_pieces(&w, "inner", &l->turned[a]);
        pir_plan_put_tree(&w);
        fputs("}", w.file);
    }
    fputs("]}\n", w.file);
    mpq_clear(w.x);
    free(w.corner);
    return ferror(l->question->proof) ? PIR_ERR_FILE : PIR_OK;
}

/* Writes a path with the question, for one that holds it against pieces by itself. */
static pir_status write_path(const struct layers *l, const pir_turn_result *path) {
    FILE *const file = l->question->proof;
    pir_plan_writer w = {.file = file, .corner = calloc(most_corners(l), sizeof *w.corner)};
    if (!w.corner)
        return PIR_ERR_MEMORY;
    mpq_init(w.x);
    put_question(&w, l);
    fputs(",\n \"answer\": \"path\",\n \"path\": [", file);
    for (uint32_t i = 0; i < path->steps; i++) {
        const pir_turn_step *step = &path->step[i];
        fprintf(file, "%s\n  {\"at\": [%.17g, %.17g, %.17g], \"radians\": [%.17g, %.17g]}", i == 0 ? "" : ",",
                step->at[0], step->at[1], step->at[2], step->low, step->high);
    }
    fputs("]}\n", file);
    mpq_clear(w.x);
    free(w.corner);
    return ferror(file) ? PIR_ERR_FILE : PIR_OK;
}

/* Decides by a division whose cells are joined. */
static pir_status decide(struct layers *l, pir_turn_result *ret) {
    const pir_turn_question *q = l->question;
    const uint32_t arc[2] = {arc_with(l, q->from_turn), arc_with(l, q->to_turn)};
    const uint32_t end[2] = {pir_plan_point_at(&l->space, q->from), pir_plan_point_at(&l->space, q->to)};
    if (l->space.status != PIR_OK)
        return l->space.status;
    const uint32_t cell[2] = {cell_at(l, arc[0], end[0]), cell_at(l, arc[1], end[1])};
    if (cell[0] == PIR_PLAN_NONE || cell[1] == PIR_PLAN_NONE)
        return l->outer ? PIR_OK : PIR_ERR_ARGUMENT;
    const bool joined = root_of(l, cell[0]) == root_of(l, cell[1]);
    if (joined && l->outer) {
        const pir_status status = make_path(l, cell, end, ret);
        const bool is_written = status == PIR_OK && q->proof && ret->answer == PIR_TURN_PLAN_PATH;
        return is_written ? write_path(l, ret) : status;
    }
    if (!joined && !l->outer) {
        ret->answer = PIR_TURN_PLAN_NO_PATH;
        return q->proof ? write_proof(l, root_of(l, cell[0])) : PIR_OK;
    }
    return PIR_OK;
}

static pir_status try_layers(const pir_turn_question *question, uint32_t arcs, bool outer, pir_turn_result *ret) {
    const pir_allocator allocator = pir_allocator_or_default(NULL);
    struct layers l = {.question = question, .outer = outer, .arcs = outer ? 2 * arcs : arcs};
    pir_plan_space_init(&l.space, &allocator, question->memory);
    l.cutter.space = &l.space;
    l.turned = calloc(l.arcs, sizeof *l.turned);
    l.sums = calloc(l.arcs, sizeof *l.sums);
    l.tree = calloc(l.arcs, sizeof *l.tree);
    l.first = calloc((size_t)l.arcs + 1, sizeof *l.first);
    pir_status status = l.turned && l.sums && l.tree && l.first ? l.space.status : PIR_ERR_MEMORY;
    for (uint32_t a = 0; a < l.arcs && status == PIR_OK; a++)
        status = add_arc(&l, a);
    if (status == PIR_OK)
        status = join_arcs(&l);
    ret->arcs = arcs;
    ret->parts = l.parts;
    if (status == PIR_OK)
        status = decide(&l, ret);
    finish(&l);
    return status;
}

pir_status pir_plan_turn(const pir_turn_question *question, pir_turn_result *ret_result) {
    *ret_result = (pir_turn_result){0};
    for (uint32_t arcs = 8; arcs <= question->most_arcs; arcs *= 2)
        for (int outer = 0; outer < 2; outer++) {
            const pir_status status = try_layers(question, arcs, outer, ret_result);
            const pir_plan_end limit = status == PIR_PLAN_ERR_PARTS ? PIR_PLAN_END_PARTS : PIR_PLAN_END_MEMORY;
            const bool is_limited = status == PIR_PLAN_ERR_PARTS || status == PIR_ERR_LIMIT;
            ret_result->end = is_limited ? limit : PIR_PLAN_END_DECIDED;
            if (is_limited && outer)
                continue; // a robot that is too thin for outer pieces, too
            if (status != PIR_OK || ret_result->answer != PIR_TURN_PLAN_UNKNOWN)
                return is_limited ? PIR_OK : status;
        }
    // more arcs may decide
    ret_result->end = PIR_PLAN_END_BOXES;
    return PIR_OK;
}
