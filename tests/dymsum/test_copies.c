/* SPDX-License-Identifier: MIT */
/* Sums that begin anew: copied, reset, of another size; and their counters. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/exact.h>

#include "support/bodies.h"
#include "support/memory.h"
#include "support/meshes.h"

#define CASES 120

static pir_sum *make_sum(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_sum_options *options) {
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, rotation, options, &sum), PIR_OK);
    return sum;
}

static void expect_same_mesh(pir_sum *a, pir_sum *b, const char *situation) {
    pir_mesh *x, *y;
    assert_int_equal(pir_sum_mesh(a, PIR_DOUBLE, &x), PIR_OK);
    assert_int_equal(pir_sum_mesh(b, PIR_DOUBLE, &y), PIR_OK);
    expect(pir_mesh_equal(x, y), "%s", situation);
    pir_mesh_destroy(y);
    pir_mesh_destroy(x);
}

/* A step from `from`, small or large. */
static pir_quat step(test_random *random, pir_quat from) {
    double size = ldexp(1, -test_random_between(random, 0, 12));
    pir_vec3 d = test_random_direction(random);
    pir_quat next = test_compose((pir_quat){size * d.x, size * d.y, size * d.z, 1}, from, 1);
    // composing the tiniest and the largest leaves the doubles
    double square = next.x * next.x + next.y * next.y + next.z * next.z + next.w * next.w;
    return square > 0.5 && square < 2 ? next : test_general_rotation(random);
}

static void copy_goes_its_own_way(void **state) {
    (void)state;
    for (uint64_t i = 0; i < CASES; i++) {
        test_random random = test_random_case("clone", i);
        test_pose pose;
        test_random_pose(&random, 14, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        test_memory memory = {0};
        pir_allocator allocator = test_allocator(&memory);
        pir_sum *sum = make_sum(p, q, pose.rotation, NULL), *copy = NULL;
        pir_quat there = step(&random, pose.rotation);
        assert_int_equal(pir_sum_rotate(sum, there, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_clone(sum, &allocator, &copy), PIR_OK);
        expect(pir_sum_same_pairing(sum, copy) && pir_sum_is_valid(copy), "case %d: %s", (int)i, pose.situation);
        assert_int_equal(pir_sum_get_statistics(copy).updates, 0);
        assert_true(pir_sum_get_statistics(sum).updates == 1);
        // each goes its own way, and both are right
        pir_quat one = step(&random, there), other = step(&random, there);
        assert_int_equal(pir_sum_rotate(copy, one, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_rotate(sum, other, PIR_METHOD_UPDATE), PIR_OK);
        expect(pir_sum_is_valid(copy) && pir_sum_is_valid(sum), "case %d: %s", (int)i, pose.situation);
        pir_sum_destroy(sum);
        pir_sum *fresh = make_sum(p, q, one, NULL);
        assert_true(pir_sum_same_pairing(copy, fresh));
        expect_same_mesh(copy, fresh, pose.situation);
        pir_sum_destroy(fresh);
        pir_sum_destroy(copy);
        assert_int_equal(memory.blocks, 0);
        assert_false(memory.wrong_size);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void copy_without_memory_leaves_nothing_behind(void **state) {
    (void)state;
    test_random random = test_random_case("clone memory", 0);
    pir_polytope *p = test_sphere(&random, 30), *q = test_sphere(&random, 30);
    pir_sum *sum = make_sum(p, q, test_general_rotation(&random), NULL), *const before = (pir_sum *)&before;
    uint64_t n = 0;
    for (bool failed = true; failed;) {
        test_memory memory = {.fail_at = ++n};
        pir_allocator allocator = test_allocator(&memory);
        pir_sum *copy = before;
        pir_status status = pir_sum_clone(sum, &allocator, &copy);
        failed = status == PIR_ERR_MEMORY;
        if (failed) {
            assert_ptr_equal(copy, before);
        } else {
            assert_int_equal(status, PIR_OK);
            pir_sum_destroy(copy);
        }
        assert_int_equal(memory.blocks, 0);
    }
    assert_true(n > 5);
    assert_int_equal(pir_sum_clone(NULL, NULL, &sum), PIR_ERR_ARGUMENT);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void reset_sum_behaves_as_a_new_one(void **state) {
    (void)state;
    test_random random = test_random_case("reset", 0);
    pir_polytope *p = test_sphere(&random, 60), *q = test_sphere(&random, 50);
    pir_sum *used = make_sum(p, q, test_general_rotation(&random), NULL);
    pir_quat there = pir_sum_rotation(used);
    for (int i = 0; i < 300; i++) {
        there = step(&random, there);
        assert_int_equal(pir_sum_rotate(used, there, PIR_METHOD_AUTO), PIR_OK);
    }
    pir_quat start = test_general_rotation(&random);
    pir_sum *fresh = make_sum(p, q, start, NULL);
    assert_int_equal(pir_sum_reset(used, (pir_quat){0, 0, 0, 0}), PIR_ERR_ZERO_QUATERNION);
    assert_int_equal(pir_sum_reset(used, start), PIR_OK);
    assert_true(pir_sum_same_pairing(used, fresh));
    pir_sum_reset_statistics(used);
    pir_sum_reset_statistics(fresh);
    // from here on both do the very same work
    there = start;
    for (int i = 0; i < 300; i++) {
        there = step(&random, there);
        assert_int_equal(pir_sum_rotate(used, there, PIR_METHOD_AUTO), PIR_OK);
        assert_int_equal(pir_sum_rotate(fresh, there, PIR_METHOD_AUTO), PIR_OK);
        expect(pir_sum_same_pairing(used, fresh), "step %d", i);
    }
    pir_sum_statistics a = pir_sum_get_statistics(used), b = pir_sum_get_statistics(fresh);
    assert_true(a.updates == b.updates && a.rebuilds == b.rebuilds && a.repaired == b.repaired);
    assert_true(a.updates + a.rebuilds == 300);
    pir_sum_destroy(fresh);
    pir_sum_destroy(used);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* The points times a factor that is a power of two, so that doubles hold them. */
static pir_polytope *scaled_body(const test_points *points, double factor) {
    test_points scaled = *points;
    for (size_t i = 0; i < scaled.count; i++)
        scaled.at[i] = (pir_vec3){factor * points->at[i].x, factor * points->at[i].y, factor * points->at[i].z};
    return test_polytope(&scaled);
}

static void scaled_operand_is_the_body_made_that_large(void **state) {
    (void)state;
    for (uint64_t i = 0; i < CASES; i++) {
        test_random random = test_random_case("scale", i);
        test_pose pose;
        test_random_pose(&random, 14, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        double factor = i % 2 ? 4 : 0.25;
        pir_operand operand = i % 4 < 2 ? PIR_OPERAND_P : PIR_OPERAND_Q;
        pir_polytope *large = scaled_body(operand == PIR_OPERAND_P ? &pose.p : &pose.q, factor);
        pir_sum *sum = make_sum(p, q, pose.rotation, NULL), *other = operand == PIR_OPERAND_P
                                                                         ? make_sum(large, q, pose.rotation, NULL)
                                                                         : make_sum(p, large, pose.rotation, NULL);
        uint64_t asked = pir_sum_get_statistics(sum).by_filter;
        // to another scale and from there on to the one meant: the last one counts alone
        assert_int_equal(pir_sum_set_scale(sum, operand, 3.7), PIR_OK);
        assert_true(pir_polytope_is_valid(operand == PIR_OPERAND_P ? pir_sum_p(sum) : pir_sum_q(sum)));
        assert_true(pir_sum_is_valid(sum));
        assert_int_equal(pir_sum_set_scale(sum, operand, factor), PIR_OK);
        assert_int_equal(pir_sum_get_statistics(sum).by_filter, asked);
        expect(pir_sum_same_pairing(sum, other), "case %d: %s", (int)i, pose.situation);
        expect_same_mesh(sum, other, pose.situation);
        // and it tracks on
        pir_quat there = step(&random, pose.rotation);
        assert_int_equal(pir_sum_rotate(sum, there, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_rotate(other, there, PIR_METHOD_WALK), PIR_OK);
        assert_true(pir_sum_same_pairing(sum, other) && pir_sum_is_valid(sum));
        expect_same_mesh(sum, other, pose.situation);
        assert_int_equal(pir_sum_set_scale(sum, operand, 1), PIR_OK);
        pir_sum *plain = make_sum(p, q, there, NULL);
        expect_same_mesh(sum, plain, pose.situation);
        pir_sum_destroy(plain);
        pir_sum_destroy(other);
        pir_sum_destroy(sum);
        pir_polytope_release(large);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void scale_by_a_third_is_exact(void **state) {
    (void)state;
    const pir_vec3 cube[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    pir_polytope *p;
    assert_int_equal(pir_polytope_create(cube, 8, NULL, &p), PIR_OK);
    pir_sum *sum = make_sum(p, p, (pir_quat){0, 0, 0, 1}, NULL);
    mpq_t third, corner[3], expected;
    mpq_inits(third, corner[0], corner[1], corner[2], expected, NULL);
    mpq_set_ui(third, 1, 3);
    mpq_set_ui(expected, 4, 3);
    assert_int_equal(pir_sum_set_scale_exact(sum, PIR_OPERAND_Q, third), PIR_OK);
    pir_mesh *mesh;
    assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
    assert_int_equal(pir_mesh_vertex_count(mesh), 8);
    bool found = false;
    for (uint32_t v = 0; v < 8; v++) {
        assert_int_equal(pir_mesh_vertex_exact(mesh, v, corner), PIR_OK);
        found |= mpq_equal(corner[0], expected) && mpq_equal(corner[1], expected) && mpq_equal(corner[2], expected);
    }
    assert_true(found);
    mpq_set_ui(third, 0, 1);
    assert_int_equal(pir_sum_set_scale_exact(sum, PIR_OPERAND_Q, third), PIR_ERR_ARGUMENT);
    mpq_clears(third, corner[0], corner[1], corner[2], expected, NULL);
    pir_mesh_destroy(mesh);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

static void scale_that_is_none_is_refused(void **state) {
    (void)state;
    test_random random = test_random_case("bad scale", 0);
    pir_polytope *p = test_sphere(&random, 12), *scaled = NULL;
    pir_sum *sum = make_sum(p, p, test_general_rotation(&random), NULL),
            *same = make_sum(p, p, pir_sum_rotation(sum), NULL);
    assert_int_equal(pir_sum_set_scale(NULL, PIR_OPERAND_P, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_scale(sum, (pir_operand)2, 1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 0), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, -1), PIR_ERR_ARGUMENT);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, (double)NAN), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, (double)INFINITY), PIR_ERR_NOT_FINITE);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 0x1p1023), PIR_OK);
    pir_polytope *huge = pir_polytope_retain((pir_polytope *)pir_sum_p(sum));
    assert_int_equal(pir_polytope_scale(huge, 8, &scaled), PIR_ERR_LIMIT);
    assert_null(scaled);
    assert_int_equal(pir_polytope_scale(NULL, 8, &scaled), PIR_ERR_ARGUMENT);
    pir_polytope_release(huge);
    assert_int_equal(pir_sum_set_scale(sum, PIR_OPERAND_P, 1), PIR_OK);
    expect_same_mesh(sum, same, "after refusals");
    pir_sum_destroy(same);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copy_goes_its_own_way),          cmocka_unit_test(copy_without_memory_leaves_nothing_behind),
        cmocka_unit_test(reset_sum_behaves_as_a_new_one), cmocka_unit_test(scaled_operand_is_the_body_made_that_large),
        cmocka_unit_test(scale_by_a_third_is_exact),      cmocka_unit_test(scale_that_is_none_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
