/* SPDX-License-Identifier: MIT */
/*
 * Objects that hold others: queries and live meshes hold a sum, locators a map, sums polytopes. They follow the
 * objects that they hold, and keep them in memory, in whatever order objects change and are destroyed.
 *
 * PIR_TEST_PROGRAMS in the environment sets the number of random programs.
 */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/cgm.h>
#include <pirouette/live_mesh.h>
#include <pirouette/query.h>

#include "dymsum/view.h"
#include "query/handle_program.h"
#include "query/query_of.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/sum_bytes.h"
#include "support/turning.h"

#define PROGRAMS      100
#define PROGRAM_BYTES 1500

static const pir_quat still = {0, 0, 0, 1};

static pir_polytope *cube(double half) {
    pir_vec3 points[8];
    pir_polytope *p = NULL;
    for (int i = 0; i < 8; i++)
        points[i] = (pir_vec3){i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half};
    assert_int_equal(pir_polytope_create(points, 8, NULL, &p), PIR_OK);
    return p;
}

/* The difference of two cubes of sides 2 and a query on it. All other references are released. */
static void make_query(const pir_allocator *allocator, pir_sum **ret_sum, pir_query **ret_query) {
    pir_polytope *p = cube(1), *q = cube(1);
    pir_sum_options options = {.size = sizeof options, .allocator = allocator, .difference = true};
    assert_int_equal(pir_sum_create(p, q, still, &options, ret_sum), PIR_OK);
    pir_polytope_release(q);
    pir_polytope_release(p);
    if (ret_query)
        assert_int_equal(pir_query_create(*ret_sum, ret_query), PIR_OK);
}

static double depth_at_middle(pir_query *query) {
    pir_query_input input = pir_query_input_default();
    pir_query_result result;
    assert_int_equal(pir_query_penetration(query, &input, NULL, &result), PIR_OK);
    return -result.distance;
}

static void query_follows_an_operand_that_is_scaled(void **state) {
    (void)state;
    pir_sum *sum;
    pir_query *query;
    make_query(NULL, &sum, NULL);
    // the operand that the query is made from is replaced, and so is the one after it
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 3), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    assert_true(depth_at_middle(query) == 4);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 2), PIR_OK);
    assert_true(depth_at_middle(query) == 3);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_Q, 5), PIR_OK);
    assert_true(depth_at_middle(query) == 7);
    test_query_free(query, sum);
}

static void query_may_outlive_its_sum(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_sum *sum;
    pir_query *query, *other;
    make_query(&allocator, &sum, &query);
    assert_int_equal(pir_query_create(sum, &other), PIR_OK);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 3), PIR_OK);
    pir_sum_destroy(sum);
    assert_true(depth_at_middle(query) == 4);
    pir_query_destroy(query);
    assert_true(depth_at_middle(other) == 4);
    // the query still rotates the sum, which it alone holds now
    const pir_motion motion = {.way = {-8, 0, 0}, .turn = {0, 0, 0.25}};
    pir_query_input input = pir_query_input_default();
    input.translation.x = 8;
    pir_impact hit;
    assert_int_equal(pir_query_time_of_impact(other, &input, &motion, 1e-6, &hit), PIR_OK);
    // P turns by a quarter of a radian over time 1: one of its faces meets a corner of Q, which is smaller
    const double turned = 0.25 * hit.time;
    assert_true(hit.outcome == PIR_CAST_HIT && fabs((7 - 8 * hit.time) * cos(turned) - 3 - sin(turned)) < 1e-5);
    pir_query_destroy(other);
    assert_true(memory.blocks == 0 && !memory.wrong_size);
}

/* A motion's time is safe for the body at its present scale. */
static void advance_reckons_with_the_scale_of_now(void **state) {
    (void)state;
    pir_sum *sum;
    pir_query *query;
    make_query(NULL, &sum, &query);
    assert_true(depth_at_middle(query) == 2);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 16), PIR_OK);
    const test_turning turn = {still, {18, 0, 0}, {0, 0, 0}, {0, 0, 1}, 1};
    pir_impact hit;
    pir_query_result before;
    assert_int_equal(test_impact(query, sum, &turn, 1e-3, &hit), PIR_OK);
    assert_int_equal(hit.outcome, PIR_CAST_HIT);
    // the corner (1, 1) of Q meets the face that is 16 from the middle of P: 17·cos − sin = 16
    double first = acos(16 / sqrt(290)) - atan(1.0 / 17);
    assert_true(hit.time <= first && hit.time > first - 1e-3);
    pir_query_input input = pir_query_input_default();
    input.translation = turn.start;
    assert_int_equal(pir_query_signed_distance(query, &input, NULL, &before), PIR_OK);
    assert_true(before.distance > 0);
    test_query_free(query, sum);
}

static void live_mesh_may_outlive_its_sum(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_sum *sum;
    pir_live_mesh *live;
    make_query(&allocator, &sum, NULL);
    assert_int_equal(pir_live_mesh_create(sum, &live), PIR_OK);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_Q, 4), PIR_OK);
    assert_int_equal(pir_sum_rotate(sum, (pir_quat){1, 2, 3, 4}, PIR_METHOD_AUTO), PIR_OK);
    pir_sum_destroy(sum);
    assert_int_equal(pir_live_mesh_refresh(live), PIR_OK);
    pir_vec3 *vertices = malloc(pir_live_mesh_vertex_slots(live) * sizeof *vertices);
    assert_non_null(vertices);
    pir_live_mesh_vertices(live, vertices);
    for (uint32_t i = 0; i < pir_live_mesh_vertex_slots(live); i++)
        assert_true(fmax(fabs(vertices[i].x), fmax(fabs(vertices[i].y), fabs(vertices[i].z))) > 4);
    free(vertices);
    pir_live_mesh_destroy(live);
    assert_true(memory.blocks == 0 && !memory.wrong_size);
}

static void locator_may_outlive_its_map(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_polytope *p = cube(1);
    pir_cgm *map;
    pir_cgm_locator *locator, *second;
    pir_cgm_location location;
    assert_int_equal(pir_cgm_create(p, NULL, &allocator, &map), PIR_OK);
    assert_int_equal(pir_cgm_locator_create(map, &locator), PIR_OK);
    // a reference more keeps the map for another locator
    assert_ptr_equal(pir_cgm_retain(map), map);
    pir_cgm_release(map);
    assert_int_equal(pir_cgm_locator_create(map, &second), PIR_OK);
    pir_cgm_locator_destroy(second);
    pir_cgm_release(map);
    pir_polytope_release(p);
    assert_int_equal(pir_cgm_locate(locator, (pir_vec3){0.5, 1, 0}, PIR_CGM_NONE, &location), PIR_OK);
    assert_int_equal(location.position, PIR_CGM_BOUNDARY);
    pir_cgm_locator_destroy(locator);
    assert_true(memory.blocks == 0 && !memory.wrong_size);
}

static void sum_that_is_no_difference_is_refused(void **state) {
    (void)state;
    pir_polytope *p = cube(1);
    pir_sum *sum, *difference, *copy;
    pir_query *const before = (pir_query *)&sum, *query = before;
    assert_int_equal(pir_sum_create(p, p, still, NULL, &sum), PIR_OK);
    make_query(NULL, &difference, NULL);
    assert_int_equal(pir_query_create(sum, &query), PIR_ERR_ARGUMENT);
    assert_ptr_equal(query, before);
    // copies and files tell the two apart
    for (int k = 0; k < 2; k++) {
        pir_status expected = k == 0 ? PIR_ERR_ARGUMENT : PIR_OK;
        test_bytes bytes = test_bytes_of(k == 0 ? sum : difference);
        assert_int_equal(pir_sum_restore(bytes.data, bytes.size, NULL, NULL, &copy), PIR_OK);
        assert_int_equal(pir_query_create(copy, &query), expected);
        if (k == 1)
            pir_query_destroy(query);
        pir_sum_destroy(copy);
        free(bytes.data);
        assert_int_equal(pir_sum_clone(k == 0 ? sum : difference, NULL, &copy), PIR_OK);
        assert_int_equal(pir_query_create(copy, &query), expected);
        if (k == 1)
            pir_query_destroy(query);
        pir_sum_destroy(copy);
    }
    pir_sum_destroy(difference);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

/*
 * A scale of few digits needs no memory. One of many digits may, and without that memory the query fails until there
 * is some.
 */
static void scale_needs_no_memory_or_can_wait_for_it(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_sum *sum;
    pir_query *query;
    pir_query_input input = pir_query_input_default();
    pir_query_result result;
    make_query(&allocator, &sum, &query);
    assert_true(depth_at_middle(query) == 2);
    uint64_t requests = memory.requests;
    for (int i = 0; i < 10; i++) {
        // the scaled polytope is the polytope's own allocator's
        assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, i % 3 + 1), PIR_OK);
        assert_true(depth_at_middle(query) == i % 3 + 2);
    }
    assert_true(memory.requests == requests);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 0x1.0000000000001p-1000), PIR_OK);
    for (int attempt = 0; attempt < 3; attempt++) {
        memory.fail_at = memory.requests + 1;
        assert_int_equal(pir_query_penetration(query, &input, NULL, &result), PIR_ERR_MEMORY);
    }
    memory.fail_at = 0;
    assert_true(depth_at_middle(query) == 1);
    test_query_free(query, sum);
    assert_true(memory.blocks == 0 && !memory.wrong_size);
}

/* Bodies too far away for their size are refused as long as they are. */
static void scale_that_is_refused_can_be_taken_back(void **state) {
    (void)state;
    pir_vec3 far[4] = {{1, 1, 1}, {1 + 0x1p-40, 1, 1}, {1, 1 + 0x1p-40, 1}, {1, 1, 1 + 0x1p-40}};
    pir_polytope *p, *q = cube(1);
    pir_sum *sum;
    pir_query *query;
    pir_query_input input = pir_query_input_default();
    pir_query_result before, after;
    assert_int_equal(pir_polytope_create(far, 4, NULL, &p), PIR_OK);
    test_query_make(p, q, still, &sum, &query);
    input.translation = (pir_vec3){-0.75, -1, -1};
    assert_int_equal(pir_query_signed_distance(query, &input, NULL, &before), PIR_OK);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_Q, 0x1p-500), PIR_OK);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 0x1p500), PIR_OK);
    assert_int_equal(pir_query_signed_distance(query, &input, NULL, &after), PIR_OK);
    pir_query_input beyond = input;
    beyond.translation.x = 0x1p1000;
    assert_int_equal(pir_query_signed_distance(query, &beyond, NULL, &after), PIR_ERR_LIMIT);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 1), PIR_OK);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_Q, 1), PIR_OK);
    assert_int_equal(pir_query_signed_distance(query, &input, NULL, &after), PIR_OK);
    assert_true(after.state == before.state && after.distance == before.distance);
    test_query_free(query, sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* Whether the sum's generation has changed since the last call. */
static bool has_changed(const pir_sum *sum, uint64_t *seen) {
    uint64_t before = *seen;
    *seen = pir_sum_generation(sum);
    return *seen != before;
}

static void generation_tells_every_change_and_no_reading(void **state) {
    (void)state;
    pir_sum *sum, *copy;
    pir_query *query;
    pir_mesh *mesh;
    uint64_t seen = 0;
    const pir_vec3 axis = {1, 2, 3};
    make_query(NULL, &sum, &query);
    assert_true(has_changed(sum, &seen));
    for (pir_method method = PIR_METHOD_AUTO; method <= PIR_METHOD_CGM; method++)
        assert_true(pir_sum_rotate(sum, (pir_quat){1, 2, method, 4}, method) == PIR_OK && has_changed(sum, &seen));
    assert_true(pir_sum_rotate_brute_force(sum, still) == PIR_OK && has_changed(sum, &seen));
    assert_true(pir_sum_reset(sum, still) == PIR_OK && has_changed(sum, &seen));
    assert_true(pir_sum_set_scale(sum, PIR_OPERAND_Q, 2) == PIR_OK && has_changed(sum, &seen));
    assert_true(pir_sum_set_region(sum, axis, 1) == PIR_OK && has_changed(sum, &seen));
    assert_true(pir_sum_set_region(sum, axis, 4) == PIR_OK && has_changed(sum, &seen));
    assert_true(pir_sum_set_tolerance(sum, 0.5) == PIR_OK && has_changed(sum, &seen));
    // the pairing stays behind, but what is seen does not
    assert_true(pir_sum_rotate(sum, (pir_quat){0, 0, 0.01, 1}, PIR_METHOD_AUTO) == PIR_OK && has_changed(sum, &seen));
    assert_true(pir_sum_shortfall_bound(sum) > 0);
    assert_true(pir_sum_settle(sum) == PIR_OK && has_changed(sum, &seen));
    assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
    assert_int_equal(pir_sum_clone(sum, NULL, &copy), PIR_OK);
    assert_true(pir_sum_is_valid(sum) && depth_at_middle(query) > 0);
    assert_int_equal(pir_sum_rotate(sum, (pir_quat){0, 0, 0, 0}, PIR_METHOD_AUTO), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, -1), PIR_ERR_ARGUMENT);
    assert_false(has_changed(sum, &seen));
    pir_mesh_destroy(mesh);
    pir_sum_destroy(copy);
    test_query_free(query, sum);
}

static void programs_in_any_order_get_the_answers_of_new_objects(void **state) {
    (void)state;
    const char *asked = getenv("PIR_TEST_PROGRAMS");
    uint64_t programs = asked ? strtoull(asked, NULL, 10) : PROGRAMS;
    for (uint64_t number = 0; number < programs; number++) {
        test_random random = test_random_case("handles", number);
        uint32_t step = 0;
        // no more room than the objects say, so that a read beyond it is caught
        uint8_t *bytes = malloc(PROGRAM_BYTES);
        assert_non_null(bytes);
        for (size_t i = 0; i < PROGRAM_BYTES; i++)
            bytes[i] = (uint8_t)test_random_bits(&random);
        const char *failed = handle_program_run(bytes, PROGRAM_BYTES, &step);
        free(bytes);
        expect(!failed, "program %llu, step %u: %s", (unsigned long long)number, step, failed);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(query_follows_an_operand_that_is_scaled),
        cmocka_unit_test(query_may_outlive_its_sum),
        cmocka_unit_test(advance_reckons_with_the_scale_of_now),
        cmocka_unit_test(live_mesh_may_outlive_its_sum),
        cmocka_unit_test(locator_may_outlive_its_map),
        cmocka_unit_test(sum_that_is_no_difference_is_refused),
        cmocka_unit_test(scale_needs_no_memory_or_can_wait_for_it),
        cmocka_unit_test(scale_that_is_refused_can_be_taken_back),
        cmocka_unit_test(generation_tells_every_change_and_no_reading),
        cmocka_unit_test(programs_in_any_order_get_the_answers_of_new_objects),
    };
    return cmocka_run_group_tests_name("handles", tests, NULL, NULL);
}
