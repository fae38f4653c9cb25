/* SPDX-License-Identifier: MIT */
/* Poses: against quaternion arithmetic of the tests' own, against the C library's sine and cosine, and bit for bit. */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include <pirouette/pose.h>

#include "support/bodies.h"
#include "support/vectors.h"

static pir_pose random_pose(test_random *random, uint64_t number) {
    return (pir_pose){number % 4 ? test_general_rotation(random) : test_hard_rotation((uint32_t)number / 4 % 16),
                      test_random_direction(random)};
}

static pir_vec3 place(pir_pose pose, pir_vec3 v) {
    return test_add(test_turn(pose.rotation, v, 1), pose.translation, 1);
}

static double apart(pir_vec3 a, pir_vec3 b) {
    return test_length(test_add(a, b, -1));
}

static void poses_are_applied_composed_and_inverted(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        test_random random = test_random_case("poses", i);
        // of lengths that the tests' own arithmetic takes
        pir_pose a = {test_general_rotation(&random), test_random_direction(&random)},
                 b = {test_integer_rotation(&random), test_random_direction(&random)};
        pir_vec3 v = test_random_direction(&random);
        unsigned long long number = i;
        expect(apart(pir_pose_apply(a, v), place(a, v)) < 1e-14, "case %llu", number);
        expect(apart(pir_pose_rotate(b, v), test_turn(b.rotation, v, 1)) < 1e-14, "case %llu", number);
        expect(apart(pir_pose_rotate_inverse(b, v), test_turn(b.rotation, v, -1)) < 1e-14, "case %llu", number);
        expect(apart(pir_pose_apply(pir_pose_compose(a, b), v), place(a, place(b, v))) < 1e-14, "case %llu", number);
        expect(apart(pir_pose_apply_inverse(a, place(a, v)), v) < 1e-14, "case %llu", number);
        expect(apart(pir_pose_apply(pir_pose_invert(a), place(a, v)), v) < 1e-14, "case %llu", number);
        // of any length
        pir_pose c = random_pose(&random, i);
        pir_pose round_trip = pir_pose_compose(pir_pose_invert(c), c);
        expect(apart(pir_pose_apply(round_trip, v), v) < 1e-14, "case %llu", number);
    }
    pir_vec3 v = {1, 2, 3};
    assert_true(apart(pir_pose_apply(pir_pose_identity(), v), v) == 0);
}

/* A half turn about each axis, and none, by quaternions whose squares are beyond the doubles. */
static void one_component_alone_may_be_of_any_size(void **state) {
    (void)state;
    static const double sizes[] = {1e300, -1e300, 1e-300, 5e-324};
    const pir_vec3 v = {1, 2, 3}, turned[4] = {{1, -2, -3}, {-1, 2, -3}, {-1, -2, 3}, {1, 2, 3}};
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 4; i++) {
            const double s = sizes[i];
            const pir_pose pose = {{k == 0 ? s : 0, k == 1 ? s : 0, k == 2 ? s : 0, k == 3 ? s : 0}, {10, 20, 30}};
            const pir_vec3 at = {10 + turned[k].x, 20 + turned[k].y, 30 + turned[k].z};
            expect(apart(pir_pose_apply(pose, v), at) < 1e-13, "component %d, %g", k, s);
            expect(apart(pir_pose_apply_inverse(pose, at), v) < 1e-13, "component %d, %g", k, s);
            const pir_pose moved = pir_pose_integrate(pose, (pir_vec3){1, 0, 0}, (pir_vec3){0, 0, 0}, 2);
            expect(apart(pir_pose_apply(moved, v), (pir_vec3){at.x + 2, at.y, at.z}) < 1e-13, "component %d, %g", k, s);
            expect(apart(pir_pose_apply(pir_pose_compose(pose, pose), v),
                         (pir_vec3){10 + (k == 0 || k == 3 ? 10 : -10) + 1, 20 + (k == 1 || k == 3 ? 20 : -20) + 2,
                                    30 + (k == 2 || k == 3 ? 30 : -30) + 3}) < 1e-13,
                   "component %d, %g, twice", k, s);
        }
}

static void a_turn_is_that_of_sine_and_cosine(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 2000; i++) {
        test_random random = test_random_case("integrate", i);
        pir_pose pose = random_pose(&random, i);
        pir_vec3 axis = test_random_direction(&random), velocity = test_random_direction(&random);
        double angle = i % 5 == 0 ? 0 : test_random_scaled(&random, -30, 6), time = 1. / 240;
        pir_vec3 omega = {axis.x * angle / time, axis.y * angle / time, axis.z * angle / time};
        pir_pose after = pir_pose_integrate(pose, velocity, omega, time);
        pir_quat turn = {axis.x * sin(angle / 2), axis.y * sin(angle / 2), axis.z * sin(angle / 2), cos(angle / 2)};
        pir_quat q = after.rotation;
        double length = sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
        pir_vec3 v = test_random_direction(&random), expected = test_turn(turn, pir_pose_rotate(pose, v), 1);
        expect(fabs(length - 1) < 0x1p-50, "case %llu", (unsigned long long)i);
        expect(apart(pir_pose_rotate(after, v), expected) < 1e-14 * (4 + fabs(angle)), "case %llu",
               (unsigned long long)i);
        expect(apart(after.translation, test_add(pose.translation, velocity, time)) < 1e-15, "case %llu",
               (unsigned long long)i);
    }
}

/* A spinning body for a thousand steps: the same bits on every machine. */
static void the_bits_are_the_same_everywhere(void **state) {
    (void)state;
    pir_pose pose = {{0.1, 0.2, 0.3, 0.9}, {1, 2, 3}};
    for (int i = 0; i < 1000; i++)
        pose = pir_pose_integrate(pose, (pir_vec3){1, -0.5, 0.25}, (pir_vec3){3, 20.5, -7}, 1. / 240);
    uint64_t hash = 0xcbf29ce484222325u;
    unsigned char bytes[sizeof pose];
    memcpy(bytes, &pose, sizeof pose);
    for (size_t i = 0; i < sizeof pose; i++)
        hash = (hash ^ bytes[i]) * 0x100000001b3u;
    expect(hash == 0xe088673880d455c9u, "the hash is %016llx", (unsigned long long)hash);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(poses_are_applied_composed_and_inverted),
        cmocka_unit_test(one_component_alone_may_be_of_any_size),
        cmocka_unit_test(a_turn_is_that_of_sine_and_cosine),
        cmocka_unit_test(the_bits_are_the_same_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
