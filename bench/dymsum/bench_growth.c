/* SPDX-License-Identifier: MIT */
/*
 * How the cost of a walk and of an update grows with the bodies. Usage: bench_growth FOLDER
 *
 * growth.csv: geodesic spheres and themselves, of 700 facets each to 400,000: the fastest walk, and the median update
 * at a fixed step, 5,000 to a turn, with the certificates that it checks and the pairs that it repairs. The exponents
 * are those of all sizes up to the row's, by least squares. A facet passes arcs in proportion to the step over their
 * length, so the pairs that the motion itself changes grow by the power 1.5 of the facets. Checks grow by less: on
 * small bodies many come before their time.
 *
 * All sizes are there at once and are visited in turn, several times, so that a clock that changes meanwhile changes
 * for all. A visit goes through the same motion twice, first by walks and then by updates: a caller does one or the
 * other, and the two, frame by frame, would drive each other out of the caches. Each begins with frames that are not
 * timed.
 *
 * growth_region.csv: a region of 30 degrees at 50 steps to a turn, with the axis resting, beside the walk of the whole;
 * the fastest of many frames by the clock, since asking for CPU time takes a sixth of the shortest.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/pirouette.h>

#include "results.h"
#include "spin.h"
#include "trial.h"

/* Frames at the beginning of a motion that are not timed: the first updates after a rebuild check everything. */
#define WARM_UP 3

/* The motion: its steps to a full turn, and its seed. */
#define STEPS 5000
#define SEED  3

/* A body and itself, and what has been measured so far. */
struct growing {
    pir_polytope *p;
    pir_sum *walked, *updated;
    uint32_t frames, facets;
    uint32_t visits;
    double walk;    /* the fastest */
    double *update; /* all of them */
};

static pir_polytope *geodesic(int level) {
    char name[32];
    snprintf(name, sizeof name, "geodesic?level=%d", level);
    return trial_model(name);
}

static struct growing growing_new(int level, uint32_t visits) {
    struct growing body = {.p = geodesic(level), .walk = HUGE_VAL};
    const struct spin spin = spin_new(STEPS, SEED, 0);
    body.facets = pir_polytope_facet_count(body.p);
    body.frames = results_count(body.facets > 50000 ? 15 : 60);
    body.update = malloc((size_t)visits * body.frames * sizeof *body.update);
    trial_need(body.update ? PIR_OK : PIR_ERR_MEMORY, "times");
    trial_need(pir_sum_create(body.p, body.p, spin.now, NULL, &body.walked), "sum");
    trial_need(pir_sum_create(body.p, body.p, spin.now, NULL, &body.updated), "sum");
    return body;
}

static void growing_free(struct growing *body) {
    pir_sum_destroy(body->updated);
    pir_sum_destroy(body->walked);
    pir_polytope_release(body->p);
    free(body->update);
}

static void visit(struct growing *body) {
    struct spin spin = spin_new(STEPS, SEED, 0);
    for (uint32_t i = 0; i < WARM_UP + body->frames; i++) {
        pir_quat rotation = spin_next(&spin);
        double start = trial_now();
        trial_need(pir_sum_rotate(body->walked, rotation, PIR_METHOD_WALK), "walk");
        double took = trial_now() - start;
        if (i >= WARM_UP)
            body->walk = took < body->walk ? took : body->walk;
    }
    spin = spin_new(STEPS, SEED, 0);
    double *update = body->update + (size_t)body->visits++ * body->frames;
    trial_need(pir_sum_reset(body->updated, spin.now), "sum");
    for (uint32_t i = 0; i < WARM_UP + body->frames; i++) {
        pir_quat rotation = spin_next(&spin);
        if (i == WARM_UP)
            pir_sum_reset_statistics(body->updated);
        double start = trial_now();
        trial_need(pir_sum_rotate(body->updated, rotation, PIR_METHOD_UPDATE), "update");
        if (i >= WARM_UP)
            update[i - WARM_UP] = trial_now() - start;
    }
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
    double x[COUNT], walk[COUNT], update[COUNT], checked[COUNT], repaired[COUNT];
    FILE *csv = results_open(results, "growth.csv");
    fprintf(csv, "level,facets,walk_ns,update_ns,checked_per_frame,repaired_per_frame,walk_exponent,update_exponent,"
                 "checked_exponent,repaired_exponent,ns_per_event\n");
    struct growing body[COUNT];
    int count = (int)results_count(COUNT);
    uint32_t visits = results_count(5);
    for (int i = 0; i < count; i++)
        body[i] = growing_new(levels[i], visits);
    for (uint32_t v = 0; v < visits; v++)
        for (int i = 0; i < count; i++)
            visit(&body[i]);
    for (int i = 0; i < count; i++) {
        struct growing *b = &body[i];
        pir_sum_statistics did = pir_sum_get_statistics(b->updated);
        double median = trial_median(b->update, visits * b->frames);
        const double checks = (double)did.checked / b->frames, repairs = (double)did.repaired / b->frames;
        x[i] = log(b->facets);
        walk[i] = log(b->walk);
        update[i] = log(median);
        checked[i] = log(checks);
        repaired[i] = log(repairs);
        // of everything up to here
        const double by_walk = slope(x, walk, i + 1), by_update = slope(x, update, i + 1);
        const double by_checks = slope(x, checked, i + 1), by_repairs = slope(x, repaired, i + 1);
        fprintf(csv, "%d,%u,%.0f,%.0f,%.1f,%.1f,%.3f,%.3f,%.3f,%.3f,%.2f\n", levels[i], b->facets, b->walk, median,
                checks, repairs, by_walk, by_update, by_checks, by_repairs, median / (checks + repairs));
        printf("%7u facets: walk %9.0f ns, update %9.0f ns, %8.1f checked, %8.1f repaired; exponents %.3f %.3f, %.3f "
               "%.3f\n",
               b->facets, b->walk, median, checks, repairs, by_walk, by_update, by_checks, by_repairs);
        growing_free(b);
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
