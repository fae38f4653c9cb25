/* SPDX-License-Identifier: MIT */
/* Methods beside each other: the automatic choice gives the same pairing at hardly more work than
   the better of the two. */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>

#include <pirouette/sum.h>

#include "support/bodies.h"

static uint64_t signs_asked(const pir_sum *sum) {
    pir_sum_statistics s = pir_sum_get_statistics(sum);
    return s.by_filter + s.by_exact + s.by_perturbation;
}

/* A turn of 2π/steps about a random axis, without sin and cos: tan(π/steps) as a quotient of small series. */
static pir_quat turn_by(test_random *random, int steps) {
    double x = 3.14159265358979324 / steps, t = x * (1 + x * x / 3 + 2 * x * x * x * x / 15);
    pir_vec3 axis = test_random_direction(random);
    return (pir_quat){axis.x * t, axis.y * t, axis.z * t, 1};
}

static void choose_well(uint64_t number, int steps, bool swings) {
    test_random random = test_random_case("methods", number);
    pir_polytope *p = test_sphere(&random, 100), *q = test_sphere(&random, 100);
    pir_quat r = test_general_rotation(&random), step = turn_by(&random, steps);
    pir_sum *sum[3];
    const pir_method method[] = {PIR_METHOD_AUTO, PIR_METHOD_UPDATE, PIR_METHOD_WALK};
    for (int k = 0; k < 3; k++)
        assert_int_equal(pir_sum_create(p, q, r, NULL, &sum[k]), PIR_OK);
    for (int frame = 0; frame < 800; frame++) {
        if (swings)
            step = (pir_quat){-step.x, -step.y, -step.z, step.w};
        else if (frame % 100 == 99)
            step = turn_by(&random, steps);
        r = test_compose(step, r, 1);
        for (int k = 0; k < 3; k++)
            assert_int_equal(pir_sum_rotate(sum[k], r, method[k]), PIR_OK);
        expect(pir_sum_same_pairing(sum[0], sum[1]) && pir_sum_same_pairing(sum[0], sum[2]), "%d steps, frame %d",
               steps, frame);
    }
    double chosen = (double)signs_asked(sum[0]), update = (double)signs_asked(sum[1]),
           walk = (double)signs_asked(sum[2]);
    print_message("# %5d steps%s: auto %.0f, update %.0f, walk %.0f signs a frame\n", steps,
                  swings ? ", to and fro" : "", chosen / 800, update / 800, walk / 800);
    expect(chosen <= 1.5 * fmin(update, walk), "%d steps", steps);
    for (int k = 0; k < 3; k++)
        pir_sum_destroy(sum[k]);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

static void automatic_choice_costs_hardly_more_than_the_better_method(void **state) {
    (void)state;
    static const int steps[] = {8, 30, 100, 300, 1000, 5000, 50000};
    for (uint64_t i = 0; i < sizeof steps / sizeof *steps; i++)
        choose_well(i, steps[i], false);
    // facets that come back cost no signs, which the choice finds out
    for (uint64_t i = 0; i < 4; i++)
        choose_well(i, steps[i], true);
}

static void automatic_choice_turns_round_when_the_steps_change(void **state) {
    (void)state;
    test_random random = test_random_case("methods change", 0);
    pir_polytope *p = test_sphere(&random, 100), *q = test_sphere(&random, 100);
    pir_quat r = test_general_rotation(&random);
    pir_sum *sum = NULL;
    assert_int_equal(pir_sum_create(p, q, r, NULL, &sum), PIR_OK);
    pir_sum_statistics before = pir_sum_get_statistics(sum), after;
    for (int phase = 0; phase < 4; phase++) {
        pir_quat step = turn_by(&random, phase % 2 ? 5 : 20000);
        for (int frame = 0; frame < 300; frame++)
            assert_int_equal(pir_sum_rotate(sum, r = test_compose(step, r, 1), PIR_METHOD_AUTO), PIR_OK);
        after = pir_sum_get_statistics(sum);
        uint64_t updates = after.updates - before.updates, rebuilds = after.rebuilds - before.rebuilds;
        expect(phase % 2 ? rebuilds > 250 : updates > 250, "phase %d: %llu updates, %llu rebuilds", phase,
               (unsigned long long)updates, (unsigned long long)rebuilds);
        before = after;
    }
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(automatic_choice_costs_hardly_more_than_the_better_method),
        cmocka_unit_test(automatic_choice_turns_round_when_the_steps_change),
    };
    return cmocka_run_group_tests_name("methods", tests, NULL, NULL);
}
