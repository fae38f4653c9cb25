/* SPDX-License-Identifier: MIT */
/* The long runs: thousands of frames of large bodies, tens of thousands of poses. Not among the fast suites. */
#include "support/test.h"

#include <pirouette/baseline.h>

#include "oracle/check_sum.h"
#include "support/bodies.h"
#include "support/meshes.h"

/* Tracks p against q over `frames` frames and compares each with a walk, some with brute
   force, some with the oracle. */
static void track(test_random *random, pir_polytope *p, pir_polytope *q, int frames, double size, int prove_every) {
    pir_quat r = test_general_rotation(random), step = {0, 0, 0, 1};
    pir_sum *tracked = NULL, *walked = NULL;
    assert_int_equal(pir_sum_create(p, q, r, NULL, &tracked), PIR_OK);
    assert_int_equal(pir_sum_create(p, q, r, NULL, &walked), PIR_OK);
    for (int frame = 0; frame < frames; frame++) {
        if (frame % 50 == 0) {
            pir_vec3 axis = test_random_direction(random);
            step = (pir_quat){axis.x * size, axis.y * size, axis.z * size, 1};
        }
        r = test_compose(step, r, 1);
        assert_int_equal(pir_sum_rotate(tracked, r, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_rotate(walked, r, PIR_METHOD_WALK), PIR_OK);
        expect(pir_sum_same_pairing(tracked, walked), "frame %d of steps %g", frame, size);
        if (frame % prove_every != prove_every - 1)
            continue;
        pir_mesh *mesh = NULL, *hull = NULL;
        assert_int_equal(pir_sum_rotate_brute_force(walked, r), PIR_OK);
        expect(pir_sum_same_pairing(tracked, walked) && pir_sum_is_valid(tracked), "frame %d of steps %g", frame, size);
        assert_int_equal(pir_sum_mesh(tracked, PIR_EXACT, &mesh), PIR_OK);
        assert_int_equal(pir_hull_sum(p, q, r, NULL, PIR_DOUBLE, &hull), PIR_OK);
        expect(pir_mesh_equal(mesh, hull), "frame %d of steps %g", frame, size);
        const char *wrong = test_prove_mesh(tracked, mesh);
        expect(!wrong, "frame %d of steps %g: %s", frame, size, wrong);
        pir_mesh_destroy(hull);
        pir_mesh_destroy(mesh);
    }
    pir_sum_destroy(walked);
    pir_sum_destroy(tracked);
}

static void large_spheres_are_tracked_for_thousands_of_frames(void **state) {
    (void)state;
    static const double size[] = {0.4, 0.03, 0.003, 0.0001};
    for (uint64_t i = 0; i < 4; i++) {
        test_random random = test_random_case("long spheres", i);
        pir_polytope *p = test_sphere(&random, 250), *q = test_sphere(&random, 250);
        track(&random, p, q, 2500, size[i], 500);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void aligned_bodies_are_tracked_for_thousands_of_frames(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 12; i++) {
        test_random random = test_random_case("long grids", i);
        pir_polytope *p = test_random_polytope(&random, TEST_GRID, 60),
                     *q = test_random_polytope(&random, TEST_PRISM, 30);
        track(&random, p, q, 2000, i % 2 ? 1 : 0.01, 200);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

static void tens_of_thousands_of_poses_agree(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 20000; i++) {
        test_random random = test_random_case("long poses", i);
        test_pose pose;
        test_random_pose(&random, 12, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_sum *tracked = NULL, *walked = NULL;
        pir_mesh *mesh = NULL, *hull = NULL;
        assert_int_equal(pir_sum_create(p, q, test_rotation(&random), NULL, &tracked), PIR_OK);
        assert_int_equal(pir_sum_create(p, q, pose.rotation, NULL, &walked), PIR_OK);
        assert_int_equal(pir_sum_rotate(tracked, pose.rotation, PIR_METHOD_UPDATE), PIR_OK);
        expect(pir_sum_same_pairing(tracked, walked), "case %llu, %s", (unsigned long long)i, pose.situation);
        assert_int_equal(pir_sum_rotate_brute_force(walked, pose.rotation), PIR_OK);
        expect(pir_sum_same_pairing(tracked, walked), "case %llu, %s", (unsigned long long)i, pose.situation);
        assert_int_equal(pir_sum_mesh(tracked, PIR_EXACT, &mesh), PIR_OK);
        assert_int_equal(pir_hull_sum(p, q, pose.rotation, NULL, PIR_DOUBLE, &hull), PIR_OK);
        expect(pir_mesh_equal(mesh, hull), "case %llu, %s", (unsigned long long)i, pose.situation);
        const char *wrong = test_prove_mesh(tracked, mesh);
        expect(!wrong, "case %llu, %s: %s", (unsigned long long)i, pose.situation, wrong);
        pir_mesh_destroy(hull);
        pir_mesh_destroy(mesh);
        pir_sum_destroy(walked);
        pir_sum_destroy(tracked);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(large_spheres_are_tracked_for_thousands_of_frames),
        cmocka_unit_test(aligned_bodies_are_tracked_for_thousands_of_frames),
        cmocka_unit_test(tens_of_thousands_of_poses_agree),
    };
    return cmocka_run_group_tests_name("long runs", tests, NULL, NULL);
}
