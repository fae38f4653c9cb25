/* SPDX-License-Identifier: MIT */
/*
 * The mesh of a sum, in four ways: from a tracked pairing, from a walk, as the hull of all sums of vertices, and proven
 * or found again by the oracle in exact arithmetic. Poses are mostly degenerate.
 */
#include "support/test.h"

#include <math.h>

#include <pirouette/baseline.h>
#include <pirouette/exact.h>

#include "oracle/check_sum.h"
#include "support/bodies.h"
#include "support/meshes.h"

static double size_of(const test_points *points) {
    double size = 0;
    for (size_t i = 0; i < points->count; i++)
        size = fmax(size, fmax(fabs(points->at[i].x), fmax(fabs(points->at[i].y), fabs(points->at[i].z))));
    return size;
}

static void mesh_is_proven_and_equals_the_hull_of_all_sums(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 700; i++) {
        test_random random = test_random_case("mesh proof", i);
        test_pose pose;
        test_random_pose(&random, i % 10 ? 12 : 40, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_sum_options options = pir_sum_options_default();
        options.difference = i % 2;
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL, *hull = NULL, *plain = NULL;
        // reached by an update from somewhere else
        assert_int_equal(pir_sum_create(p, q, (pir_quat){1, 0, 0, 1}, &options, &sum), PIR_OK);
        assert_int_equal(pir_sum_rotate(sum, pose.rotation, PIR_METHOD_UPDATE), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &plain), PIR_OK);
        assert_int_equal(pir_hull_sum(p, q, pose.rotation, &options, PIR_EXACT, &hull), PIR_OK);
        const char *wrong = test_prove_mesh(sum, mesh);
        expect(!wrong, "case %llu, %s: %s", (unsigned long long)i, pose.situation, wrong);
        wrong = oracle_check_doubles(mesh, 64, size_of(&pose.p) + size_of(&pose.q));
        expect(!wrong, "case %llu, %s: %s", (unsigned long long)i, pose.situation, wrong);
        expect(pir_mesh_equal(mesh, hull), "case %llu, %s", (unsigned long long)i, pose.situation);
        expect(pir_mesh_equal(mesh, plain), "case %llu, %s", (unsigned long long)i, pose.situation);
        expect(test_hash_mesh(TEST_HASH_START, mesh) == test_hash_mesh(TEST_HASH_START, hull), "case %llu, %s",
               (unsigned long long)i, pose.situation);
        pir_mesh_destroy(plain);
        pir_mesh_destroy(hull);
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* The exact mesh of a pose's sum, from a walk; it outlives what it was made from. */
static pir_mesh *mesh_of(const test_pose *pose) {
    pir_polytope *p = test_polytope(&pose->p), *q = test_polytope(&pose->q);
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_sum_create(p, q, pose->rotation, NULL, &sum), PIR_OK);
    assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return mesh;
}

static void small_sum_has_the_facets_that_brute_force_finds(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 160; i++) {
        test_random random = test_random_case("mesh brute force", i);
        test_pose pose;
        test_random_pose(&random, 7, &pose);
        pir_mesh *mesh = mesh_of(&pose);
        // from the points as they were given, not from the library's hulls of them
        oracle_points at_p, at_q;
        oracle_quat rotation;
        oracle_points_from_doubles(&at_p, pose.p.at, pose.p.count);
        oracle_points_from_doubles(&at_q, pose.q.at, pose.q.count);
        oracle_quat_init(rotation, pose.rotation);
        oracle_points_rotate(&at_p, rotation);
        const char *wrong = oracle_compare_brute_force(mesh, &at_p, &at_q);
        expect(!wrong, "case %llu, %s: %s", (unsigned long long)i, pose.situation, wrong);
        oracle_quat_clear(rotation);
        oracle_points_clear(&at_q);
        oracle_points_clear(&at_p);
        pir_mesh_destroy(mesh);
    }
}

static void support_of_the_sum_is_the_sum_of_the_supports(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        test_random random = test_random_case("mesh support", i);
        test_pose pose;
        test_random_pose(&random, 16, &pose);
        pir_mesh *mesh = mesh_of(&pose);
        oracle_points at_p, at_q, at_m;
        oracle_quat rotation;
        oracle_points_from_doubles(&at_p, pose.p.at, pose.p.count);
        oracle_points_from_doubles(&at_q, pose.q.at, pose.q.count);
        oracle_points_from_mesh(&at_m, mesh);
        oracle_quat_init(rotation, pose.rotation);
        oracle_points_rotate(&at_p, rotation);
        oracle_points_common((oracle_points *const[]){&at_p, &at_q, &at_m}, 3);
        mpz_t a, b, m;
        oracle_vec direction;
        mpz_inits(a, b, m, NULL);
        oracle_vec_init(direction);
        for (int n = 0; n < 20; n++) {
            for (int k = 0; k < 3; k++)
                mpz_set_si(direction[k], n % 2 ? test_random_between(&random, -1000000, 1000000)
                                               : test_random_between(&random, -1, 1));
            oracle_support(a, &at_p, direction);
            oracle_support(b, &at_q, direction);
            oracle_support(m, &at_m, direction);
            mpz_add(a, a, b);
            expect(mpz_cmp(a, m) == 0, "case %llu, %s", (unsigned long long)i, pose.situation);
        }
        oracle_vec_clear(direction);
        mpz_clears(a, b, m, NULL);
        oracle_quat_clear(rotation);
        oracle_points_clear(&at_m);
        oracle_points_clear(&at_q);
        oracle_points_clear(&at_p);
        pir_mesh_destroy(mesh);
    }
}

/* Random fractions of small numbers: what no double holds. */
static pir_polytope *rational_polytope(test_random *random, uint32_t count) {
    mpq_t *x = test_malloc(3 * count * sizeof *x);
    pir_polytope *polytope = NULL;
    for (uint32_t i = 0; i < 3 * count; i++) {
        mpq_init(x[i]);
        mpq_set_si(x[i], test_random_between(random, -9, 9), (unsigned long)test_random_between(random, 1, 7));
        mpq_canonicalize(x[i]);
    }
    assert_int_equal(pir_polytope_create_exact((const mpq_t *)x, count, NULL, &polytope), PIR_OK);
    for (uint32_t i = 0; i < 3 * count; i++)
        mpq_clear(x[i]);
    test_free(x);
    return polytope;
}

static void sums_of_rational_bodies_are_proven(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 120; i++) {
        test_random random = test_random_case("mesh rationals", i);
        pir_polytope *p = rational_polytope(&random, 1 + test_random_below(&random, 14));
        pir_polytope *q = rational_polytope(&random, 1 + test_random_below(&random, 14));
        pir_quat r = test_rotation(&random);
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL, *hull = NULL;
        assert_int_equal(pir_sum_create(p, q, r, NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_EXACT, &mesh), PIR_OK);
        assert_int_equal(pir_hull_sum(p, q, r, NULL, PIR_EXACT, &hull), PIR_OK);
        const char *wrong = test_prove_mesh(sum, mesh);
        expect(!wrong, "case %llu: %s", (unsigned long long)i, wrong);
        expect(pir_mesh_equal(mesh, hull), "case %llu", (unsigned long long)i);
        pir_mesh_destroy(hull);
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mesh_is_proven_and_equals_the_hull_of_all_sums),
        cmocka_unit_test(small_sum_has_the_facets_that_brute_force_finds),
        cmocka_unit_test(support_of_the_sum_is_the_sum_of_the_supports),
        cmocka_unit_test(sums_of_rational_bodies_are_proven),
    };
    return cmocka_run_group_tests_name("meshes", tests, NULL, NULL);
}
