/* SPDX-License-Identifier: MIT */
/*
 * What holds of every query: nothing allocates after the first, swapping the bodies mirrors the answer, scaling and
 * moving change no state, radii and cutoffs count in their own call only, batches and followed sums answer like single
 * queries on new ones, bad input is a status.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/ccd.h>
#include <pirouette/query.h>

#include "query/box_scene.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/queries.h"

static void radii_and_cutoff_stay_where_they_are_asked(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1), cube(1), still);
    pir_query_input input = at(2, 0, 0);
    pir_query_result r;
    input.radius_p = 0.25;
    input.radius_q = 0.5;
    assert_int_equal(pir_query_signed_distance(s.query, &input, &s.cache, &r), PIR_OK);
    assert_true(r.state == PIR_OUTSIDE && fabs(r.distance - 0.25) < 1e-12 && fabs(r.point_q.x - 1) < 1e-12);
    input.radius_p = 0.75;
    assert_int_equal(pir_query_signed_distance(s.query, &input, &s.cache, &r), PIR_OK);
    assert_true(r.state == PIR_INSIDE && fabs(r.distance + 0.25) < 1e-12);
    expect_answer(ask_scene(&s, 2, 0, 0), PIR_OUTSIDE, 1, 1);
    input = at(2, 0, 0);
    input.cutoff = 0.5;
    assert_int_equal(pir_query_distance(s.query, &input, &s.cache, &r), PIR_OK);
    assert_true(r.outcome == PIR_BEYOND_CUTOFF && r.distance == 0.5);
    clear_scene(&s);
}

static void bad_input_is_a_status(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1), cube(1), still);
    pir_query_input input = at(NAN, 0, 0);
    pir_query_result r;
    pir_impact cast;
    assert_int_equal(pir_query_overlap(s.query, &input, NULL, &r), PIR_ERR_NOT_FINITE);
    input = at(0, 0, 0);
    input.radius_p = -1;
    assert_int_equal(pir_query_distance(s.query, &input, NULL, &r), PIR_ERR_ARGUMENT);
    input = at(0, 0, 0);
    assert_int_equal(pir_query_directional_depth(s.query, &input, (pir_vec3){0, 0, 0}, &r), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_query_cast(s.query, &input, (pir_vec3){INFINITY, 0, 0}, &cast), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_query_overlap(s.query, NULL, NULL, &r), PIR_ERR_ARGUMENT);
    // a cache of anything at all is safe
    pir_query_cache wild;
    memset(&wild, 0xa5, sizeof wild);
    assert_int_equal(pir_query_signed_distance(s.query, &input, &wild, &r), PIR_OK);
    expect_answer(r, PIR_INSIDE, -1, 1);
    assert_true(isnan(pir_query_break_even(-1, 1, 1)));
    assert_true(pir_query_break_even(10, 1, 3) == 5 && pir_query_break_even(10, 3, 1) == HUGE_VAL);
    clear_scene(&s);
}

static void nothing_allocates_after_the_first_query(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    test_random random = test_random_case("allocations", 0);
    pir_polytope *p = test_sphere(&random, 60), *q = test_sphere(&random, 60);
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    options.allocator = &allocator;
    pir_sum *sum;
    pir_query *query;
    assert_int_equal(pir_sum_create(p, q, still, &options, &sum), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    pir_query_cache cache = {0};
    uint64_t before = 0;
    for (int i = 0; i < 400; i++) {
        // the first turn is the warm-up
        if (i == 200)
            before = memory.requests;
        assert_int_equal(
            pir_sum_rotate(sum, (pir_quat){0, 0, sin(0.05 * (i % 200)), cos(0.05 * (i % 200))}, PIR_METHOD_AUTO),
            PIR_OK);
        pir_vec3 d = test_random_direction(&random);
        pir_query_input input = at(d.x * (i % 5), d.y * (i % 5), d.z * (i % 5));
        pir_query_result r;
        pir_contact contacts[64];
        size_t count;
        assert_int_equal(pir_query_signed_distance(query, &input, &cache, &r), PIR_OK);
        assert_int_equal(pir_query_manifold(query, &input, &r, 64, contacts, &count), PIR_OK);
        test_answer answer;
        for (const test_query_kind *kind = test_query_kinds; kind->name; kind++)
            assert_int_equal(kind->ask(&(test_question){query, &input, &cache, d}, &answer), PIR_OK);
        pir_vec3 many[3] = {d, input.translation, {0, 0, 0}};
        double depths[3];
        assert_int_equal(pir_query_batch_depths(query, many, 3, depths, NULL), PIR_OK);
    }
    assert_true(memory.requests == before);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    assert_true(memory.blocks == 0 && !memory.wrong_size);
    pir_polytope_release(p);
    pir_polytope_release(q);
}

static void running_out_of_memory_is_a_status(void **state) {
    (void)state;
    pir_polytope *p = cube(1), *q = cube(2);
    for (uint64_t fail = 1; fail < 200; fail++) {
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_sum_options options = pir_sum_options_default();
        options.difference = true;
        options.allocator = &allocator;
        pir_sum *sum;
        pir_query *query;
        double depth = 0;
        assert_int_equal(pir_sum_create(p, q, still, &options, &sum), PIR_OK);
        memory.fail_at = memory.requests + fail;
        pir_status status = pir_query_create(sum, &query);
        if (status == PIR_OK) {
            // a batch has memory of its own
            pir_vec3 t = {0, 0, 0};
            status = pir_query_batch_depths(query, &t, 1, &depth, NULL);
            pir_query_destroy(query);
        }
        if (status == PIR_OK) {
            assert_true(fabs(depth - 1.5) < 1e-12);
            fail = 200;
        } else {
            assert_int_equal(status, PIR_ERR_MEMORY);
        }
        pir_sum_destroy(sum);
        assert_true(memory.blocks == 0 && !memory.wrong_size);
    }
    pir_polytope_release(p);
    pir_polytope_release(q);
}

/* --- symmetries --- */

static pir_polytope *scaled(const test_points *points, double scale, pir_vec3 offset) {
    test_points moved = *points;
    for (size_t i = 0; i < moved.count; i++)
        moved.at[i] = (pir_vec3){points->at[i].x * scale + offset.x, points->at[i].y * scale + offset.y,
                                 points->at[i].z * scale + offset.z};
    return test_polytope(&moved);
}

/* Small integers, so that moving by an integer is exact. */
static void grid_points(test_random *random, test_points *points) {
    points->count = 9;
    for (size_t i = 0; i < points->count; i++)
        points->at[i] = (pir_vec3){test_random_between(random, -4, 4), test_random_between(random, -4, 4),
                                   test_random_between(random, -4, 4)};
}

static void swapping_scaling_and_moving_change_no_state(void **state) {
    (void)state;
    static const pir_quat turns[4] = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, 1}, {1, 1, 1, 1}};
    for (uint64_t number = 0; number < 400; number++) {
        test_random random = test_random_case("symmetries", number);
        test_points a, b;
        grid_points(&random, &a);
        grid_points(&random, &b);
        // quarter and third turns: R is a matrix of integers, and the inverse pose is exact
        pir_quat r = turns[number % 4], back = {-r.x, -r.y, -r.z, r.w};
        struct scene s = make_scene(scaled(&a, 1, (pir_vec3){0, 0, 0}), scaled(&b, 1, (pir_vec3){0, 0, 0}), r);
        struct scene swapped = make_scene(scaled(&b, 1, (pir_vec3){0, 0, 0}), scaled(&a, 1, (pir_vec3){0, 0, 0}), back);
        double up = number % 2 ? 0x1p20 : 0x1p-20;
        struct scene other = make_scene(scaled(&a, up, (pir_vec3){0, 0, 0}), scaled(&b, up, (pir_vec3){0, 0, 0}), r);
        struct scene moved =
            make_scene(scaled(&a, 1, (pir_vec3){0, 0, 0}), scaled(&b, 1, (pir_vec3){1e7, -3e6, 5e6}), r);
        for (int i = 0; i < 12; i++) {
            double x = test_random_between(&random, -8, 8), y = test_random_between(&random, -8, 8),
                   z = test_random_between(&random, -8, 8);
            // R⁻¹(−t) for turns about z and x by a quarter, and about (1,1,1) by a third
            pir_vec3 inverse = number % 4 == 0   ? (pir_vec3){-x, -y, -z}
                               : number % 4 == 1 ? (pir_vec3){-y, x, -z}
                               : number % 4 == 2 ? (pir_vec3){-x, -z, y}
                                                 : (pir_vec3){-y, -z, -x};
            pir_query_result one = ask_scene(&s, x, y, z), two = ask_scene(&swapped, inverse.x, inverse.y, inverse.z);
            pir_query_result big = ask_scene(&other, x * up, y * up, z * up),
                             far = ask_scene(&moved, x + 1e7, y - 3e6, z + 5e6);
            expect(one.state == two.state && fabs(one.distance - two.distance) <= 1e-12 * 10,
                   "case %llu swapped: %d %.17g, %d %.17g", (unsigned long long)number, (int)one.state, one.distance,
                   (int)two.state, two.distance);
            expect(one.state == big.state && one.distance * up == big.distance, "case %llu scaled",
                   (unsigned long long)number);
            expect(one.state == far.state && fabs(one.distance - far.distance) <= 1e-12 * 10,
                   "case %llu moved: %d %.17g, %d %.17g", (unsigned long long)number, (int)one.state, one.distance,
                   (int)far.state, far.distance);
        }
        clear_scene(&s);
        clear_scene(&swapped);
        clear_scene(&other);
        clear_scene(&moved);
    }
}

static void batches_say_what_single_queries_say(void **state) {
    (void)state;
    test_random random = test_random_case("batches", 0);
    pir_polytope *p = test_sphere(&random, 30), *q = test_sphere(&random, 40);
    struct scene s = make_scene(p, q, (pir_quat){1, 2, 3, 4});
    enum { COUNT = 500 };
    static pir_vec3 t[COUNT];
    static pir_state states[COUNT];
    static double depths[COUNT], distances[COUNT];
    for (int i = 0; i < COUNT; i++)
        t[i] = (pir_vec3){2.5 * test_random_unit(&random), 2.5 * test_random_unit(&random),
                          2.5 * test_random_unit(&random)};
    assert_int_equal(pir_query_batch_states(s.query, t, COUNT, states), PIR_OK);
    assert_int_equal(pir_query_batch_depths(s.query, t, COUNT, depths, NULL), PIR_OK);
    assert_int_equal(pir_query_batch_distances(s.query, t, COUNT, distances, NULL), PIR_OK);
    for (int i = 0; i < COUNT; i++) {
        pir_query_result r = ask_scene(&s, t[i].x, t[i].y, t[i].z);
        assert_int_equal(states[i], r.state);
        assert_true(depths[i] == (r.state == PIR_INSIDE ? -r.distance : 0));
        assert_true(fabs(distances[i] - r.distance) < 1e-12);
        pir_ccd_pair pair = {p, q, {1, 2, 3, 4}, t[i]};
        pir_ccd_outcome outcome;
        double distance;
        pir_status status = pir_ccd_distance(&pair, &outcome, &distance);
        if (status == PIR_ERR_NOT_BUILT || fabs(r.distance) < 1e-6)
            continue;
        assert_int_equal(status, PIR_OK);
        expect(outcome == (r.state == PIR_OUTSIDE ? PIR_CCD_SEPARATED : PIR_CCD_OVERLAPPING) &&
                   fabs(distance - fmax(r.distance, 0)) < 1e-7,
               "supports alone: %d, %.17g not %.17g", (int)outcome, distance, r.distance);
    }
    clear_scene(&s);
}

/* Support functions alone know the same refusals, in a build that has them. */
static void supports_alone_refuse_what_is_no_place(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1), cube(1), still);
    const pir_ccd_pair pairs[] = {{s.p, s.q, still, {NAN, 0, 0}},        {s.p, s.q, still, {0, HUGE_VAL, 0}},
                                  {s.p, s.q, {0, NAN, 0, 1}, {3, 0, 0}}, {s.p, s.q, {0, 0, 0, 0}, {3, 0, 0}},
                                  {NULL, s.q, still, {3, 0, 0}},         {s.p, NULL, still, {3, 0, 0}}};
    const pir_status should[] = {PIR_ERR_NOT_FINITE,      PIR_ERR_NOT_FINITE, PIR_ERR_NOT_FINITE,
                                 PIR_ERR_ZERO_QUATERNION, PIR_ERR_ARGUMENT,   PIR_ERR_ARGUMENT};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        pir_ccd_outcome outcome = PIR_CCD_FAILED;
        double distance = 7;
        pir_status status = pir_ccd_overlap(&pairs[i], &outcome);
        expect(status == should[i] || status == PIR_ERR_NOT_BUILT, "pair %zu: status %d", i, (int)status);
        status = pir_ccd_distance(&pairs[i], &outcome, &distance);
        expect(status == should[i] || status == PIR_ERR_NOT_BUILT, "pair %zu: status %d", i, (int)status);
        assert_true(outcome == PIR_CCD_FAILED && distance == 7);
    }
    clear_scene(&s);
}

/* A query that has followed every step, and one that has seen nothing, agree to the bit. */
static void following_small_steps_is_like_looking_afresh(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 12; number++) {
        test_random random = test_random_case("following", number);
        pir_polytope *p = test_sphere(&random, 12 + 10 * (uint32_t)number), *q = test_sphere(&random, 50);
        struct scene s = make_scene(p, q, still);
        pir_vec3 axis = test_random_direction(&random), t = test_random_direction(&random),
                 drift = test_random_direction(&random);
        pir_quat r = still;
        double deep = 0.2 + 0.15 * (double)(number % 6);
        for (int frame = 0; frame < 300; frame++) {
            double turn = number % 3 == 0 ? 0.002 : 0.0126;
            r = test_compose((pir_quat){axis.x * turn / 2, axis.y * turn / 2, axis.z * turn / 2, 1}, r, 1);
            t = (pir_vec3){t.x + 0.003 * drift.x, t.y + 0.003 * drift.y, t.z + 0.003 * drift.z};
            if (frame % 100 == 99) {
                axis = test_random_direction(&random);
                drift = test_random_direction(&random);
            }
            assert_int_equal(pir_sum_rotate(s.sum, r, PIR_METHOD_AUTO), PIR_OK);
            pir_query *fresh;
            assert_int_equal(pir_query_create(s.sum, &fresh), PIR_OK);
            pir_query_input input = at(deep * t.x, deep * t.y, deep * t.z);
            pir_query_result followed, afresh;
            assert_int_equal(pir_query_penetration(s.query, &input, &s.cache, &followed), PIR_OK);
            assert_int_equal(pir_query_penetration(fresh, &input, NULL, &afresh), PIR_OK);
            expect(followed.state == afresh.state && followed.distance == afresh.distance &&
                       memcmp(&followed.normal, &afresh.normal, sizeof afresh.normal) == 0,
                   "case %llu, frame %d: %.17g and %.17g", (unsigned long long)number, frame, followed.distance,
                   afresh.distance);
            pir_query_destroy(fresh);
        }
        clear_scene(&s);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radii_and_cutoff_stay_where_they_are_asked),
        cmocka_unit_test(bad_input_is_a_status),
        cmocka_unit_test(nothing_allocates_after_the_first_query),
        cmocka_unit_test(running_out_of_memory_is_a_status),
        cmocka_unit_test(swapping_scaling_and_moving_change_no_state),
        cmocka_unit_test(supports_alone_refuse_what_is_no_place),
        cmocka_unit_test(following_small_steps_is_like_looking_afresh),
        cmocka_unit_test(batches_say_what_single_queries_say),
    };
    return cmocka_run_group_tests_name("every query", tests, NULL, NULL);
}
