/* SPDX-License-Identifier: MIT */
/*
 * Support functions in libccd's form give points of the body in its pose. No other point of the body is farther along
 * the direction.
 */
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
    direction[0] = d.x * length;
    direction[1] = d.y * length;
    direction[2] = d.z * length;
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
        pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = (int)(i % 2)};
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_sum_create(p, q, pose.rotation, &options, &sum), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
        for (int n = 0; n < 24; n++) {
            double direction[3], point[3], size = 0;
            draw(&random, n, direction);
            pir_support_sum_ccd(sum, direction, point);
            double most = greatest(pir_mesh_vertices(mesh), pir_mesh_vertex_count(mesh), direction, &size);
            // terms may be larger than their sum
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

static pir_polytope *point_at(double x, double y, double z) {
    pir_polytope *point = NULL;
    assert_int_equal(pir_polytope_create(&(pir_vec3){x, y, z}, 1, NULL, &point), PIR_OK);
    return point;
}

/*
 * Two points have no size. The unit comes from the distance, whichever body or coordinate it is in, or from the
 * translation.
 */
static void two_points_are_apart_at_every_scale(void **state) {
    (void)state;
    // the limit for a body is 2^400 of the unit, which is 1 for points at the origin
    for (int n = 0; n < 9; n++)
        for (int exponent = -1060; exponent <= (n < 6 ? 1000 : 380); exponent += 20) {
            double far = ldexp(1, exponent), v[3] = {n % 3 == 0 ? far : 0, n % 3 == 1 ? far : 0, n % 3 == 2 ? far : 0};
            pir_polytope *origin = point_at(0, 0, 0), *away = point_at(v[0], v[1], v[2]);
            pir_polytope *p = n / 3 == 0 ? away : origin, *q = n / 3 == 1 ? away : origin;
            const pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = true};
            pir_query_input input = {.cutoff = HUGE_VAL};
            if (n / 3 == 2)
                input.translation = (pir_vec3){v[0], v[1], v[2]};
            pir_sum *sum = NULL;
            pir_query *query = NULL;
            pir_query_result told;
            assert_int_equal(pir_sum_create(p, q, (pir_quat){0, 0, 0, 1}, &options, &sum), PIR_OK);
            assert_int_equal(pir_query_create(sum, &query), PIR_OK);
            assert_int_equal(pir_query_signed_distance(query, &input, NULL, &told), PIR_OK);
            double length =
                sqrt(told.normal.x * told.normal.x + told.normal.y * told.normal.y + told.normal.z * told.normal.z);
            expect(told.state == PIR_OUTSIDE && told.distance == far && fabs(length - 1) < 1e-14,
                   "case %d, 2^%d: state %d, distance %g, normal of length %g", n, exponent, (int)told.state,
                   told.distance, length);
            pir_ccd_pair pair = {p, q, {0, 0, 0, 1}, input.translation};
            pir_ccd_outcome outcome;
            double distance;
            pir_status status = pir_ccd_distance(&pair, &outcome, &distance);
            // the least unit is 2^-1020
            expect(status == PIR_ERR_NOT_BUILT || exponent < -1000 ||
                       (status == PIR_OK && outcome == PIR_CCD_SEPARATED && fabs(distance - far) <= 1e-9 * far),
                   "case %d, 2^%d: by supports alone outcome %d, distance %g", n, exponent, (int)outcome, distance);
            pir_query_destroy(query);
            pir_sum_destroy(sum);
            pir_polytope_release(away);
            pir_polytope_release(origin);
        }
}

/* A translation that is no double in units of the bodies' size is refused. One at the limit is not. */
static void bodies_too_far_for_their_size_are_refused_by_supports(void **state) {
    (void)state;
    for (int size = -1000; size <= 0; size += 125)
        for (int more = -2; more <= 2; more++) {
            const double half = ldexp(1, size - 1);
            test_points cube = {.count = 8};
            for (int i = 0; i < 8; i++)
                cube.at[i] = (pir_vec3){i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half};
            pir_polytope *p = test_polytope(&cube);
            // bodies of a width of 2^size are less than a unit of 2^(size + 1) wide
            const int exponent = size + 1 + 1023 + more;
            if (exponent <= 1023) {
                const pir_ccd_pair pair = {p, p, {0, 0, 0, 1}, {0, ldexp(1, exponent), 0}};
                pir_ccd_outcome outcome = PIR_CCD_FAILED;
                double distance = -1;
                const pir_status status = pir_ccd_distance(&pair, &outcome, &distance);
                expect(status == PIR_ERR_NOT_BUILT || status == (more > 0 ? PIR_ERR_LIMIT : PIR_OK),
                       "2^%d, 2^%d apart: %s", size, exponent, pir_status_text(status));
                if (status != PIR_OK)
                    assert_true(outcome == PIR_CCD_FAILED && distance == -1);
                assert_int_equal(pir_ccd_overlap(&pair, &outcome), status);
            }
            pir_polytope_release(p);
        }
}

/*
 * Bodies that touch are too close to decide by supports alone: the answer is never that they are apart, and no
 * distance.
 */
static void bodies_that_touch_are_not_apart_by_supports(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        test_random random = test_random_case("touching supports", i);
        pir_polytope *p = test_random_polytope(&random, i % 2 ? TEST_BOX : TEST_OCTAHEDRON, 8),
                     *q = test_random_polytope(&random, i % 3 ? TEST_BOX : TEST_OCTAHEDRON, 8);
        pir_vec3 low[2], high[2], middle[2];
        pir_polytope_bounds(p, &low[0], &high[0]);
        pir_polytope_bounds(q, &low[1], &high[1]);
        // the corners of an octahedron are on the axes
        for (int k = 0; k < 2; k++)
            middle[k] = (k ? i % 3 : i % 2) ? (pir_vec3){0, (low[k].y + high[k].y) / 2, (low[k].z + high[k].z) / 2}
                                            : (pir_vec3){0, 0, 0};
        // the middle of P's left side, or its corner there, on that of Q's right
        pir_vec3 t = {high[1].x - low[0].x, middle[1].y - middle[0].y, middle[1].z - middle[0].z};
        pir_ccd_pair pair = {p, q, {0, 0, 0, 1}, t};
        pir_ccd_outcome outcome = PIR_CCD_OVERLAPPING;
        double distance = 0;
        pir_status status = pir_ccd_distance(&pair, &outcome, &distance);
        assert_true(status == PIR_OK || status == PIR_ERR_NOT_BUILT);
        expect(outcome != PIR_CCD_SEPARATED && distance == 0, "case %llu: outcome %d, distance %g",
               (unsigned long long)i, (int)outcome, distance);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(supports_of_sums_are_farthest),
        cmocka_unit_test(supports_of_bodies_are_farthest),
        cmocka_unit_test(two_points_are_apart_at_every_scale),
        cmocka_unit_test(bodies_too_far_for_their_size_are_refused_by_supports),
        cmocka_unit_test(bodies_that_touch_are_not_apart_by_supports),
    };
    return cmocka_run_group_tests_name("supports", tests, NULL, NULL);
}
