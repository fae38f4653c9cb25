/* SPDX-License-Identifier: MIT */
/*
 * Situations that are known to defeat iterative engines, each with the answer that plain geometry gives: touching,
 * depth exactly 0, thin and tiny boxes, axes that only two edges make, far origins, casts that recede. And what holds
 * of every query: nothing allocates after the first, swapping the bodies mirrors the answer, scaling and moving change
 * no state.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/ccd.h>
#include <pirouette/query.h>

#include "query/query_of.h"
#include "support/bodies.h"
#include "support/memory.h"

static const pir_quat still = {0, 0, 0, 1};

struct scene {
    pir_polytope *p, *q;
    pir_sum *sum;
    pir_query *query;
    pir_query_cache cache;
};

/* The box of full sides x, y, z about `at`. */
static pir_polytope *box(double x, double y, double z, pir_vec3 at) {
    pir_vec3 points[8];
    pir_polytope *p;
    for (int i = 0; i < 8; i++)
        points[i] = (pir_vec3){at.x + (i & 1 ? x : -x) / 2, at.y + (i & 2 ? y : -y) / 2, at.z + (i & 4 ? z : -z) / 2};
    assert_int_equal(pir_polytope_create(points, 8, NULL, &p), PIR_OK);
    return p;
}

static pir_polytope *cube(double side) {
    return box(side, side, side, (pir_vec3){0, 0, 0});
}

/* Takes over the two polytopes. */
static struct scene make(pir_polytope *p, pir_polytope *q, pir_quat rotation) {
    struct scene scene = {.p = p, .q = q};
    test_query_make(p, q, rotation, &scene.sum, &scene.query);
    return scene;
}

static void clear(struct scene *scene) {
    test_query_free(scene->query, scene->sum);
    pir_polytope_release(scene->p);
    pir_polytope_release(scene->q);
}

static pir_query_input at(double x, double y, double z) {
    pir_query_input input = pir_query_input_default();
    input.translation = (pir_vec3){x, y, z};
    return input;
}

static pir_query_result ask(struct scene *scene, double x, double y, double z) {
    pir_query_input input = at(x, y, z);
    pir_query_result r;
    assert_int_equal(pir_query_signed_distance(scene->query, &input, &scene->cache, &r), PIR_OK);
    // the answer's own invariant
    double dx = r.point_p.x - r.point_q.x - r.distance * r.normal.x,
           dy = r.point_p.y - r.point_q.y - r.distance * r.normal.y;
    double dz = r.point_p.z - r.point_q.z - r.distance * r.normal.z;
    double size =
        1 + fabs(x) + fabs(y) + fabs(z) + fabs(r.distance) + fabs(r.point_q.x) + fabs(r.point_q.y) + fabs(r.point_q.z);
    assert_true(sqrt(dx * dx + dy * dy + dz * dz) <= 1e-12 * size);
    assert_true(r.outcome != PIR_STEP_LIMIT);
    return r;
}

static void expect_answer(pir_query_result r, pir_state state, double distance, double size) {
    expect(r.state == state && fabs(r.distance - distance) <= 1e-12 * size, "state %d not %d, distance %.17g not %.17g",
           (int)r.state, (int)state, r.distance, distance);
}

static void cubes_of_side_two_a_tenth_deep(void **state) {
    (void)state;
    struct scene s = make(cube(2), cube(2), still);
    pir_query_result r = ask(&s, 0, 0, 1.9);
    expect_answer(r, PIR_INSIDE, -0.1, 2);
    assert_true(r.normal.x == 0 && r.normal.y == 0 && r.normal.z == 1);
    clear(&s);
}

static void depth_exactly_zero_is_touching(void **state) {
    (void)state;
    struct scene s = make(cube(2), cube(2), still);
    pir_query_result r = ask(&s, 0.25, -0.5, 2);
    expect_answer(r, PIR_BOUNDARY, 0, 2);
    assert_int_equal(r.outcome, PIR_TOUCHING);
    assert_true(r.normal.z == 1);
    // on an edge and a corner of the difference
    assert_int_equal(ask(&s, 0, 2, 2).state, PIR_BOUNDARY);
    assert_int_equal(ask(&s, 2, 2, 2).state, PIR_BOUNDARY);
    clear(&s);
}

static void thin_boxes_have_their_depth(void **state) {
    (void)state;
    struct scene s =
        make(box(0.46, 0.48, 0.01, (pir_vec3){0, 0, 0}), box(0.0495, 0.146, 0.0725, (pir_vec3){0, 0, 0}), still);
    expect_answer(ask(&s, 0.01, 0.02, 0.03), PIR_INSIDE, -(0.0725 / 2 + 0.005 - 0.03), 0.5);
    expect_answer(ask(&s, 0.01, 0.02, 0.05), PIR_OUTSIDE, 0.05 - 0.0725 / 2 - 0.005, 0.5);
    clear(&s);
}

static void kissing_boxes_swept_by_hairs(void **state) {
    (void)state;
    // two boxes turned alike: in the frame of one of them both stand straight
    struct scene s = make(cube(0.5), cube(0.5), still);
    for (double hair = 1e-16; hair < 2e-6; hair *= 10)
        for (int side = -1; side <= 1; side += 2) {
            double x = 0.5 + side * hair;
            pir_state right = x > 0.5 ? PIR_OUTSIDE : x < 0.5 ? PIR_INSIDE : PIR_BOUNDARY;
            expect_answer(ask(&s, x, 0, 0), right, x - 0.5, 1);
            expect_answer(ask(&s, 0.1, -x, 0.2), right, x - 0.5, 1);
        }
    clear(&s);
}

static void small_boxes_nearly_touching(void **state) {
    (void)state;
    for (double side = 1e-2; side > 0.9e-4; side /= 10) {
        struct scene s = make(cube(side), cube(side), still);
        expect_answer(ask(&s, 0, side + 7.7e-7, 0), PIR_OUTSIDE, (side + 7.7e-7) - side, side);
        clear(&s);
    }
}

static void concentric_boxes_leave_by_the_first_face(void **state) {
    (void)state;
    struct scene s = make(cube(1), cube(1), still);
    pir_query_result first = ask(&s, 0, 0, 0), again = ask(&s, 0, 0, 0);
    expect_answer(first, PIR_INSIDE, -1, 1);
    assert_memory_equal(&first.normal, &again.normal, sizeof first.normal);
    // the least faces that hold the two points: a corner of each, for equal faces that cover each other
    assert_int_equal(first.witness.p.kind, PIR_FEATURE_VERTEX);
    assert_int_equal(first.witness.q.kind, PIR_FEATURE_VERTEX);
    // all six, in order
    pir_escape ways[64];
    size_t count;
    pir_query_input input = at(0, 0, 0);
    assert_int_equal(pir_query_escapes(s.query, &input, 0, 64, ways, &count), PIR_OK);
    assert_int_equal(count, 6);
    assert_memory_equal(&ways[0].normal, &first.normal, sizeof first.normal);
    for (size_t i = 0; i < count; i++)
        assert_true(fabs(ways[i].depth - 1) < 1e-12);
    clear(&s);
}

static void small_box_on_large_slabs(void **state) {
    (void)state;
    for (double side = 1; side <= 100; side *= 10) {
        struct scene s = make(cube(0.1), box(side, side, 0.1, (pir_vec3){0, 0, -0.05}), still);
        expect_answer(ask(&s, 0.3 * side, 0.2 * side, 0.045), PIR_INSIDE, -((0.1 / 2) - 0.045), side);
        expect_answer(ask(&s, 0.3 * side, 0.2 * side, 0.06), PIR_OUTSIDE, 0.06 - 0.05, side);
        clear(&s);
    }
}

static void only_an_edge_edge_axis_separates(void **state) {
    (void)state;
    // P turned by a quarter about (1, 1, 0): an edge of each faces the other along it, P's across and Q's along z
    struct scene s = make(cube(1), cube(1), (pir_quat){1, 1, 0, sqrt(2)});
    pir_query_result r = ask(&s, 1.1, 1.1, 0);
    expect_answer(r, PIR_OUTSIDE, 0.1 * sqrt(2), 1);
    assert_int_equal(r.witness.p.kind, PIR_FEATURE_EDGE);
    assert_int_equal(r.witness.q.kind, PIR_FEATURE_EDGE);
    r = ask(&s, 0.95, 0.95, 0);
    expect_answer(r, PIR_INSIDE, -0.05 * sqrt(2), 1);
    assert_int_equal(r.witness.p.kind, PIR_FEATURE_EDGE);
    assert_int_equal(r.witness.q.kind, PIR_FEATURE_EDGE);
    // one contact: the point where the edges cross
    pir_query_input input = at(0.95, 0.95, 0);
    pir_contact contact;
    size_t count;
    assert_int_equal(pir_query_manifold(s.query, &input, &r, 1, &contact, &count), PIR_OK);
    assert_true(count == 1 && fabs(contact.point_q.x - 0.5) < 1e-12 && fabs(contact.point_q.z) < 1e-12);
    clear(&s);
}

static void small_cube_on_a_large_cubes_diagonal(void **state) {
    (void)state;
    struct scene s = make(cube(0.01), cube(10), still);
    expect_answer(ask(&s, 5.5, 5.5, 5.5), PIR_OUTSIDE, sqrt(3) * (0.5 - 0.005), 10);
    expect_answer(ask(&s, 4.9, 4.9, 4.9), PIR_INSIDE, -0.105, 10);
    clear(&s);
}

static void parallel_edges_give_a_segment_of_contact(void **state) {
    (void)state;
    struct scene s = make(cube(1), cube(1), still);
    pir_query_result r = ask(&s, 1.5, 1.5, 0.25);
    expect_answer(r, PIR_OUTSIDE, sqrt(0.5), 1);
    // face to face: four contacts, the overlap of the two squares
    pir_query_input input = at(0.25, 0.5, 0.9);
    pir_contact contacts[8];
    size_t count;
    r = ask(&s, 0.25, 0.5, 0.9);
    assert_int_equal(pir_query_manifold(s.query, &input, &r, 8, contacts, &count), PIR_OK);
    assert_int_equal(count, 4);
    for (size_t i = 0; i < count; i++) {
        expect(fabs(contacts[i].distance + 0.1) < 1e-12, "contact at %.17g", contacts[i].distance);
        assert_true(contacts[i].point_q.x >= -0.25 - 1e-12 && contacts[i].point_q.x <= 0.5 + 1e-12);
        assert_true(contacts[i].point_q.y >= -1e-12 && contacts[i].point_q.y <= 0.5 + 1e-12);
    }
    clear(&s);
}

static void hulls_of_size_1e_23(void **state) {
    (void)state;
    struct scene s = make(cube(1e-23), cube(3e-23), still);
    expect_answer(ask(&s, 4e-23, 0, 0), PIR_OUTSIDE, 2e-23, 1e-23);
    expect_answer(ask(&s, 1e-23, 0, 0), PIR_INSIDE, -1e-23, 1e-23);
    clear(&s);
}

static void casts_hit_miss_and_recede(void **state) {
    (void)state;
    struct scene s = make(cube(1), cube(1), still);
    pir_cast_result r;
    pir_query_input input = at(3, 0, 0);
    assert_int_equal(pir_query_cast(s.query, &input, (pir_vec3){-4, 0, 0}, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_HIT);
    assert_true(fabs(r.time - 0.5) < 1e-12 && r.normal.x == 1);
    assert_int_equal(pir_query_cast(s.query, &input, (pir_vec3){4, 0, 0}, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_MISS);
    assert_int_equal(pir_query_cast(s.query, &input, (pir_vec3){-1.9, 0, 0}, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_MISS);
    assert_int_equal(pir_query_cast(s.query, &input, (pir_vec3){0, 0, 0}, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_AT_REST);
    input = at(1, 0, 0);
    assert_int_equal(pir_query_cast(s.query, &input, (pir_vec3){1, 0, 0}, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_RECEDING);
    assert_int_equal(pir_query_cast(s.query, &input, (pir_vec3){0, 1, 0}, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_RECEDING);
    assert_int_equal(pir_query_cast(s.query, &input, (pir_vec3){-1, 0, 0}, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_HIT);
    assert_true(r.time == 0);
    input = at(0.5, 0, 0);
    assert_int_equal(pir_query_cast(s.query, &input, (pir_vec3){1, 0, 0}, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_START_INSIDE);
    clear(&s);
}

static void directions_tell_how_far(void **state) {
    (void)state;
    struct scene s = make(cube(1), cube(1), still);
    pir_query_result r;
    pir_query_input input = at(0.25, 0, 0);
    assert_int_equal(pir_query_directional_depth(s.query, &input, (pir_vec3){0, 0, 5}, &r), PIR_OK);
    assert_true(fabs(r.distance + 1) < 1e-12);
    assert_int_equal(pir_query_directional_depth(s.query, &input, (pir_vec3){-2, 0, 0}, &r), PIR_OK);
    assert_true(fabs(r.distance + 1.25) < 1e-12);
    input = at(3, 0.5, 0);
    assert_int_equal(pir_query_directional_distance(s.query, &input, (pir_vec3){-1, 0, 0}, &r), PIR_OK);
    assert_true(r.outcome == PIR_SEPARATED && fabs(r.distance - 2) < 1e-12);
    assert_int_equal(pir_query_directional_distance(s.query, &input, (pir_vec3){1, 0, 0}, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_NO_HIT);
    assert_int_equal(pir_query_largest_distance(s.query, &input, &r), PIR_OK);
    assert_true(fabs(r.distance - sqrt(16 + 1.5 * 1.5 + 1)) < 1e-12);
    clear(&s);
}

static void a_turning_box_arrives_in_time(void **state) {
    (void)state;
    struct scene s = make(cube(1), cube(1), still);
    pir_motion motion = {.rotation = still, .start = {3, 0, 0}, .motion = {-4, 0, 0}, .axis = {0, 0, 1}, .angle = 1};
    pir_cast_result r;
    assert_int_equal(pir_query_advance(s.query, &motion, 1e-9, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_HIT);
    // at contact the nearest corner of P is at x = 1/2: 3 − 4t − (cos t + sin t)/2 = 1/2
    expect(fabs(2.5 - 4 * r.time - 0.5 * (cos(r.time) + sin(r.time))) < 1e-8, "time %.17g", r.time);
    motion.motion = (pir_vec3){4, 0, 0};
    assert_int_equal(pir_query_advance(s.query, &motion, 1e-9, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_MISS);
    clear(&s);
}

static void the_answer_is_the_same_a_million_away(void **state) {
    (void)state;
    const double away[3] = {0, 1e6, 1e7};
    for (int k = 0; k < 3; k++) {
        struct scene s = make(cube(1), box(1, 1, 1, (pir_vec3){0, away[k], 0}), (pir_quat){0, 0, 1, 3});
        pir_query_result r = ask(&s, 0.5, away[k] + 0.25, 0.125);
        struct scene home = make(cube(1), cube(1), (pir_quat){0, 0, 1, 3});
        pir_query_result right = ask(&home, 0.5, 0.25, 0.125);
        assert_int_equal(r.state, right.state);
        assert_true(r.distance == right.distance);
        clear(&s);
        clear(&home);
    }
}

static void radii_and_cutoff_stay_where_they_are_asked(void **state) {
    (void)state;
    struct scene s = make(cube(1), cube(1), still);
    pir_query_input input = at(2, 0, 0);
    pir_query_result r;
    input.radius_p = 0.25;
    input.radius_q = 0.5;
    assert_int_equal(pir_query_signed_distance(s.query, &input, &s.cache, &r), PIR_OK);
    assert_true(r.state == PIR_OUTSIDE && fabs(r.distance - 0.25) < 1e-12 && fabs(r.point_q.x - 1) < 1e-12);
    input.radius_p = 0.75;
    assert_int_equal(pir_query_signed_distance(s.query, &input, &s.cache, &r), PIR_OK);
    assert_true(r.state == PIR_INSIDE && fabs(r.distance + 0.25) < 1e-12);
    expect_answer(ask(&s, 2, 0, 0), PIR_OUTSIDE, 1, 1);
    input = at(2, 0, 0);
    input.cutoff = 0.5;
    assert_int_equal(pir_query_distance(s.query, &input, &s.cache, &r), PIR_OK);
    assert_true(r.outcome == PIR_BEYOND_CUTOFF && r.distance == 0.5);
    clear(&s);
}

static void bad_input_is_a_status(void **state) {
    (void)state;
    struct scene s = make(cube(1), cube(1), still);
    pir_query_input input = at(NAN, 0, 0);
    pir_query_result r;
    pir_cast_result cast;
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
    clear(&s);
}

static void nothing_allocates_after_the_first_query(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    test_random random = test_random_case("allocations", 0);
    pir_polytope *p = test_sphere(&random, 60), *q = test_sphere(&random, 60);
    pir_sum_options options = pir_sum_options_default();
    options.difference = 1;
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
        assert_int_equal(pir_query_overlap(query, &input, &cache, &r), PIR_OK);
        assert_int_equal(pir_query_penetration(query, &input, &cache, &r), PIR_OK);
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
        options.difference = 1;
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
        struct scene s = make(scaled(&a, 1, (pir_vec3){0, 0, 0}), scaled(&b, 1, (pir_vec3){0, 0, 0}), r);
        struct scene swapped = make(scaled(&b, 1, (pir_vec3){0, 0, 0}), scaled(&a, 1, (pir_vec3){0, 0, 0}), back);
        double up = number % 2 ? 0x1p20 : 0x1p-20;
        struct scene other = make(scaled(&a, up, (pir_vec3){0, 0, 0}), scaled(&b, up, (pir_vec3){0, 0, 0}), r);
        struct scene moved = make(scaled(&a, 1, (pir_vec3){0, 0, 0}), scaled(&b, 1, (pir_vec3){1e7, -3e6, 5e6}), r);
        for (int i = 0; i < 12; i++) {
            double x = test_random_between(&random, -8, 8), y = test_random_between(&random, -8, 8),
                   z = test_random_between(&random, -8, 8);
            // R⁻¹(−t) for turns about z and x by a quarter, and about (1,1,1) by a third
            pir_vec3 inverse = number % 4 == 0   ? (pir_vec3){-x, -y, -z}
                               : number % 4 == 1 ? (pir_vec3){-y, x, -z}
                               : number % 4 == 2 ? (pir_vec3){-x, -z, y}
                                                 : (pir_vec3){-y, -z, -x};
            pir_query_result one = ask(&s, x, y, z), two = ask(&swapped, inverse.x, inverse.y, inverse.z);
            pir_query_result big = ask(&other, x * up, y * up, z * up), far = ask(&moved, x + 1e7, y - 3e6, z + 5e6);
            expect(one.state == two.state && fabs(one.distance - two.distance) <= 1e-12 * 10,
                   "case %llu swapped: %d %.17g, %d %.17g", (unsigned long long)number, (int)one.state, one.distance,
                   (int)two.state, two.distance);
            expect(one.state == big.state && one.distance * up == big.distance, "case %llu scaled",
                   (unsigned long long)number);
            expect(one.state == far.state && fabs(one.distance - far.distance) <= 1e-12 * 10,
                   "case %llu moved: %d %.17g, %d %.17g", (unsigned long long)number, (int)one.state, one.distance,
                   (int)far.state, far.distance);
        }
        clear(&s);
        clear(&swapped);
        clear(&other);
        clear(&moved);
    }
}

static void batches_say_what_single_queries_say(void **state) {
    (void)state;
    test_random random = test_random_case("batches", 0);
    pir_polytope *p = test_sphere(&random, 30), *q = test_sphere(&random, 40);
    struct scene s = make(p, q, (pir_quat){1, 2, 3, 4});
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
        pir_query_result r = ask(&s, t[i].x, t[i].y, t[i].z);
        assert_int_equal(states[i], r.state);
        assert_true(depths[i] == (r.state == PIR_INSIDE ? -r.distance : 0));
        assert_true(fabs(distances[i] - r.distance) < 1e-12);
        pir_ccd_pair pair = {p, q, {1, 2, 3, 4}, t[i]};
        pir_ccd_outcome outcome;
        double distance;
        pir_status status = pir_ccd_distance(&pair, &outcome, &distance);
        if (status == PIR_ERR_UNSUPPORTED || fabs(r.distance) < 1e-6)
            continue;
        assert_int_equal(status, PIR_OK);
        expect(outcome == (r.state == PIR_OUTSIDE ? PIR_CCD_SEPARATED : PIR_CCD_OVERLAPPING) &&
                   fabs(distance - fmax(r.distance, 0)) < 1e-7,
               "supports alone: %d, %.17g not %.17g", (int)outcome, distance, r.distance);
    }
    clear(&s);
}

/* A query that has followed every step, and one that has seen nothing, agree to the bit. */
static void following_small_steps_is_like_looking_afresh(void **state) {
    (void)state;
    for (uint64_t number = 0; number < 12; number++) {
        test_random random = test_random_case("following", number);
        pir_polytope *p = test_sphere(&random, 12 + 10 * (uint32_t)number), *q = test_sphere(&random, 50);
        struct scene s = make(p, q, still);
        pir_vec3 axis = test_random_direction(&random), t = test_random_direction(&random),
                 drift = test_random_direction(&random);
        pir_quat r = still;
        double deep = 0.2 + 0.15 * (double)(number % 6);
        for (int frame = 0; frame < 300; frame++) {
            double turn = number % 3 == 0 ? 0.002 : 0.0126;
            r = test_compose((pir_quat){axis.x * turn / 2, axis.y * turn / 2, axis.z * turn / 2, 1}, r, 1);
            t = (pir_vec3){t.x + 0.003 * drift.x, t.y + 0.003 * drift.y, t.z + 0.003 * drift.z};
            if (frame % 100 == 99)
                axis = test_random_direction(&random), drift = test_random_direction(&random);
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
        clear(&s);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_of_side_two_a_tenth_deep),
        cmocka_unit_test(depth_exactly_zero_is_touching),
        cmocka_unit_test(thin_boxes_have_their_depth),
        cmocka_unit_test(kissing_boxes_swept_by_hairs),
        cmocka_unit_test(small_boxes_nearly_touching),
        cmocka_unit_test(concentric_boxes_leave_by_the_first_face),
        cmocka_unit_test(small_box_on_large_slabs),
        cmocka_unit_test(only_an_edge_edge_axis_separates),
        cmocka_unit_test(small_cube_on_a_large_cubes_diagonal),
        cmocka_unit_test(parallel_edges_give_a_segment_of_contact),
        cmocka_unit_test(hulls_of_size_1e_23),
        cmocka_unit_test(casts_hit_miss_and_recede),
        cmocka_unit_test(directions_tell_how_far),
        cmocka_unit_test(a_turning_box_arrives_in_time),
        cmocka_unit_test(the_answer_is_the_same_a_million_away),
        cmocka_unit_test(radii_and_cutoff_stay_where_they_are_asked),
        cmocka_unit_test(bad_input_is_a_status),
        cmocka_unit_test(nothing_allocates_after_the_first_query),
        cmocka_unit_test(running_out_of_memory_is_a_status),
        cmocka_unit_test(swapping_scaling_and_moving_change_no_state),
        cmocka_unit_test(following_small_steps_is_like_looking_afresh),
        cmocka_unit_test(batches_say_what_single_queries_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
