/* SPDX-License-Identifier: MIT */
/*
 * The world of examples/physics: what stands keeps standing without sleep, a pile comes to rest with little overlap,
 * free bodies keep their angular momentum, what sleeps wakes, and threads change nothing. A world goes back to a state
 * that was kept.
 *
 * The environment makes runs longer: PIR_TEST_SECONDS is how long what stands is watched, PIR_TEST_PILE the scene that
 * is to come to rest.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "depths.h"
#include "support/vectors.h"

static const char *scenes; /* their folder */

static double seconds_of(const char *name, double otherwise) {
    const char *text = getenv(name);
    return text ? atof(text) : otherwise;
}

static struct stage read(const char *name) {
    char path[4096], why[STAGE_WHY];
    struct stage stage;
    snprintf(path, sizeof path, "%s/%s.json", scenes, name);
    expect(stage_read(path, &stage, why), "%s", why);
    return stage;
}

static struct world *world_of(const struct stage *stage) {
    struct world *world = NULL;
    assert_int_equal(stage_world(stage, &world), PIR_OK);
    return world;
}

static void run_seconds(struct world *world, double seconds) {
    for (int i = 0; i < 240 * seconds; i++)
        assert_int_equal(world_step(world), PIR_OK);
}

/* Runs a scene without sleep; each body stays within `near` of where it was, and settles. */
static void stands(const char *name, double near) {
    struct stage stage = read(name);
    stage.options.sleep = false;
    struct world *world = world_of(&stage);
    double seconds = seconds_of("PIR_TEST_SECONDS", 4);
    run_seconds(world, seconds);
    for (uint32_t i = 0; i < stage.body_count; i++) {
        pir_vec3 from = stage.body[i].body.pose.translation, to = world_motion(world, i).pose.translation;
        double way = test_length(test_add(to, from, -1));
        expect(way < near, "%s: body %u has gone %g m in %g s", name, i, way, seconds);
    }
    struct depths depths = depths_of(&stage, world);
    print_message("%s: mean speed %.2g m/s after %g s, deepest %.3g m\n", name, world_mean_speed(world), seconds,
                  depths.depth);
    assert_true(world_mean_speed(world) < 1e-3);
    world_destroy(world);
    stage_clear(&stage);
}

static void a_stack_of_ten_boxes_stands(void **state) {
    (void)state;
    stands("stack", 0.015);
}

static void a_house_of_fifteen_cards_stands(void **state) {
    (void)state;
    stands("cards", 0.008);
}

/* With contacts that move along with bodies for up to a millimetre. */
static void contacts_told_again_carry(void **state) {
    (void)state;
    static const char *const names[3] = {"stack", "cards", "heap"};
    for (int i = 0; i < 3; i++) {
        struct stage stage = read(names[i]);
        stage.options.sleep = false;
        stage.options.reuse = 1e-3;
        struct world *world = world_of(&stage);
        run_seconds(world, 12);
        struct depths depths = depths_of(&stage, world);
        print_message("%s: mean speed %.2g m/s, deepest %.3g m\n", names[i], world_mean_speed(world), depths.depth);
        expect(world_mean_speed(world) < 2e-3, "%s: mean speed %g", names[i], world_mean_speed(world));
        expect(depths.relative < 0.02, "%s: overlap of %g of a size", names[i], depths.relative);
        for (uint32_t b = 0; i < 2 && b < stage.body_count; b++) {
            pir_vec3 from = stage.body[b].body.pose.translation, to = world_motion(world, b).pose.translation;
            expect(test_length(test_add(to, from, -1)) < 0.015, "%s: body %u has gone", names[i], b);
        }
        world_destroy(world);
        stage_clear(&stage);
    }
}

static void a_pile_comes_to_rest(void **state) {
    (void)state;
    const char *name = getenv("PIR_TEST_PILE");
    struct stage stage = read(name ? name : "heap");
    stage.options.sleep = false;
    struct world *world = world_of(&stage);
    run_seconds(world, name ? stage.seconds : 3);
    struct depths depths = depths_of(&stage, world);
    print_message("%s: mean speed %.2g m/s, %u pairs looked at, deepest %.3g m, %.2f %% of a size\n", stage.title,
                  world_mean_speed(world), depths.pairs, depths.depth, 100 * depths.relative);
    expect(world_mean_speed(world) < 1e-3, "mean speed %g", world_mean_speed(world));
    expect(depths.relative < 0.02, "bodies %u and %u overlap by %g of a size", depths.p, depths.q, depths.relative);
    world_destroy(world);
    stage_clear(&stage);
}

static void what_sleeps_wakes_when_it_is_hit(void **state) {
    (void)state;
    struct stage stage = read("stack");
    struct world *world = world_of(&stage);
    run_seconds(world, 3);
    for (uint32_t i = 1; i < stage.body_count; i++)
        assert_true(world_motion(world, i).asleep);
    run_seconds(world, 0.1);
    // nothing that sleeps is looked at
    assert_int_equal(pir_scene_get_statistics(world_scene(world)).looked, 0);
    struct world_body ball = stage.body[1].body;
    ball.pose.translation = (pir_vec3){-2, 0, 3};
    ball.velocity = (pir_vec3){8, 0, 2};
    assert_int_equal(world_add(world, &ball), PIR_OK);
    run_seconds(world, 0.6);
    assert_false(world_motion(world, 10).asleep);
    assert_true(fabs(world_motion(world, 10).pose.translation.x) > 0.01);
    world_destroy(world);
    stage_clear(&stage);
}

/* About its middle axis a body without supports turns over, again and again; energy and momentum stay. */
static void a_free_body_keeps_its_momentum(void **state) {
    (void)state;
    struct stage stage = read("slot");
    struct world_options options = world_options_default();
    options.gravity = (pir_vec3){0, 0, 0};
    struct world *world = NULL;
    assert_int_equal(world_create(&options, &world), PIR_OK);
    pir_polytope *box = NULL;
    struct world_shape shape;
    assert_int_equal(pir_shape_create("box?x=1&y=0.6&z=0.2", NULL, NULL, &box), PIR_OK);
    assert_int_equal(world_shape_make(&box, 1, &shape), PIR_OK);
    struct world_body body = {.pose = pir_pose_identity(), .spin = {0.01, 4, 0.01}, .shape = &shape, .density = 1000};
    assert_int_equal(world_add(world, &body), PIR_OK);
    double low = 1, energy[2] = {0}, momentum[2] = {0};
    for (int i = 0; i <= 240 * 4; i++) {
        struct world_motion now = world_motion(world, 0);
        pir_vec3 w = pir_pose_rotate_inverse(now.pose, now.spin), l = {0, 0, 0};
        for (int k = 0; k < 3; k++) {
            const double *row = shape.mass.inertia[k];
            *(k == 0 ? &l.x : k == 1 ? &l.y : &l.z) = row[0] * w.x + row[1] * w.y + row[2] * w.z;
        }
        energy[i > 0] = test_dot(w, l);
        momentum[i > 0] = test_length(l);
        low = fmin(low, pir_pose_rotate(now.pose, (pir_vec3){0, 1, 0}).y);
        assert_int_equal(world_step(world), PIR_OK);
    }
    expect(low < -0.8, "it has not turned over: %g", low);
    expect(energy[1] <= energy[0] * 1.0001 && energy[1] > energy[0] * 0.9, "energy %g to %g", energy[0], energy[1]);
    expect(fabs(momentum[1] / momentum[0] - 1) < 0.05, "momentum %g to %g", momentum[0], momentum[1]);
    world_destroy(world);
    world_shape_release(&shape);
    pir_polytope_release(box);
    stage_clear(&stage);
}

/* A ball of restitution 0.8 rises to 0.64 of the height that it fell from. */
static void a_ball_bounces(void **state) {
    (void)state;
    struct stage stage = read("stack");
    stage.body[1].body.restitution = 0.8;
    stage.body[1].body.pose.translation.z = 1.2;
    stage.body_count = 2;
    struct world *world = world_of(&stage);
    double top = 0;
    for (int i = 0; i < 240 * 1; i++) {
        assert_int_equal(world_step(world), PIR_OK);
        struct world_motion now = world_motion(world, 1);
        if (i > 120 && now.velocity.z > 0)
            top = fmax(top, now.pose.translation.z - 0.2);
    }
    expect(fabs(top - 0.64) < 0.05, "rises to %g", top);
    world_destroy(world);
    stage_clear(&stage);
}

static void threads_change_nothing(void **state) {
    (void)state;
    struct stage stage = read("heap");
    struct world *world[2];
    for (int k = 0; k < 2; k++) {
        stage.options.threads = k + 1;
        world[k] = world_of(&stage);
        run_seconds(world[k], 0.8);
    }
    for (uint32_t i = 0; i < stage.body_count; i++) {
        struct world_motion a = world_motion(world[0], i), b = world_motion(world[1], i);
        assert_memory_equal(&a.pose, &b.pose, sizeof a.pose);
        assert_memory_equal(&a.spin, &b.spin, sizeof a.spin);
    }
    for (int k = 0; k < 2; k++)
        world_destroy(world[k]);
    stage_clear(&stage);
}

/* Bodies that begin in each other part at a bounded speed. */
static void what_begins_inside_is_pushed_out_slowly(void **state) {
    (void)state;
    struct stage stage = read("stack");
    for (uint32_t i = 1; i < stage.body_count; i++)
        stage.body[i].body.pose.translation = (pir_vec3){0, 0, 0.2};
    struct world *world = world_of(&stage);
    for (int i = 0; i < 480; i++) {
        assert_int_equal(world_step(world), PIR_OK);
        for (uint32_t k = 1; k < stage.body_count; k++)
            assert_true(test_length(world_motion(world, k).velocity) < 20);
    }
    struct depths depths = depths_of(&stage, world);
    expect(depths.relative < 0.02, "still %g of a size", depths.relative);
    world_destroy(world);
    stage_clear(&stage);
}

static bool same_motion(const struct world_motion *a, const struct world_motion *b) {
    return memcmp(&a->pose, &b->pose, sizeof a->pose) == 0 &&
           memcmp(&a->velocity, &b->velocity, sizeof a->velocity) == 0 &&
           memcmp(&a->spin, &b->spin, sizeof a->spin) == 0 && a->asleep == b->asleep && a->sensed == b->sensed;
}

/* Back to states in the fall, at the impact and at rest, some of them after other steps than the first time. */
static void a_world_goes_back(void **state) {
    (void)state;
    static const char *const names[3] = {"sensors", "heap", "bullets"};
    for (int n = 0; n < 3; n++) {
        struct stage stage = read(names[n]);
        struct world *world = world_of(&stage), *other = world_of(&stage);
        uint32_t sensed = 0;
        run_seconds(world, 0.25 + 0.3 * n);
        for (int back = 0; back < 4; back++) {
            struct world_state *kept = world_save(world);
            struct world_motion *first = calloc(stage.body_count, sizeof *first);
            assert_true(kept && first);
            run_seconds(world, 0.2);
            const uint32_t contacts = world_contact_count(world);
            for (uint32_t i = 0; i < stage.body_count; i++)
                first[i] = world_motion(world, i);
            world_set_velocity(world, stage.body_count - 1, (pir_vec3){1, 0, 2});
            run_seconds(world, 0.1);
            struct world *again = back % 2 ? other : world;
            assert_int_equal(world_restore(again, kept), PIR_OK);
            run_seconds(again, 0.2);
            assert_int_equal(world_contact_count(again), contacts);
            for (uint32_t i = 0; i < stage.body_count; i++) {
                const struct world_motion motion = world_motion(again, i);
                expect(same_motion(&motion, &first[i]), "%s: body %u, the %dth time", names[n], i, back);
                sensed += motion.sensed;
            }
            world_state_destroy(kept);
            free(first);
        }
        assert_int_equal(sensed > 0, n == 0);
        world_destroy(world);
        world_destroy(other);
        stage_clear(&stage);
    }
}

int main(int argc, char **argv) {
    const struct CMUnitTest standing[] = {
        cmocka_unit_test(a_stack_of_ten_boxes_stands),
        cmocka_unit_test(a_house_of_fifteen_cards_stands),
        cmocka_unit_test(contacts_told_again_carry),
        cmocka_unit_test(a_pile_comes_to_rest),
    };
    const struct CMUnitTest others[] = {
        cmocka_unit_test(what_sleeps_wakes_when_it_is_hit),
        cmocka_unit_test(a_free_body_keeps_its_momentum),
        cmocka_unit_test(a_ball_bounces),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(a_world_goes_back),
        cmocka_unit_test(what_begins_inside_is_pushed_out_slowly),
    };
    scenes = argc > 1 ? argv[1] : ".";
    int failed = cmocka_run_group_tests(standing, NULL, NULL);
    if (!getenv("PIR_TEST_SECONDS"))
        failed += cmocka_run_group_tests(others, NULL, NULL);
    return failed;
}
