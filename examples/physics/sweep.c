/* SPDX-License-Identifier: MIT */
/*
 * Moves; see sweep.h. Slow bodies go first, all at once: two of them that are no contact are too far apart to meet.
 * Fast ones follow. One that is stopped by another fast one waits until that has moved, as long as some still can.
 */
#include "sweep.h"

#include <stdlib.h>

/* How often bodies that wait try again, and how often a way is made shorter before it is given up. */
#define ROUNDS_MOST 2
#define TRIES_MOST  4
/* Categories of bodies in the scenes of casts. */
#define SOLIDS   1u
#define SURFACES 2u
/* In a mask: of the scene of cores. */
#define CORES 4u
/* A core is held by nothing but what is in it. */
#define HELD_LEAST 1e-9

pir_status sweep_init(struct sweep *sweep) {
    *sweep = (struct sweep){0};
    pir_scene_options options = pir_scene_options_default();
    options.detail = PIR_SCENE_STATES;
    pir_status status = pir_scene_create(&options, &sweep->scene);
    return status == PIR_OK ? pir_scene_create(&options, &sweep->cores) : status;
}

void sweep_finish(struct sweep *sweep) {
    pir_scene_destroy(sweep->scene);
    pir_scene_destroy(sweep->cores);
    free(sweep->pending);
    free(sweep->moves);
    *sweep = (struct sweep){0};
}

static pir_status reserve(struct sweep *sweep, uint32_t count) {
    if (count <= sweep->room)
        return PIR_OK;
    uint32_t room = 2 * count + 64;
    uint32_t *pending = realloc(sweep->pending, room * sizeof *pending);
    sweep->pending = pending ? pending : sweep->pending;
    pir_scene_move *moves = realloc(sweep->moves, room * sizeof *moves);
    sweep->moves = moves ? moves : sweep->moves;
    if (!pending || !moves)
        return PIR_ERR_MEMORY;
    sweep->room = room;
    return PIR_OK;
}

/* Such bodies do not meet each other, so that a scene keeps no pairs: casts alone see those that have a category. */
static pir_status add(pir_scene *scene, const struct body *body, pir_polytope *const *pieces, uint32_t category) {
    const struct world_shape *shape = body->shape;
    pir_body_options options = pir_body_options_default();
    options.kind = PIR_BODY_KINEMATIC;
    options.pose = body->pose;
    options.pieces = pieces;
    options.piece_count = shape->count;
    options.mesh = shape->mesh;
    options.field = shape->field;
    options.category = category;
    uint32_t number;
    return pir_scene_add(scene, &options, &number);
}

pir_status sweep_add(struct sweep *sweep, const struct body *body, uint32_t number) {
    const struct world_shape *shape = body->shape;
    pir_status status = reserve(sweep, number + 1);
    const bool surface = world_shape_is_surface(shape);
    const uint32_t category = body->sensor ? 0 : surface ? SURFACES : SOLIDS;
    if (status == PIR_OK)
        status = add(sweep->scene, body, shape->piece, category);
    // a surface has no core
    return status == PIR_OK ? add(sweep->cores, body, shape->core[WORLD_CORES - 1], category & SOLIDS) : status;
}

static pir_status update(const struct sweep *sweep, const pir_scene_move *moves, size_t count) {
    pir_status status = pir_scene_update(sweep->scene, moves, count);
    return status == PIR_OK ? pir_scene_update(sweep->cores, moves, count) : status;
}

/* --- one body --- */

/* The body as it begins the step, with what the impulses of the step have done: half of its gravity is in them. */
static struct motion_state state_of(const struct body *body, const struct sweep_rules *rules) {
    pir_vec3 half = vec_times(0.5 * rules->step, rules->gravity);
    return (struct motion_state){body->pose, vec_less(body->velocity, half), body->spin};
}

static void set_state(struct body *body, const struct motion_state *state) {
    body->pose = state->pose;
    body->velocity = state->velocity;
    body->spin = state->spin;
}

static struct motion_law law_of(const struct body *body, const struct sweep_rules *rules) {
    return (struct motion_law){&body->inertia, &body->inverse_inertia, rules->gravity};
}

/* Works off overlap: a short way, which is looked at by nothing, for it leads out of what is in the way. */
static void push(struct motion_state *state, const struct body *body, double step) {
    state->pose = pir_pose_integrate(state->pose, body->push, body->push_spin, step);
}

/* No point of the body goes farther than this in a step. */
static double reach_of_step(const struct body *body, double step) {
    return step * (vec_length(body->velocity) + body->radius * vec_length(body->spin));
}

static bool is_fast(const struct body *body, const struct sweep_rules *rules) {
    return body->flies || reach_of_step(body, rules->step) > 0.5 * rules->margin;
}

/* A body on its way through a step. */
struct trip {
    const struct sweep *sweep;
    const struct body *body;
    uint32_t number;
    const struct sweep_rules *rules;
    struct motion_state state; /* where it is by now */
    uint32_t stopper;          /* what has stopped it, or PIR_SCENE_NONE */
    bool guards;               /* its cores */
};

/* The first thing in the way of a piece, or of its core, of the categories in a mask. */
static pir_status look_along(const struct trip *trip, pir_polytope *piece, uint32_t mask, const pir_motion *way,
                             double near, pir_impact *first) {
    pir_scene *scene = mask & CORES ? trip->sweep->cores : trip->sweep->scene;
    pir_scene_shape shape = pir_scene_shape_default(piece);
    pir_impact impact;
    shape.mask = mask;
    shape.pose = trip->state.pose;
    shape.except = trip->number;
    pir_status status = pir_scene_cast(scene, &shape, way, near, &impact);
    if (status == PIR_OK && impact.body != PIR_SCENE_NONE &&
        (first->body == PIR_SCENE_NONE || impact.time < first->time))
        *first = impact;
    return status;
}

/* The first thing in the way of the body, at a distance of `near`. */
static pir_status look_ahead(const struct trip *trip, pir_motion way, double near, pir_impact *ret_first) {
    const struct world_shape *shape = trip->body->shape;
    pir_impact first = {.body = PIR_SCENE_NONE, .time = 1};
    pir_status status = PIR_OK;
    for (uint32_t i = 0; status == PIR_OK && i < shape->count; i++) {
        way.held = trip->rules->held;
        // what slides over a surface comes near edges that its contacts hold it off: its cores look for that one
        status = look_along(trip, shape->piece[i], trip->guards ? SOLIDS : SOLIDS | SURFACES, &way, near, &first);
        // what is held already, or has come into the piece, is kept out of its cores, and the piece out of its core
        way.held = HELD_LEAST;
        for (int k = 0; status == PIR_OK && k < WORLD_CORES && trip->guards; k++)
            status = look_along(trip, shape->core[k][i], SOLIDS | SURFACES, &way, near, &first);
        if (status == PIR_OK && trip->guards)
            status = look_along(trip, shape->piece[i], SOLIDS | CORES, &way, near, &first);
    }
    if (status == PIR_OK)
        *ret_first = first;
    return status;
}

/*
 * Goes on for a time, or as far as nothing is in the way. A shorter time has a way of its own, which is looked at
 * again, for something still nearer.
 */
static pir_status go(struct trip *trip, double time) {
    const struct motion_law law = law_of(trip->body, trip->rules);
    double near = trip->rules->near;
    pir_impact impact;
    for (int i = 0; i < TRIES_MOST && time > 0; i++) {
        struct motion_part part = motion_over(&trip->state, &law, time);
        pir_status status = look_ahead(trip, part.way, near, &impact);
        if (status != PIR_OK)
            return status;
        if (impact.body == PIR_SCENE_NONE) {
            trip->state = part.to;
            return PIR_OK;
        }
        trip->stopper = i == 0 ? impact.body : trip->stopper;
        // what is neared again from within the distance is told at one place, however near it may come
        time *= i == 0 ? impact.time : 0.9 * impact.time;
        near *= 0.6;
    }
    return PIR_OK;
}

/* All of the step, or until something stops it. */
static pir_status fly(struct trip *trip) {
    const double step = trip->rules->step;
    trip->state = state_of(trip->body, trip->rules);
    trip->stopper = PIR_SCENE_NONE;
    push(&trip->state, trip->body, step);
    unsigned parts = motion_parts(trip->state.spin, step);
    pir_status status = PIR_OK;
    // of several parts the first may bring it to where it is held
    trip->guards = trip->body->touches || parts > 1;
    for (unsigned i = 0; status == PIR_OK && i < parts && trip->stopper == PIR_SCENE_NONE; i++)
        status = go(trip, step / parts);
    return status;
}

/* --- all bodies --- */

/* A step of a body that nothing stops. */
static void move_freely(struct body *body, const struct sweep_rules *rules) {
    if (body->kind == PIR_BODY_KINEMATIC) {
        body->pose = pir_pose_integrate(body->pose, body->velocity, body->spin, rules->step);
        return;
    }
    struct motion_state state = state_of(body, rules);
    const struct motion_law law = law_of(body, rules);
    push(&state, body, rules->step);
    unsigned parts = motion_parts(state.spin, rules->step);
    for (unsigned i = 0; i < parts; i++)
        state = motion_over(&state, &law, rules->step / parts).to;
    set_state(body, &state);
}

/* Moves one that waited, or that nothing else waits for. */
static pir_status settle(struct sweep *sweep, struct body *body, uint32_t number, const struct motion_state *state,
                         size_t *moved) {
    pir_scene_move *move = &sweep->moves[(*moved)++];
    set_state(body, state);
    *move = (pir_scene_move){number, body->pose};
    return update(sweep, move, 1);
}

/* One look at all that wait; those that go on waiting stand at the front of `pending`. */
static pir_status try_all(struct sweep *sweep, struct body *body, const struct sweep_rules *rules, bool wait,
                          uint32_t *pending_count, size_t *moved) {
    uint32_t left = 0;
    for (uint32_t i = 0; i < *pending_count; i++) {
        uint32_t number = sweep->pending[i];
        struct trip trip = {.sweep = sweep, .body = &body[number], .number = number, .rules = rules};
        pir_status status = fly(&trip);
        if (status != PIR_OK)
            return status;
        if (wait && trip.stopper != PIR_SCENE_NONE && body[trip.stopper].waits) {
            sweep->pending[left++] = number;
            continue;
        }
        sweep->stops += trip.stopper != PIR_SCENE_NONE;
        body[number].waits = false;
        status = settle(sweep, &body[number], number, &trip.state, moved);
        if (status != PIR_OK)
            return status;
    }
    *pending_count = left;
    return PIR_OK;
}

pir_status sweep_step(struct sweep *sweep, struct body *body, uint32_t count, const struct sweep_rules *rules,
                      size_t *ret_moved) {
    size_t moved = 0;
    uint32_t pending = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!body_is_awake(&body[i]) && !body_is_driven(&body[i]))
            continue;
        body[i].waits = body_is_awake(&body[i]) && is_fast(&body[i], rules);
        if (body[i].waits) {
            sweep->pending[pending++] = i;
            continue;
        }
        move_freely(&body[i], rules);
        sweep->moves[moved++] = (pir_scene_move){i, body[i].pose};
    }
    pir_status status = update(sweep, sweep->moves, moved);
    for (int round = 0; status == PIR_OK && pending > 0; round++) {
        uint32_t before = pending;
        status = try_all(sweep, body, rules, round < ROUNDS_MOST, &pending, &moved);
        // a ring of bodies that wait for each other
        if (status == PIR_OK && pending == before)
            status = try_all(sweep, body, rules, false, &pending, &moved);
    }
    *ret_moved = moved;
    return status;
}
