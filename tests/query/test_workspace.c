/* SPDX-License-Identifier: MIT */
/*
 * Sums and queries that share a workspace: small, without memory of their own for scratch, with the answers that they
 * have alone, and independent of the order in which they and the workspace go.
 */
#include "support/test.h"

#include <string.h>

#include <pirouette/query.h>
#include <pirouette/shape.h>
#include <pirouette/workspace.h>

#include "support/answers.h"
#include "support/bodies.h"
#include "support/memory.h"

/* Whether arrays have gaps between them (base/layout.c). */
#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif
#ifndef SANITIZED
#define SANITIZED 0
#endif

/* --- answers --- */

#define OBJECTS 6

/* A sum and a query in the common workspace, and beside it those of its own. */
struct object {
    pir_polytope *p, *q;
    pir_sum *sum[2];
    pir_query *query[2];
    pir_query_cache cache[2];
};

static void make_object(struct object *object, test_random *random, pir_workspace *workspace) {
    memset(object, 0, sizeof *object);
    object->p = test_random_polytope(random, (test_body)test_random_below(random, TEST_BODY_COUNT), 14);
    object->q = test_random_polytope(random, (test_body)test_random_below(random, TEST_BODY_COUNT), 14);
    pir_quat rotation = test_rotation(random);
    for (int own = 0; own < 2; own++) {
        pir_sum_options options = pir_sum_options_default();
        options.difference = true;
        options.workspace = own ? NULL : workspace;
        assert_int_equal(pir_sum_create(object->p, object->q, rotation, &options, &object->sum[own]), PIR_OK);
        assert_int_equal(pir_query_create(object->sum[own], &object->query[own]), PIR_OK);
    }
}

static void clear_object(struct object *object) {
    for (int own = 0; own < 2; own++) {
        pir_query_destroy(object->query[own]);
        pir_sum_destroy(object->sum[own]);
    }
    pir_polytope_release(object->p);
    pir_polytope_release(object->q);
}

/* A translation of small integers, or half of one: where bodies of integers touch. */
static pir_vec3 grid_vector(test_random *random) {
    double by = test_random_below(random, 2) ? 1 : 0.5;
    return (pir_vec3){by * test_random_between(random, -3, 3), by * test_random_between(random, -3, 3),
                      by * test_random_between(random, -3, 3)};
}

static void ask_both(struct object *object, test_random *random, uint64_t number) {
    pir_query_input input = pir_query_input_default();
    pir_query_result result[2] = {{0}};
    double depth[2][3];
    pir_contact contacts[2][16];
    size_t count[2] = {0, 0};
    input.translation = grid_vector(random);
    const pir_vec3 at[3] = {input.translation, {0, 0, 0}, {0.25, 0.5, 1}};
    bool batch = test_random_below(random, 4) == 0;
    pir_status status[2];
    for (int own = 0; own < 2; own++) {
        status[own] = pir_query_signed_distance(object->query[own], &input, &object->cache[own], &result[own]);
        if (status[own] == PIR_OK)
            pir_query_manifold(object->query[own], &input, &result[own], 16, contacts[own], &count[own]);
        if (batch && status[own] == PIR_OK)
            status[own] = pir_query_batch_distances(object->query[own], at, 3, depth[own], NULL);
    }
    expect(status[0] == status[1], "step %llu: status", (unsigned long long)number);
    if (status[0] != PIR_OK)
        return;
    expect(test_same_result(&result[0], &result[1]), "step %llu: answers differ", (unsigned long long)number);
    expect(count[0] == count[1] && memcmp(contacts[0], contacts[1], count[0] * sizeof *contacts[0]) == 0,
           "step %llu: contacts differ", (unsigned long long)number);
    expect(!batch || memcmp(depth[0], depth[1], sizeof depth[0]) == 0, "step %llu: batches differ",
           (unsigned long long)number);
}

/* Changes both sums alike. */
static void change(struct object *object, test_random *random) {
    pir_quat rotation = test_rotation(random);
    double scale = test_random_between(random, 1, 3);
    pir_vec3 axis = test_random_direction(random);
    uint32_t which = test_random_below(random, 12);
    pir_method method = (pir_method)test_random_below(random, 4);
    for (int own = 0; own < 2; own++) {
        pir_status status = PIR_OK;
        if (which < 8)
            status = pir_sum_rotate(object->sum[own], rotation, method);
        else if (which == 8)
            status = pir_sum_set_scale(object->sum[own], PIR_OPERAND_P, scale);
        else if (which == 9)
            status = pir_sum_set_region(object->sum[own], axis, 1);
        else
            status = pir_sum_clear_region(object->sum[own]);
        assert_int_equal(status, PIR_OK);
    }
    assert_true(pir_sum_same_pairing(object->sum[0], object->sum[1]));
}

static void what_is_shared_changes_no_bit(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 12; i++) {
        test_random random = test_random_case("one workspace", i);
        struct object objects[OBJECTS];
        pir_workspace *workspace;
        assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
        for (int k = 0; k < OBJECTS; k++)
            make_object(&objects[k], &random, workspace);
        for (uint64_t step = 0; step < 300; step++) {
            struct object *object = &objects[test_random_below(&random, OBJECTS)];
            uint32_t what = test_random_below(&random, 20);
            if (what == 0) {
                clear_object(object);
                make_object(object, &random, workspace);
            } else if (what < 6) {
                change(object, &random);
            } else {
                ask_both(object, &random, step);
            }
            if (step % 50 == 0)
                assert_true(pir_sum_is_valid(object->sum[0]));
        }
        // those that are left go on without the caller's workspace
        pir_workspace_destroy(workspace);
        for (int k = 0; k < OBJECTS; k++) {
            change(&objects[k], &random);
            ask_both(&objects[k], &random, 1000);
        }
        for (int k = 0; k < OBJECTS; k++)
            clear_object(&objects[k]);
    }
}

/* --- memory --- */

/* What a sum of a body with itself and a query on it hold after many frames, in a workspace with memory of its own. */
static size_t bytes_in_use(pir_polytope *p, size_t *ret_blocks) {
    test_memory memory = {0}, shared = {0};
    pir_allocator allocator = test_allocator(&memory), scratch = test_allocator(&shared);
    pir_workspace *workspace;
    pir_sum *sum;
    pir_query *query;
    assert_int_equal(pir_workspace_create(&scratch, &workspace), PIR_OK);
    pir_sum_options options = {
        .size = sizeof options, .allocator = &allocator, .difference = true, .workspace = workspace};
    assert_int_equal(pir_sum_create(p, p, (pir_quat){0, 0, 0, 1}, &options, &sum), PIR_OK);
    assert_int_equal(pir_query_create(sum, &query), PIR_OK);
    *ret_blocks = memory.blocks;
    test_random random = test_random_case("bytes", 0);
    pir_quat rotation = {0, 0, 0, 1};
    pir_query_input input = pir_query_input_default();
    pir_query_cache cache = {0};
    for (int frame = 0; frame < 500; frame++) {
        pir_vec3 axis = test_random_direction(&random);
        rotation = test_compose((pir_quat){0.05 * axis.x, 0.05 * axis.y, 0.05 * axis.z, 1}, rotation, 1);
        input.translation = test_random_direction(&random);
        pir_query_result result;
        assert_int_equal(pir_sum_rotate(sum, rotation, PIR_METHOD_AUTO), PIR_OK);
        assert_int_equal(pir_query_signed_distance(query, &input, &cache, &result), PIR_OK);
    }
    size_t bytes = memory.bytes;
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    assert_int_equal(memory.blocks, 0);
    pir_workspace_destroy(workspace);
    assert_true(shared.blocks == 0 && !memory.wrong_size && !shared.wrong_size);
    return bytes;
}

static void objects_in_a_workspace_are_small(void **state) {
    (void)state;
    test_random random = test_random_case("small", 0);
    pir_polytope *cube, *gs4, *hull = test_sphere(&random, 20);
    assert_int_equal(pir_shape_create("cube", NULL, NULL, &cube), PIR_OK);
    assert_int_equal(pir_shape_create("gs4", NULL, NULL, &gs4), PIR_OK);
    struct {
        pir_polytope *p;
        size_t most;
    } bodies[3] = {{cube, 6144}, {hull, 16384}, {gs4, 307200}};
    for (int i = 0; i < 3; i++) {
        size_t blocks, bytes = bytes_in_use(bodies[i].p, &blocks);
        expect(SANITIZED || bytes <= bodies[i].most, "body %d: %zu bytes", i, bytes);
        expect(blocks <= 6, "body %d: %zu blocks", i, blocks);
        pir_polytope_release(bodies[i].p);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_shared_changes_no_bit),
                                       cmocka_unit_test(objects_in_a_workspace_are_small)};
    return cmocka_run_group_tests_name("one workspace", tests, NULL, NULL);
}
