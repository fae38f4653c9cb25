/* SPDX-License-Identifier: MIT */
/* What callers see of a sum: bad input, the difference, rotations brought in by any method, memory
   after warm-up, counters. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/baseline.h>

#include "dymsum/sum.h"
#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"

static const pir_quat identity = {0, 0, 0, 1};

static pir_sum *make_sum(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_sum_options *options) {
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, rotation, options, &sum), PIR_OK);
    return sum;
}

static int same_quat(pir_quat a, pir_quat b) {
    return memcmp(&a, &b, sizeof a) == 0;
}

static const struct {
    pir_quat q;
    pir_status status;
} bad_rotations[] = {
    {{0, 0, 0, 0}, PIR_ERR_ZERO_QUATERNION},
    {{-0.0, 0, 0, -0.0}, PIR_ERR_ZERO_QUATERNION},
    {{(double)NAN, 0, 0, 1}, PIR_ERR_NOT_FINITE},
    {{1, (double)INFINITY, 0, 1}, PIR_ERR_NOT_FINITE},
    {{1, 0, -(double)INFINITY, 1}, PIR_ERR_NOT_FINITE},
    {{1, 0, 0, (double)NAN}, PIR_ERR_NOT_FINITE},
};

static void bad_arguments_are_refused_and_the_result_is_untouched(void **state) {
    (void)state;
    test_random random = test_random_case("sum arguments", 0);
    pir_polytope *p = test_sphere(&random, 10), *q = test_sphere(&random, 10);
    pir_sum *const before = (pir_sum *)&before;
    pir_mesh *const mesh_before = (pir_mesh *)&mesh_before;
    pir_sum *sum = before;
    pir_mesh *mesh = mesh_before;
    assert_int_equal(pir_sum_create(NULL, q, identity, NULL, &sum), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_create(p, NULL, identity, NULL, &sum), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_create(p, q, identity, NULL, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_rotate(NULL, identity, PIR_METHOD_UPDATE), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_rotate_brute_force(NULL, identity), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_mesh(NULL, PIR_DOUBLE, &mesh), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_hull_sum(NULL, q, identity, NULL, PIR_DOUBLE, &mesh), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_hull_sum(p, NULL, identity, NULL, PIR_DOUBLE, &mesh), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_hull_sum(p, q, identity, NULL, PIR_DOUBLE, NULL), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_mesh_from_polytope(NULL, &mesh), PIR_ERR_ARGUMENT);
    for (size_t i = 0; i < sizeof bad_rotations / sizeof *bad_rotations; i++) {
        assert_int_equal(pir_sum_create(p, q, bad_rotations[i].q, NULL, &sum), bad_rotations[i].status);
        assert_int_equal(pir_hull_sum(p, q, bad_rotations[i].q, NULL, PIR_DOUBLE, &mesh), bad_rotations[i].status);
    }
    assert_ptr_equal(sum, before);
    assert_ptr_equal(mesh, mesh_before);
    pir_sum_destroy(NULL);
    pir_mesh_destroy(NULL);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void refused_rotation_leaves_the_sum_where_it_was(void **state) {
    (void)state;
    test_random random = test_random_case("sum refused", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_sphere(&random, 20);
    pir_quat there = test_general_rotation(&random);
    pir_sum *sum = make_sum(p, q, there, NULL), *other = make_sum(p, q, there, NULL);
    for (size_t i = 0; i < sizeof bad_rotations / sizeof *bad_rotations; i++)
        for (int method = PIR_METHOD_AUTO; method <= PIR_METHOD_WALK; method++) {
            assert_int_equal(pir_sum_rotate(sum, bad_rotations[i].q, (pir_method)method), bad_rotations[i].status);
            assert_int_equal(pir_sum_rotate_brute_force(sum, bad_rotations[i].q), bad_rotations[i].status);
            assert_true(same_quat(pir_sum_rotation(sum), there));
            assert_true(pir_sum_same_pairing(sum, other));
        }
    assert_int_equal(pir_sum_rotate(sum, identity, (pir_method)77), PIR_ERR_ARGUMENT);
    assert_true(same_quat(pir_sum_rotation(sum), there));
    // and it still tracks
    pir_quat next = test_compose((pir_quat){0.1, 0, 0, 1}, there, 0);
    assert_int_equal(pir_sum_rotate(sum, next, PIR_METHOD_UPDATE), PIR_OK);
    assert_int_equal(pir_sum_rotate(other, next, PIR_METHOD_WALK), PIR_OK);
    assert_true(pir_sum_same_pairing(sum, other) && pir_sum_is_valid(sum));
    pir_sum_destroy(other);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void sum_holds_its_operands_alive(void **state) {
    (void)state;
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    const pir_vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int difference = 0; difference < 2; difference++) {
        pir_polytope *p = NULL;
        pir_sum_options options = {.size = sizeof options, .allocator = &allocator, .difference = difference};
        assert_int_equal(
            pir_polytope_create(points, 4, &(pir_polytope_options){sizeof(pir_polytope_options), &allocator, 0}, &p),
            PIR_OK);
        pir_sum *sum = make_sum(p, p, identity, &options);
        pir_polytope_release(p);
        assert_int_equal(pir_sum_rotate(sum, (pir_quat){1, 2, 3, 4}, PIR_METHOD_UPDATE), PIR_OK);
        assert_true(pir_sum_is_valid(sum));
        pir_sum_destroy(sum);
        assert_int_equal(memory.blocks, 0);
        assert_false(memory.wrong_size);
    }
}

static void difference_is_the_sum_with_the_reflection(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 150; i++) {
        test_random random = test_random_case("sum difference", i);
        test_pose pose;
        test_random_pose(&random, 14, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q), *minus;
        assert_int_equal(pir_polytope_reflect(p, &minus), PIR_OK);
        pir_sum_options options = pir_sum_options_default();
        options.difference = true;
        pir_sum *difference = make_sum(p, q, pose.rotation, &options), *sum = make_sum(minus, q, pose.rotation, NULL);
        assert_true(pir_sum_same_pairing(difference, sum));
        pir_mesh *a, *b, *c;
        assert_int_equal(pir_sum_mesh(difference, PIR_EXACT, &a), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &b), PIR_OK);
        assert_int_equal(pir_hull_sum(p, q, pose.rotation, &options, PIR_DOUBLE, &c), PIR_OK);
        expect(pir_mesh_equal(a, b) && pir_mesh_equal(a, c), "case %llu: %s", (unsigned long long)i, pose.situation);
        const char *wrong = test_prove_mesh(difference, a);
        expect(!wrong, "case %llu: %s: %s", (unsigned long long)i, pose.situation, wrong);
        pir_mesh_destroy(c);
        pir_mesh_destroy(b);
        pir_mesh_destroy(a);
        pir_sum_destroy(sum);
        pir_sum_destroy(difference);
        pir_polytope_release(minus);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void length_and_sign_of_a_quaternion_do_not_matter_in_general_position(void **state) {
    (void)state;
    test_random random = test_random_case("sum length", 0);
    pir_polytope *p = test_sphere(&random, 30), *q = test_sphere(&random, 30);
    pir_quat r = test_general_rotation(&random);
    pir_sum *sum = make_sum(p, q, r, NULL);
    const double lengths[] = {1, -1, 0x1p-500, -0x1p500, 0x1p-900};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        pir_sum *other =
            make_sum(p, q, (pir_quat){r.x * lengths[i], r.y * lengths[i], r.z * lengths[i], r.w * lengths[i]}, NULL);
        assert_true(pir_sum_same_pairing(sum, other));
        pir_sum_destroy(other);
    }
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void tracking_does_not_allocate_after_warm_up(void **state) {
    (void)state;
    test_random random = test_random_case("sum warm-up", 0);
    test_memory memory = {0};
    pir_allocator allocator = test_allocator(&memory);
    pir_sum_options options = {.size = sizeof options, .allocator = &allocator, .difference = false};
    pir_polytope *p = test_sphere(&random, 150), *q = test_sphere(&random, 150);
    pir_sum *sum = make_sum(p, q, identity, &options);
    pir_quat r = identity;
    const pir_quat step = {0.02, -0.01, 0.03, 1};
    for (int frame = 0; frame < 300; frame++)
        assert_int_equal(pir_sum_rotate(sum, r = test_compose(step, r, 1), (pir_method)(frame % 3)), PIR_OK);
    uint64_t requests = memory.requests, grown = pir_sum_get_statistics(sum).allocations;
    // the same way once more
    r = identity;
    for (int frame = 0; frame < 300; frame++)
        assert_int_equal(pir_sum_rotate(sum, r = test_compose(step, r, 1), (pir_method)(frame % 3)), PIR_OK);
    assert_int_equal(memory.requests, requests);
    assert_int_equal(pir_sum_get_statistics(sum).allocations, grown);
    pir_sum_destroy(sum);
    assert_int_equal(memory.blocks, 0);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void counters_tell_what_was_done(void **state) {
    (void)state;
    test_random random = test_random_case("sum counters", 0);
    pir_polytope *p = test_sphere(&random, 60), *q = test_sphere(&random, 60);
    pir_sum *sum = make_sum(p, q, identity, NULL);
    for (int i = 0; i < 5; i++)
        assert_int_equal(pir_sum_rotate(sum, (pir_quat){0.001 * i, 0, 0, 1}, PIR_METHOD_UPDATE), PIR_OK);
    for (int i = 0; i < 3; i++)
        assert_int_equal(pir_sum_rotate(sum, (pir_quat){0.1 * i, 0, 1, 1}, PIR_METHOD_WALK), PIR_OK);
    pir_sum_statistics s = pir_sum_get_statistics(sum);
    assert_int_equal(s.updates, 5);
    assert_int_equal(s.rebuilds, 3);
    assert_true(s.checked > 0 && s.repaired <= s.checked && s.by_filter > 0);
    // without turning, a second update has nothing left to check
    assert_int_equal(pir_sum_rotate(sum, (pir_quat){0, 0, 1, 1}, PIR_METHOD_UPDATE), PIR_OK);
    uint64_t checked = pir_sum_get_statistics(sum).checked;
    for (int i = 0; i < 10; i++)
        assert_int_equal(pir_sum_rotate(sum, (pir_quat){0, 0, 1, 1}, PIR_METHOD_UPDATE), PIR_OK);
    uint64_t again = pir_sum_get_statistics(sum).checked - checked;
    // but for pairs so close to failing that they are never certain
    assert_true(again <= 10 * (uint64_t)pir_polytope_facet_count(p));
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void updates_of_small_turns_look_at_few_pairs(void **state) {
    (void)state;
    test_random random = test_random_case("sum small turns", 0);
    pir_polytope *p = test_sphere(&random, 200), *q = test_sphere(&random, 200);
    pir_sum *sum = make_sum(p, q, test_general_rotation(&random), NULL);
    uint32_t pairs = pir_polytope_facet_count(p) + pir_polytope_facet_count(q) + pir_sum_ee_count(sum);
    pir_quat r = pir_sum_rotation(sum);
    assert_int_equal(pir_sum_rotate(sum, r, PIR_METHOD_UPDATE), PIR_OK);
    uint64_t before = pir_sum_get_statistics(sum).checked;
    for (int frame = 0; frame < 1000; frame++) {
        r = test_compose((pir_quat){1e-5, 2e-5, -1e-5, 1}, r, 1);
        assert_int_equal(pir_sum_rotate(sum, r, PIR_METHOD_UPDATE), PIR_OK);
    }
    uint64_t checked = (pir_sum_get_statistics(sum).checked - before) / 1000;
    expect(checked < pairs / 20, "%llu of %u pairs checked in a frame", (unsigned long long)checked, pairs);
    assert_true(pir_sum_is_valid(sum));
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void long_run_of_turns_stays_right_past_its_rebasing(void **state) {
    (void)state;
    // large turns push the accumulated angle over its limit again and again
    test_random random = test_random_case("sum rebasing", 0);
    pir_polytope *p = test_sphere(&random, 24), *q = test_sphere(&random, 24);
    pir_quat r = test_general_rotation(&random);
    pir_sum *tracked = make_sum(p, q, r, NULL), *rebuilt = make_sum(p, q, r, NULL);
    for (int frame = 0; frame < 3000; frame++) {
        pir_vec3 axis = test_random_direction(&random);
        double size = frame % 3 ? 1e-4 : 1;
        r = test_compose((pir_quat){axis.x * size, axis.y * size, axis.z * size, 1}, r, 1);
        assert_int_equal(pir_sum_rotate(tracked, r, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_rotate(rebuilt, r, PIR_METHOD_WALK), PIR_OK);
        expect(pir_sum_same_pairing(tracked, rebuilt), "frame %d", frame);
    }
    pir_sum_destroy(rebuilt);
    pir_sum_destroy(tracked);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void check_of_a_sum_sees_every_kind_of_damage(void **state) {
    (void)state;
    test_random random = test_random_case("sum damage", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_sphere(&random, 20);
    pir_sum *sum = make_sum(p, q, test_general_rotation(&random), NULL);
    assert_true(pir_sum_is_valid(sum));
    // another vertex in a pair
    for (uint32_t f = 0; f < sum->tracked.pairing.p->facet_count; f++) {
        uint32_t kept = sum->tracked.pairing.fv[f];
        sum->tracked.pairing.fv[f] = sum->tracked.pairing.q->target[sum->tracked.pairing.q->ring_start[kept]];
        assert_false(pir_sum_is_valid(sum));
        sum->tracked.pairing.fv[f] = kept;
    }
    for (uint32_t g = 0; g < sum->tracked.pairing.q->facet_count; g++) {
        uint32_t kept = sum->tracked.pairing.vf[g];
        sum->tracked.pairing.vf[g] = (kept + 1) % sum->tracked.pairing.p->vertex_count;
        assert_false(pir_sum_is_valid(sum));
        sum->tracked.pairing.vf[g] = kept;
    }
    // a crossing turned round, one left out, one lost
    uint32_t slot = 0;
    while (sum->tracked.pairing.crossings.at[slot].edge == PIR_NO_CROSSING)
        slot++;
    uint32_t half = sum->tracked.pairing.crossings.at[slot].half, edge = sum->tracked.pairing.crossings.at[slot].edge,
             first = sum->tracked.pairing.crossings.first[edge];
    sum->tracked.pairing.crossings.at[slot].half = sum->tracked.pairing.q->twin[half];
    assert_false(pir_sum_is_valid(sum));
    sum->tracked.pairing.crossings.at[slot].half = half;
    sum->tracked.pairing.crossings.first[edge] = sum->tracked.pairing.crossings.at[first].next;
    assert_false(pir_sum_is_valid(sum));
    sum->tracked.pairing.crossings.first[edge] = first;
    sum->tracked.pairing.crossings.used++;
    assert_false(pir_sum_is_valid(sum));
    sum->tracked.pairing.crossings.used--;
    // a pairing that is right elsewhere
    assert_int_equal(pir_rotation_set(&sum->tracked.pairing.signs.rotation, (pir_quat){1, 2, 3, 4}), PIR_OK);
    assert_false(pir_sum_is_valid(sum));
    assert_int_equal(pir_sum_rotate(sum, (pir_quat){1, 2, 3, 4}, PIR_METHOD_WALK), PIR_OK);
    assert_true(pir_sum_is_valid(sum));
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void comparison_of_pairings_sees_each_part(void **state) {
    (void)state;
    test_random random = test_random_case("sum comparison", 0);
    pir_polytope *p = test_sphere(&random, 20), *q = test_sphere(&random, 20);
    pir_quat there = test_general_rotation(&random);
    pir_sum *a = make_sum(p, q, there, NULL), *b = make_sum(p, q, there, NULL), *c = make_sum(q, p, there, NULL);
    assert_true(pir_sum_same_pairing(a, b));
    b->tracked.pairing.fv[3]++;
    assert_false(pir_sum_same_pairing(a, b));
    b->tracked.pairing.fv[3]--;
    b->tracked.pairing.vf[3]++;
    assert_false(pir_sum_same_pairing(a, b));
    b->tracked.pairing.vf[3]--;
    uint32_t last = b->tracked.pairing.crossings.used - 1;
    b->tracked.pairing.crossings.at[last].half = q->twin[b->tracked.pairing.crossings.at[last].half];
    assert_false(pir_sum_same_pairing(a, b));
    b->tracked.pairing.crossings.at[last].half = q->twin[b->tracked.pairing.crossings.at[last].half];
    assert_true(pir_sum_same_pairing(a, b));
    assert_false(pir_sum_same_pairing(a, c));
    assert_int_equal(pir_sum_rotate(b, (pir_quat){1, -1, 0.5, 0}, PIR_METHOD_WALK), PIR_OK);
    assert_false(pir_sum_same_pairing(a, b));
    pir_sum_destroy(c);
    pir_sum_destroy(b);
    pir_sum_destroy(a);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_arguments_are_refused_and_the_result_is_untouched),
        cmocka_unit_test(refused_rotation_leaves_the_sum_where_it_was),
        cmocka_unit_test(sum_holds_its_operands_alive),
        cmocka_unit_test(difference_is_the_sum_with_the_reflection),
        cmocka_unit_test(length_and_sign_of_a_quaternion_do_not_matter_in_general_position),
        cmocka_unit_test(tracking_does_not_allocate_after_warm_up),
        cmocka_unit_test(counters_tell_what_was_done),
        cmocka_unit_test(updates_of_small_turns_look_at_few_pairs),
        cmocka_unit_test(long_run_of_turns_stays_right_past_its_rebasing),
        cmocka_unit_test(check_of_a_sum_sees_every_kind_of_damage),
        cmocka_unit_test(comparison_of_pairings_sees_each_part),
    };
    return cmocka_run_group_tests_name("sum", tests, NULL, NULL);
}
