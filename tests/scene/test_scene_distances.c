/* SPDX-License-Identifier: MIT */
/*
 * Distances over a scene, as accurate as is asked for, against the answer for each piece by a pair made for it and, for
 * boxes along the axes, against a formula: the exact distance is always between the bounds, these are as near to each
 * other as was asked for, and which pieces are told does not depend on the accuracy.
 *
 * PIR_TEST_ROOMS in the environment sets the number of scenes.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/scene_query.h>
#include <pirouette/shape.h>

#include "scene/crowd.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/vectors.h"

#define BODIES 40
#define FORMS  4

struct room {
    pir_vec3 middle;
    test_random random;
    pir_scene *scene;
    pir_polytope *form[FORMS];
    pir_coarse *coarse[FORMS];
    pir_body_options body[BODIES];
    uint32_t form_of[BODIES];
    pir_workspace *workspace;
    uint64_t settled[3]; /* how many distances boxes, coarse bodies and the bodies have settled */
};

/* What a distance in doubles may be off: 1e-11 of coordinates. */
static double off_in(const struct room *room) {
    return room->middle.x > 0 ? 1e-11 * 0x1p41 : 1e-9;
}

static pir_pose some_pose(struct room *room, double size) {
    test_random *random = &room->random;
    pir_vec3 at = test_add(room->middle, test_random_direction(random), size * test_random_unit(random));
    return (pir_pose){test_general_rotation(random), at};
}

/* Every fifth is far from the origin. */
static void open_room(struct room *room, uint64_t number) {
    static const char *const names[FORMS] = {"gs4", "gs2", "dodecahedron", "cube"};
    *room = (struct room){.random = test_random_case("distances", number)};
    if (number % 5 == 4)
        room->middle = (pir_vec3){0x1p40, -0x1p36, 3};
    assert_int_equal(pir_scene_create(NULL, &room->scene), PIR_OK);
    assert_int_equal(pir_workspace_create(NULL, &room->workspace), PIR_OK);
    for (int i = 0; i < FORMS; i++) {
        assert_int_equal(pir_shape_create(names[i], NULL, NULL, &room->form[i]), PIR_OK);
        assert_int_equal(pir_coarse_create(room->form[i], &room->coarse[i]), PIR_OK);
    }
    for (uint32_t i = 0; i < BODIES; i++) {
        pir_body_options *body = &room->body[i];
        uint32_t id, form = room->form_of[i] = test_random_below(&room->random, FORMS);
        *body = pir_body_options_default();
        body->pieces = &room->form[form];
        body->piece_count = 1;
        body->coarse = test_random_below(&room->random, 4) ? &room->coarse[form] : NULL;
        body->radius = test_random_below(&room->random, 3) ? 0 : 0.25;
        body->pose = some_pose(room, number % 2 ? 12 : 100);
        assert_int_equal(pir_scene_add(room->scene, body, &id), PIR_OK);
        assert_int_equal(id, i);
    }
}

static void close_room(struct room *room) {
    pir_scene_destroy(room->scene);
    pir_workspace_destroy(room->workspace);
    for (int i = 0; i < FORMS; i++) {
        pir_coarse_release(room->coarse[i]);
        pir_polytope_release(room->form[i]);
    }
}

static pir_query_result exact_answer(const struct room *room, const pir_scene_shape *shape, uint32_t body) {
    pir_pair *pair;
    pir_pair_input input = pir_pair_input_default();
    pir_query_result result;
    input.pose_p = shape->pose;
    input.radius_p = shape->radius;
    input.pose_q = room->body[body].pose;
    input.radius_q = room->body[body].radius;
    assert_int_equal(pir_pair_create(shape->polytope, room->form[room->form_of[body]], NULL, &pair), PIR_OK);
    assert_int_equal(pir_pair_distance(pair, room->workspace, &input, &result), PIR_OK);
    pir_pair_destroy(pair);
    return result;
}

/* One question: each body is told where its distance is within the cutoff, and its distance is between the bounds. */
static void check_distances(struct room *room, const pir_scene_shape *shape, double cutoff, pir_accuracy accuracy) {
    pir_scene_distance told[BODIES];
    size_t count = 0, at = 0;
    const double off = off_in(room);
    assert_int_equal(pir_scene_distances(room->scene, shape, cutoff, accuracy, BODIES, told, &count), PIR_OK);
    for (uint32_t i = 0; i < BODIES; i++) {
        pir_query_result exact = exact_answer(room, shape, i);
        bool within = exact.distance <= cutoff;
        if (fabs(exact.distance - cutoff) > off || cutoff == 0)
            expect(within == (at < count && told[at].body == i), "body %u at %.17g, cutoff %.17g", i, exact.distance,
                   cutoff);
        if (at == count || told[at].body != i)
            continue;
        const pir_scene_distance *d = &told[at++];
        room->settled[d->settled]++;
        expect(d->least <= exact.distance && exact.distance <= d->most, "body %u: %.17g is not in [%.17g, %.17g]", i,
               exact.distance, d->least, d->most);
        expect(d->state == exact.state && d->least >= 0, "body %u: state %d, not %d", i, (int)d->state,
               (int)exact.state);
        double allowed = fmax(accuracy.length, accuracy.part * d->least) + off;
        expect(d->most - d->least <= allowed, "body %u: [%.17g, %.17g] is wider than %g", i, d->least, d->most,
               allowed);
    }
    assert_int_equal(at, count);
}

static void distances_are_within_their_bounds(void **state) {
    (void)state;
    static const pir_accuracy accuracies[] = {{0, 0}, {0.5, 0}, {0.01, 0}, {0, 0.5}, {0, 0.1}, {0, 0.01}, {1e3, 0}};
    uint64_t settled[3] = {0};
    const char *asked = getenv("PIR_TEST_ROOMS");
    uint64_t rooms = asked ? strtoull(asked, NULL, 10) : 6;
    for (uint64_t number = 0; number < rooms; number++) {
        struct room room;
        open_room(&room, number);
        for (int k = 0; k < 14; k++) {
            uint32_t form = test_random_below(&room.random, FORMS);
            pir_scene_shape shape = pir_scene_shape_default(room.form[form]);
            shape.coarse = k % 4 ? room.coarse[form] : NULL;
            shape.radius = k % 5 ? 0 : 0.5;
            shape.pose = some_pose(&room, number % 2 ? 12 : 100);
            double cutoff = k % 3 == 0 ? HUGE_VAL : k % 3 == 1 ? 10 * test_random_unit(&room.random) : 0;
            check_distances(&room, &shape, fabs(cutoff), accuracies[k % 7]);
        }
        for (int i = 0; i < 3; i++)
            settled[i] += room.settled[i];
        close_room(&room);
    }
    expect(settled[0] > 100 && settled[1] > 100 && settled[2] > 100, "settled by boxes %llu, coarse %llu, bodies %llu",
           (unsigned long long)settled[0], (unsigned long long)settled[1], (unsigned long long)settled[2]);
}

/* Where a cutoff lies between bounds, in or on them, the bodies decide: the cutoff is a distance of one of them. */
static void accuracy_does_not_change_what_is_told(void **state) {
    (void)state;
    struct room room;
    open_room(&room, 20);
    pir_scene_shape shape = pir_scene_shape_default(room.form[0]);
    shape.coarse = room.coarse[0];
    for (uint32_t i = 0; i < BODIES; i++) {
        double cutoff = exact_answer(&room, &shape, i).distance;
        pir_scene_distance exact[BODIES], rough[BODIES];
        size_t count, other;
        assert_int_equal(pir_scene_distances(room.scene, &shape, cutoff, (pir_accuracy){0}, BODIES, exact, &count),
                         PIR_OK);
        assert_int_equal(pir_scene_distances(room.scene, &shape, cutoff, (pir_accuracy){1e9, 1}, BODIES, rough, &other),
                         PIR_OK);
        assert_int_equal(count, other);
        bool found = false;
        for (size_t k = 0; k < count; k++) {
            assert_true(exact[k].body == rough[k].body && exact[k].state == rough[k].state);
            found = found || exact[k].body == i;
        }
        assert_true(found);
    }
    close_room(&room);
}

/* The gap between boxes along the axes, one with its corner at `p`, the other at `q`, both of edge 2. */
static double gap(pir_vec3 p, pir_vec3 q) {
    double x = fmax(0, fabs(p.x - q.x) - 2), y = fmax(0, fabs(p.y - q.y) - 2), z = fmax(0, fabs(p.z - q.z) - 2);
    return sqrt(x * x + y * y + z * z);
}

static void boxes_have_the_distance_of_the_formula(void **state) {
    (void)state;
    pir_polytope *box;
    pir_scene *scene;
    pir_vec3 at[BODIES];
    test_random random = test_random_case("boxes", 0);
    assert_int_equal(pir_shape_create("box?x=2&y=2&z=2", NULL, NULL, &box), PIR_OK);
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    for (uint32_t i = 0; i < BODIES; i++) {
        pir_body_options body = pir_body_options_default();
        uint32_t id;
        at[i] = body.pose.translation = test_add(test_zero, test_random_direction(&random), 30);
        body.pieces = &box;
        body.piece_count = 1;
        assert_int_equal(pir_scene_add(scene, &body, &id), PIR_OK);
    }
    for (int k = 0; k < 20; k++) {
        pir_scene_shape shape = pir_scene_shape_default(box);
        pir_scene_distance told[BODIES];
        size_t count;
        shape.pose.translation = test_add(test_zero, test_random_direction(&random), 2 * k);
        pir_accuracy accuracy = {0, k % 2 ? 0.2 : 0};
        assert_int_equal(pir_scene_distances(scene, &shape, HUGE_VAL, accuracy, BODIES, told, &count), PIR_OK);
        assert_int_equal(count, BODIES);
        for (uint32_t i = 0; i < BODIES; i++) {
            double right = gap(shape.pose.translation, at[i]);
            expect(told[i].least <= right && right <= told[i].most, "%.17g is not in [%.17g, %.17g]", right,
                   told[i].least, told[i].most);
        }
    }
    pir_scene_destroy(scene);
    pir_polytope_release(box);
}

static void few_are_the_first_of_all(void **state) {
    (void)state;
    struct room room;
    open_room(&room, 31);
    pir_scene_shape shape = pir_scene_shape_default(room.form[1]);
    pir_scene_distance all[BODIES], few[3];
    size_t count, same;
    const pir_accuracy accuracy = {0, 0.1};
    assert_int_equal(pir_scene_distances(room.scene, &shape, 20, accuracy, BODIES, all, &count), PIR_OK);
    assert_int_equal(pir_scene_distances(room.scene, &shape, 20, accuracy, 3, few, &same), PIR_OK);
    assert_true(count > 3 && count == same);
    for (int i = 0; i < 3; i++)
        assert_true(few[i].body == all[i].body && few[i].least == all[i].least && few[i].most == all[i].most);
    assert_int_equal(pir_scene_distances(room.scene, &shape, 20, accuracy, 0, NULL, &same), PIR_OK);
    assert_int_equal(count, same);
    close_room(&room);
}

static void what_is_wrong_is_refused(void **state) {
    (void)state;
    struct room room;
    open_room(&room, 32);
    pir_scene_shape shape = pir_scene_shape_default(room.form[0]);
    pir_scene_distance told[BODIES];
    size_t count;
    const struct {
        double cutoff;
        pir_accuracy accuracy;
        pir_status status;
    } wrong[] = {{-1, {0, 0}, PIR_ERR_ARGUMENT},    {1, {-1, 0}, PIR_ERR_ARGUMENT},
                 {1, {0, -1}, PIR_ERR_ARGUMENT},    {NAN, {0, 0}, PIR_ERR_NOT_FINITE},
                 {1, {NAN, 0}, PIR_ERR_NOT_FINITE}, {1, {0, NAN}, PIR_ERR_NOT_FINITE}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(
            pir_scene_distances(room.scene, &shape, wrong[i].cutoff, wrong[i].accuracy, BODIES, told, &count),
            wrong[i].status);
    const pir_accuracy none = {0, 0};
    assert_int_equal(pir_scene_distances(NULL, &shape, 1, none, BODIES, told, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_distances(room.scene, NULL, 1, none, BODIES, told, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_distances(room.scene, &shape, 1, none, BODIES, NULL, &count), PIR_ERR_ARGUMENT);
    shape.coarse = room.coarse[1]; // of another polytope
    assert_int_equal(pir_scene_distances(room.scene, &shape, 1, none, BODIES, told, &count), PIR_ERR_ARGUMENT);
    pir_body_options body = room.body[0];
    uint32_t id;
    body.coarse = &room.coarse[(room.form_of[0] + 1) % FORMS];
    assert_int_equal(pir_scene_add(room.scene, &body, &id), PIR_ERR_ARGUMENT);
    close_room(&room);
}

/* Each request fails in turn: of making coarse bodies, and of the question. */
static void memory_that_runs_out_leaves_nothing(void **state) {
    (void)state;
    test_memory memory = {0};
    const pir_allocator allocator = test_allocator(&memory);
    const pir_polytope_options on = {.size = sizeof on, .allocator = &allocator};
    test_random random = test_random_case("memory", 0);
    test_points points = {.count = 40};
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = test_random_direction(&random);
    pir_polytope *body;
    assert_int_equal(pir_polytope_create(points.at, points.count, &on, &body), PIR_OK);
    size_t before = memory.blocks;
    pir_coarse *coarse = NULL;
    pir_status status = PIR_ERR_MEMORY;
    uint64_t tries = 0;
    while (status != PIR_OK && tries < 5000) {
        memory.fail_at = memory.requests + ++tries;
        status = pir_coarse_create(body, &coarse);
        assert_true(status == PIR_OK || (status == PIR_ERR_MEMORY && !coarse));
        // what the polytope keeps for its pairs stays with it
        assert_true(status == PIR_OK || memory.blocks <= before + 8);
    }
    memory.fail_at = 0;
    assert_true(tries > 20 && pir_coarse_count(coarse) == 2);
    assert_ptr_equal(pir_coarse_retain(coarse), coarse);
    pir_coarse_release(coarse);
    assert_true(pir_coarse_get(coarse, 0).error > 0 && pir_coarse_get(coarse, 1).polytope == body);
    assert_int_equal(pir_polytope_vertex_count(pir_coarse_get(coarse, 0).polytope), 8);
    pir_coarse_release(coarse);
    pir_coarse_release(NULL);
    assert_null(pir_coarse_retain(NULL));
    assert_int_equal(pir_coarse_create(NULL, &coarse), PIR_ERR_ARGUMENT);
    pir_polytope_release(body);
    assert_int_equal(memory.blocks, 0);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(distances_are_within_their_bounds),
                                       cmocka_unit_test(accuracy_does_not_change_what_is_told),
                                       cmocka_unit_test(boxes_have_the_distance_of_the_formula),
                                       cmocka_unit_test(few_are_the_first_of_all),
                                       cmocka_unit_test(what_is_wrong_is_refused),
                                       cmocka_unit_test(memory_that_runs_out_leaves_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
