/* SPDX-License-Identifier: MIT */
/* The two balls of coarse bodies, about one middle: all of the body is in the one, the other is in the body. */
#include "support/test.h"

#include <math.h>

#include <pirouette/shape.h>
#include <pirouette/simplify.h>

#include "simplify/coarse.h"
#include "support/bodies.h"

static void expect_near(double x, double expected, const char *what) {
    expect(fabs(x - expected) <= 1e-9 * fabs(expected), "%s: %.17g, not %.17g", what, x, expected);
}

/* A box is held by the ball through its corners, and holds the one that its nearest sides touch. */
static void balls_of_a_box_are_about_its_middle(void **state) {
    (void)state;
    test_points points = {.count = 8};
    for (int i = 0; i < 8; i++)
        points.at[i] = (pir_vec3){i & 1 ? 103 : 97, i & 2 ? 4 : 0, i & 4 ? -2 : -14};
    pir_polytope *box = test_polytope(&points);
    pir_coarse *coarse = NULL;
    assert_int_equal(pir_coarse_create(box, &coarse), PIR_OK);
    assert_true(coarse->centre.x == 100 && coarse->centre.y == 2 && coarse->centre.z == -8);
    expect_near(coarse->around, 7, "around");
    expect_near(coarse->inside, 2, "inside");
    assert_true(coarse->around >= 7 && coarse->inside <= 2);
    pir_coarse_release(coarse);
    pir_polytope_release(box);
}

/* A body without an inside holds no ball: the number says how far its nearest vertex is, as one below 0. */
static void a_flat_body_holds_no_ball(void **state) {
    (void)state;
    test_points points = {.count = 4, .at = {{0, 0, 1}, {6, 0, 1}, {6, 8, 1}, {0, 8, 1}}};
    pir_polytope *flat = test_polytope(&points);
    pir_coarse *coarse = NULL;
    assert_int_equal(pir_coarse_create(flat, &coarse), PIR_OK);
    expect_near(coarse->around, 5, "around");
    expect_near(coarse->inside, -5, "inside");
    assert_true(coarse->inside <= -5);
    pir_coarse_release(coarse);
    pir_polytope_release(flat);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_of_a_box_are_about_its_middle),
        cmocka_unit_test(a_flat_body_holds_no_ball),
    };
    return cmocka_run_group_tests_name("balls of coarse bodies", tests, NULL, NULL);
}
