/* SPDX-License-Identifier: MIT */
/*
 * Situations that are known to defeat iterative engines, each with the answer that plain geometry gives: touching,
 * depth exactly 0, thin and tiny boxes, axes that only two edges make, far origins, casts that recede.
 */
#include "support/test.h"

#include <math.h>

#include <pirouette/query.h>

#include "query/box_scene.h"
#include "support/random.h"
#include "support/turning.h"

static void cubes_of_side_two_a_tenth_deep(void **state) {
    (void)state;
    struct scene s = make_scene(cube(2), cube(2), still);
    pir_query_result r = ask_scene(&s, 0, 0, 1.9);
    expect_answer(r, PIR_INSIDE, -0.1, 2);
    assert_true(r.normal.x == 0 && r.normal.y == 0 && r.normal.z == 1);
    clear_scene(&s);
}

static void depth_exactly_zero_is_touching(void **state) {
    (void)state;
    struct scene s = make_scene(cube(2), cube(2), still);
    pir_query_result r = ask_scene(&s, 0.25, -0.5, 2);
    expect_answer(r, PIR_BOUNDARY, 0, 2);
    assert_int_equal(r.outcome, PIR_TOUCHING);
    assert_true(r.normal.z == 1);
    // on an edge and a corner of the difference
    assert_int_equal(ask_scene(&s, 0, 2, 2).state, PIR_BOUNDARY);
    assert_int_equal(ask_scene(&s, 2, 2, 2).state, PIR_BOUNDARY);
    clear_scene(&s);
}

static void thin_boxes_have_their_depth(void **state) {
    (void)state;
    struct scene s =
        make_scene(box(0.46, 0.48, 0.01, (pir_vec3){0, 0, 0}), box(0.0495, 0.146, 0.0725, (pir_vec3){0, 0, 0}), still);
    expect_answer(ask_scene(&s, 0.01, 0.02, 0.03), PIR_INSIDE, -(0.0725 / 2 + 0.005 - 0.03), 0.5);
    expect_answer(ask_scene(&s, 0.01, 0.02, 0.05), PIR_OUTSIDE, 0.05 - 0.0725 / 2 - 0.005, 0.5);
    clear_scene(&s);
}

static void touching_boxes_swept_by_tiny_gaps(void **state) {
    (void)state;
    // two boxes turned alike: in the frame of one of them both stand straight
    struct scene s = make_scene(cube(0.5), cube(0.5), still);
    for (double gap = 1e-16; gap < 2e-6; gap *= 10)
        for (int side = -1; side <= 1; side += 2) {
            double x = 0.5 + side * gap;
            pir_state right = x > 0.5 ? PIR_OUTSIDE : x < 0.5 ? PIR_INSIDE : PIR_BOUNDARY;
            expect_answer(ask_scene(&s, x, 0, 0), right, x - 0.5, 1);
            expect_answer(ask_scene(&s, 0.1, -x, 0.2), right, x - 0.5, 1);
        }
    clear_scene(&s);
}

static void small_boxes_nearly_touching(void **state) {
    (void)state;
    for (double side = 1e-2; side > 0.9e-4; side /= 10) {
        struct scene s = make_scene(cube(side), cube(side), still);
        expect_answer(ask_scene(&s, 0, side + 7.7e-7, 0), PIR_OUTSIDE, (side + 7.7e-7) - side, side);
        clear_scene(&s);
    }
}

static void concentric_boxes_leave_by_the_first_face(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1), cube(1), still);
    pir_query_result first = ask_scene(&s, 0, 0, 0), again = ask_scene(&s, 0, 0, 0);
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
    clear_scene(&s);
}

static void small_box_on_large_slabs(void **state) {
    (void)state;
    for (double side = 1; side <= 100; side *= 10) {
        struct scene s = make_scene(cube(0.1), box(side, side, 0.1, (pir_vec3){0, 0, -0.05}), still);
        expect_answer(ask_scene(&s, 0.3 * side, 0.2 * side, 0.045), PIR_INSIDE, -((0.1 / 2) - 0.045), side);
        expect_answer(ask_scene(&s, 0.3 * side, 0.2 * side, 0.06), PIR_OUTSIDE, 0.06 - 0.05, side);
        clear_scene(&s);
    }
}

static void only_an_edge_edge_axis_separates(void **state) {
    (void)state;
    // P turned by a quarter about (1, 1, 0): an edge of each faces the other along it, P's across and Q's along z
    struct scene s = make_scene(cube(1), cube(1), (pir_quat){1, 1, 0, sqrt(2)});
    pir_query_result r = ask_scene(&s, 1.1, 1.1, 0);
    expect_answer(r, PIR_OUTSIDE, 0.1 * sqrt(2), 1);
    assert_int_equal(r.witness.p.kind, PIR_FEATURE_EDGE);
    assert_int_equal(r.witness.q.kind, PIR_FEATURE_EDGE);
    r = ask_scene(&s, 0.95, 0.95, 0);
    expect_answer(r, PIR_INSIDE, -0.05 * sqrt(2), 1);
    assert_int_equal(r.witness.p.kind, PIR_FEATURE_EDGE);
    assert_int_equal(r.witness.q.kind, PIR_FEATURE_EDGE);
    // one contact: the point where the edges cross
    pir_query_input input = at(0.95, 0.95, 0);
    pir_contact contact;
    size_t count;
    assert_int_equal(pir_query_manifold(s.query, &input, &r, 1, &contact, &count), PIR_OK);
    assert_true(count == 1 && fabs(contact.point_q.x - 0.5) < 1e-12 && fabs(contact.point_q.z) < 1e-12);
    clear_scene(&s);
}

static void small_cube_on_a_large_cubes_diagonal(void **state) {
    (void)state;
    struct scene s = make_scene(cube(0.01), cube(10), still);
    expect_answer(ask_scene(&s, 5.5, 5.5, 5.5), PIR_OUTSIDE, sqrt(3) * (0.5 - 0.005), 10);
    expect_answer(ask_scene(&s, 4.9, 4.9, 4.9), PIR_INSIDE, -0.105, 10);
    clear_scene(&s);
}

static void parallel_edges_give_a_segment_of_contact(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1), cube(1), still);
    pir_query_result r = ask_scene(&s, 1.5, 1.5, 0.25);
    expect_answer(r, PIR_OUTSIDE, sqrt(0.5), 1);
    // face to face: four contacts, the overlap of the two squares
    pir_query_input input = at(0.25, 0.5, 0.9);
    pir_contact contacts[8];
    size_t count;
    r = ask_scene(&s, 0.25, 0.5, 0.9);
    assert_int_equal(pir_query_manifold(s.query, &input, &r, 8, contacts, &count), PIR_OK);
    assert_int_equal(count, 4);
    for (size_t i = 0; i < count; i++) {
        expect(fabs(contacts[i].distance + 0.1) < 1e-12, "contact at %.17g", contacts[i].distance);
        assert_true(contacts[i].point_q.x >= -0.25 - 1e-12 && contacts[i].point_q.x <= 0.5 + 1e-12);
        assert_true(contacts[i].point_q.y >= -1e-12 && contacts[i].point_q.y <= 0.5 + 1e-12);
    }
    clear_scene(&s);
}

static void hulls_of_size_1e_23(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1e-23), cube(3e-23), still);
    expect_answer(ask_scene(&s, 4e-23, 0, 0), PIR_OUTSIDE, 2e-23, 1e-23);
    expect_answer(ask_scene(&s, 1e-23, 0, 0), PIR_INSIDE, -1e-23, 1e-23);
    clear_scene(&s);
}

static void casts_hit_miss_and_recede(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1), cube(1), still);
    pir_impact r;
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
    clear_scene(&s);
}

static void directions_tell_how_far(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1), cube(1), still);
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
    clear_scene(&s);
}

static void a_turning_box_arrives_in_time(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1), cube(1), still);
    test_turning motion = {.rotation = still, .start = {3, 0, 0}, .motion = {-4, 0, 0}, .axis = {0, 0, 1}, .angle = 1};
    pir_impact r;
    assert_int_equal(test_impact(s.query, s.sum, &motion, 1e-9, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_HIT);
    // at contact the nearest corner of P is at x = 1/2: 3 − 4t − (cos t + sin t)/2 = 1/2
    expect(fabs(2.5 - 4 * r.time - 0.5 * (cos(r.time) + sin(r.time))) < 1e-8, "time %.17g", r.time);
    motion.motion = (pir_vec3){4, 0, 0};
    assert_int_equal(test_impact(s.query, s.sum, &motion, 1e-9, &r), PIR_OK);
    assert_int_equal(r.outcome, PIR_CAST_MISS);
    clear_scene(&s);
}

/* A cube that spins about the vertical over a floor which it never nears. */
static void a_spinning_box_that_glides_by_is_a_miss(void **state) {
    (void)state;
    for (int k = 2; k <= 6; k++) {
        struct scene s = make_scene(cube(1), box(40, 40, 2, (pir_vec3){0, 0, -1}), still);
        const double gap = pow(10, -k);
        test_turning motion = {.rotation = still, .start = {0, 0, 0.5 + gap}, .motion = {2, 0, 0}, .axis = {0, 0, 1}};
        pir_impact r;
        for (motion.angle = 0.1; motion.angle < 1000; motion.angle *= 10) {
            assert_int_equal(test_impact(s.query, s.sum, &motion, 1e-7, &r), PIR_OK);
            expect(r.outcome == PIR_CAST_MISS, "gap %g, angle %g: outcome %d", gap, motion.angle, (int)r.outcome);
        }
        clear_scene(&s);
    }
}

/* Faces that touch: what goes away or slides recedes at time 0, what goes on is a hit, what does not move rests. */
static void boxes_that_touch_and_part_recede_at_once(void **state) {
    (void)state;
    struct scene s = make_scene(cube(1), cube(1), still);
    static const struct {
        pir_vec3 start, way;
        pir_cast_outcome outcome;
    } cases[] = {{{1, 0, 0}, {2, 0, 0}, PIR_CAST_RECEDING}, {{1, 0, 0}, {0, 1, 0}, PIR_CAST_RECEDING},
                 {{1, 0, 0}, {-1, 0, 0}, PIR_CAST_HIT},     {{0.9, 0, 0}, {2, 0, 0}, PIR_CAST_START_INSIDE},
                 {{3, 0, 0}, {0, 0, 0}, PIR_CAST_AT_REST},  {{3, 0, 0}, {-1, 0, 0}, PIR_CAST_MISS}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const test_turning motion = {
            .rotation = still, .start = cases[i].start, .motion = cases[i].way, .axis = {0, 0, 1}, .angle = 0};
        pir_impact r;
        assert_int_equal(test_impact(s.query, s.sum, &motion, 1e-9, &r), PIR_OK);
        expect(r.outcome == cases[i].outcome, "case %zu: outcome %d", i, (int)r.outcome);
        expect(r.time == (i < 4 ? 0 : 1), "case %zu: time %g", i, r.time);
        expect(r.steps >= 1 && r.steps < 1000, "case %zu: %u steps", i, r.steps);
    }
    clear_scene(&s);
}

static void the_answer_is_the_same_a_million_away(void **state) {
    (void)state;
    const double away[3] = {0, 1e6, 1e7};
    for (int k = 0; k < 3; k++) {
        struct scene s = make_scene(cube(1), box(1, 1, 1, (pir_vec3){0, away[k], 0}), (pir_quat){0, 0, 1, 3});
        pir_query_result r = ask_scene(&s, 0.5, away[k] + 0.25, 0.125);
        struct scene home = make_scene(cube(1), cube(1), (pir_quat){0, 0, 1, 3});
        pir_query_result right = ask_scene(&home, 0.5, 0.25, 0.125);
        assert_int_equal(r.state, right.state);
        assert_true(r.distance == right.distance);
        clear_scene(&s);
        clear_scene(&home);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubes_of_side_two_a_tenth_deep),
        cmocka_unit_test(depth_exactly_zero_is_touching),
        cmocka_unit_test(thin_boxes_have_their_depth),
        cmocka_unit_test(touching_boxes_swept_by_tiny_gaps),
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
        cmocka_unit_test(a_spinning_box_that_glides_by_is_a_miss),
        cmocka_unit_test(boxes_that_touch_and_part_recede_at_once),
        cmocka_unit_test(the_answer_is_the_same_a_million_away),
    };
    return cmocka_run_group_tests_name("known cases", tests, NULL, NULL);
}
