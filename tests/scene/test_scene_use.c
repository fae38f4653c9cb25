/* SPDX-License-Identifier: MIT */
/*
 * Scenes as callers use them: what they refuse, memory that fails and budgets that are too small, after which a scene
 * goes on as it was, no allocation once warm, sensors, cost of bodies that do not move.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <pirouette/scene.h>
#include <pirouette/shape.h>

#include "scene/crowd.h"
#include "scene/scene_bodies.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"

/* --- refusals --- */

static void what_is_no_scene_is_refused(void **state) {
    (void)state;
    pir_scene *scene = NULL;
    const pir_tasks no_tasks = {0};
    pir_scene_options options = pir_scene_options_default();
    assert_int_equal(pir_scene_create(&options, NULL), PIR_ERR_ARGUMENT);
    options.margin = NAN;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_ERR_NOT_FINITE);
    const double margins[2] = {-1, 1};
    const pir_scene_detail details[2] = {PIR_SCENE_MANIFOLDS, PIR_SCENE_STATES};
    for (int i = 0; i < 2; i++) {
        options.margin = margins[i];
        options.detail = details[i];
        assert_int_equal(pir_scene_create(&options, &scene), PIR_ERR_ARGUMENT);
    }
    const uint32_t threads[2] = {0, 65};
    for (int i = 0; i < 2; i++) {
        options = pir_scene_options_default();
        options.threads = threads[i];
        assert_int_equal(pir_scene_create(&options, &scene), PIR_ERR_ARGUMENT);
    }
    options = pir_scene_options_default();
    options.tasks = &no_tasks;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_ERR_ARGUMENT);
    options = pir_scene_options_default();
    options.detail = (pir_scene_detail)7;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_ERR_ARGUMENT);
    options = pir_scene_options_default();
    options.budget = 100;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_ERR_MEMORY);
    assert_null(scene);
    pir_scene_destroy(NULL);
}

static void what_is_no_body_is_refused(void **state) {
    (void)state;
    pir_polytope *p = scene_cube(1), *none = NULL;
    pir_scene *scene;
    uint32_t id = 42;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    pir_body_options good = pir_body_options_default();
    good.pieces = &p;
    good.piece_count = 1;
    struct {
        pir_body_options body;
        pir_status status;
    } cases[10];
    for (int i = 0; i < 10; i++)
        cases[i].body = good, cases[i].status = PIR_ERR_ARGUMENT;
    cases[0].body.pieces = NULL;
    cases[1].body.piece_count = 0;
    cases[2].body.pieces = &none;
    cases[3].body.radius = -1;
    cases[4].body.radius = NAN, cases[4].status = PIR_ERR_NOT_FINITE;
    cases[5].body.kind = (pir_body_kind)5;
    cases[6].body.pose.rotation = (pir_quat){0, 0, 0, 0}, cases[6].status = PIR_ERR_ZERO_QUATERNION;
    cases[7].body.pose.translation.y = INFINITY, cases[7].status = PIR_ERR_NOT_FINITE;
    cases[8].body.pose.translation.y = 0x1p61, cases[8].status = PIR_ERR_LIMIT;
    cases[9].body.radius = 0x1p61, cases[9].status = PIR_ERR_LIMIT;
    for (int i = 0; i < 10; i++) {
        expect(pir_scene_add(scene, &cases[i].body, &id) == cases[i].status, "case %d", i);
        assert_int_equal(id, 42);
    }
    good.piece_count = 4097;
    assert_int_equal(pir_scene_add(scene, &good, &id), PIR_ERR_LIMIT);
    good.piece_count = 1;
    assert_int_equal(pir_scene_add(NULL, &good, &id), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_add(scene, NULL, &id), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_add(scene, &good, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_remove(scene, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_remove(NULL, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_get_statistics(scene).bodies, 0);
    pir_scene_destroy(scene);
    pir_polytope_release(p);
}

static void moves_that_cannot_be_change_nothing(void **state) {
    (void)state;
    pir_polytope *p = scene_cube(1);
    pir_scene *scene;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    uint32_t a = scene_add(scene, p, scene_at(0, 0, 0), PIR_BODY_MOVING),
             wall = scene_add(scene, p, scene_at(1.5, 0, 0), PIR_BODY_STATIC);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    pir_pose zero = {{0, 0, 0, 0}, {0, 0, 0}}, pose;
    struct {
        pir_scene_move moves[2];
        size_t count;
        pir_status status;
    } const cases[7] = {{{{7, scene_at(0, 0, 0)}}, 1, PIR_ERR_ARGUMENT},
                        {{{wall, scene_at(0, 0, 0)}}, 1, PIR_ERR_ARGUMENT},
                        {{{a, scene_at(5, 0, 0)}, {a, scene_at(5, 0, 0)}}, 2, PIR_ERR_ARGUMENT},
                        {{{a, scene_at(5, 0, 0)}, {7, scene_at(5, 0, 0)}}, 2, PIR_ERR_ARGUMENT},
                        {{{a, zero}}, 1, PIR_ERR_ZERO_QUATERNION},
                        {{{a, scene_at(5, NAN, 0)}}, 1, PIR_ERR_NOT_FINITE},
                        {{{a, scene_at(5, 0x1.8p60, 0)}}, 1, PIR_ERR_LIMIT}};
    for (int i = 0; i < 7; i++) {
        size_t count = 42;
        expect(pir_scene_update(scene, cases[i].moves, cases[i].count) == cases[i].status, "case %d", i);
        assert_null(pir_scene_events(scene, &count));
        assert_int_equal(count, 0);
        assert_int_equal(pir_scene_pose(scene, a, &pose), PIR_OK);
        assert_true(pose.translation.x == 0);
    }
    // and the contact persists, as if nothing had been
    pir_scene_move move = {a, scene_at(0.25, 0, 0)};
    size_t count;
    assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
    const pir_scene_event *event = pir_scene_events(scene, &count);
    assert_int_equal(count, 1);
    assert_int_equal(event->kind, PIR_EVENT_PERSISTED);
    assert_int_equal(pir_scene_update(NULL, &move, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_update(scene, NULL, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_pose(scene, 2, &pose), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_pose(scene, a, NULL), PIR_ERR_ARGUMENT);
    pir_scene_destroy(scene);
    pir_polytope_release(p);
}

/* --- a life of one contact --- */

static void a_contact_begins_persists_and_ends(void **state) {
    (void)state;
    pir_polytope *p = scene_cube(1);
    pir_scene_options options = pir_scene_options_default();
    pir_scene *scene;
    options.approach = true;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    uint32_t floor = scene_add(scene, p, scene_at(0, 0, -1), PIR_BODY_STATIC),
             box = scene_add(scene, p, scene_at(0.25, 0, 2), PIR_BODY_MOVING);
    static const double heights[6] = {1.5, 1, 0.75, 1, 1.5, 9};
    static const pir_event_kind kinds[6] = {PIR_EVENT_ENDED,     PIR_EVENT_BEGAN, PIR_EVENT_PERSISTED,
                                            PIR_EVENT_PERSISTED, PIR_EVENT_ENDED, PIR_EVENT_ENDED};
    uint64_t ids[4] = {0};
    for (int i = 0; i < 6; i++) {
        pir_scene_move move = {box, scene_at(0.25, 0, heights[i])};
        size_t count;
        assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
        const pir_scene_event *event = pir_scene_events(scene, &count);
        assert_int_equal(count, i > 0 && i < 5);
        if (count == 0)
            continue;
        assert_int_equal(event->kind, kinds[i]);
        assert_int_equal(event->body_p, floor);
        assert_int_equal(event->body_q, box);
        if (event->kind == PIR_EVENT_ENDED)
            continue;
        assert_int_equal(event->state, i == 2 ? PIR_INSIDE : PIR_BOUNDARY);
        assert_true(event->distance == heights[i] - 1 && event->normal.z == -1);
        assert_true(event->approach == heights[i - 1] - heights[i]);
        assert_true(event->contact_count >= 4);
        for (uint32_t k = 0; k < 4; k++) {
            expect(i == 1 || event->contacts[k].id == ids[k], "update %d, contact %u", i, k);
            ids[k] = event->contacts[k].id;
        }
    }
    pir_scene_destroy(scene);
    pir_polytope_release(p);
}

/* --- memory --- */

/* A crowd's life, and what it was like. */
static pir_status live(const pir_allocator *a, pir_polytope *const p[3], uint64_t *hash) {
    pir_scene_options options = pir_scene_options_default();
    options.allocator = a;
    options.threads = 2;
    pir_scene *scene = NULL;
    pir_status status = pir_scene_create(&options, &scene);
    uint32_t id[6];
    *hash = TEST_HASH_START;
    for (uint32_t i = 0; i < 6 && status == PIR_OK; i++) {
        pir_body_options body = pir_body_options_default();
        body.pieces = p + i % 2;
        body.piece_count = 2;
        body.pose = scene_at(0.75 * i, 0.25 * (i % 3), 0.125 * i);
        status = pir_scene_add(scene, &body, &id[i]);
    }
    for (int step = 0; step < 5 && status == PIR_OK; step++) {
        pir_scene_move moves[6];
        for (uint32_t i = 0; i < 6; i++)
            moves[i] = (pir_scene_move){
                id[i], scene_at(0.75 * i - 0.2 * step * (i % 3), 0.25 * (i % 3), 0.125 * i + 0.1 * step)};
        status = pir_scene_update(scene, moves, 6);
        assert_true(pir_scene_is_valid(scene));
        // what failed once works the next time, and gives what it would have given
        if (status == PIR_ERR_MEMORY && pir_scene_update(scene, moves, 6) == PIR_OK)
            status = PIR_OK;
        *hash = crowd_hash_events(*hash, scene);
    }
    pir_scene_destroy(scene);
    return status;
}

static void memory_that_fails_leaves_the_scene_as_it_was(void **state) {
    (void)state;
    pir_polytope *p[3] = {scene_cube(0.5), scene_cube(0.6), scene_cube(0.7)};
    uint64_t expected, hash;
    assert_int_equal(live(NULL, p, &expected), PIR_OK);
    pir_status status = PIR_ERR_MEMORY;
    uint64_t request = 1, recovered = 0;
    for (bool failed = true; failed; request++) {
        test_memory memory = {.fail_at = request};
        pir_allocator allocator = test_allocator(&memory);
        status = live(&allocator, p, &hash);
        failed = memory.requests >= request;
        expect(memory.blocks == 0 && !memory.wrong_size, "request %llu", (unsigned long long)request);
        expect(status == PIR_ERR_MEMORY || (status == PIR_OK && hash == expected), "request %llu",
               (unsigned long long)request);
        recovered += failed && status == PIR_OK;
    }
    assert_true(request > 40 && recovered > 20);
    for (int i = 0; i < 3; i++)
        pir_polytope_release(p[i]);
}

static void a_budget_is_kept(void **state) {
    (void)state;
    pir_polytope *p = scene_cube(1);
    pir_scene_options options = pir_scene_options_default();
    pir_scene *scene;
    options.budget = 1000000;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    pir_scene_move moves[64];
    uint32_t count = 0, fit = 0;
    pir_status status = PIR_OK;
    size_t events = 0;
    // more and more boxes in one place, until one cannot be added or its pairs do not fit
    while (status == PIR_OK && count < 64) {
        moves[count] = (pir_scene_move){.pose = scene_at(0.01 * count, 0, 0)};
        pir_body_options body = pir_body_options_default();
        body.pieces = &p;
        body.piece_count = 1;
        body.pose = moves[count].pose;
        status = pir_scene_add(scene, &body, &moves[count].body);
        if (status != PIR_OK)
            break;
        status = pir_scene_update(scene, moves, ++count);
        size_t now;
        pir_scene_events(scene, &now);
        events = status == PIR_OK ? now : events;
        fit = status == PIR_OK ? count : fit;
        assert_true(pir_scene_get_statistics(scene).peak <= 1000000);
    }
    assert_int_equal(status, PIR_ERR_MEMORY);
    assert_true(fit > 4 && events == (size_t)fit * (fit - 1) / 2);
    // without the body that was too much it goes on
    size_t now;
    if (count > fit)
        assert_int_equal(pir_scene_remove(scene, moves[fit].body), PIR_OK);
    assert_int_equal(pir_scene_update(scene, moves, fit), PIR_OK);
    const pir_scene_event *event = pir_scene_events(scene, &now);
    assert_int_equal(now, events);
    for (size_t i = 0; i < now; i++)
        assert_int_equal(event[i].kind, PIR_EVENT_PERSISTED);
    pir_scene_destroy(scene);
    pir_polytope_release(p);
}

static void a_scene_that_no_longer_grows_allocates_nothing(void **state) {
    (void)state;
    for (uint32_t threads = 1; threads < 4; threads += 2) {
        static crowd c;
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_scene_options options = pir_scene_options_default();
        options.allocator = &allocator;
        options.threads = threads;
        crowd_init(&c, 77, CROWD_BODIES, &options);
        static pir_scene_move moves[40][CROWD_BODIES];
        size_t count[40];
        for (int i = 0; i < 40; i++) {
            crowd_move(&c, 1);
            memcpy(moves[i], c.move, sizeof c.move);
            count[i] = c.moves;
        }
        uint64_t before = 0;
        for (int round = 0; round < 12; round++) {
            before = memory.requests;
            for (int i = 0; i < 40; i++)
                assert_int_equal(pir_scene_update(c.scene, moves[i], count[i]), PIR_OK);
        }
        expect(threads > 1 || memory.requests == before, "%llu requests",
               (unsigned long long)(memory.requests - before));
        crowd_finish(&c);
        assert_int_equal(memory.blocks, 0);
        assert_false(memory.wrong_size);
    }
}

/* --- what does not move --- */

static void only_moved_bodies_are_looked_at(void **state) {
    (void)state;
    pir_polytope *p = scene_cube(0.5);
    pir_scene *scene;
    uint32_t id[900];
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    for (uint32_t i = 0; i < 900; i++)
        id[i] = scene_add(scene, p, scene_at(i % 30, i / 30, 0), PIR_BODY_MOVING);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    size_t count;
    pir_scene_events(scene, &count);
    // each shares a face, an edge or a corner with up to eight
    assert_int_equal(count, 2 * 29 * 30 + 2 * 29 * 29);
    pir_scene_move move = {id[435], scene_at(15, 14, 0.5)};
    assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
    const pir_scene_event *event = pir_scene_events(scene, &count);
    assert_int_equal(count, 8);
    for (size_t i = 0; i < count; i++)
        assert_true(event[i].kind == PIR_EVENT_PERSISTED && (event[i].body_p == id[435] || event[i].body_q == id[435]));
    assert_int_equal(pir_scene_get_statistics(scene).looked, 8);
    assert_int_equal(pir_scene_get_statistics(scene).bodies, 900);
    assert_int_equal(pir_scene_get_statistics(scene).pieces, 900);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    assert_int_equal(pir_scene_get_statistics(scene).looked, 0);
    pir_scene_destroy(scene);
    pir_polytope_release(p);
}

/* Two octahedra apart whose boxes meet are not asked about again until they have travelled as far as was proven. */
static void bodies_that_are_apart_are_asked_about_once(void **state) {
    (void)state;
    pir_scene *scene = NULL;
    pir_polytope *octahedron = NULL;
    pir_body_options body = pir_body_options_default();
    uint32_t still_one, mover;
    assert_int_equal(pir_shape_create("octahedron", NULL, NULL, &octahedron), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    body.pieces = &octahedron;
    body.piece_count = 1;
    assert_int_equal(pir_scene_add(scene, &body, &still_one), PIR_OK);
    pir_vec3 low, high;
    pir_polytope_bounds(octahedron, &low, &high);
    const double reach = high.x, apart = reach / sqrt(3);
    body.pose.translation = (pir_vec3){1.5 * reach, 1.5 * reach, 0};
    assert_int_equal(pir_scene_add(scene, &body, &mover), PIR_OK);
    assert_int_equal(pir_scene_update(scene, NULL, 0), PIR_OK);
    assert_int_equal(pir_scene_get_statistics(scene).asked, 1);
    uint32_t asked = 0;
    for (int i = 1; i <= 40; i++) {
        // to and fro, so that the bodies stay as far apart
        pir_scene_move move = {mover, body.pose};
        move.pose.translation.z = i % 2 ? 0.05 * apart : 0;
        assert_int_equal(pir_scene_update(scene, &move, 1), PIR_OK);
        asked += pir_scene_get_statistics(scene).asked;
    }
    expect(asked >= 1 && asked <= 10, "asked %u times in 40 moves of a twentieth of the distance", asked);
    pir_scene_destroy(scene);
    pir_polytope_release(octahedron);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_scene_is_refused),
        cmocka_unit_test(what_is_no_body_is_refused),
        cmocka_unit_test(moves_that_cannot_be_change_nothing),
        cmocka_unit_test(a_contact_begins_persists_and_ends),
        cmocka_unit_test(memory_that_fails_leaves_the_scene_as_it_was),
        cmocka_unit_test(a_budget_is_kept),
        cmocka_unit_test(a_scene_that_no_longer_grows_allocates_nothing),
        cmocka_unit_test(only_moved_bodies_are_looked_at),
        cmocka_unit_test(bodies_that_are_apart_are_asked_about_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
