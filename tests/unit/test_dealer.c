/* SPDX-License-Identifier: MIT */
/* Units dealt to simulated workers of different speed, some of which stop or are lost: all units get done, in a time
   that no dealing could beat by much. */
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#include "dealer.h"
#include "support/random.h"

#define WORKERS 8

/* A simulated worker. */
struct worker {
    double speed;  /* units of cost a second */
    double ready;  /* when the unit in work is done; HUGE_VAL when it never is */
    uint64_t unit; /* in work, or `units` */
    bool lost;
};

/* A job, what its units cost, and how often each was given out. */
struct job {
    struct dealer dealer;
    uint64_t units;
    double *cost;
    uint8_t *given;
};

static struct job new_job(test_random *random, uint64_t pairs, uint64_t per_pair) {
    struct job job = {.units = pairs * per_pair};
    job.cost = malloc(job.units * sizeof *job.cost);
    job.given = calloc(job.units, 1);
    assert_true(job.cost && job.given && dealer_init(&job.dealer, job.units, pairs));
    for (uint64_t p = 0; p < pairs; p++) {
        double mean = ldexp(1 + fabs(test_random_unit(random)), test_random_between(random, 0, 6));
        for (uint64_t u = 0; u < per_pair; u++)
            job.cost[p * per_pair + u] = mean * (1 + 0.2 * test_random_unit(random));
    }
    return job;
}

static void end_job(struct job *job) {
    dealer_finish(&job->dealer);
    free(job->cost);
    free(job->given);
}

/* Gives the worker what it gets at `now`. */
static void feed(struct job *job, struct worker *worker, double now) {
    uint64_t unit = dealer_deal(&job->dealer, now);
    if (unit == job->units)
        unit = dealer_late(&job->dealer, now);
    worker->unit = unit;
    if (unit < job->units) {
        job->given[unit]++;
        worker->ready = now + job->cost[unit] / worker->speed;
    } else {
        worker->ready = now + 0.5; // looks again
    }
}

/* The time until all units are done by `count` workers; `stuck` stops in the middle of a unit, `lost` is lost. */
static double run_job(struct job *job, struct worker *workers, int count, int stuck, int lost) {
    double now = 0;
    int turns = 0;
    for (int w = 0; w < count; w++)
        feed(job, &workers[w], 0);
    while (job->dealer.done < job->units) {
        int next = 0;
        for (int w = 1; w < count; w++)
            if (workers[w].ready < workers[next].ready)
                next = w;
        struct worker *worker = &workers[next];
        now = worker->ready;
        assert_true(isfinite(now) && turns++ < 100000);
        if (worker->unit < job->units && next == stuck && turns > 20) {
            worker->ready = HUGE_VAL;
            stuck = -1;
        } else if (worker->unit < job->units && next == lost && turns > 10) {
            dealer_lost(&job->dealer, worker->unit);
            worker->ready = HUGE_VAL;
            lost = -1;
        } else {
            if (worker->unit < job->units)
                dealer_done(&job->dealer, worker->unit, true, now);
            feed(job, worker, now);
        }
    }
    return now;
}

static void all_units_are_done_in_nearly_the_least_time(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("dealer", i);
        int count = test_random_between(&random, 1, WORKERS);
        struct job job = new_job(&random, 1 + test_random_below(&random, 12), 1 + test_random_below(&random, 30));
        struct worker workers[WORKERS];
        double sum = 0, most = 0, speed = 0, slowest = HUGE_VAL;
        for (int w = 0; w < count; w++) {
            workers[w] = (struct worker){.speed = 1 + fabs(test_random_unit(&random)) * (double)(i % 3)};
            speed += workers[w].speed;
            slowest = fmin(slowest, workers[w].speed);
        }
        for (uint64_t u = 0; u < job.units; u++) {
            sum += job.cost[u];
            most = fmax(most, job.cost[u]);
        }
        double took = run_job(&job, workers, count, -1, -1);
        // whoever is last began its unit, or the second go at it, while no one had nothing to do
        expect(took <= sum / speed + 2 * most / slowest + 3 && took >= sum / speed - 1e-9, "case %llu: %g, %g and %g",
               (unsigned long long)i, took, sum / speed, most);
        for (uint64_t u = 0; u < job.units; u++)
            expect(job.given[u] >= 1 && job.given[u] <= 2, "case %llu: unit %llu given %d times", (unsigned long long)i,
                   (unsigned long long)u, job.given[u]);
        end_job(&job);
    }
}

static void a_worker_that_stops_or_is_lost_holds_up_no_unit(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("dealer, lost", i);
        int count = test_random_between(&random, 3, WORKERS);
        struct job job = new_job(&random, 5, 20);
        struct worker workers[WORKERS];
        for (int w = 0; w < count; w++)
            workers[w] = (struct worker){.speed = 1};
        double took = run_job(&job, workers, count, 0, 1), sum = 0, most = 0;
        for (uint64_t u = 0; u < job.units; u++) {
            sum += job.cost[u];
            most = fmax(most, job.cost[u]);
        }
        expect(took <= sum / (count - 2) + 6 * most + 6, "case %llu: %g of %g", (unsigned long long)i, took, sum);
        end_job(&job);
    }
}

static void the_dearest_pair_comes_first(void **state) {
    (void)state;
    struct dealer dealer;
    assert_true(dealer_init(&dealer, 12, 3));
    // one of each pair; the second is the dearest
    const double took[] = {1, 5, 2};
    for (uint64_t p = 0; p < 3; p++) {
        assert_int_equal(dealer_deal(&dealer, 0), 4 * p);
        dealer_done(&dealer, 4 * p, true, took[p]);
    }
    const uint64_t order[] = {5, 6, 7, 9, 10, 11, 1, 2, 3};
    for (int i = 0; i < 9; i++)
        assert_int_equal(dealer_deal(&dealer, 10), order[i]);
    assert_int_equal(dealer_deal(&dealer, 10), 12);
    // none is late yet, then the one whose worker is lost, then those that take too long
    assert_int_equal(dealer_late(&dealer, 10.5), 12);
    dealer_lost(&dealer, 11);
    assert_int_equal(dealer_late(&dealer, 10.5), 11);
    assert_int_equal(dealer_late(&dealer, 10.5), 12);
    assert_int_equal(dealer_late(&dealer, 12.5), 1);
    // done twice counts once
    dealer_done(&dealer, 1, true, 13);
    dealer_done(&dealer, 1, true, 14);
    assert_int_equal(dealer.done, 4);
    dealer_finish(&dealer);
}

static void units_that_were_there_already_say_nothing_about_cost(void **state) {
    (void)state;
    struct dealer dealer;
    assert_true(dealer_init(&dealer, 6, 2));
    assert_int_equal(dealer_deal(&dealer, 0), 0);
    dealer_done(&dealer, 0, false, 9);
    assert_int_equal(dealer_deal(&dealer, 9), 3);
    dealer_done(&dealer, 3, true, 10);
    assert_int_equal(dealer_deal(&dealer, 10), 4);
    assert_int_equal(dealer.pair[0].timed, 0);
    dealer_finish(&dealer);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_units_are_done_in_nearly_the_least_time),
        cmocka_unit_test(a_worker_that_stops_or_is_lost_holds_up_no_unit),
        cmocka_unit_test(the_dearest_pair_comes_first),
        cmocka_unit_test(units_that_were_there_already_say_nothing_about_cost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
