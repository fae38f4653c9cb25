/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a scene: bodies come, go and move, and now and then the scene goes back to an earlier snapshot. After
 * each update the events are compared with all pairs of pieces, each asked by a pair made for it, and with those of a
 * scene that has been restored from the snapshot before.
 *
 * See fuzz_sum.c for how to run an engine.
 */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/scene.h>
#include <pirouette/scene_file.h>

#include "fuzz/input.h"

#define BODIES 6
#define PIECES 2
#define POINTS 6
#define STEPS  10
#define GONE   (BODIES * BODIES * PIECES * PIECES * STEPS)

struct body {
    bool used, fresh, moved;
    uint32_t id, stale; /* the scene's; one that it had before, or PIR_SCENE_NONE */
    pir_body_options options;
    pir_polytope *piece[PIECES];
};

/* The end of a contact: ids of bodies, numbers of pieces. */
struct end {
    uint32_t of[4];
};

struct world {
    pir_scene *scene;
    pir_workspace *workspace;
    struct body body[BODIES]; /* by the scene's numbers */
    double margin;
    bool touching[BODIES][BODIES][PIECES][PIECES];
    struct end gone[GONE]; /* contacts that ended since the last update */
    uint32_t gone_count;
};

/* A place on a coarse grid, so that bodies meet, or any. */
static pir_vec3 next_place(struct fuzz_input *input) {
    bool any = fuzz_byte(input) % 8 == 0;
    double at[3];
    for (int k = 0; k < 3; k++)
        at[k] = any ? fuzz_double(input) : fuzz_small(input) / 32.0;
    return (pir_vec3){at[0], at[1], at[2]};
}

static void add_body(struct world *world, struct fuzz_input *input) {
    struct body made = {.used = true, .fresh = true, .options = pir_body_options_default()};
    uint8_t form = fuzz_byte(input);
    uint32_t id = 0;
    made.options.kind = (pir_body_kind)(form % 8 < 3 ? form % 8 : 0);
    made.options.sensor = form / 8 % 8 == 0;
    made.options.piece_count = 1 + form / 64 % PIECES;
    for (uint32_t i = 0; i < made.options.piece_count; i++)
        made.piece[i] = fuzz_body(input, POINTS);
    made.options.pieces = made.piece;
    made.options.pose.translation = next_place(input);
    made.options.pose.rotation = fuzz_rotation(input, made.options.pose.rotation);
    pir_status status = pir_scene_add(world->scene, &made.options, &id);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "a body is added, or is too far away");
    if (status == PIR_OK) {
        const uint32_t number = pir_body_number(id);
        fuzz_require(number < BODIES && !world->body[number].used, "a body has the least number that is free");
        made.id = id;
        made.stale = world->body[number].stale;
        fuzz_require(id != made.stale && pir_scene_has(world->scene, id), "an id is new");
        world->body[number] = made;
        world->body[number].options.pieces = world->body[number].piece;
        return;
    }
    for (uint32_t i = 0; i < made.options.piece_count; i++)
        pir_polytope_release(made.piece[i]);
}

static bool may_meet(const struct body *a, const struct body *b);

/* Two bodies' contacts end, which the next update tells. */
static void end_contacts(struct world *world, uint32_t a, uint32_t b) {
    const uint32_t p = a < b ? a : b, q = a < b ? b : a;
    for (uint32_t i = 0; i < PIECES; i++)
        for (uint32_t k = 0; k < PIECES; k++) {
            if (world->touching[p][q][i][k])
                world->gone[world->gone_count++] = (struct end){{world->body[p].id, world->body[q].id, i, k}};
            world->touching[p][q][i][k] = false;
        }
}

/* Changes what a body is told by; what it does not meet any more ends. */
static void change_body(struct world *world, uint32_t id, uint8_t how) {
    struct body *body = &world->body[id];
    const uint32_t named = body->used ? body->id : body->stale;
    const pir_status right = body->used ? PIR_OK : PIR_ERR_ARGUMENT;
    if (how % 2) {
        body->options.disabled = !body->options.disabled;
        fuzz_require(pir_scene_set_disabled(world->scene, named, body->options.disabled) == right,
                     "a body is disabled");
    } else {
        body->options.sensor = !body->options.sensor;
        fuzz_require(pir_scene_set_sensor(world->scene, named, body->options.sensor) == right, "a body is a sensor");
    }
    if (!body->used)
        return;
    body->fresh = true;
    for (uint32_t other = 0; other < BODIES; other++)
        if (other != id && !may_meet(body, &world->body[other]))
            end_contacts(world, id, other);
}

static void remove_body(struct world *world, uint32_t id) {
    struct body *body = &world->body[id];
    const uint32_t named = body->used ? body->id : body->stale;
    fuzz_require(pir_scene_remove(world->scene, named) == (body->used ? PIR_OK : PIR_ERR_ARGUMENT),
                 "a body is removed");
    fuzz_require(!pir_scene_has(world->scene, named), "an id of a body that was removed is refused");
    body->stale = named;
    for (uint32_t other = 0; other < BODIES; other++)
        if (other != id)
            end_contacts(world, id, other);
    for (uint32_t i = 0; body->used && i < body->options.piece_count; i++)
        pir_polytope_release(body->piece[i]);
    body->used = false;
}

static bool may_meet(const struct body *a, const struct body *b) {
    const pir_body_options *p = &a->options, *q = &b->options;
    const bool moves = p->kind == PIR_BODY_MOVING || q->kind == PIR_BODY_MOVING;
    const bool is_sensed = (p->sensor && q->kind == PIR_BODY_KINEMATIC) || (q->sensor && p->kind == PIR_BODY_KINEMATIC);
    return a->used && b->used && !p->disabled && !q->disabled && (moves || is_sensed) && !(p->sensor && q->sensor);
}

/* Whether two pieces are in contact, by a pair made for the question. */
static bool in_contact(const struct world *world, const struct body *a, const struct body *b, const uint32_t piece[2],
                       pir_query_result *ret_result) {
    pir_pair *pair = NULL;
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = a->options.pose;
    input.pose_q = b->options.pose;
    input.margin = world->margin;
    pir_status status = pir_pair_create(a->piece[piece[0]], b->piece[piece[1]], NULL, &pair);
    if (status == PIR_OK)
        status = pir_pair_signed_distance(pair, world->workspace, &input, ret_result);
    pir_pair_destroy(pair);
    // a scene does not ask of pieces whose boxes are apart, such as tiny ones far from each other
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "a distance of two bodies that a scene has taken");
    if (status != PIR_OK)
        return false;
    bool sensor = a->options.sensor || b->options.sensor;
    return ret_result->state != PIR_OUTSIDE || (!sensor && world->margin > 0 && ret_result->distance <= world->margin);
}

static void check_event(const pir_scene_event *event, pir_event_kind kind, const pir_query_result *right) {
    fuzz_require(event->kind == kind, "an event tells what happened");
    if (kind == PIR_EVENT_ENDED)
        return;
    fuzz_require(event->state == right->state, "an event tells the state");
    fuzz_require(event->sensor || memcmp(&event->distance, &right->distance, sizeof(double)) == 0,
                 "an event tells the distance of a pair");
}

/* Whether an event tells the end of a contact of a body that was removed or changed: then it is counted off. */
static bool is_gone(struct world *world, const pir_scene_event *event) {
    const uint32_t of[4] = {event->body_p, event->body_q, event->piece_p, event->piece_q};
    for (uint32_t i = 0; event->kind == PIR_EVENT_ENDED && i < world->gone_count; i++)
        if (memcmp(of, world->gone[i].of, sizeof of) == 0) {
            world->gone[i] = world->gone[--world->gone_count];
            return true;
        }
    return false;
}

/* Compares the events with those that all pairs of pieces should have. */
static void check_events(struct world *world) {
    size_t count = 0, next = 0;
    const pir_scene_event *events = pir_scene_events(world->scene, &count);
    fuzz_require(pir_scene_is_valid(world->scene), "the scene is valid");
    for (uint32_t a = 0; a < BODIES; a++)
        for (uint32_t b = a + 1; b < BODIES; b++) {
            const struct body *p = &world->body[a], *q = &world->body[b];
            if (!may_meet(p, q) || !(p->fresh || q->fresh || p->moved || q->moved))
                continue;
            for (uint32_t i = 0; i < p->options.piece_count; i++)
                for (uint32_t k = 0; k < q->options.piece_count; k++) {
                    pir_query_result right = {0};
                    bool *before = &world->touching[a][b][i][k], was = *before;
                    bool is = in_contact(world, p, q, (const uint32_t[2]){i, k}, &right);
                    *before = is;
                    if (!is && !was)
                        continue;
                    while (next < count && is_gone(world, &events[next]))
                        next++;
                    fuzz_require(next < count, "all contacts have events");
                    const pir_scene_event *event = &events[next++];
                    fuzz_require(event->body_p == p->id && event->body_q == q->id && event->piece_p == i &&
                                     event->piece_q == k,
                                 "events are in the order of their bodies");
                    check_event(event, !is ? PIR_EVENT_ENDED : was ? PIR_EVENT_PERSISTED : PIR_EVENT_BEGAN, &right);
                }
        }
    while (next < count && is_gone(world, &events[next]))
        next++;
    fuzz_require(next == count && world->gone_count == 0, "no other events");
    for (uint32_t a = 0; a < BODIES; a++)
        world->body[a].fresh = world->body[a].moved = false;
}

/* Moves some of the bodies. Where the update is refused nothing has changed. */
static void update(struct world *world, struct fuzz_input *input) {
    pir_scene_move move[BODIES];
    size_t count = 0;
    uint8_t which = fuzz_byte(input);
    for (uint32_t a = 0; a < BODIES; a++) {
        const struct body *body = &world->body[a];
        if (!(which >> a & 1) || !body->used || body->options.kind == PIR_BODY_STATIC)
            continue;
        pir_pose pose = {fuzz_rotation(input, body->options.pose.rotation), next_place(input)};
        move[count++] = (pir_scene_move){body->id, pose};
    }
    pir_status status = pir_scene_update(world->scene, move, count);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, "an update, or bodies too far away");
    if (status != PIR_OK) {
        fuzz_require(pir_scene_is_valid(world->scene), "a scene that refused an update is as it was");
        return;
    }
    for (size_t i = 0; i < count; i++) {
        world->body[pir_body_number(move[i].body)].options.pose = move[i].pose;
        world->body[pir_body_number(move[i].body)].moved = true;
    }
    check_events(world);
}

/* A snapshot restored into the scene that it was taken of is the same snapshot. */
static void check_snapshot(struct world *world, struct fuzz_input *input) {
    size_t size = pir_scene_serialised_size(world->scene);
    uint8_t *first = malloc(size), *second = malloc(size);
    fuzz_require(first && second, "memory for snapshots");
    fuzz_require(pir_scene_serialise(world->scene, first, size) == PIR_OK, "a snapshot");
    fuzz_require(pir_scene_restore(world->scene, first, size, NULL) == PIR_OK, "a scene is restored");
    fuzz_require(pir_scene_serialised_size(world->scene) == size, "a restored scene has a snapshot of the same size");
    fuzz_require(pir_scene_serialise(world->scene, second, size) == PIR_OK, "a snapshot once more");
    fuzz_require(memcmp(first, second, size) == 0, "a restored scene has the same snapshot");
    // bytes that are not trusted
    second[fuzz_byte(input) % size] ^= (uint8_t)(1 + fuzz_byte(input) % 255);
    fuzz_require(pir_scene_restore(world->scene, second, size, NULL) == PIR_ERR_FORMAT ||
                     memcmp(first, second, size) == 0 || pir_scene_is_valid(world->scene),
                 "a changed snapshot is refused");
    fuzz_require(pir_scene_restore(world->scene, first, size, NULL) == PIR_OK, "and the scene goes on");
    free(second);
    free(first);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct fuzz_input input = {data, size, 0};
    struct world world = {0};
    pir_scene_options options = pir_scene_options_default();
    options.margin = world.margin = fuzz_byte(&input) % 2 ? 0.125 : 0;
    fuzz_require(pir_scene_create(&options, &world.scene) == PIR_OK, "a scene");
    fuzz_require(pir_workspace_create(NULL, &world.workspace) == PIR_OK, "a workspace");
    for (uint32_t a = 0; a < BODIES; a++)
        world.body[a].stale = PIR_SCENE_NONE;
    for (int step = 0; step < STEPS && input.at < input.size; step++) {
        uint8_t form = fuzz_byte(&input);
        uint32_t bodies = pir_scene_get_statistics(world.scene).bodies;
        if (form % 4 < 2 && bodies < BODIES)
            add_body(&world, &input);
        else if (form % 16 == 3)
            remove_body(&world, fuzz_byte(&input) % BODIES);
        else if (form % 16 == 11)
            change_body(&world, fuzz_byte(&input) % BODIES, form / 16);
        else if (form % 16 == 7)
            check_snapshot(&world, &input);
        else
            update(&world, &input);
    }
    update(&world, &input);
    pir_scene_destroy(world.scene);
    pir_workspace_destroy(world.workspace);
    for (uint32_t a = 0; a < BODIES; a++)
        for (uint32_t i = 0; world.body[a].used && i < world.body[a].options.piece_count; i++)
            pir_polytope_release(world.body[a].piece[i]);
    return 0;
}
