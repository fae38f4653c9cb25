/* SPDX-License-Identifier: MIT */
/* The world: its bodies, and its steps. A body's number here is its number in the scene. */
#include "world.h"

#include <stdlib.h>

#include "bounce.h"
#include "contacts.h"
#include "sleep.h"
#include "sweep.h"

/*
 * Parts of the margin: the gap at which bodies rest, within which they are held; the overlap that is left alone; where
 * fast bodies stop, and within which they then bounce.
 */
#define GAP_PART    0.0004
#define HELD_PART   0.004
#define SLOP_PART   0.04
#define NEAR_PART   0.1
#define BOUNCE_PART 0.2
/* The sizes of cores, as parts of the piece's. */
static const double core_parts[WORLD_CORES] = {0.99, 0.9, 0.4};
/* A margin, in metres, where none is given. */
#define MARGIN_LEAST 1e-4
/* Slower approaches do not bounce, in m/s; what gravity adds in two steps comes to it. */
#define BOUNCE_LEAST 0.01

struct world {
    struct world_options options;
    pir_scene *scene;
    struct body *body;
    uint32_t *group; /* per body, for bounce_all and sleep_update */
    uint32_t count, room;
    struct sweep sweep;
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
    for (uint32_t i = 0; i < shape->count; i++) {
        pir_polytope_release(shape->piece[i]);
        for (int k = 0; k < WORLD_CORES; k++)
            pir_polytope_release(shape->core[k][i]);
    }
    free(shape->piece);
    for (int k = 0; k < WORLD_CORES; k++)
        free(shape->core[k]);
    pir_trimesh_release(shape->mesh);
    pir_height_field_release(shape->field);
    *shape = (struct world_shape){0};
}

static double radius_of(const struct world_shape *shape) {
    double radius = 0;
    for (uint32_t i = 0; i < shape->count; i++)
        for (uint32_t v = 0; v < pir_polytope_vertex_count(shape->piece[i]); v++)
            radius = fmax(radius, vec_length(pir_polytope_vertex(shape->piece[i], v)));
    return radius;
}

/* A piece, smaller about the mean of its vertices. */
static pir_status make_core(pir_polytope *piece, double part, pir_polytope **ret_core) {
    uint32_t count = pir_polytope_vertex_count(piece);
    pir_vec3 *point = calloc(count, sizeof *point), middle = {0, 0, 0};
    for (uint32_t v = 0; v < count; v++)
        middle = vec_add(middle, vec_times(1. / count, pir_polytope_vertex(piece, v)));
    for (uint32_t v = 0; point && v < count; v++)
        point[v] = vec_add(middle, vec_times(part, vec_less(pir_polytope_vertex(piece, v), middle)));
    pir_status status = point ? pir_polytope_create(point, count, NULL, ret_core) : PIR_ERR_MEMORY;
    free(point);
    return status;
}

pir_status world_shape_make(pir_polytope *const *pieces, uint32_t count, struct world_shape *ret_shape) {
    struct world_shape shape = {.piece = calloc(count + (size_t)1, sizeof *shape.piece)};
    pir_mass *mass = calloc(count + (size_t)1, sizeof *mass);
    pir_status status = shape.piece && mass ? PIR_OK : PIR_ERR_MEMORY;
    for (int k = 0; k < WORLD_CORES; k++) {
        shape.core[k] = calloc(count + (size_t)1, sizeof *shape.core[k]);
        status = shape.core[k] ? status : PIR_ERR_MEMORY;
    }
    for (uint32_t i = 0; status == PIR_OK && i < count; i++)
        status = pir_polytope_mass(pieces[i], &mass[i]);
    if (status == PIR_OK)
        status = pir_mass_combine(mass, count, &shape.mass);
    shape.offset = shape.mass.centroid;
    for (uint32_t i = 0; status == PIR_OK && i < count; i++) {
        status = pir_polytope_translate(pieces[i], vec_times(-1, shape.offset), &shape.piece[i]);
        shape.count += status == PIR_OK;
        for (int k = 0; status == PIR_OK && k < WORLD_CORES; k++)
            status = make_core(shape.piece[i], core_parts[k], &shape.core[k][i]);
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

/* How far the farthest corner of a box is from the origin. */
static double farthest(pir_vec3 low, pir_vec3 high) {
    return vec_length(
        (pir_vec3){fmax(fabs(low.x), fabs(high.x)), fmax(fabs(low.y), fabs(high.y)), fmax(fabs(low.z), fabs(high.z))});
}

struct world_shape world_shape_of_mesh(pir_trimesh *mesh) {
    pir_trimesh_info info;
    pir_trimesh_describe(mesh, &info);
    return (struct world_shape){.mesh = pir_trimesh_retain(mesh), .radius = farthest(info.low, info.high)};
}

struct world_shape world_shape_of_field(pir_height_field *field) {
    pir_height_info info;
    pir_height_field_describe(field, &info);
    return (struct world_shape){.field = pir_height_field_retain(field), .radius = farthest(info.low, info.high)};
}

/* --- bodies --- */

pir_status world_create(const struct world_options *options, struct world **ret_world) {
    struct world *world = calloc(1, sizeof *world);
    if (!world)
        return PIR_ERR_MEMORY;
    world->options = *options;
    pir_scene_options scene = pir_scene_options_default();
    scene.unions = true;
    world->options.margin = scene.margin = options->margin > 0 ? options->margin : MARGIN_LEAST;
    scene.threads = options->threads;
    scene.reuse = options->reuse;
    scene.profile = options->profile;
    scene.clock = options->clock;
    pir_status status = pir_scene_create(&scene, &world->scene);
    if (status == PIR_OK)
        status = sweep_init(&world->sweep);
    if (status == PIR_OK)
        *ret_world = world;
    else
        world_destroy(world);
    return status;
}

void world_destroy(struct world *world) {
    if (!world)
        return;
    pir_scene_destroy(world->scene);
    sweep_finish(&world->sweep);
    contacts_clear(&world->contacts);
    contacts_clear(&world->last);
    free(world->body);
    free(world->group);
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
    if (!body || !group)
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
                        .restitution = from->restitution,
                        .sensor = from->sensor,
                        .shape = from->shape};
    if (body.kind == PIR_BODY_MOVING && (body.sensor || world_shape_is_surface(from->shape)))
        return PIR_ERR_ARGUMENT;
    if (body.kind == PIR_BODY_MOVING) {
        set_mass(&body, from);
        if (!(body.inverse_mass > 0 && isfinite(body.inverse_mass) && isfinite(body.inverse_inertia.row[0].x)))
            return PIR_ERR_ARGUMENT;
    }
    pir_body_options options = pir_body_options_default();
    options.kind = body.kind;
    options.sensor = body.sensor;
    // of length 1 from the beginning
    options.pose = body.pose = pir_pose_integrate(body.pose, body.velocity, body.spin, 0);
    options.pieces = from->shape->piece;
    options.piece_count = from->shape->count;
    options.mesh = from->shape->mesh;
    options.field = from->shape->field;
    uint32_t number;
    pir_status status = reserve_body(world);
    if (status == PIR_OK)
        status = pir_scene_add(world->scene, &options, &number);
    if (status == PIR_OK)
        status = sweep_add(&world->sweep, &body, number);
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

/* Half of the step's gravity, and all of a step that begins anew. */
static void begin_step(struct world *world) {
    pir_vec3 half = vec_times(0.5 * world->options.step, world->options.gravity), none = {0, 0, 0};
    for (uint32_t i = 0; i < world->count; i++) {
        struct body *body = &world->body[i];
        body->push = body->push_spin = none;
        body->flies = body->touches = false;
        if (body_is_awake(body))
            body->velocity = vec_add(body->velocity, half);
    }
}

/* Contacts where the bodies are now. */
static pir_status find_contacts(struct world *world, size_t moved) {
    pir_status status = pir_scene_update(world->scene, world->sweep.moves, moved);
    if (status != PIR_OK)
        return status;
    size_t count;
    const pir_scene_event *event = pir_scene_events(world->scene, &count);
    for (size_t i = 0; i < count; i++)
        if (event[i].sensor && event[i].kind != PIR_EVENT_PERSISTED) {
            const uint32_t other = world->body[event[i].body_p].sensor ? event[i].body_q : event[i].body_p;
            world->body[other].sensed += event[i].kind == PIR_EVENT_BEGAN ? 1 : UINT32_MAX;
        }
    if (!contacts_follow(&world->last, &world->contacts, world->body, event, count))
        return PIR_ERR_MEMORY;
    struct contacts now = world->last;
    world->last = world->contacts;
    world->contacts = now;
    return PIR_OK;
}

/* What bounces, and then what touches: the speeds that bodies have at the end of the step. */
static void end_step(struct world *world, const struct solver_rules *rules) {
    for (uint32_t i = 0; i < world->count; i++)
        if (body_is_awake(&world->body[i]))
            turn_inertia(&world->body[i]);
    solver_place(world->body, &world->contacts);
    bounce_all(world->body, world->count, &world->contacts, rules, world->group);
    solver_begin(world->body, &world->contacts, rules);
    solver_passes(world->body, &world->contacts, rules, world->options.relaxations, false);
}

pir_status world_step(struct world *world) {
    const struct world_options *options = &world->options;
    const struct solver_rules rules = {options->step, GAP_PART * options->margin, BOUNCE_PART * options->margin,
                                       SLOP_PART * options->margin,
                                       BOUNCE_LEAST + 2 * options->step * vec_length(options->gravity)};
    const struct sweep_rules sweep = {options->gravity, options->step, options->margin, NEAR_PART * options->margin,
                                      HELD_PART * options->margin};
    if (world->count == 0)
        return PIR_OK;
    begin_step(world);
    solver_begin(world->body, &world->contacts, &rules);
    solver_passes(world->body, &world->contacts, &rules, options->iterations, true);
    size_t moved;
    pir_status status = sweep_step(&world->sweep, world->body, world->count, &sweep, &moved);
    if (status == PIR_OK)
        status = find_contacts(world, moved);
    if (status != PIR_OK)
        return status;
    end_step(world, &rules);
    if (options->sleep)
        sleep_update(world->body, world->count, &world->contacts, options->step, world->group);
    return PIR_OK;
}

void world_set_velocity(struct world *world, uint32_t number, pir_vec3 velocity) {
    struct body *body = &world->body[number];
    body->velocity = velocity;
    body->asleep = false;
    body->still = 0;
}

/* --- states --- */

/* The scene, and those of the sweep. */
#define SCENES 3

struct world_state {
    uint32_t count;
    struct body *body;
    struct contacts contacts;
    struct {
        void *bytes;
        size_t size;
    } scene[SCENES];
};

static pir_scene *scene_of(const struct world *world, int which) {
    return which == 0 ? world->scene : which == 1 ? world->sweep.scene : world->sweep.cores;
}

void world_state_destroy(struct world_state *state) {
    if (!state)
        return;
    for (int i = 0; i < SCENES; i++)
        free(state->scene[i].bytes);
    contacts_clear(&state->contacts);
    free(state->body);
    free(state);
}

struct world_state *world_save(struct world *world) {
    struct world_state *state = calloc(1, sizeof *state);
    bool done = state && (state->body = calloc(world->count + (size_t)1, sizeof *state->body)) &&
                contacts_copy(&state->contacts, &world->contacts);
    for (int i = 0; done && i < SCENES; i++) {
        const size_t size = state->scene[i].size = pir_scene_serialised_size(scene_of(world, i));
        state->scene[i].bytes = malloc(size);
        done = state->scene[i].bytes && pir_scene_serialise(scene_of(world, i), state->scene[i].bytes, size) == PIR_OK;
    }
    if (!done) {
        world_state_destroy(state);
        return NULL;
    }
    state->count = world->count;
    for (uint32_t i = 0; i < world->count; i++)
        state->body[i] = world->body[i];
    return state;
}

pir_status world_restore(struct world *world, const struct world_state *state) {
    if (state->count != world->count)
        return PIR_ERR_ARGUMENT;
    pir_status status = contacts_copy(&world->contacts, &state->contacts) ? PIR_OK : PIR_ERR_MEMORY;
    for (int i = 0; status == PIR_OK && i < SCENES; i++)
        status = pir_scene_restore(scene_of(world, i), state->scene[i].bytes, state->scene[i].size, NULL);
    for (uint32_t i = 0; status == PIR_OK && i < world->count; i++)
        world->body[i] = state->body[i];
    return status;
}

/* --- what can be seen --- */

struct world_motion world_motion(const struct world *world, uint32_t i) {
    const struct body *body = &world->body[i];
    return (struct world_motion){body->pose, body->velocity, body->spin, body->asleep, body->sensed > 0};
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
                                  point->spent + point->impulse,
                                  link->body_p,
                                  link->body_q};
}

pir_scene *world_scene(struct world *world) {
    return world->scene;
}
