/* SPDX-License-Identifier: MIT */
/*
 * All hits of moving shapes against scenes of one piece each, boxes alone against boxes of vertices, and the caller's
 * rule of which bodies meet against scenes without one.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/scene_file.h>
#include <pirouette/scene_query.h>

#include "scene/crowd.h"
#include "scene/scene_bodies.h"
#include "support/bodies.h"
#include "support/vectors.h"

#define MOST 256

static void new_crowd(crowd *c, uint64_t number) {
    pir_scene_options options = pir_scene_options_default();
    options.margin = number % 2 ? 0.125 : 0;
    crowd_init(c, 5000 + number, 10 + (uint32_t)number % 20, &options);
}

static pir_polytope *random_body(crowd *c) {
    static const test_body kinds[4] = {TEST_SPHERE, TEST_BOX, TEST_SEGMENT, TEST_POINT};
    test_points points;
    test_body_points(&c->random, kinds[test_random_below(&c->random, 4)], 10, &points);
    for (size_t i = 0; i < points.count; i++)
        points.at[i] = test_add(test_zero, points.at[i], 0.25);
    return test_polytope(&points);
}

/* --- all hits of a cast --- */

/* The hit of one piece of a body that is alone in a scene. */
static pir_impact cast_at_one(const crowd_body *body, uint32_t piece, const pir_scene_shape *shape,
                              const pir_motion *motion) {
    pir_scene *scene;
    uint32_t id;
    pir_impact impact;
    pir_body_options one = body->options;
    pir_scene_shape any = *shape;
    one.pieces = &body->piece[piece];
    one.piece_count = 1;
    one.piece_users = NULL;
    any.except = PIR_SCENE_NONE;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    assert_int_equal(pir_scene_add(scene, &one, &id), PIR_OK);
    assert_int_equal(pir_scene_cast(scene, &any, motion, 1e-6, &impact), PIR_OK);
    pir_scene_destroy(scene);
    return impact;
}

/* Holds that a list has what each piece alone gives, in order; gives their number. */
static size_t expect_hits_of_all_pieces(const crowd *c, const pir_scene_shape *shape, const pir_motion *motion,
                                        const pir_impact *hit, size_t count, unsigned long long number) {
    size_t expected = 0;
    for (uint32_t id = 0; id < CROWD_BODIES; id++) {
        const crowd_body *body = crowd_body_of(c, id);
        for (uint32_t k = 0; body && id != shape->except && k < body->options.piece_count; k++) {
            const pir_impact one = cast_at_one(body, k, shape, motion);
            size_t at = 0;
            while (at < count && !(hit[at].body == body->id && hit[at].piece_q == k))
                at++;
            expect((one.body == PIR_SCENE_NONE) == (at == count), "case %llu, body %u, piece %u", number, id, k);
            if (at == count)
                continue;
            expected++;
            expect(hit[at].time == one.time && hit[at].outcome == one.outcome && hit[at].user == body->options.user &&
                       memcmp(&hit[at].point, &one.point, sizeof one.point) == 0,
                   "case %llu, body %u, piece %u: at %a, alone at %a", number, id, k, hit[at].time, one.time);
        }
    }
    return expected;
}

static void casts_tell_all_that_each_piece_alone_gives(void **state) {
    (void)state;
    static crowd c;
    size_t many = 0, inside = 0;
    for (uint64_t n = 0; n < 60; n++) {
        new_crowd(&c, n);
        pir_scene_shape shape = pir_scene_shape_default(random_body(&c));
        const double away = n % 4 ? 1.5 * c.size : 0.25 * c.size, turns[3] = {0, 2, 20};
        shape.pose =
            (pir_pose){test_integer_rotation(&c.random), test_add(test_zero, test_random_direction(&c.random), away)};
        shape.radius = n % 3 ? 0 : 0.125;
        shape.mask = n % 5 ? UINT32_MAX : 3;
        shape.except = n % 2 ? PIR_SCENE_NONE : crowd_body_of(&c, 2)->id;
        const pir_motion motion = {test_add(test_random_direction(&c.random), shape.pose.translation, -2),
                                   test_add(test_zero, test_random_direction(&c.random), turns[n % 3]), 0};
        pir_impact hit[MOST], few[2], first;
        size_t count, again;
        assert_int_equal(pir_scene_cast_all(c.scene, &shape, &motion, 1e-6, MOST, hit, &count), PIR_OK);
        assert_int_equal(expect_hits_of_all_pieces(&c, &shape, &motion, hit, count, n), count);
        for (size_t i = 1; i < count; i++)
            assert_true(hit[i - 1].time <= hit[i].time);
        assert_int_equal(pir_scene_cast(c.scene, &shape, &motion, 1e-6, &first), PIR_OK);
        assert_true(count == 0
                        ? first.body == PIR_SCENE_NONE
                        : first.body == hit[0].body && first.piece_q == hit[0].piece_q && first.time == hit[0].time);
        assert_int_equal(pir_scene_cast_all(c.scene, &shape, &motion, 1e-6, 2, few, &again), PIR_OK);
        assert_int_equal(again, count);
        for (size_t i = 0; i < count && i < 2; i++)
            assert_true(few[i].body == hit[i].body && few[i].piece_q == hit[i].piece_q && few[i].time == hit[i].time);
        many += count > 1;
        inside += count > 0 && hit[0].outcome == PIR_CAST_START_INSIDE;
        pir_polytope_release(shape.polytope);
        crowd_finish(&c);
    }
    assert_true(many > 15 && inside > 0);
}

/* --- boxes alone --- */

/* How far a piece reaches into a box along the axis where it does so least: below 0 where their boxes are apart. */
static double reach_into(const crowd_body *body, uint32_t piece, double around, const double low[3],
                         const double high[3]) {
    const pir_polytope *p = body->piece[piece];
    double least = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        double from = HUGE_VAL, to = -HUGE_VAL;
        for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
            const pir_vec3 x = test_add(body->options.pose.translation,
                                        test_turn(body->options.pose.rotation, pir_polytope_vertex(p, v), 1), 1);
            const double at[3] = {x.x, x.y, x.z};
            from = fmin(from, at[k] - around);
            to = fmax(to, at[k] + around);
        }
        least = fmin(least, fmin(to - low[k], high[k] - from));
    }
    return least;
}

static void boxes_meet_boxes_of_vertices(void **state) {
    (void)state;
    static crowd c;
    size_t told = 0;
    for (uint64_t n = 0; n < 120; n++) {
        new_crowd(&c, n);
        const pir_vec3 middle = test_add(test_zero, test_random_direction(&c.random), 0.5 * c.size),
                       half = {0.1 + 0.01 * (double)n, 0.5, n % 7 ? 0.25 : 0};
        const double low[3] = {middle.x - half.x, middle.y - half.y, n % 5 ? middle.z - half.z : -HUGE_VAL},
                     high[3] = {middle.x + half.x, middle.y + half.y, n % 5 ? middle.z + half.z : HUGE_VAL};
        pir_scene_box box =
            pir_scene_box_default((pir_vec3){low[0], low[1], low[2]}, (pir_vec3){high[0], high[1], high[2]});
        pir_scene_part part[MOST], few[2];
        size_t count, next = 0, again;
        box.mask = n % 3 ? UINT32_MAX : 5;
        box.except = n % 2 ? PIR_SCENE_NONE : crowd_body_of(&c, 1)->id;
        assert_int_equal(pir_scene_in_box(c.scene, &box, MOST, part, &count), PIR_OK);
        for (uint32_t id = 0; id < CROWD_BODIES; id++) {
            const crowd_body *body = crowd_body_of(&c, id);
            const bool counts =
                body && !body->options.sensor && (body->options.category & box.mask) != 0 && body->id != box.except;
            for (uint32_t k = 0; counts && k < body->options.piece_count; k++) {
                const double into = reach_into(body, k, body->options.radius + 0.5 * c.options.margin, low, high);
                const bool is_told = next < count && part[next].body == body->id && part[next].piece == k;
                expect(into > 0 ? is_told : into > -1e-5 || !is_told, "case %llu, body %u, piece %u: %g",
                       (unsigned long long)n, id, k, into);
                assert_true(!is_told || (part[next].user == body->options.user && part[next].piece_user == 100 + k));
                next += is_told;
            }
        }
        expect(next == count, "case %llu: %zu, not %zu", (unsigned long long)n, count, next);
        assert_int_equal(pir_scene_in_box(c.scene, &box, 2, few, &again), PIR_OK);
        assert_int_equal(again, count);
        assert_memory_equal(few, part, (count < 2 ? count : 2) * sizeof *part);
        told += count;
        crowd_finish(&c);
    }
    assert_true(told > 100);
}

static void a_box_of_no_number_is_refused(void **state) {
    (void)state;
    pir_scene *scene;
    pir_scene_options options = pir_scene_options_default();
    pir_report report = {.status = PIR_OK};
    size_t count;
    options.report = &report;
    assert_int_equal(pir_scene_create(&options, &scene), PIR_OK);
    pir_scene_box box = pir_scene_box_default((pir_vec3){0, 0, 0}, (pir_vec3){1, -1, 1});
    assert_int_equal(pir_scene_in_box(scene, &box, 0, NULL, &count), PIR_ERR_ARGUMENT);
    assert_string_equal(report.text, "boxes: in y the low corner is at 0, the high one at -1");
    box.high.y = NAN;
    assert_int_equal(pir_scene_in_box(scene, &box, 0, NULL, &count), PIR_ERR_NOT_FINITE);
    assert_string_equal(report.text, "boxes: y of a corner is not a number");
    assert_int_equal(pir_scene_in_box(scene, NULL, 0, NULL, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_in_box(scene, &box, 0, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_in_box(scene, &box, 1, NULL, &count), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_scene_in_box(NULL, &box, 0, NULL, &count), PIR_ERR_ARGUMENT);
    pir_scene_destroy(scene);
}

static void boxes_find_the_triangles_of_surfaces(void **state) {
    (void)state;
    const float heights[25] = {0, 0.5f, 0, 0, 0.25f};
    const pir_height_samples samples = {heights, PIR_NUMBERS_FLOAT, 5, 5, 1, 1, NULL, NULL};
    pir_body_options ground = pir_body_options_default();
    pir_scene *scene;
    uint32_t id;
    size_t count;
    pir_scene_part part[64];
    assert_int_equal(pir_height_field_create(&samples, NULL, NULL, &ground.field), PIR_OK);
    ground.kind = PIR_BODY_STATIC;
    ground.pose.translation.x = 10;
    assert_int_equal(pir_scene_create(NULL, &scene), PIR_OK);
    assert_int_equal(pir_scene_add(scene, &ground, &id), PIR_OK);
    // the two triangles of the cell at (2, 2), with all that touch it
    pir_scene_box box = pir_scene_box_default((pir_vec3){12.25, 2.25, -1}, (pir_vec3){12.75, 2.75, 1});
    assert_int_equal(pir_scene_in_box(scene, &box, 64, part, &count), PIR_OK);
    assert_int_equal(count, 2);
    assert_true(part[0].body == id && part[0].piece < part[1].piece);
    box.high.z = box.low.z = 2;
    assert_int_equal(pir_scene_in_box(scene, &box, 64, part, &count), PIR_OK);
    assert_int_equal(count, 0);
    box = pir_scene_box_default((pir_vec3){-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, (pir_vec3){HUGE_VAL, HUGE_VAL, HUGE_VAL});
    assert_int_equal(pir_scene_in_box(scene, &box, 64, part, &count), PIR_OK);
    assert_int_equal(count, 32);
    pir_scene_destroy(scene);
    pir_height_field_release(ground.field);
}

/* --- the caller's rule --- */

/* Bodies of one group, by users that are not 0, do not meet; nor does what is `alone`. */
struct rule {
    uint64_t alone, asked;
};

static bool meets(void *context, uint32_t body_p, uint64_t user_p, uint32_t body_q, uint64_t user_q) {
    struct rule *rule = context;
    assert_true(pir_body_number(body_p) < pir_body_number(body_q));
    rule->asked++;
    return (user_p != user_q || user_p == 0) && user_p != rule->alone && user_q != rule->alone;
}

#define BOXES 40

/* Boxes at random in a room, of groups 0 to 4. */
static pir_scene *room_new(test_random *random, const pir_scene_options *options, uint32_t *ret_ids) {
    pir_polytope *cube = scene_cube(0.5);
    pir_scene *scene;
    assert_int_equal(pir_scene_create(options, &scene), PIR_OK);
    for (uint32_t i = 0; i < BOXES; i++) {
        pir_body_options body = pir_body_options_default();
        body.pieces = &cube;
        body.piece_count = 1;
        body.kind = i < 5 ? PIR_BODY_STATIC : PIR_BODY_MOVING;
        body.pose.translation = test_add(test_zero, test_random_direction(random), 2);
        body.user = test_random_below(random, 5);
        assert_int_equal(pir_scene_add(scene, &body, &ret_ids[i]), PIR_OK);
    }
    pir_polytope_release(cube);
    return scene;
}

/* Holds the events of a scene with a rule to those of one without, of which some are left out. */
static size_t expect_rule(pir_scene *with, pir_scene *without, const struct rule *rule, unsigned long long number) {
    size_t all, count, next = 0;
    const pir_scene_event *a = pir_scene_events(with, &count), *b = pir_scene_events(without, &all);
    for (size_t i = 0; i < all; i++) {
        struct rule asked = *rule;
        if (b[i].kind == PIR_EVENT_ENDED || !meets(&asked, b[i].body_p, b[i].user_p, b[i].body_q, b[i].user_q))
            continue;
        while (next < count && a[next].kind == PIR_EVENT_ENDED)
            next++;
        expect(next < count && a[next].body_p == b[i].body_p && a[next].body_q == b[i].body_q &&
                   a[next].distance == b[i].distance && a[next].contact_count == b[i].contact_count,
               "case %llu, event %zu", number, i);
        next++;
    }
    while (next < count && a[next].kind == PIR_EVENT_ENDED)
        next++;
    expect(next == count, "case %llu: %zu events, not %zu", number, count, next);
    return all - count;
}

static void bodies_meet_as_the_caller_says(void **state) {
    (void)state;
    size_t fewer = 0;
    for (uint64_t n = 0; n < 20; n++) {
        struct rule rule = {UINT64_MAX, 0};
        pir_scene_options options = pir_scene_options_default();
        uint32_t a[BOXES], b[BOXES];
        options.threads = n % 2 ? 2 : 1;
        test_random random = test_random_case("rules of scenes", n), again = random;
        pir_scene *without = room_new(&random, &options, b);
        options.meets = meets;
        options.meets_context = &rule;
        pir_scene *with = room_new(&again, &options, a);
        for (int frame = 0; frame < 12; frame++) {
            pir_scene_move move[BOXES];
            for (uint32_t i = 5; i < BOXES; i++)
                move[i - 5] = (pir_scene_move){
                    a[i], {test_integer_rotation(&random), test_add(test_zero, test_random_direction(&random), 1.5)}};
            if (frame == 6) { // the rule changes for two bodies, which are asked about again
                rule.alone = 77;
                for (uint32_t i = 3; i < 8; i += 4) {
                    assert_int_equal(pir_scene_set_user(with, a[i], 77), PIR_OK);
                    assert_int_equal(pir_scene_set_user(without, b[i], 77), PIR_OK);
                    assert_int_equal(pir_scene_set_filter(with, a[i], 1, UINT32_MAX), PIR_OK);
                    assert_int_equal(pir_scene_set_filter(without, b[i], 1, UINT32_MAX), PIR_OK);
                }
            }
            assert_int_equal(pir_scene_update(with, move, BOXES - 5), PIR_OK);
            assert_int_equal(pir_scene_update(without, move, BOXES - 5), PIR_OK);
            fewer += expect_rule(with, without, &rule, n);
        }
        // queries of bodies heed it, those of shapes do not
        pir_scene_near near[MOST];
        size_t count, hits;
        assert_int_equal(pir_scene_closest_pairs(with, 0.25, MOST, near, &count), PIR_OK);
        for (size_t i = 0; i < count; i++)
            assert_true(meets(&rule, near[i].body_p, near[i].user_p, near[i].body_q, near[i].user_q));
        const pir_motion motion = {{-4, 0, 0}, {0, 0, 0}, 0};
        pir_impact impact;
        assert_int_equal(pir_scene_time_of_impact(with, a[7], &motion, 1e-4, &impact), PIR_OK);
        assert_int_equal(impact.body, PIR_SCENE_NONE); // 7 is alone
        pir_scene_shape shape = pir_scene_shape_default(scene_cube(3));
        assert_int_equal(pir_scene_overlap(with, &shape, 0, NULL, &hits), PIR_OK);
        assert_int_equal(hits, BOXES);
        pir_polytope_release(shape.polytope);
        // the state comes back, and with it what meets
        char bytes[65536];
        const size_t size = pir_scene_serialised_size(with);
        assert_true(size <= sizeof bytes);
        assert_int_equal(pir_scene_serialise(with, bytes, size), PIR_OK);
        assert_int_equal(pir_scene_restore(with, bytes, size, NULL), PIR_OK);
        assert_true(rule.asked > 0);
        pir_scene_destroy(with);
        pir_scene_destroy(without);
    }
    assert_true(fewer > 100);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(casts_tell_all_that_each_piece_alone_gives),
        cmocka_unit_test(boxes_meet_boxes_of_vertices),
        cmocka_unit_test(a_box_of_no_number_is_refused),
        cmocka_unit_test(boxes_find_the_triangles_of_surfaces),
        cmocka_unit_test(bodies_meet_as_the_caller_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
