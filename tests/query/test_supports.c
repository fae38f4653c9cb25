/* SPDX-License-Identifier: MIT */
/* Support functions in libccd's form give points of the body, in its pose, that no other point of it goes beyond. */
#include "support/test.h"

#include <math.h>

#include <pirouette/ccd.h>
#include <pirouette/exact.h>
#include <pirouette/query.h>

#include "support/bodies.h"

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The greatest dot product of `direction` with a vertex, and the largest coordinate. */
static double greatest(const pir_vec3 *at, uint32_t count, const double *direction, double *size) {
    double most = -HUGE_VAL;
    for (uint32_t v = 0; v < count; v++) {
        const double x[3] = {at[v].x, at[v].y, at[v].z};
        most = fmax(most, dot(x, direction));
        for (int k = 0; k < 3; k++)
            *size = fmax(*size, fabs(x[k]));
    }
    return most;
}

/* Directions of all lengths, and along axes. */
static void draw(test_random *random, int n, double *direction) {
    pir_vec3 d = test_random_direction(random);
    double length = n % 3 ? 1 : ldexp(1, test_random_between(random, -200, 200));
    direction[0] = d.x * length, direction[1] = d.y * length, direction[2] = d.z * length;
    for (int k = 0; k < 3 && n % 4 == 0; k++)
        direction[k] = k == n % 3 ? length : 0;
}

static void expect_farthest(double reached, double most, const double *direction, double size, uint64_t number) {
    double length = sqrt(dot(direction, direction));
    expect(fabs(reached - most) <= 1e-13 * size * length, "case %llu: %.17g, not %.17g", (unsigned long long)number,
           reached, most);
}

static void supports_of_sums_are_farthest(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 120; i++) {
        test_random random = test_random_case("supports", i);
        test_pose pose;
        test_random_pose(&random, 14, &pose);
        pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
        pir_sum_options options = {NULL, (int)(i % 2)};
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_sum_create(p, q, pose.rotation, &options, &sum), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
        for (int n = 0; n < 24; n++) {
            double direction[3], point[3], size = 0;
            draw(&random, n, direction);
            pir_support_sum_ccd(sum, direction, point);
            double most = greatest(pir_mesh_vertices(mesh), pir_mesh_vertex_count(mesh), direction, &size);
            // what is added up may be larger than the sum
            greatest(pose.p.at, (uint32_t)pose.p.count, direction, &size);
            greatest(pose.q.at, (uint32_t)pose.q.count, direction, &size);
            expect_farthest(dot(point, direction), most, direction, size, i);
        }
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

/* A body alone is its sum with one point. */
static void supports_of_bodies_are_farthest(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 120; i++) {
        test_random random = test_random_case("body supports", i);
        test_pose pose;
        test_random_pose(&random, 14, &pose);
        pir_polytope *p = test_polytope(&pose.p), *point_body = NULL;
        pir_support_body body = {p, pose.rotation, test_random_direction(&random), UINT32_MAX};
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_polytope_create(&body.translation, 1, NULL, &point_body), PIR_OK);
        assert_int_equal(pir_sum_create(p, point_body, pose.rotation, NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
        for (int n = 0; n < 24; n++) {
            double direction[3], point[3], size = 1;
            draw(&random, n, direction);
            pir_support_body_ccd(&body, direction, point);
            double most = greatest(pir_mesh_vertices(mesh), pir_mesh_vertex_count(mesh), direction, &size);
            greatest(pose.p.at, (uint32_t)pose.p.count, direction, &size);
            expect_farthest(dot(point, direction), most, direction, size, i);
            assert_true(body.last < pir_polytope_vertex_count(p));
        }
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        pir_polytope_release(point_body);
        pir_polytope_release(p);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(supports_of_sums_are_farthest),
        cmocka_unit_test(supports_of_bodies_are_farthest),
    };
    return cmocka_run_group_tests_name("supports", tests, NULL, NULL);
}
