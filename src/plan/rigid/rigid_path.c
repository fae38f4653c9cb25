/* SPDX-License-Identifier: MIT */
/* See rigid_path.h. */
#include "plan/rigid/rigid_path.h"

#include <stdlib.h>
#include <string.h>

#include "plan/band/band.h"
#include "plan/turn_bodies.h"
#include "plan/way.h"

/* Turns in a row from one end to the other, each with the side that is entered by it. */
struct route {
    uint32_t *by, *queue, *turn; /* by which turn each hub was reached, from the goal */
    uint32_t turns;
};

/* Turns of each hub in a row, so that hubs are reached in the order of their distance. */
static bool reach(const pir_rigid_job *job, struct route *route) {
    uint32_t *first = calloc((size_t)job->hubs + 2, sizeof *first);
    uint32_t *list = calloc(2 * (size_t)job->turns + 1, sizeof *list), done = 0, count = 0;
    if (first && list) {
        for (uint32_t i = 0; i < job->turns; i++)
            for (int s = 0; s < 2; s++)
                first[job->turn[i].hub[s] + 2]++;
        for (uint32_t h = 2; h < job->hubs + 2; h++)
            first[h] += first[h - 1];
        for (uint32_t i = 0; i < job->turns; i++)
            for (int s = 0; s < 2; s++)
                list[first[job->turn[i].hub[s] + 1]++] = i;
        memset(route->by, 0xff, job->hubs * sizeof *route->by);
        route->queue[count++] = PIR_RIGID_GOAL;
        while (done < count) {
            const uint32_t hub = route->queue[done++];
            for (uint32_t i = first[hub]; i < first[hub + 1]; i++) {
                const pir_rigid_turn *turn = &job->turn[list[i]];
                const uint32_t other = turn->hub[turn->hub[0] == hub];
                if (other == PIR_RIGID_GOAL || route->by[other] != PIR_PLAN_NONE)
                    continue;
                route->by[other] = list[i];
                route->queue[count++] = other;
            }
        }
        for (uint32_t hub = PIR_RIGID_START; hub != PIR_RIGID_GOAL && route->by[hub] != PIR_PLAN_NONE;) {
            const pir_rigid_turn *turn = &job->turn[route->by[hub]];
            route->turn[route->turns++] = route->by[hub];
            hub = turn->hub[turn->hub[0] == hub];
        }
    }
    const bool good = first && list;
    free(first);
    free(list);
    return good;
}

static bool add_step(pir_rigid_result *path, uint32_t *room, pir_quat rotation, const double at[3]) {
    const pir_pose *last = path->steps > 0 ? &path->step[path->steps - 1] : NULL;
    if (last && memcmp(&last->rotation, &rotation, sizeof rotation) == 0 && memcmp(&last->translation, at, 24) == 0)
        return true;
    if (path->steps == *room) {
        *room = 2 * *room + 16;
        pir_pose *grown = realloc(path->step, *room * sizeof *grown);
        if (!grown)
            return false;
        path->step = grown;
    }
    path->step[path->steps++] = (pir_pose){rotation, {at[0], at[1], at[2]}};
    return true;
}

/* Whether a point is one of doubles. */
static bool is_double(pir_plan_space *space, uint32_t point) {
    const pir_plan_point *p = &space->point[point];
    bool same = isfinite(p->at[0]) && isfinite(p->at[1]) && isfinite(p->at[2]);
    mpq_t x, rounded;
    mpq_inits(x, rounded, NULL);
    for (int k = 0; k < 3 && same; k++) {
        mpz_set(mpq_numref(x), p->x[k]);
        mpz_set(mpq_denref(x), p->w);
        mpq_canonicalize(x);
        mpq_set_d(rounded, p->at[k]);
        same = mpq_equal(x, rounded);
    }
    mpq_clears(x, rounded, NULL);
    return same;
}

/* Translations at the middle of a leaf, from where a path is: false where they cannot be proven in doubles. */
static bool add_motions(const pir_rigid_job *job, uint32_t leaf, const double from[3], const double to[3],
                        pir_rigid_result *path, uint32_t *room, pir_status *status) {
    const pir_quat middle = pir_rotation_box_middle(job->leaf[leaf].box);
    if (memcmp(from, to, 3 * sizeof *from) == 0) {
        *status = add_step(path, room, middle, from) ? PIR_OK : PIR_ERR_MEMORY;
        return *status == PIR_OK;
    }
    const pir_plan_turns turns = {{middle}, 1};
    pir_plan_pieces pieces;
    pir_box_division division;
    pir_plan_way way = {0};
    *status = pir_plan_pieces_over(job->question->robot, &turns, true, &pieces);
    if (*status != PIR_OK) {
        pir_plan_pieces_over_free(&pieces);
        return false;
    }
    *status = pir_box_division_make(job->question, &pieces, true, &division);
    bool good = *status == PIR_OK;
    if (good) {
        pir_plan_space *space = &division.space;
        const uint32_t end[2] = {pir_plan_point_at(space, from), pir_plan_point_at(space, to)};
        const uint32_t cell[2] = {pir_box_division_cell_at(&division, end[0]),
                                  pir_box_division_cell_at(&division, end[1])};
        good = cell[0] != PIR_PLAN_NONE && cell[1] != PIR_PLAN_NONE &&
               division.joints.root[cell[0]] == division.joints.root[cell[1]];
        if (good)
            pir_plan_way_make(&division.cutter, &division.sums, &division.tree, &division.joints, cell, end, &way);
        *status = space->status;
        good = good && *status == PIR_OK;
        for (uint32_t i = 0; i < way.count && good; i++) {
            good = is_double(space, way.point[i]);
            if (good && !add_step(path, room, middle, space->point[way.point[i]].at))
                *status = PIR_ERR_MEMORY;
            good = good && *status == PIR_OK;
        }
        pir_plan_way_finish(space, &way);
    }
    pir_box_division_finish(&division);
    pir_plan_pieces_over_free(&pieces);
    return good;
}

/* The leaf that is entered by a turn of the route, from a hub; the hub is then the one that is entered. */
static uint32_t enter(const pir_rigid_turn *turn, uint32_t *hub) {
    const int side = turn->hub[0] == *hub;
    *hub = turn->hub[side];
    return turn->leaf[side];
}

pir_status pir_rigid_path_make(const pir_rigid_job *job, pir_rigid_result *result) {
    struct route route = {calloc(job->hubs, sizeof *route.by), calloc(job->hubs, sizeof *route.queue),
                          calloc(job->hubs, sizeof *route.turn), 0};
    pir_rigid_result path = *result;
    uint32_t room = 0, hub = PIR_RIGID_START;
    const pir_quat *end = job->question->rotation;
    pir_status status = route.by && route.queue && route.turn && reach(job, &route) ? PIR_OK : PIR_ERR_MEMORY;
    path.answer = PIR_TURN_PLAN_PATH;
    bool good = status == PIR_OK && route.turns >= 2 && add_step(&path, &room, end[0], job->question->at[0]);
    for (uint32_t i = 0; i + 1 < route.turns && good; i++) {
        const uint32_t leaf = enter(&job->turn[route.turn[i]], &hub);
        good =
            add_motions(job, leaf, job->turn[route.turn[i]].at, job->turn[route.turn[i + 1]].at, &path, &room, &status);
    }
    good = good && add_step(&path, &room, end[1], job->question->at[1]);
    if (good)
        *result = path;
    else
        free(path.step);
    free(route.by);
    free(route.queue);
    free(route.turn);
    return status;
}

/* --- ways that are pushed, and trees --- */

/*
 * Distances that ways may ask for, and as many that trees may; how many ways there are, are pushed before the best are
 * tried, are tried then.
 */
#define WORK  ((uint64_t)3 << 20)
#define WAYS  48
#define FIRST 8
#define TRIES 4

static pir_vec3 point_of(const double x[3]) {
    return (pir_vec3){x[0], x[1], x[2]};
}

/* The 24 rotations of a cube, of which many bodies are made. */
static pir_quat cube_rotation(uint32_t number) {
    for (int i = 0;; i++) {
        const int q[4] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1, i / 27 % 3 - 1};
        const int size = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        const int last = q[3] ? q[3] : q[2] ? q[2] : q[1] ? q[1] : q[0];
        if (last > 0 && size != 3 && number-- == 0)
            return (pir_quat){q[0], q[1], q[2], q[3]};
    }
}

/* Adds a way that turns, goes straight, and turns again: at a rotation of a cube, or the middle of a small box. */
static pir_status add_way(const pir_rigid_question *question, pir_band *band, uint32_t number, uint64_t *work,
                          double *ret_room) {
    const uint32_t of = number / 2;
    // all charts soon have their turn
    const pir_rotation_box root = pir_rotation_box_root(of * 13 % PIR_ROTATION_ROOTS);
    const pir_quat middle = number % 2 == 0 ? cube_rotation(of * 7 % 24)
                                            : pir_rotation_box_middle(pir_rotation_box_child(root, of * 3 % 8));
    const pir_vec3 from = point_of(question->at[0]), to = point_of(question->at[1]);
    const pir_pose way[4] = {{question->rotation[0], from}, {middle, from}, {middle, to}, {question->rotation[1], to}};
    return pir_band_add(band, way, 4, work, ret_room);
}

static bool is_to_go_on(const pir_rigid_question *question) {
    return !question->progress || question->progress(question->context, 0, 0);
}

/* Trees and ways are given distances alike; what is left of them for each, and the path. */
struct push {
    pir_band *band;
    uint64_t work[2];
    pir_pose *step;
    uint32_t steps;
};

/* Pushes the best ways at finer spacings. */
static pir_status try_ways(const pir_rigid_question *question, struct push *push, bool *goes_on) {
    pir_status status = PIR_OK;
    for (int k = 0; k < TRIES && status == PIR_OK && *goes_on && !push->step; k++) {
        status = pir_band_try(push->band, &push->work[0], &push->step, &push->steps);
        *goes_on = is_to_go_on(question);
    }
    return status == PIR_ERR_EMPTY ? PIR_OK : status;
}

/* Lets trees grow until they have asked for as many distances as the ways have. */
static pir_status grow_trees(const pir_rigid_question *question, struct push *push, bool *goes_on) {
    const pir_pose end[2] = {{question->rotation[0], point_of(question->at[0])},
                             {question->rotation[1], point_of(question->at[1])}};
    if (push->work[1] <= push->work[0])
        return PIR_OK;
    uint64_t left = push->work[1] - push->work[0];
    const pir_status status = pir_band_grow(push->band, end, &left, &push->step, &push->steps);
    push->work[1] = push->work[0] + left;
    *goes_on = is_to_go_on(question);
    return status == PIR_ERR_EMPTY ? PIR_OK : status;
}

/* Pushes ways and grows trees; what cannot be asked or found is left to boxes. */
static pir_status push_ways(const pir_rigid_question *question, pir_pose **ret_step, uint32_t *ret_steps) {
    const pir_band_question bodies = {question->robot, question->obstacles, question->wide, question->low,
                                      question->high};
    struct push push = {.work = {WORK, WORK}};
    double most = -INFINITY, room;
    bool goes_on = true;
    pir_status status = pir_band_create(&bodies, &push.band);
    for (uint32_t i = 0; i < WAYS && status == PIR_OK && goes_on && !push.step && push.work[0] > 0; i++) {
        status = add_way(question, push.band, i, &push.work[0], &room);
        most = fmax(most, room);
        goes_on = is_to_go_on(question);
        if (status != PIR_OK || ((i + 1) % FIRST != 0 && push.work[0] > 0))
            continue;
        // where none nearly fits, others will hardly do
        if (most <= -1)
            break;
        status = try_ways(question, &push, &goes_on);
        if (status == PIR_OK && goes_on && !push.step)
            status = grow_trees(question, &push, &goes_on);
    }
    pir_band_destroy(push.band);
    *ret_step = push.step;
    *ret_steps = push.steps;
    if (!push.step && !goes_on)
        return PIR_PLAN_ERR_CALLER;
    return status == PIR_ERR_MEMORY ? status : PIR_OK;
}

/* Gives all processes the path of the first one, or what it ended with. */
static pir_status share_path(const pir_plan_ranks *ranks, pir_status status, pir_pose **step, uint32_t *steps) {
    const unsigned char failed = (unsigned char)status;
    const void *own = status == PIR_OK ? (const void *)*step : &failed;
    const size_t size = ranks->number > 0 ? 0 : status == PIR_OK ? *steps * sizeof **step : sizeof failed;
    void *all = NULL;
    size_t got = 0;
    if (!ranks->exchange(ranks->context, own, size, &all, &got))
        return PIR_ERR_MEMORY;
    if (got == sizeof failed)
        return (pir_status) * (const unsigned char *)all;
    if (ranks->number == 0 || got == 0)
        return status;
    *steps = (uint32_t)(got / sizeof **step);
    *step = malloc(got);
    if (!*step)
        return PIR_ERR_MEMORY;
    memcpy(*step, all, got);
    return PIR_OK;
}

pir_status pir_rigid_path_push(const pir_rigid_question *question, const pir_plan_ranks *ranks,
                               pir_rigid_result *result) {
    pir_pose *step = NULL;
    uint32_t steps = 0;
    pir_status status = PIR_OK;
    if (!ranks || ranks->number == 0)
        status = push_ways(question, &step, &steps);
    if (ranks)
        status = share_path(ranks, status, &step, &steps);
    if (status != PIR_OK) {
        free(step);
    } else if (step) {
        result->answer = PIR_TURN_PLAN_PATH;
        result->step = step;
        result->steps = steps;
    }
    return status;
}
