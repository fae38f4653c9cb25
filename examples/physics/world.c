/* SPDX-License-Identifier: MIT */
/* The world: its bodies, and its steps. A body's number here is its number in the scene. */
#include "world.h"

#include <stdlib.h>

#include "contacts.h"
#include "sleep.h"
#include "solver.h"

struct world {
    struct world_options options;
    pir_scene *scene;
    struct body *body;
    uint32_t *group;       /* per body, for sleep_update */
    pir_scene_move *moves; /* room for all bodies */
    uint32_t count, room;
    struct contacts contacts, last; /* the present ones; memory for the next */
};

struct world_options world_options_default(void) {
    return (struct world_options){.gravity = {0, 0, -9.81},
                                  .step = 1. / 240,
                                  .margin = 0.005,
                                  .iterations = 8,
                                  .relaxations = 4,
                                  .sleep = true,
                                  .threads = 1};
}

/* --- shapes --- */

void world_shape_release(struct world_shape *shape) {
    for (uint32_t i = 0; i < shape->count; i++)
        pir_polytope_release(shape->piece[i]);
    free(shape->piece);
    *shape = (struct world_shape){0};
}

static double radius_of(const struct world_shape *shape) {
    double radius = 0;
    for (uint32_t i = 0; i < shape->count; i++)
        for (uint32_t v = 0; v < pir_polytope_vertex_count(shape->piece[i]); v++)
            radius = fmax(radius, vec_length(pir_polytope_vertex(shape->piece[i], v)));
    return radius;
}

pir_status world_shape_make(pir_polytope *const *pieces, uint32_t count, struct world_shape *ret_shape) {
    struct world_shape shape = {.piece = calloc(count + (size_t)1, sizeof *shape.piece)};
    pir_mass *mass = calloc(count + (size_t)1, sizeof *mass);
    pir_status status = shape.piece && mass ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t i = 0; status == PIR_OK && i < count; i++)
        status = pir_polytope_mass(pieces[i], &mass[i]);
    if (status == PIR_OK)
        status = pir_mass_combine(mass, count, &shape.mass);
    shape.offset = shape.mass.centroid;
    for (uint32_t i = 0; status == PIR_OK && i < count; i++) {
        status = pir_polytope_translate(pieces[i], vec_times(-1, shape.offset), &shape.piece[i]);
        shape.count += status == PIR_OK;
    }
    free(mass);
    shape.mass.centroid = (pir_vec3){0, 0, 0};
    shape.radius = radius_of(&shape);
    if (status == PIR_OK)
        *ret_shape = shape;
    else
        world_shape_release(&shape);
    return status;
}

/* --- bodies --- */

pir_status world_create(const struct world_options *options, struct world **ret_world) {
    struct world *world = calloc(1, sizeof *world);
    if (!world)
        return PIR_ERR_MEMORY;
    world->options = *options;
    pir_scene_options scene = pir_scene_options_default();
    scene.margin = options->margin;
    scene.threads = options->threads;
    pir_status status = pir_scene_create(&scene, &world->scene);
    if (status == PIR_OK)
        *ret_world = world;
    else
        free(world);
    return status;
}

void world_destroy(struct world *world) {
    if (!world)
        return;
    pir_scene_destroy(world->scene);
    contacts_clear(&world->contacts);
    contacts_clear(&world->last);
    free(world->body);
    free(world->group);
    free(world->moves);
    free(world);
}

static pir_status reserve_body(struct world *world) {
    if (world->count < world->room)
        return PIR_OK;
    uint32_t room = world->room ? 2 * world->room : 64;
    struct body *body = realloc(world->body, room * sizeof *body);
    world->body = body ? body : world->body;
    uint32_t *group = realloc(world->group, room * sizeof *group);
    world->group = group ? group : world->group;
    pir_scene_move *moves = realloc(world->moves, room * sizeof *moves);
    world->moves = moves ? moves : world->moves;
    if (!body || !group || !moves)
        return PIR_ERR_MEMORY;
    world->room = room;
    return PIR_OK;
}

/* Mass and inertia of a moving body. */
static void set_mass(struct body *to, const struct world_body *from) {
    const pir_mass *mass = &from->shape->mass;
    to->inverse_mass = 1 / (from->density * mass->volume);
    for (int i = 0; i < 3; i++) {
        const double *row = mass->inertia[i];
        to->inertia.row[i] = vec_times(from->density, (pir_vec3){row[0], row[1], row[2]});
    }
    to->inverse_inertia = mat_inverse(&to->inertia);
}

pir_status world_add(struct world *world, const struct world_body *from) {
    struct body body = {from->kind,
                        from->pose,
                        from->velocity,
                        from->spin,
                        .radius = from->shape->radius,
                        .friction = from->friction,
                        .restitution = from->restitution};
    if (body.kind == PIR_BODY_MOVING) {
        set_mass(&body, from);
        if (!(body.inverse_mass > 0 && isfinite(body.inverse_mass) && isfinite(body.inverse_inertia.row[0].x)))
            return PIR_ERR_ARGUMENT;
    }
    pir_body_options options = pir_body_options_default();
    options.kind = body.kind;
    // of length 1 from the beginning
    options.pose = body.pose = pir_pose_integrate(body.pose, body.velocity, body.spin, 0);
    options.pieces = from->shape->piece;
    options.piece_count = from->shape->count;
    uint32_t number;
    pir_status status = reserve_body(world);
    if (status == PIR_OK)
        status = pir_scene_add(world->scene, &options, &number);
    if (status == PIR_OK)
        world->body[world->count++] = body;
    return status;
}

uint32_t world_count(const struct world *world) {
    return world->count;
}

/* --- a step --- */

/* The inverse inertia as the world sees it: R · inverse · Rᵀ. */
static void turn_inertia(struct body *body) {
    struct mat3 turned;
    const pir_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; i++) {
        pir_vec3 seen = pir_pose_rotate_inverse(body->pose, axis[i]);
        turned.row[i] = pir_pose_rotate(body->pose, mat_times(&body->inverse_inertia, seen));
    }
    body->inverse_in_world = turned;
}

/*
 * The spin of a body that nothing turns: its angular momentum stays, so its spin does not. One step of Newton's method
 * on the implicit equation, in the body's frame, which takes energy away rather than adding it (Catto, GDC 2015).
 */
static pir_vec3 spin_freely(const struct body *body, double step) {
    pir_vec3 w = pir_pose_rotate_inverse(body->pose, body->spin), l = mat_times(&body->inertia, w);
    pir_vec3 off = vec_times(step, vec_cross(w, l));
    struct mat3 slope;
    const pir_vec3 *row = body->inertia.row;
    // row i of [w]× inertia, and of [l]×
    pir_vec3 turned[3] = {vec_less(vec_times(w.y, row[2]), vec_times(w.z, row[1])),
                          vec_less(vec_times(w.z, row[0]), vec_times(w.x, row[2])),
                          vec_less(vec_times(w.x, row[1]), vec_times(w.y, row[0]))};
    pir_vec3 crossed[3] = {{0, -l.z, l.y}, {l.z, 0, -l.x}, {-l.y, l.x, 0}};
    for (int i = 0; i < 3; i++)
        slope.row[i] = vec_add(row[i], vec_times(step, vec_less(turned[i], crossed[i])));
    struct mat3 inverse = mat_inverse(&slope);
    return pir_pose_rotate(body->pose, vec_less(w, mat_times(&inverse, off)));
}

static bool is_awake(const struct body *body) {
    return body->kind == PIR_BODY_MOVING && !body->asleep;
}

/* Gravity and free spin. */
static void begin_step(struct world *world) {
    double step = world->options.step;
    for (uint32_t i = 0; i < world->count; i++) {
        struct body *body = &world->body[i];
        if (!is_awake(body))
            continue;
        turn_inertia(body);
        body->velocity = vec_add(body->velocity, vec_times(step, world->options.gravity));
        body->spin = spin_freely(body, step);
    }
}

/* Moves what moves; returns how many, which stand in `moves`. */
static size_t move_bodies(struct world *world) {
    size_t count = 0;
    for (uint32_t i = 0; i < world->count; i++) {
        struct body *body = &world->body[i];
        if (!is_awake(body) && !body_is_driven(body))
            continue;
        body->pose = pir_pose_integrate(body->pose, body->velocity, body->spin, world->options.step);
        world->moves[count++] = (pir_scene_move){i, body->pose};
    }
    return count;
}

/* Contacts where the bodies are now. */
static pir_status find_contacts(struct world *world, size_t moved) {
    pir_status status = pir_scene_update(world->scene, world->moves, moved);
    if (status != PIR_OK)
        return status;
    size_t count;
    const pir_scene_event *event = pir_scene_events(world->scene, &count);
    if (!contacts_follow(&world->last, &world->contacts, world->body, event, count))
        return PIR_ERR_MEMORY;
    struct contacts now = world->last;
    world->last = world->contacts;
    world->contacts = now;
    return PIR_OK;
}

pir_status world_step(struct world *world) {
    const struct world_options *options = &world->options;
    const struct contacts *contacts = &world->contacts;
    if (world->count == 0)
        return PIR_OK;
    begin_step(world);
    solver_begin(world->body, contacts);
    for (uint32_t i = 0; i < options->iterations; i++)
        solver_pass(world->body, contacts, options->step, true);
    size_t moved = move_bodies(world);
    solver_advance(world->body, contacts, options->step);
    for (uint32_t i = 0; i < options->relaxations; i++)
        solver_pass(world->body, contacts, options->step, false);
    solver_bounce(world->body, contacts);
    pir_status status = find_contacts(world, moved);
    if (status == PIR_OK && options->sleep)
        sleep_update(world->body, world->count, contacts, options->step, world->group);
    return status;
}

/* --- what can be seen --- */

struct world_motion world_motion(const struct world *world, uint32_t i) {
    const struct body *body = &world->body[i];
    return (struct world_motion){body->pose, body->velocity, body->spin, body->asleep};
}

double world_mean_speed(const struct world *world) {
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < world->count; i++)
        if (world->body[i].kind == PIR_BODY_MOVING) {
            sum += vec_length(world->body[i].velocity);
            count++;
        }
    return count ? sum / count : 0;
}

uint32_t world_contact_count(const struct world *world) {
    return world->contacts.point_count;
}

struct world_contact world_contact(const struct world *world, uint32_t index) {
    const struct contacts *contacts = &world->contacts;
    // the last link that begins at or before the point
    uint32_t low = 0, high = contacts->link_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (contacts->link[middle].first <= index)
            low = middle;
        else
            high = middle;
    }
    const struct link *link = &contacts->link[low];
    const struct point *point = &contacts->point[index];
    return (struct world_contact){vec_add(world->body[link->body_p].pose.translation, point->at_p),
                                  link->normal,
                                  point->distance,
                                  point->impulse,
                                  link->body_p,
                                  link->body_q};
}

pir_scene *world_scene(struct world *world) {
    return world->scene;
}
