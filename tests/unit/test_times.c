/* SPDX-License-Identifier: MIT */
/* The command's record of times: of short runs exact, of long ones by bins, held against all times sorted. */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "support/random.h"
#include "times.h"

static int64_t random_time(test_random *random) {
    switch (test_random_below(random, 20)) {
    case 0:
        return 0;
    case 1:
        return (int64_t)1 << test_random_below(random, 62);
    case 2:
        return ((int64_t)1 << test_random_below(random, 62)) - 1;
    default:
        return (int64_t)test_random_below(random, 1u << test_random_between(random, 1, 30));
    }
}

static void order_is_that_of_all_times(void **state) {
    (void)state;
    static const uint64_t frames[] = {1, 2, 3, 100, TIMES_KEPT, TIMES_KEPT + 1, 3 * TIMES_KEPT - 7};
    for (uint64_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        test_random random = test_random_case("times", i);
        struct times times;
        struct order order, all;
        double *every = malloc(frames[i] * sizeof *every);
        assert_non_null(every);
        assert_true(times_init(&times, frames[i]));
        assert_true(times.kept_count <= TIMES_KEPT);
        assert_true(times_order(&times, &order));
        assert_true(order.count == 0 && isnan(order.median));
        for (uint64_t frame = 0; frame < frames[i]; frame++) {
            // some are not measured
            int64_t ns = random_time(&random);
            bool measured = frame == 0 || test_random_below(&random, 5) > 0;
            every[frame] = measured ? (double)ns : NAN;
            if (measured)
                times_add(&times, frame, ns);
        }
        assert_true(times_order(&times, &order) && order_of(every, frames[i], &all));
        double slack = frames[i] > TIMES_KEPT ? 1.0 / 2000 : 0;
        assert_true(order.count == all.count && order.max == all.max);
        expect(fabs(order.median - all.median) <= slack * all.median, "%g for %g", order.median, all.median);
        expect(fabs(order.p99 - all.p99) <= slack * all.p99, "%g for %g", order.p99, all.p99);
        for (size_t k = 0; k < times.kept_count; k++)
            assert_true(isnan(times.kept[k]) || times.kept[k] <= all.max);
        times_finish(&times);
        free(every);
    }
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {cmocka_unit_test(order_is_that_of_all_times)};
    return cmocka_run_group_tests_name("times", tests, NULL, NULL);
}
