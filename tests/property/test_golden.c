/* SPDX-License-Identifier: MIT */
/*
 * The same inputs give the same bits on every machine and with every compiler: hashes of pairings and meshes against kept ones. They may
 * change only when what a sum looks like is meant to change. Inputs are made with +, −, ·, / and sqrt alone.
 */
#include "support/test.h"

#include <inttypes.h>

#include "support/bodies.h"
#include "support/meshes.h"

static test_random fixed_random(uint64_t number) {
    // whatever PIR_TEST_SEED says
    return (test_random){{number, 0x9e3779b97f4a7c15u, 0xd1342543de82ef95u, 1}};
}

static void expect_hash(const char *what, uint64_t hash, uint64_t kept) {
    expect(hash == kept, "%s: 0x%016" PRIx64 " instead of 0x%016" PRIx64, what, hash, kept);
}

static uint64_t hash_of_sum(pir_sum *sum) {
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
    uint64_t hash = test_hash_mesh(test_hash_pairing(TEST_HASH_START, sum), mesh);
    pir_mesh_destroy(mesh);
    return hash;
}

static uint64_t hash_of_pose(test_body p_body, test_body q_body, size_t most, pir_quat rotation, uint64_t number) {
    test_random random = fixed_random(number);
    pir_polytope *p = test_random_polytope(&random, p_body, most), *q = test_random_polytope(&random, q_body, most);
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, rotation, NULL, &sum), PIR_OK);
    uint64_t hash = hash_of_sum(sum);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return hash;
}

static void sums_keep_their_bits(void **state) {
    (void)state;
    expect_hash("spheres", hash_of_pose(TEST_SPHERE, TEST_SPHERE, 100, (pir_quat){0.1, -0.7, 0.3, 0.4}, 1),
                0xfd21b7a8f899adefu);
    expect_hash("boxes", hash_of_pose(TEST_BOX, TEST_BOX, 8, (pir_quat){0, 0, 1, 3}, 2), 0x951fe10c7b1806d6u);
    expect_hash("grids", hash_of_pose(TEST_GRID, TEST_GRID, 40, (pir_quat){1, 1, 1, 1}, 3), 0x6cca78678b7630afu);
    expect_hash("far", hash_of_pose(TEST_FAR, TEST_NEEDLE, 40, (pir_quat){1, 2, -3, 4}, 4), 0xd641100581be7b72u);
    expect_hash("flat", hash_of_pose(TEST_POLYGON, TEST_PRISM, 20, (pir_quat){3e-160, 0, 4e-160, 5e-160}, 5),
                0x05b224268965f730u);
}

static void track_of_two_hundred_frames_keeps_its_bits(void **state) {
    (void)state;
    test_random random = fixed_random(6);
    pir_polytope *p = test_sphere(&random, 60), *q = test_random_polytope(&random, TEST_GRID, 60);
    pir_quat r = {0, 0, 0, 1};
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, r, NULL, &sum), PIR_OK);
    uint64_t hash = 0;
    for (int frame = 0; frame < 200; frame++) {
        r = test_compose(frame % 40 == 39 ? (pir_quat){1, 0, 0, 1} : (pir_quat){0.01, -0.02, 0.015, 1}, r, 1);
        assert_int_equal(pir_sum_rotate(sum, r, PIR_METHOD_AUTO), PIR_OK);
        hash = hash * 0x100000001b3u ^ hash_of_sum(sum);
    }
    expect_hash("track", hash, 0xdf0bf8e3cb59e86fu);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_keep_their_bits),
        cmocka_unit_test(track_of_two_hundred_frames_keeps_its_bits),
    };
    return cmocka_run_group_tests_name("golden", tests, NULL, NULL);
}
