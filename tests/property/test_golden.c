/* SPDX-License-Identifier: MIT */
/*
 * The same inputs give the same bits on every machine and with every compiler: hashes of pairings and meshes against
 * kept ones. They may change only when what a sum looks like is meant to change. So with the work that was done, which
 * decides between update and walk. Inputs are made with +, −, ·, / and sqrt alone.
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

enum motion { NEW_AXES, SWINGS, TREMBLES };

/* The work of `frames` small steps by `method`: a new axis every 40 frames, to and fro about one, or a
   new one in each frame. */
static pir_sum_statistics work_of(test_body body, enum motion motion, pir_method method, uint32_t frames,
                                  uint64_t number) {
    test_random random = fixed_random(number);
    pir_polytope *p = test_random_polytope(&random, body, 60), *q = test_sphere(&random, 50);
    pir_quat r = {0.1, 0.2, -0.3, 0.9}, step = {0.004, -0.003, 0.002, 1};
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, r, NULL, &sum), PIR_OK);
    pir_sum_reset_statistics(sum);
    for (uint32_t frame = 0; frame < frames; frame++) {
        if (motion == NEW_AXES && frame % 40 == 39)
            step = (pir_quat){step.y, -step.z, step.x, 1};
        if (motion == SWINGS && frame % 7 == 6)
            step = (pir_quat){-step.x, -step.y, -step.z, 1};
        if (motion == TREMBLES) {
            pir_vec3 axis = test_random_direction(&random);
            step = (pir_quat){1e-4 * axis.x, 1e-4 * axis.y, 1e-4 * axis.z, 1};
        }
        r = test_compose(step, r, 1);
        assert_int_equal(pir_sum_rotate(sum, r, method), PIR_OK);
    }
    pir_sum_statistics did = pir_sum_get_statistics(sum);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return did;
}

static void expect_work(const char *what, pir_sum_statistics did, const uint64_t kept[7]) {
    const uint64_t counted[7] = {did.updates,   did.rebuilds, did.checked,        did.repaired,
                                 did.by_filter, did.by_exact, did.by_perturbation};
    int same = 1;
    for (int k = 0; k < 7; k++)
        same = same && counted[k] == kept[k];
    if (!same)
        for (int k = 0; k < 7; k++)
            print_error("%s%" PRIu64 "%s", k ? ", " : "counted: ", counted[k], k < 6 ? "" : "\n");
    expect(same, "%s", what);
}

/* How much an update looks at is part of what it promises. These numbers may change when an update is meant
   to look at other things. */
static void updates_look_at_no_more_than_they_did(void **state) {
    (void)state;
    expect_work("new axes", work_of(TEST_SPHERE, NEW_AXES, PIR_METHOD_UPDATE, 400, 11),
                (uint64_t[7]){400, 0, 5979, 4422, 37211, 0, 0});
    expect_work("to and fro", work_of(TEST_SPHERE, SWINGS, PIR_METHOD_UPDATE, 400, 12),
                (uint64_t[7]){400, 0, 2267, 5005, 3917, 0, 0});
    expect_work("a grid", work_of(TEST_GRID, NEW_AXES, PIR_METHOD_UPDATE, 400, 13),
                (uint64_t[7]){400, 0, 2463, 1414, 10523, 0, 0});
    expect_work("a prism, to and fro", work_of(TEST_PRISM, SWINGS, PIR_METHOD_AUTO, 400, 14),
                (uint64_t[7]){400, 0, 434, 598, 663, 0, 0});
    expect_work("trembling", work_of(TEST_SPHERE, TREMBLES, PIR_METHOD_UPDATE, 400, 16),
                (uint64_t[7]){400, 0, 232, 10, 1406, 0, 0});
    expect_work("walks", work_of(TEST_GRID, NEW_AXES, PIR_METHOD_WALK, 40, 15),
                (uint64_t[7]){0, 40, 0, 0, 20174, 0, 0});
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_keep_their_bits),
        cmocka_unit_test(track_of_two_hundred_frames_keeps_its_bits),
        cmocka_unit_test(updates_look_at_no_more_than_they_did),
    };
    return cmocka_run_group_tests_name("golden", tests, NULL, NULL);
}
