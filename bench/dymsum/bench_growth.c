/* SPDX-License-Identifier: MIT */
/*
 * How the cost of a walk and of an update grows with the bodies. Usage: bench_growth FOLDER
 *
 * growth.csv: geodesic spheres and themselves, of 700 facets each to 400,000, in CPU time: the fastest walk, and the
 * median update at a fixed step, 5,000 to a turn, with the certificates that it checks and the pairs that it repairs.
 * The exponents are those of all sizes up to the row's, by least squares. A facet passes arcs in proportion to the step
 * over their length, so what the motion itself changes grows by the power 1.5 of the facets; checks that come before
 * their time hide some of that on small bodies.
 *
 * growth_region.csv: a region of 30 degrees at 50 steps to a turn, with the axis resting, beside the walk of the whole;
 * the fastest of many frames by the clock, since asking for CPU time takes a sixth of the shortest.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <pirouette/pirouette.h>

#include "results.h"
#include "spin.h"
#include "trial.h"

static double cpu_now(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

/* The fastest walk and the median update of a body and itself, and events a frame of updates. */
struct cost {
    double walk, update, events;
};

static struct cost cost_of(pir_polytope *p, uint32_t frames, double steps) {
    pir_sum *walked, *updated;
    struct spin spin = spin_new(steps, 3, 0);
    double *walk = malloc(frames * sizeof *walk), *update = malloc(frames * sizeof *update);
    trial_need(walk && update ? PIR_OK : PIR_ERR_MEMORY, "times");
    trial_need(pir_sum_create(p, p, spin.now, NULL, &walked), "sum");
    trial_need(pir_sum_create(p, p, spin.now, NULL, &updated), "sum");
    // the first updates after a rebuild check everything
    for (int i = 0; i < 3; i++)
        trial_need(pir_sum_rotate(updated, spin_next(&spin), PIR_METHOD_UPDATE), "update");
    pir_sum_reset_statistics(updated);
    for (uint32_t i = 0; i < frames; i++) {
        pir_quat rotation = spin_next(&spin);
        double start = cpu_now();
        trial_need(pir_sum_rotate(walked, rotation, PIR_METHOD_WALK), "walk");
        double between = cpu_now();
        trial_need(pir_sum_rotate(updated, rotation, PIR_METHOD_UPDATE), "update");
        walk[i] = between - start;
        update[i] = cpu_now() - between;
    }
    pir_sum_statistics did = pir_sum_get_statistics(updated);
    trial_median(walk, frames);
    struct cost cost = {walk[0], trial_median(update, frames), (double)(did.checked + did.repaired) / frames};
    pir_sum_destroy(updated);
    pir_sum_destroy(walked);
    free(update);
    free(walk);
    return cost;
}

static pir_polytope *geodesic(int level) {
    char name[32];
    snprintf(name, sizeof name, "geodesic?level=%d", level);
    return trial_model(name);
}

/* The slope of y over x, both logarithms, by least squares. */
static double slope(const double *x, const double *y, int count) {
    double mx = 0, my = 0, xy = 0, xx = 0;
    for (int i = 0; i < count; i++) {
        mx += x[i] / count;
        my += y[i] / count;
    }
    for (int i = 0; i < count; i++) {
        xy += (x[i] - mx) * (y[i] - my);
        xx += (x[i] - mx) * (x[i] - mx);
    }
    return count > 1 ? xy / xx : 0;
}

static void write_growth(const struct results *results) {
    static const int levels[] = {5, 7, 10, 14, 20, 28, 40, 57, 80, 113, 142};
    enum { COUNT = sizeof levels / sizeof levels[0] };
    double x[COUNT], walk[COUNT], update[COUNT], events[COUNT];
    FILE *csv = results_open(results, "growth.csv");
    fprintf(csv, "level,facets,walk_ns,update_ns,events_per_frame,walk_exponent,update_exponent,events_exponent,"
                 "ns_per_event\n");
    int count = (int)results_count(COUNT);
    for (int i = 0; i < count; i++) {
        pir_polytope *p = geodesic(levels[i]);
        uint32_t facets = pir_polytope_facet_count(p);
        struct cost c = cost_of(p, results_count(facets > 50000 ? 15 : 60), 5000);
        x[i] = log(facets);
        walk[i] = log(c.walk);
        update[i] = log(c.update);
        events[i] = log(c.events);
        // of everything up to here
        fprintf(csv, "%d,%u,%.0f,%.0f,%.1f,%.2f,%.2f,%.2f,%.2f\n", levels[i], facets, c.walk, c.update, c.events,
                slope(x, walk, i + 1), slope(x, update, i + 1), slope(x, events, i + 1), c.update / c.events);
        printf("%7u facets: walk %9.0f ns, update %9.0f ns, %8.1f events; exponents %.2f %.2f %.2f\n", facets, c.walk,
               c.update, c.events, slope(x, walk, i + 1), slope(x, update, i + 1), slope(x, events, i + 1));
        fflush(stdout);
        pir_polytope_release(p);
    }
    results_close(csv, "growth.csv");
}

/* --- regions --- */

static void region_of(const char *name, FILE *csv) {
    pir_polytope *p = trial_model(name);
    pir_sum *whole, *kept;
    struct spin spin = spin_new(50, 5, 0);
    const pir_vec3 axis = {0.48, 0.6, 0.64};
    const double half_angle = 30 * (3.14159265358979323846 / 180);
    enum { FRAMES = 400 };
    static double walk[FRAMES], update[FRAMES];
    trial_need(pir_sum_create(p, p, spin.now, NULL, &whole), "sum");
    trial_need(pir_sum_create(p, p, spin.now, NULL, &kept), "sum");
    trial_need(pir_sum_set_region(kept, axis, half_angle), "region");
    uint32_t frames = results_count(FRAMES);
    for (uint32_t i = 0; i < frames; i++) {
        pir_quat rotation = spin_next(&spin);
        double start = trial_now();
        trial_need(pir_sum_rotate(whole, rotation, PIR_METHOD_WALK), "walk");
        double walked = trial_now();
        trial_need(pir_sum_rotate(kept, rotation, PIR_METHOD_AUTO), "region");
        walk[i] = walked - start;
        update[i] = trial_now() - walked;
    }
    trial_median(walk, frames);
    trial_median(update, frames);
    double of_walk = walk[0], of_region = update[0];
    fprintf(csv, "%s,%u,%.0f,%.0f,%.3f\n", name, pir_polytope_facet_count(p), of_walk, of_region, of_region / of_walk);
    printf("%s: walk %.0f ns, region %.0f ns, %.3f\n", name, of_walk, of_region, of_region / of_walk);
    pir_sum_destroy(kept);
    pir_sum_destroy(whole);
    pir_polytope_release(p);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_growth FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *csv = results_open(&results, "growth_region.csv");
    fprintf(csv, "model,facets,walk_ns,region_ns,region_over_walk\n");
    static const char *const names[] = {"gs4", "ellipse", "geodesic?level=10", "geodesic?level=20"};
    for (int i = 0; i < 4; i++)
        region_of(names[i], csv);
    results_close(csv, "growth_region.csv");
    write_growth(&results);
    printf("results in %s\n", results.folder);
    return 0;
}
