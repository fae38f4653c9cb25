/* SPDX-License-Identifier: MIT */
/*
 * One pairing, found in four ways: tracked, walked, by brute force in the library, and by the oracle at a real, tiny
 * perturbation of the rotation. Poses are mostly degenerate.
 */
#include "support/test.h"

#include <pirouette/baseline.h>

#include "oracle/perturbed.h"
#include "support/bodies.h"
#include "support/meshes.h"

struct bodies {
    pir_polytope *p, *q;
    pir_sum *tracked, *walked, *brute;
};

static void bodies_init(struct bodies *b, const test_pose *pose, int difference) {
    pir_sum_options options = pir_sum_options_default();
    options.difference = difference;
    b->p = test_polytope(&pose->p);
    b->q = test_polytope(&pose->q);
    pir_sum **sums[] = {&b->tracked, &b->walked, &b->brute};
    for (int i = 0; i < 3; i++)
        assert_int_equal(pir_sum_create(b->p, b->q, pose->rotation, &options, sums[i]), PIR_OK);
}

static void bodies_clear(struct bodies *b) {
    pir_sum_destroy(b->brute);
    pir_sum_destroy(b->walked);
    pir_sum_destroy(b->tracked);
    pir_polytope_release(b->q);
    pir_polytope_release(b->p);
}

/* Brings all three to `rotation` and compares. */
static void expect_same_pairing(struct bodies *b, pir_quat rotation, uint64_t number, int frame,
                                const char *situation) {
    assert_int_equal(pir_sum_rotate(b->tracked, rotation, PIR_METHOD_UPDATE), PIR_OK);
    assert_int_equal(pir_sum_rotate(b->walked, rotation, PIR_METHOD_WALK), PIR_OK);
    assert_int_equal(pir_sum_rotate_brute_force(b->brute, rotation), PIR_OK);
    expect(pir_sum_is_valid(b->walked), "case %llu, frame %d, %s", (unsigned long long)number, frame, situation);
    expect(pir_sum_same_pairing(b->walked, b->brute), "case %llu, frame %d, %s", (unsigned long long)number, frame,
           situation);
    expect(pir_sum_same_pairing(b->tracked, b->walked), "case %llu, frame %d, %s", (unsigned long long)number, frame,
           situation);
}

static void pairing_is_that_of_the_perturbed_rotation(void **state) {
    (void)state;
    uint32_t checked = 0;
    for (uint64_t i = 0; i < 250; i++) {
        test_random random = test_random_case("pairing oracle", i);
        test_pose pose;
        test_random_pose(&random, 7, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        if (pir_polytope_dimension(p) >= 2 && pir_polytope_dimension(q) >= 2) {
            pir_sum *sum = NULL;
            assert_int_equal(pir_sum_create(p, q, pose.rotation, NULL, &sum), PIR_OK);
            const char *wrong = oracle_check_pairing(sum);
            expect(!wrong, "case %llu, %s: %s", (unsigned long long)i, pose.situation, wrong);
            pir_sum_destroy(sum);
            checked++;
        }
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    assert_true(checked > 80);
}

static void tracked_walked_and_brute_force_agree_on_every_step(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 400; i++) {
        test_random random = test_random_case("pairing tracks", i);
        test_pose pose;
        struct bodies b;
        test_random_pose(&random, i % 8 ? 14 : 40, &pose);
        bodies_init(&b, &pose, i % 2);
        // steps that stay on the grid, tiny ones, small ones and jumps
        pir_vec3 axis = test_random_direction(&random);
        const double size[] = {1e-7, 1e-3, 0.1, 1};
        double s = size[test_random_below(&random, 4)];
        pir_quat step = i % 3 ? (pir_quat){axis.x * s, axis.y * s, axis.z * s, 1} : test_integer_rotation(&random),
                 r = pose.rotation;
        for (int frame = 0; frame < 12; frame++) {
            expect_same_pairing(&b, r, i, frame, pose.situation);
            // exact products grow: after a few steps start from another integer rotation
            r = i % 3 ? test_compose(step, r, 1) : frame % 4 == 3 ? test_rotation(&random) : test_compose(step, r, 0);
            if (r.x == 0 && r.y == 0 && r.z == 0 && r.w == 0)
                r = (pir_quat){0, 0, 0, 1};
            if (!(r.x - r.x == 0 && r.y - r.y == 0 && r.z - r.z == 0 && r.w - r.w == 0))
                r = test_rotation(&random);
        }
        bodies_clear(&b);
    }
}

static void box_turning_on_a_table_is_tracked_through_its_ties(void **state) {
    (void)state;
    test_random random = test_random_case("pairing table", 0);
    test_pose pose = {.situation = "a box on a table"};
    struct bodies b;
    test_body_points(&random, TEST_BOX, 8, &pose.p);
    test_body_points(&random, TEST_BOX, 8, &pose.q);
    pose.rotation = (pir_quat){0, 0, 0, 1};
    bodies_init(&b, &pose, 1);
    // about z all the way and back, through the aligned poses exactly
    for (int frame = -64; frame <= 64; frame++) {
        expect_same_pairing(&b, (pir_quat){0, 0, frame / 32.0, 1}, 0, frame, pose.situation);
        expect_same_pairing(&b, (pir_quat){0, 0, 1, frame / 32.0}, 0, frame, pose.situation);
    }
    assert_true(pir_sum_get_statistics(b.tracked).by_perturbation > 0);
    bodies_clear(&b);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairing_is_that_of_the_perturbed_rotation),
        cmocka_unit_test(tracked_walked_and_brute_force_agree_on_every_step),
        cmocka_unit_test(box_turning_on_a_table_is_tracked_through_its_ties),
    };
    return cmocka_run_group_tests_name("pairings", tests, NULL, NULL);
}
