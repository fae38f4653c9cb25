/* SPDX-License-Identifier: MIT */
/*
 * Energy and momentum in worlds at random: boxes, hulls and bodies of two pieces, thrown, spinning and stacked, in a
 * closed room or in free space, with gravity and without, of any restitution and friction. Kinetic energy, of
 * translation and of rotation, and potential energy together never grow; where nothing is fixed, momentum and angular
 * momentum stay.
 *
 * PIR_TEST_WORLDS is how many worlds, PIR_TEST_SECONDS for how long each.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include "support/bodies.h"
#include "support/vectors.h"
#include "world.h"

#define BODIES_MOST 24
#define SHAPES      4
/* How much more there may be than at first, as a part of it. */
#define GAIN_MOST 1e-3

static double number_of(const char *name, double otherwise) {
    const char *text = getenv(name);
    return text ? atof(text) : otherwise;
}

struct room {
    test_random random;
    struct world_options options;
    struct world_shape shape[SHAPES], wall;
    struct world_body body[BODIES_MOST];
    uint32_t count;
    bool closed;
    struct world *world;
};

/* --- making them --- */

static double between(struct room *room, double low, double high) {
    return low + (high - low) * 0.5 * (test_random_unit(&room->random) + 1);
}

static pir_polytope *hull(struct room *room) {
    test_points points = {.count = 12};
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = test_add(test_zero, test_random_direction(&room->random), between(room, 0.1, 0.2));
    return test_polytope(&points);
}

static void make_shape(struct room *room, uint32_t kind, struct world_shape *shape) {
    pir_polytope *piece[2] = {NULL, NULL};
    uint32_t count = kind == 3 ? 2 : 1;
    if (kind == 1)
        piece[0] = hull(room);
    else
        piece[0] = test_box_at(between(room, 0.05, 0.2), between(room, 0.05, 0.2), between(room, 0.05, 0.2), test_zero);
    if (count == 2)
        piece[1] = test_box_at(0.05, 0.05, 0.2, (pir_vec3){0.1, 0, 0.2});
    assert_int_equal(world_shape_make(piece, count, shape), PIR_OK);
    for (uint32_t i = 0; i < count; i++)
        pir_polytope_release(piece[i]);
}

static void add_body(struct room *room, const struct world_body *body) {
    assert_int_equal(world_add(room->world, body), PIR_OK);
    room->body[room->count++] = *body;
}

/* Six slabs around a cube of 3 m that stands on z = 0, a bit over each other. */
static void add_walls(struct room *room, double restitution, double friction) {
    pir_polytope *slab = test_box_at(2, 2, 0.25, test_zero);
    const pir_vec3 at[6] = {{0, 0, -0.25},   {0, 0, 3.25},   {1.75, 0, 1.5},
                            {-1.75, 0, 1.5}, {0, 1.75, 1.5}, {0, -1.75, 1.5}};
    const pir_quat turn[6] = {{0, 0, 0, 1}, {0, 0, 0, 1}, {0, 1, 0, 1}, {0, 1, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
    assert_int_equal(world_shape_make(&slab, 1, &room->wall), PIR_OK);
    pir_polytope_release(slab);
    for (int i = 0; i < 6; i++)
        add_body(room, &(struct world_body){.kind = PIR_BODY_STATIC,
                                            .pose = {turn[i], at[i]},
                                            .shape = &room->wall,
                                            .friction = friction,
                                            .restitution = restitution});
}

/* Moving bodies on places of a grid, so that none overlaps another, or on top of each other. */
static void add_bodies(struct room *room, uint32_t count, double restitution, double friction, bool stacked) {
    double speed = stacked ? 0 : between(room, 0, 5), spin = stacked ? 0 : between(room, 0, 12);
    double top = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct world_shape *shape = &room->shape[test_random_below(&room->random, SHAPES)];
        struct world_body body = {.pose = {{0, 0, 0, 1}, {0, 0, 0}}, .shape = shape, .density = 500};
        body.friction = friction;
        body.restitution = restitution;
        if (stacked) {
            double low = 0, high = 0;
            for (uint32_t k = 0; k < shape->count; k++)
                for (uint32_t v = 0; v < pir_polytope_vertex_count(shape->piece[k]); v++) {
                    low = fmin(low, pir_polytope_vertex(shape->piece[k], v).z);
                    high = fmax(high, pir_polytope_vertex(shape->piece[k], v).z);
                }
            body.pose.translation.z = top - low;
            top += high - low;
        } else {
            body.pose.rotation = test_general_rotation(&room->random);
            body.pose.translation =
                (pir_vec3){0.85 * (i % 3) - 0.85, 0.85 * (i / 3 % 3) - 0.85, 0.6 + 0.85 * (double)(i / 9)};
            body.velocity = test_add(test_zero, test_random_direction(&room->random), speed);
            body.spin = test_add(test_zero, test_random_direction(&room->random), spin);
        }
        add_body(room, &body);
    }
}

static void room_init(struct room *room, uint64_t number) {
    static const double restitutions[6] = {0, 0.25, 0.5, 0.9, 1, 1}, frictions[3] = {0, 0.3, 0.8};
    *room = (struct room){.random = test_random_case("energy", number), .options = world_options_default()};
    double restitution = restitutions[number % 6], friction = frictions[number / 6 % 3];
    bool gravity = number / 18 % 3 != 2, stacked = gravity && number % 7 == 3;
    room->closed = gravity || number % 2;
    if (!gravity)
        room->options.gravity = test_zero;
    room->options.sleep = number % 5 == 0;
    room->options.reuse = number % 4 == 1 ? 1e-3 : 0;
    for (uint32_t i = 0; i < SHAPES; i++)
        make_shape(room, i, &room->shape[i]);
    assert_int_equal(world_create(&room->options, &room->world), PIR_OK);
    if (room->closed)
        add_walls(room, restitution, friction);
    // bodies of their own restitution: of two the greater counts
    add_bodies(room, stacked ? 6 : 1 + test_random_below(&room->random, 16), number % 4 == 0 ? 0 : restitution,
               friction, stacked);
}

static void room_finish(struct room *room) {
    world_destroy(room->world);
    world_shape_release(&room->wall);
    for (uint32_t i = 0; i < SHAPES; i++)
        world_shape_release(&room->shape[i]);
}

/* --- what they have --- */

struct sums {
    double energy, speed, turning;
    pir_vec3 momentum, angular; /* about the origin */
};

static void add_sums(struct sums *sums, const struct world_body *body, const struct world_motion *now,
                     pir_vec3 gravity) {
    const pir_mass *of = &body->shape->mass;
    const double mass = body->density * of->volume;
    pir_vec3 w = test_turn(now->pose.rotation, now->spin, -1);
    double in[3] = {w.x, w.y, w.z}, out[3];
    for (int i = 0; i < 3; i++)
        out[i] = body->density * (of->inertia[i][0] * in[0] + of->inertia[i][1] * in[1] + of->inertia[i][2] * in[2]);
    pir_vec3 own = test_turn(now->pose.rotation, (pir_vec3){out[0], out[1], out[2]}, 1);
    pir_vec3 p = test_add(test_zero, now->velocity, mass), x = now->pose.translation;
    sums->energy += 0.5 * test_dot(p, now->velocity) + 0.5 * test_dot(own, now->spin) - mass * test_dot(gravity, x);
    sums->speed += test_length(p);
    sums->momentum = test_add(sums->momentum, p, 1);
    sums->angular = test_add(sums->angular, test_add(own, test_cross(x, p), 1), 1);
    sums->turning += test_length(own) + test_length(x) * test_length(p);
}

static struct sums sums_of(const struct room *room) {
    struct sums sums = {0};
    for (uint32_t i = 0; i < room->count; i++) {
        struct world_motion now = world_motion(room->world, i);
        if (room->body[i].kind == PIR_BODY_MOVING)
            add_sums(&sums, &room->body[i], &now, room->options.gravity);
    }
    return sums;
}

/* --- tests --- */

static void energy_never_grows_and_momentum_stays(void **state) {
    (void)state;
    const uint64_t worlds = (uint64_t)number_of("PIR_TEST_WORLDS", 54),
                   first = (uint64_t)number_of("PIR_TEST_FIRST", 0);
    const double seconds = number_of("PIR_TEST_SECONDS", 3);
    double worst = 0, drift = 0;
    for (uint64_t number = first; number < first + worlds; number++) {
        struct room room;
        unsigned long long n = number;
        room_init(&room, number);
        struct sums begin = sums_of(&room);
        for (int i = 0; i < 240 * seconds; i++) {
            assert_int_equal(world_step(room.world), PIR_OK);
            struct sums now = sums_of(&room);
            double gain = now.energy / begin.energy - 1;
            expect(gain <= GAIN_MOST, "world %llu: %g more energy after %d steps", n, gain, i + 1);
            worst = fmax(worst, gain);
            if (room.closed)
                continue;
            double moved = test_length(test_add(now.momentum, begin.momentum, -1)) / begin.speed,
                   turned = test_length(test_add(now.angular, begin.angular, -1)) / begin.turning;
            expect(moved < 1e-9 && turned < 1e-6, "world %llu: momentum off by %g, angular by %g, after %d steps", n,
                   moved, turned, i + 1);
            drift = fmax(drift, fmax(moved, turned));
        }
        room_finish(&room);
    }
    print_message("%llu worlds of %g s: energy grows by a part of %.2g at most, momentum changes by %.2g\n",
                  (unsigned long long)worlds, seconds, worst, drift);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_never_grows_and_momentum_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
