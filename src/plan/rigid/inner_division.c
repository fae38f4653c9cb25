/* SPDX-License-Identifier: MIT */
/* See inner_division.h. */
#include "plan/rigid/inner_division.h"

#include <stdlib.h>
#include <string.h>

#include "plan/rigid/inner_sums.h"

/* Into how many parts a piece of a way is divided for points that are looked at. */
#define STEPS 8

/* How many points about a deepest one are looked at. */
#define NEARS 48

struct sum_choice {
    const pir_rigid_question *question;
    bool is_thick; /* whether all sums are made */
    pir_inner_search *search;
    pir_plan_pieces *sums;
    pir_box_division *division;
    bool *used; /* per pair */
    uint32_t pairs, best;
    double depth, deepest[3];
    double size;       /* of the robot */
    double (*near)[3]; /* points about the deepest ones of all ways */
    uint32_t nears, room;
};

static double size_of(const pir_plan_pieces *robot) {
    double size = 0;
    for (uint32_t k = 0; k < robot->count; k++) {
        pir_vec3 low, high;
        pir_polytope_bounds(robot->at[k], &low, &high);
        size = fmax(size, fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z)));
    }
    return size;
}

static void mean_of(const pir_box_division *division, uint32_t cell, double ret[3]) {
    const pir_plan_cell *own = &division->tree.cell[cell];
    for (int k = 0; k < 3; k++) {
        ret[k] = 0;
        for (uint32_t v = 0; v < own->points; v++)
            ret[k] += division->space.point[own->point[v]].at[k] / own->points;
    }
}

/* Looks at points between two for the pair that has one deepest. */
static void look_along(struct sum_choice *c, const double a[3], const double b[3]) {
    for (int i = 0; i <= STEPS; i++) {
        const double s = (double)i / STEPS;
        const double x[3] = {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
        for (uint32_t p = 0; p < c->pairs; p++) {
            const double depth = c->used[p] ? 0 : pir_inner_depth(c->search, p, x);
            if (depth > c->depth && pir_inner_has(c->search, p, x)) {
                c->depth = depth;
                c->best = p;
                memcpy(c->deepest, x, sizeof x);
            }
        }
    }
}

/* By which joint each cell is reached from one, or none. */
static void reach(const pir_box_division *division, uint32_t from, uint32_t *by) {
    const pir_plan_joints *joints = &division->joints;
    memset(by, 0xff, joints->cells * sizeof *by);
    // joints are a forest, and few
    for (bool more = true; more;) {
        more = false;
        for (uint32_t i = 0; i < joints->count; i++)
            for (int s = 0; s < 2; s++) {
                const uint32_t a = joints->joint[i].cell[s], b = joints->joint[i].cell[1 - s];
                if (b != from && by[b] == PIR_PLAN_NONE && (a == from || by[a] != PIR_PLAN_NONE)) {
                    by[b] = i;
                    more = true;
                }
            }
    }
}

/* Looks along the way between two cells. */
static pir_status look_at_way(struct sum_choice *c, const uint32_t cell[2]) {
    const pir_plan_joints *joints = &c->division->joints;
    pir_plan_space *space = &c->division->space;
    uint32_t *by = pir_plan_new(space, joints->cells, sizeof *by), now = cell[1];
    double last[3], next[3];
    if (!by)
        return space->status;
    c->best = PIR_PLAN_NONE;
    c->depth = 0;
    reach(c->division, cell[0], by);
    memcpy(last, c->question->at[1], sizeof last);
    for (; now != cell[0]; memcpy(last, next, sizeof last)) {
        mean_of(c->division, now, next);
        look_along(c, last, next);
        const uint32_t *of = joints->joint[by[now]].cell;
        now = of[0] == now ? of[1] : of[0];
    }
    if (cell[0] != cell[1]) {
        mean_of(c->division, now, next);
        look_along(c, last, next);
        memcpy(last, next, sizeof last);
    }
    look_along(c, last, c->question->at[0]);
    pir_plan_free(space, by, joints->cells, sizeof *by);
    return PIR_OK;
}

/* Makes the sum of a pair. */
static pir_status make_sum(struct sum_choice *c, uint32_t pair) {
    c->used[pair] = true;
    const pir_status status = pir_inner_sum_make(c->search, pair, &c->sums->at[c->sums->count]);
    if (c->sums->at[c->sums->count])
        c->sums->body[c->sums->count++] = pair;
    return status;
}

/* The free cell that has an end's translation, or none. */
static uint32_t cell_of(struct sum_choice *c, int end) {
    pir_box_division *d = c->division;
    const uint32_t point = pir_plan_point_at(&d->space, c->question->at[end]);
    for (uint32_t i = 0; i < d->tree.cell_count && d->space.status == PIR_OK; i++)
        if (pir_plan_cell_has(&d->space, &d->tree.cell[i], point))
            return i;
    return PIR_PLAN_NONE;
}

/* Adds points about the deepest one of a way: of a lattice that fills a ball. */
static bool add_near(struct sum_choice *c) {
    if (!pir_plan_grow(&c->division->space, (void **)&c->near, &c->room, c->nears + NEARS, sizeof *c->near))
        return false;
    for (int i = 0; i < NEARS; i++) {
        // the fractional parts of multiples of roots of x^4 = x + 1 are even in the cube
        const double part[3] = {fmod((i + 1) * 0.8191725134, 1), fmod((i + 1) * 0.6710436067, 1),
                                fmod((i + 1) * 0.5497004779, 1)};
        for (int k = 0; k < 3; k++)
            c->near[c->nears][k] = c->deepest[k] + c->size * (part[k] - 0.5);
        c->nears++;
    }
    return true;
}

/* Whether a translation is in a sum. */
static bool is_blocked(const struct sum_choice *c, const double x[3]) {
    for (uint32_t i = 0; i < c->sums->count; i++) {
        const pir_polytope *made = c->sums->at[i];
        bool has = true;
        for (uint32_t f = 0; f < pir_polytope_facet_count(made) && has; f++) {
            uint32_t corner[PIR_INNER_CORNERS];
            const pir_vec3 n = pir_polytope_normal(made, f);
            pir_polytope_facet(made, f, corner);
            const pir_vec3 v = pir_polytope_vertex(made, corner[0]);
            has = n.x * (x[0] - v.x) + n.y * (x[1] - v.y) + n.z * (x[2] - v.z) <= 0;
        }
        if (has)
            return true;
    }
    return false;
}

/* Makes sums of pairs that have points near ways which no sum has yet, those of most points first. */
static pir_status thicken(struct sum_choice *c) {
    const uint32_t first = c->sums->count;
    pir_plan_space *space = &c->division->space;
    const size_t all = (size_t)c->nears * c->pairs;
    bool *has = pir_plan_new(space, all, sizeof *has);
    uint32_t *count = pir_plan_new(space, c->pairs, sizeof *count);
    pir_status status = space->status;
    for (uint32_t i = 0; i < c->nears && status == PIR_OK; i++)
        for (uint32_t p = 0; p < c->pairs && !is_blocked(c, c->near[i]); p++) {
            has[i * c->pairs + p] =
                !c->used[p] && pir_inner_depth(c->search, p, c->near[i]) > 0 && pir_inner_has(c->search, p, c->near[i]);
            count[p] += has[i * c->pairs + p];
        }
    while (status == PIR_OK) {
        uint32_t best = 0;
        for (uint32_t p = 1; p < c->pairs; p++)
            best = count[p] > count[best] ? p : best;
        if (count[best] == 0)
            break;
        status = make_sum(c, best);
        for (uint32_t i = 0; i < c->nears; i++)
            for (uint32_t p = 0; has[i * c->pairs + best] && p < c->pairs; p++) {
                if (p == best)
                    continue;
                count[p] -= has[i * c->pairs + p];
                has[i * c->pairs + p] = false;
            }
        count[best] = 0;
    }
    pir_plan_free(space, has, all, sizeof *has);
    pir_plan_free(space, count, c->pairs, sizeof *count);
    if (status == PIR_OK && c->sums->count > first)
        status = pir_box_division_add(c->question, c->sums, first, c->division);
    return status == PIR_OK ? pir_box_division_join(false, c->division) : status;
}

/* Makes the sums of all pairs. */
static pir_status add_all(struct sum_choice *c) {
    const uint32_t first = c->sums->count;
    pir_status status = PIR_OK;
    for (uint32_t p = 0; p < c->pairs && status == PIR_OK; p++)
        if (!c->used[p])
            status = make_sum(c, p);
    if (status == PIR_OK && c->sums->count > first)
        status = pir_box_division_add(c->question, c->sums, first, c->division);
    return status == PIR_OK ? pir_box_division_join(false, c->division) : status;
}

static pir_status choose(struct sum_choice *c) {
    pir_status status = pir_box_division_add(c->question, c->sums, 0, c->division);
    if (c->is_thick && status == PIR_OK)
        return add_all(c);
    while (status == PIR_OK) {
        const uint32_t first = c->sums->count;
        status = pir_box_division_join(false, c->division);
        if (status != PIR_OK)
            break;
        const uint32_t cell[2] = {cell_of(c, 0), cell_of(c, 1)};
        if (cell[0] == PIR_PLAN_NONE || cell[1] == PIR_PLAN_NONE)
            return add_all(c);
        if (c->division->joints.root[cell[0]] != c->division->joints.root[cell[1]])
            return thicken(c);
        status = look_at_way(c, cell);
        if (status != PIR_OK || c->best == PIR_PLAN_NONE)
            break;
        status = add_near(c) ? make_sum(c, c->best) : c->division->space.status;
        if (status == PIR_OK && c->sums->count > first)
            status = pir_box_division_add(c->question, c->sums, first, c->division);
    }
    return status;
}

pir_status pir_inner_division_make(const pir_rigid_question *question, const pir_plan_turns *turns, bool is_thick,
                                   pir_plan_pieces *ret_sums, pir_box_division *ret_division) {
    pir_plan_space *space = &ret_division->space;
    const uint32_t pairs = question->robot->count * question->wide->count;
    struct sum_choice c = {.question = question,
                           .is_thick = is_thick,
                           .sums = ret_sums,
                           .division = ret_division,
                           .pairs = pairs,
                           .size = size_of(question->robot)};
    *ret_sums =
        (pir_plan_pieces){.at = calloc(pairs, sizeof *ret_sums->at), .body = calloc(pairs, sizeof *ret_sums->body)};
    pir_status status = pir_box_division_open(question, ret_division);
    if (status == PIR_OK && !(ret_sums->at && ret_sums->body))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        c.used = pir_plan_new(space, pairs, sizeof *c.used);
        status = pir_inner_search_open(question, turns, space, &c.search);
    }
    if (status == PIR_OK)
        status = choose(&c);
    pir_inner_search_close(c.search);
    pir_plan_free(space, c.near, c.room, sizeof *c.near);
    pir_plan_free(space, c.used, c.used ? pairs : 0, sizeof *c.used);
    return status;
}
