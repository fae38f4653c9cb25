/* SPDX-License-Identifier: MIT */
/*
 * Scenes at the ends of what is allowed: many bodies in one place, huge beside tiny, kinematic through static, bodies
 * that go while their events are read, moves in any order. Events are held to pairs made for the question.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "scene/crowd.h"
#include "scene/scene_bodies.h"
#include "support/bodies.h"
#include "support/meshes.h"

static pir_scene *new_scene(uint32_t threads) {
    pir_scene_options options = pir_scene_options_default();
    pir_scene *scene;
    options.threads = threads;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    return scene;
}

/* The events of the last update, each as a pair made for it says. */
static size_t check_events(const pir_scene *scene, pir_polytope *const *shape) {
    size_t count;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    pir_workspace *workspace;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (size_t i = 0; i < count; i++) {
        if (event[i].kind == PIR_EVENT_ENDED)
            continue;
        pir_pair_input input = pir_pair_input_default();
        pir_query_result result;
        pir_pair *pair;
        assert_int_equal(pir_scene_pose(scene, event[i].body_p, &input.pose_p), PIR_OK);
        assert_int_equal(pir_scene_pose(scene, event[i].body_q, &input.pose_q), PIR_OK);
        assert_int_equal(pir_pair_create(shape[pir_body_number(event[i].body_p)],
                                         shape[pir_body_number(event[i].body_q)], NULL, &pair),
                         PIR_OK);
        assert_int_equal(pir_pair_signed_distance(pair, workspace, &input, &result), PIR_OK);
        expect(result.state == event[i].state && result.distance == event[i].distance &&
                   memcmp(&result.normal, &event[i].normal, sizeof result.normal) == 0,
               "event %zu: %g, %g", i, event[i].distance, result.distance);
        assert_true(event[i].contact_count > 0 && event[i].distance <= 0);
        pir_pair_destroy(pair);
    }
    pir_workspace_destroy(workspace);
    return count;
}

static void many_bodies_in_one_place(void **state) {
    (void)state;
    enum { COUNT = 32 };
    pir_polytope *p = scene_cube(1), *shape[COUNT];
    uint64_t hash[3] = {0};
    for (uint32_t threads = 1; threads < 4; threads++) {
        pir_scene *scene = new_scene(threads);
        pir_scene_move moves[COUNT];
        for (uint32_t i = 0; i < COUNT; i++) {
            moves[i] = (pir_scene_move){scene_add(scene, p, scene_at(0, 0, 0), PIR_BODY_MOVING), scene_at(0, 0, 0)};
            shape[i] = p;
        }
        assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
        assert_int_equal(check_events(scene, shape), COUNT * (COUNT - 1) / 2);
        hash[threads - 1] = crowd_hash_events(TEST_HASH_START, scene);
        assert_int_equal(pir_scene_update(scene, moves, COUNT), PIR_OK);
        assert_int_equal(check_events(scene, shape), COUNT * (COUNT - 1) / 2);
        // all in one row, face to face
        for (uint32_t i = 0; i < COUNT; i++)
            moves[i].pose = scene_at(2. * i, 0, 0);
        assert_int_equal(pir_scene_update(scene, moves, COUNT), PIR_OK);
        size_t count, persisted = 0;
        const pir_scene_event *event = pir_scene_events(scene, &count);
        for (size_t i = 0; i < count; i++)
            persisted += event[i].kind == PIR_EVENT_PERSISTED;
        assert_int_equal(count, COUNT * (COUNT - 1) / 2);
        assert_int_equal(persisted, COUNT - 1);
        assert_true(pir_scene_is_valid(scene));
        hash[threads - 1] = crowd_hash_events(hash[threads - 1], scene);
        pir_scene_destroy(scene);
    }
    assert_true(hash[0] == hash[1] && hash[1] == hash[2]);
    pir_polytope_release(p);
}

static void huge_beside_tiny(void **state) {
    (void)state;
    const double big = 0x1p58, small = 0x1p-60;
    pir_polytope *shape[3] = {scene_cube(big), scene_cube(small), scene_cube(1)};
    pir_scene *scene = new_scene(1);
    uint32_t id[3];
    // a huge one whose face is at z = 0, a tiny one that stands on it, one that is far off
    id[0] = scene_add(scene, shape[0], scene_at(0, 0, -big), PIR_BODY_STATIC);
    id[1] = scene_add(scene, shape[1], scene_at(0.25, 0.5, small), PIR_BODY_MOVING);
    id[2] = scene_add(scene, shape[2], scene_at(big, big, 3), PIR_BODY_MOVING);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    size_t count;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    assert_int_equal(count, 1);
    assert_int_equal(event->state, PIR_BOUNDARY);
    assert_true(event->body_p == id[0] && event->body_q == id[1] && event->normal.z == -1);
    // by the least that can be: apart, and inside
    const double steps[2] = {nextafter(small, 1), nextafter(small, 0)};
    for (int i = 0; i < 2; i++) {
        pir_scene_move move = {id[1], scene_at(0.25, 0.5, steps[i])};
        assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
        event = pir_scene_events(scene, &count);
        assert_int_equal(count, 1);
        assert_int_equal(event->kind, i ? PIR_EVENT_BEGAN : PIR_EVENT_ENDED);
        assert_true(i == 0 || event->state == PIR_INSIDE);
    }
    // beyond what is allowed nothing changes
    pir_scene_move far = {id[2], scene_at(0x1p61, 0, 0)};
    assert_int_equal(pir_scene_update(scene, &far, 1), PIR_ERR_LIMIT);
    pir_pose pose;
    assert_int_equal(pir_scene_pose(scene, id[2], &pose), PIR_OK);
    assert_true(pose.translation.x == big && pir_scene_is_valid(scene));
    pir_scene_destroy(scene);
    for (int i = 0; i < 3; i++)
        pir_polytope_release(shape[i]);
}

static void kinematic_bodies_pass_through_static_ones(void **state) {
    (void)state;
    pir_polytope *p = scene_cube(1);
    pir_scene *scene = new_scene(1);
    uint32_t lift = scene_add(scene, p, scene_at(0, 0, -4), PIR_BODY_KINEMATIC),
             box = scene_add(scene, p, scene_at(0, 0, 2), PIR_BODY_MOVING);
    scene_add(scene, p, scene_at(0, 0, 0), PIR_BODY_STATIC);
    scene_add(scene, p, scene_at(0.5, 0, 0), PIR_BODY_STATIC);
    for (int i = 0; i < 9; i++) {
        pir_scene_move move = {lift, scene_at(0, 0, -4 + i)};
        size_t count;
        assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
        const pir_scene_event *event = pir_scene_events(scene, &count);
        // the box rests on both static ones, which is told once; the lift comes from below
        assert_int_equal(count, i == 0 ? 2 : i >= 4 && i <= 8);
        for (size_t k = 0; k < count; k++)
            assert_true(event[k].body_q == box || event[k].body_p == box);
    }
    pir_scene_destroy(scene);
    pir_polytope_release(p);
}

/* A caller removes bodies while it reads the events that name them. */
static void bodies_may_go_while_events_are_read(void **state) {
    (void)state;
    enum { COUNT = 12 };
    pir_polytope *p = scene_cube(1), *shape[COUNT];
    pir_scene *scene = new_scene(1);
    bool there[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        scene_add(scene, p, scene_at(0.5 * i, 0.25 * i, 0), PIR_BODY_MOVING);
        shape[i] = p;
        there[i] = true;
    }
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    size_t count, removed = 0;
    const pir_scene_event *event = pir_scene_events(scene, &count);
    assert_true(count > COUNT);
    for (size_t i = 0; i < count; i++)
        if (event[i].state == PIR_INSIDE && event[i].contact_count > 0 && there[event[i].body_p] && i % 3 == 0) {
            assert_int_equal(pir_scene_remove(scene, event[i].body_p), PIR_OK);
            assert_int_equal(pir_scene_remove(scene, event[i].body_p), PIR_ERR_ARGUMENT);
            assert_true(pir_scene_is_valid(scene));
            there[event[i].body_p] = false;
            removed++;
        }
    assert_true(removed > 1 && removed < COUNT);
    pir_scene_move moves[COUNT];
    size_t moved = 0;
    for (uint32_t i = COUNT; i-- > 0;) {
        pir_scene_move move = {i, scene_at(0.5 * i, 0.25 * i, 0)};
        assert_int_equal(pir_scene_update(scene, &move, 1), there[i] ? PIR_OK : PIR_ERR_ARGUMENT);
        if (there[i])
            moves[moved++] = move;
    }
    assert_int_equal(pir_scene_update(scene, moves, moved), PIR_OK);
    event = pir_scene_events(scene, &count);
    for (size_t i = 0; i < count; i++)
        assert_true(there[event[i].body_p] && there[event[i].body_q] && event[i].kind == PIR_EVENT_PERSISTED);
    // numbers that are free are given again, the least first, under ids that are new
    for (uint32_t i = 0; i < COUNT; i++)
        if (!there[i])
            assert_int_equal(scene_add(scene, p, scene_at(0.5 * i, 0.25 * i, 0), PIR_BODY_MOVING), i + (1u << 20));
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    assert_true(check_events(scene, shape) > 0 && pir_scene_is_valid(scene));
    pir_scene_destroy(scene);
    pir_polytope_release(p);
}

/* Enough bodies that boxes, looks, questions and events are made by several tasks; all move, or a part of them. */
static void the_order_of_moves_means_nothing(void **state) {
    (void)state;
    enum { COUNT = 240, PART = 150, ROW = 20 };
    static pir_scene_move moves[2][COUNT];
    pir_polytope *p = scene_cube(0.7);
    pir_scene *scene[2] = {new_scene(1), new_scene(4)};
    test_random random = test_random_case("order of moves", 0);
    for (int k = 0; k < 2; k++)
        for (uint32_t i = 0; i < COUNT; i++)
            scene_add(scene[k], p, scene_at(i % ROW, i / ROW, 0), PIR_BODY_MOVING);
    for (int step = 0; step < 6; step++) {
        uint32_t count = step % 2 ? PART : COUNT;
        uint64_t hash[2];
        for (uint32_t i = 0; i < count; i++) {
            double x = test_random_unit(&random), y = test_random_unit(&random);
            moves[0][i] = (pir_scene_move){i, scene_at(i % ROW + 0.5 * x, i / ROW + 0.5 * y, 0)};
            moves[1][count - 1 - i] = moves[0][i];
        }
        for (int k = 0; k < 2; k++) {
            assert_int_equal(pir_scene_update(scene[k], moves[k], count), PIR_OK);
            assert_true(pir_scene_is_valid(scene[k]));
            hash[k] = crowd_hash_events(TEST_HASH_START, scene[k]);
        }
        assert_true(hash[0] == hash[1]);
        assert_int_equal(pir_scene_get_statistics(scene[0]).looked, pir_scene_get_statistics(scene[1]).looked);
        assert_true(pir_scene_get_statistics(scene[0]).looked > 1100);
    }
    pir_scene_destroy(scene[0]);
    pir_scene_destroy(scene[1]);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_bodies_in_one_place),
        cmocka_unit_test(huge_beside_tiny),
        cmocka_unit_test(kinematic_bodies_pass_through_static_ones),
        cmocka_unit_test(bodies_may_go_while_events_are_read),
        cmocka_unit_test(the_order_of_moves_means_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
