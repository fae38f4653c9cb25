/* SPDX-License-Identifier: MIT */
/*
 * Fast bodies against thin walls: cubes, rods, plates, hulls and bodies of two pieces at 1 to 200 m/s, spinning, with
 * walls of 1 to 5 cm that stand or fly towards them. The middle of none is ever beyond the wall that it flew at.
 *
 * PIR_TEST_SHOTS is how many.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include "support/bodies.h"
#include "support/vectors.h"
#include "world.h"

#define SECONDS 0.6

static double between(test_random *random, double low, double high) {
    return low + (high - low) * 0.5 * (test_random_unit(random) + 1);
}

/* A cube of 4 cm, a rod, a plate, a hull, a hammer. */
static void make_shape(test_random *random, uint32_t kind, struct world_shape *shape) {
    pir_polytope *piece[2] = {NULL, NULL};
    uint32_t count = 1;
    if (kind == 0)
        piece[0] = test_box_at(0.02, 0.02, 0.02, test_zero);
    if (kind == 1)
        piece[0] = test_box_at(between(random, 0.1, 0.5), 0.01, 0.01, test_zero);
    if (kind == 2)
        piece[0] = test_box_at(0.2, 0.15, 0.004, test_zero);
    if (kind == 3) {
        test_points points = {.count = 14};
        for (size_t i = 0; i < points.count; i++)
            points.at[i] = test_add(test_zero, test_random_direction(random), between(random, 0.02, 0.06));
        piece[0] = test_polytope(&points);
    }
    if (kind == 4) {
        piece[count++] = test_box_at(0.2, 0.01, 0.01, test_zero);
        piece[0] = test_box_at(0.03, 0.06, 0.03, (pir_vec3){0.2, 0, 0});
    }
    assert_int_equal(world_shape_make(piece, count, shape), PIR_OK);
    for (uint32_t i = 0; i < count; i++)
        pir_polytope_release(piece[i]);
}

struct shot {
    struct world *world;
    struct world_shape shape, wall;
    double thick, speed;
};

/* The wall is body 0, across z; the body comes from above. Every third wall flies, every fourth shot has gravity. */
static void shot_init(struct shot *shot, uint64_t number) {
    test_random random = test_random_case("tunnel", number);
    struct world_options options = world_options_default();
    const double restitutions[3] = {0, 0.5, 1};
    if (number % 4 != 0)
        options.gravity = test_zero;
    shot->thick = between(&random, 0.01, 0.05);
    shot->speed = ldexp(1, (int)test_random_below(&random, 8)) * between(&random, 1, 1.5625);
    pir_polytope *wall = test_box_at(6, 6, shot->thick / 2, test_zero);
    assert_int_equal(world_shape_make(&wall, 1, &shot->wall), PIR_OK);
    pir_polytope_release(wall);
    make_shape(&random, (uint32_t)(number % 5), &shot->shape);
    bool flies = number % 3 == 2;
    struct world_body target = {.kind = flies ? PIR_BODY_MOVING : PIR_BODY_STATIC,
                                .pose = pir_pose_identity(),
                                .shape = &shot->wall,
                                .density = 1000};
    if (flies)
        target.velocity.z = shot->speed * between(&random, 0, 1);
    struct world_body body = {
        .pose = {test_general_rotation(&random), {0, 0, 0}}, .shape = &shot->shape, .density = 500};
    body.friction = target.friction = between(&random, 0, 1);
    body.restitution = restitutions[test_random_below(&random, 3)];
    body.velocity = test_add((pir_vec3){0, 0, -1}, test_random_direction(&random), 0.5);
    body.velocity = test_add(test_zero, body.velocity, shot->speed / test_length(body.velocity));
    const double spins[4] = {0, 10, 60, 300};
    body.spin = test_add(test_zero, test_random_direction(&random), spins[test_random_below(&random, 4)]);
    // anywhere from beside the wall to several steps before it
    double above = shot->shape.radius + between(&random, 0.001, 0.02 * shot->speed);
    body.pose.translation =
        test_add((pir_vec3){0, 0, shot->thick / 2 + above}, body.velocity, -0.2 * above / shot->speed);
    assert_int_equal(world_create(&options, &shot->world), PIR_OK);
    assert_int_equal(world_add(shot->world, &target), PIR_OK);
    assert_int_equal(world_add(shot->world, &body), PIR_OK);
}

static void shot_finish(struct shot *shot) {
    world_destroy(shot->world);
    world_shape_release(&shot->shape);
    world_shape_release(&shot->wall);
}

/* The height of the body's middle over that of the wall, in its frame; whether it is over it at all. */
static bool is_above(const struct shot *shot, double *ret_height) {
    pir_pose wall = world_motion(shot->world, 0).pose;
    pir_vec3 at = test_add(world_motion(shot->world, 1).pose.translation, wall.translation, -1);
    pir_vec3 in_wall = test_turn(wall.rotation, at, -1);
    *ret_height = in_wall.z;
    return fabs(in_wall.x) < 6 && fabs(in_wall.y) < 6;
}

static void no_body_passes_a_wall(void **state) {
    (void)state;
    const char *text = getenv("PIR_TEST_SHOTS");
    const uint64_t shots = text ? strtoull(text, NULL, 10) : 600;
    uint64_t met = 0;
    double deepest = HUGE_VAL;
    for (uint64_t number = 0; number < shots; number++) {
        struct shot shot;
        double height;
        bool meets = false;
        shot_init(&shot, number);
        for (int i = 0; i < 240 * SECONDS; i++) {
            assert_int_equal(world_step(shot.world), PIR_OK);
            meets |= world_contact_count(shot.world) > 0;
            if (!is_above(&shot, &height))
                break;
            expect(height > -shot.thick / 2, "shot %llu at %g m/s: %g m beyond a wall of %g m after %d steps",
                   (unsigned long long)number, shot.speed, -height, shot.thick, i + 1);
            deepest = fmin(deepest, height - shot.thick / 2);
        }
        met += meets;
        shot_finish(&shot);
    }
    print_message("%llu shots, %llu met the wall, the nearest middle is %.2g m over it\n", (unsigned long long)shots,
                  (unsigned long long)met, deepest);
    assert_true(met > shots * 9 / 10);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_body_passes_a_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
