/* SPDX-License-Identifier: MIT */
/*
 * Memory that runs out at every n-th request, for n = 1, 2, … until nothing fails: each failing call says so, leaves
 * its result untouched and its sum whole at the rotation before, and nothing leaks.
 */
#include "support/test.h"

#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/exact.h>

#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"

/* What one run makes, and how far it comes. */
struct run {
    const test_pose *pose;
    int difference;
    test_memory memory;
    pir_allocator allocator;
    uint32_t failures;
};

/* Whether a call failed for want of memory; any other failure fails the test. */
static int ran_out(struct run *run, pir_status status) {
    if (status == PIR_OK)
        return 0;
    assert_int_equal(status, PIR_ERR_MEMORY);
    run->failures++;
    return 1;
}

static pir_polytope *try_polytope(struct run *run, const test_points *points) {
    pir_polytope *const before = (pir_polytope *)&before;
    pir_polytope *polytope = before;
    const pir_polytope_options options = {sizeof options, &run->allocator, 0};
    if (!ran_out(run, pir_polytope_create(points->at, points->count, &options, &polytope)))
        return polytope;
    assert_ptr_equal(polytope, before);
    return NULL;
}

static void try_mesh(struct run *run, pir_sum *sum, pir_precision precision) {
    pir_mesh *const before = (pir_mesh *)&before;
    pir_mesh *mesh = before;
    if (ran_out(run, pir_sum_mesh(sum, precision, &mesh)))
        assert_ptr_equal(mesh, before);
    else
        pir_mesh_destroy(mesh);
}

/* Whether the sum is what a fresh one, made with plenty of memory, is at `rotation`. */
static void expect_whole(struct run *run, pir_sum *sum, pir_quat rotation) {
    pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = false};
    pir_sum *fresh = NULL;
    pir_quat now = pir_sum_rotation(sum);
    assert_memory_equal(&now, &rotation, sizeof now);
    assert_int_equal(
        pir_sum_create((pir_polytope *)pir_sum_p(sum), (pir_polytope *)pir_sum_q(sum), rotation, &options, &fresh),
        PIR_OK);
    expect(pir_sum_same_pairing(sum, fresh), "%s, failure at request %llu", run->pose->situation,
           (unsigned long long)run->memory.fail_at);
    assert_true(pir_sum_is_valid(sum));
    pir_sum_destroy(fresh);
}

/* Rotations by every method; after one that failed the sum must be where it was. */
static void try_rotations(struct run *run, pir_sum *sum) {
    test_random random = test_random_case("allocation rotations", 0);
    pir_quat there = run->pose->rotation;
    for (int i = 0; i < 12; i++) {
        // from the fourth to the eighth with a region
        if (i == 3 || i == 8) {
            pir_vec3 axis;
            double half_angle;
            pir_status set = pir_sum_set_region(sum, test_random_direction(&random), i == 3 ? 0.7 : 4);
            assert_int_equal(pir_sum_region(sum, &axis, &half_angle), (set == PIR_OK) == (i == 3));
            if (ran_out(run, set))
                expect_whole(run, sum, there);
        }
        pir_quat next = i % 2 ? test_integer_rotation(&random) : test_general_rotation(&random);
        pir_status status =
            i % 4 == 3 ? pir_sum_rotate_brute_force(sum, next) : pir_sum_rotate(sum, next, (pir_method)(i % 3));
        if (!ran_out(run, status))
            there = next;
        if (status != PIR_OK || i == 11)
            expect_whole(run, sum, there);
        // a mesh of what the region leaves out too
        if (i == 5)
            try_mesh(run, sum, PIR_DOUBLE);
    }
}

static void try_all(struct run *run) {
    pir_sum *const before = (pir_sum *)&before;
    pir_mesh *const mesh_before = (pir_mesh *)&mesh_before;
    pir_sum_options options = {.size = sizeof options, .allocator = &run->allocator, .difference = run->difference};
    pir_polytope *p = try_polytope(run, &run->pose->p), *q = try_polytope(run, &run->pose->q);
    if (p && q) {
        pir_sum *sum = before;
        pir_mesh *mesh = mesh_before;
        if (ran_out(run, pir_sum_create(p, q, run->pose->rotation, &options, &sum))) {
            assert_ptr_equal(sum, before);
        } else {
            try_rotations(run, sum);
            try_mesh(run, sum, PIR_DOUBLE);
            try_mesh(run, sum, PIR_EXACT);
            pir_sum_destroy(sum);
        }
        if (ran_out(run, pir_hull_sum(p, q, run->pose->rotation, &options, PIR_EXACT, &mesh)))
            assert_ptr_equal(mesh, mesh_before);
        else
            pir_mesh_destroy(mesh);
        mesh = mesh_before;
        if (ran_out(run, pir_object_sum(p, q, run->pose->rotation, &options, PIR_EXACT, &mesh)))
            assert_ptr_equal(mesh, mesh_before);
        else
            pir_mesh_destroy(mesh);
        mesh = mesh_before;
        if (ran_out(run, pir_mesh_from_polytope(p, &mesh)))
            assert_ptr_equal(mesh, mesh_before);
        else
            pir_mesh_destroy(mesh);
    }
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void expect_balance(const test_memory *memory, const char *situation) {
    expect(memory->blocks == 0 && memory->bytes == 0, "%s, failure at request %llu: %zu blocks, %zu bytes left",
           situation, (unsigned long long)memory->fail_at, memory->blocks, memory->bytes);
    expect(!memory->wrong_size, "%s, failure at request %llu", situation, (unsigned long long)memory->fail_at);
}

static void every_failing_request_is_survived(void **state) {
    (void)state;
    uint64_t failed = 0;
    for (uint64_t i = 0; i < 10; i++) {
        test_random random = test_random_case("allocation", i);
        test_pose pose;
        test_random_pose(&random, i == 0 ? 40 : 8, &pose);
        if (i == 0) {
            // large enough for the list of crossings to grow while it turns
            test_body_points(&random, TEST_BOX, 8, &pose.q);
            pose.situation = "a box and a sphere";
        }
        for (int persistent = 0; persistent < 2; persistent++)
            for (uint64_t n = 1;; n++) {
                struct run run = {
                    .pose = &pose, .difference = i % 2, .memory = {.fail_at = n, .fail_after = persistent != 0}};
                run.allocator = test_allocator(&run.memory);
                try_all(&run);
                expect_balance(&run.memory, pose.situation);
                failed += run.failures;
                if (run.memory.requests < n) {
                    assert_int_equal(run.failures, 0);
                    break;
                }
                assert_true(run.failures > 0);
            }
    }
    print_message("# %llu calls failed\n", (unsigned long long)failed);
    assert_true(failed > 500);
}

static void expect_region(const pir_sum *sum, pir_vec3 axis, double half_angle) {
    pir_vec3 its_axis;
    double its_half_angle;
    assert_int_equal(pir_sum_region(sum, &its_axis, &its_half_angle), 1);
    assert_memory_equal(&its_axis, &axis, sizeof axis);
    assert_true(its_half_angle == half_angle);
}

static void list_of_crossings_that_cannot_grow_leaves_the_sum_whole(void **state) {
    (void)state;
    pir_polytope *p = test_fluted_prism(1), *q = test_fluted_prism(0);
    const pir_quat apart = {0, 0, 1, 0.001}, upright = {0.001, 0.002, 0, 1};
    uint32_t grown[6] = {0};
    for (int how = 0; how < 6; how++)
        for (uint64_t n = 1; n <= 4; n++) {
            test_memory memory = {0};
            pir_allocator allocator = test_allocator(&memory);
            pir_sum_options options = {.size = sizeof options, .allocator = &allocator, .difference = false};
            pir_sum *sum = NULL, *fresh = NULL;
            assert_int_equal(pir_sum_create(p, q, apart, &options, &sum), PIR_OK);
            assert_int_equal(pir_sum_create(p, q, apart, NULL, &fresh), PIR_OK);
            // a cone that holds nearly all the crossings, and one that is to hold them and cannot
            if (how == 3 || how == 4)
                assert_int_equal(pir_sum_set_region(sum, (pir_vec3){1, 0, 0}, how == 3 ? 1.2 : 0.001), PIR_OK);
            // one as wide about another axis
            const pir_vec3 behind = {-1, 0, 0};
            if (how == 5)
                assert_int_equal(pir_sum_set_region(sum, behind, 1.2), PIR_OK);
            if (how >= 4)
                assert_int_equal(pir_sum_rotate(sum, upright, PIR_METHOD_UPDATE), PIR_OK);
            memory.fail_at = memory.requests + n;
            pir_status status = how >= 4 ? pir_sum_set_region(sum, (pir_vec3){1, 0, 0}, how == 4 ? 4 : 1.2)
                                : how == 2
                                    ? pir_sum_rotate_brute_force(sum, upright)
                                    : pir_sum_rotate(sum, upright, how == 0 ? PIR_METHOD_UPDATE : PIR_METHOD_WALK);
            if (how >= 4)
                assert_int_equal(pir_sum_rotate(fresh, upright, PIR_METHOD_WALK), PIR_OK);
            if (status != PIR_OK) {
                assert_int_equal(status, PIR_ERR_MEMORY);
                assert_true(pir_sum_same_pairing(sum, fresh) && pir_sum_is_valid(sum));
                if (how == 5)
                    expect_region(sum, behind, 1.2);
                grown[how]++;
            }
            // with memory it goes on, and its certificates are right
            memory.fail_at = 0;
            assert_int_equal(pir_sum_rotate(sum, upright, PIR_METHOD_UPDATE), PIR_OK);
            assert_int_equal(pir_sum_rotate(fresh, upright, PIR_METHOD_WALK), PIR_OK);
            assert_true(pir_sum_same_pairing(sum, fresh) && pir_sum_is_valid(sum));
            pir_sum_destroy(fresh);
            pir_sum_destroy(sum);
            expect_balance(&memory, "crossings");
        }
    // otherwise nothing was tried
    for (int how = 0; how < 6; how++)
        expect(grown[how] > 0, "way %d", how);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* Small steps, so that arcs gain and lose crossings at their ends: whenever the list has to
   grow, it cannot at first. */
static void step_that_finds_no_memory_can_be_taken_again(void **state) {
    (void)state;
    uint32_t failures = 0;
    for (uint64_t i = 0; i < 40; i++) {
        test_random random = test_random_case("allocation steps", i);
        pir_polytope *p = test_fluted_prism(1), *q = test_fluted_prism(0);
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_sum_options options = {.size = sizeof options, .allocator = &allocator, .difference = false};
        pir_sum *sum = NULL, *fresh = NULL;
        pir_quat now = {0, 0, 1, 0.001};
        pir_vec3 tilt = test_random_direction(&random);
        uint32_t steps = 10 + test_random_below(&random, 600);
        assert_int_equal(pir_sum_create(p, q, now, &options, &sum), PIR_OK);
        for (uint32_t step = 1; step <= steps; step++) {
            // half a turn about z in all, not quite
            pir_quat next = {0.01 * tilt.x, 0.01 * tilt.y, 1 - (double)step / steps, 0.001 + (double)step / steps};
            memory.fail_at = memory.requests + 1;
            pir_status status = pir_sum_rotate(sum, next, PIR_METHOD_UPDATE);
            memory.fail_at = 0;
            if (status != PIR_OK) {
                assert_int_equal(status, PIR_ERR_MEMORY);
                failures++;
                assert_true(pir_sum_is_valid(sum));
                assert_int_equal(pir_sum_rotate(sum, next, PIR_METHOD_UPDATE), PIR_OK);
            }
            now = next;
        }
        assert_int_equal(pir_sum_create(p, q, now, NULL, &fresh), PIR_OK);
        assert_true(pir_sum_same_pairing(sum, fresh) && pir_sum_is_valid(sum));
        pir_sum_destroy(fresh);
        pir_sum_destroy(sum);
        expect_balance(&memory, "steps");
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    assert_true(failures > 12);
}

static void rational_points_survive_every_failing_request(void **state) {
    (void)state;
    mpq_t x[24];
    for (int i = 0; i < 24; i++) {
        mpq_init(x[i]);
        mpq_set_si(x[i], (i * 7 + i / 3 * 5) % 11 - 5, (unsigned long)(1 + i % 6));
        mpq_canonicalize(x[i]);
    }
    for (uint64_t n = 1;; n++) {
        test_memory memory = {.fail_at = n};
        pir_allocator allocator = test_allocator(&memory);
        pir_polytope *const before = (pir_polytope *)&before;
        pir_polytope *polytope = before, *minus = before;
        const pir_polytope_options options = {sizeof options, &allocator, 0};
        pir_status status = pir_polytope_create_exact((const mpq_t *)x, 8, &options, &polytope);
        if (status != PIR_OK) {
            assert_int_equal(status, PIR_ERR_MEMORY);
            assert_ptr_equal(polytope, before);
        } else {
            status = pir_polytope_reflect(polytope, &minus);
            if (status != PIR_OK) {
                assert_int_equal(status, PIR_ERR_MEMORY);
                assert_ptr_equal(minus, before);
            } else {
                pir_polytope_release(minus);
            }
            pir_polytope_release(polytope);
        }
        expect_balance(&memory, "rationals");
        if (memory.requests < n) {
            assert_int_equal(status, PIR_OK);
            break;
        }
        assert_int_equal(status, PIR_ERR_MEMORY);
    }
    for (int i = 0; i < 24; i++)
        mpq_clear(x[i]);
}

static void allocator_changes_no_bit_of_the_result(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("allocation bits", i);
        test_pose pose;
        test_random_pose(&random, 14, &pose);
        uint64_t hash[2];
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        for (int own = 0; own < 2; own++) {
            pir_sum_options options = {
                .size = sizeof options, .allocator = own ? &allocator : NULL, .difference = false};
            pir_polytope *p = NULL, *q = NULL;
            pir_sum *sum = NULL;
            pir_mesh *mesh = NULL;
            const pir_polytope_options body = {sizeof body, options.allocator, 0};
            assert_int_equal(pir_polytope_create(pose.p.at, pose.p.count, &body, &p), PIR_OK);
            assert_int_equal(pir_polytope_create(pose.q.at, pose.q.count, &body, &q), PIR_OK);
            assert_int_equal(pir_sum_create(p, q, pose.rotation, &options, &sum), PIR_OK);
            assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
            hash[own] = test_hash_mesh(test_hash_pairing(TEST_HASH_START, sum), mesh);
            pir_mesh_destroy(mesh);
            pir_sum_destroy(sum);
            pir_polytope_release(q);
            pir_polytope_release(p);
        }
        expect(hash[0] == hash[1], "case %llu, %s", (unsigned long long)i, pose.situation);
        expect_balance(&memory, pose.situation);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_failing_request_is_survived),
        cmocka_unit_test(list_of_crossings_that_cannot_grow_leaves_the_sum_whole),
        cmocka_unit_test(step_that_finds_no_memory_can_be_taken_again),
        cmocka_unit_test(rational_points_survive_every_failing_request),
        cmocka_unit_test(allocator_changes_no_bit_of_the_result),
    };
    return cmocka_run_group_tests_name("allocation", tests, NULL, NULL);
}
