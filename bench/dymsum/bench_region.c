/* SPDX-License-Identifier: MIT */
/*
 * What an update costs by the half-angle of the region that is kept. Usage: bench_region FOLDER
 *
 * A body and itself turn about random axes, as in bench_speed; the region's axis stands still, or goes with P, so that
 * either what P has in it changes or what Q has. All half-angles go through the same frames in the same run.
 * region.csv, and region.md with the table.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "results.h"
#include "spin.h"
#include "trial.h"

#define FRAMES  4000
#define WARM_UP 500
#define WIDTHS  5

static const double widths[WIDTHS] = {180, 90, 60, 30, 15};

/* v turned by q, of length 1. */
static pir_vec3 turned(pir_quat q, pir_vec3 v) {
    pir_vec3 t = {2 * (q.y * v.z - q.z * v.y), 2 * (q.z * v.x - q.x * v.z), 2 * (q.x * v.y - q.y * v.x)};
    return (pir_vec3){v.x + q.w * t.x + q.y * t.z - q.z * t.y, v.y + q.w * t.y + q.z * t.x - q.x * t.z,
                      v.z + q.w * t.z + q.x * t.y - q.y * t.x};
}

static double mean_of(const double *times, uint32_t count) {
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += times[i];
    return sum / count;
}

static void region_of(const char *name, double steps, int carried, FILE *csv, FILE *page) {
    static double times[WIDTHS][FRAMES];
    pir_polytope *p = trial_model(name);
    struct spin spin = spin_new(steps, 1, 0);
    pir_sum *sums[WIDTHS];
    const pir_vec3 axis = {0.48, 0.6, 0.64};
    double half_angles[WIDTHS];
    for (int k = 0; k < WIDTHS; k++) {
        half_angles[k] = widths[k] < 180 ? widths[k] * (3.14159265358979323846 / 180) : 4;
        trial_need(pir_sum_create(p, p, spin.now, NULL, &sums[k]), "sum");
    }
    uint32_t frames = results_count(FRAMES), warm_up = results_count(WARM_UP);
    for (uint32_t i = 0; i < warm_up + frames; i++) {
        pir_quat rotation = spin_next(&spin);
        pir_vec3 now = carried ? turned(rotation, axis) : axis;
        for (int k = 0; k < WIDTHS; k++) {
            double start = trial_now();
            trial_need(pir_sum_set_region(sums[k], now, half_angles[k]), "region");
            trial_need(pir_sum_rotate(sums[k], rotation, PIR_METHOD_UPDATE), "rotation");
            if (i >= warm_up)
                times[k][i - warm_up] = trial_now() - start;
        }
    }
    for (int k = 0; k < WIDTHS; k++) {
        pir_sum_statistics did = pir_sum_get_statistics(sums[k]);
        double mean = mean_of(times[k], frames), median = trial_median(times[k], frames);
        double checked = (double)did.checked / (frames + warm_up);
        const char *of = carried ? "P" : "Q";
        fprintf(csv, "%s,%.0f,%s,%.0f,%.1f,%.1f,%.1f,%.1f,%.1f\n", name, steps, of, widths[k], median, mean,
                times[k][frames / 100], times[k][frames - 1 - frames / 100], checked);
        fprintf(page, "| %s | %.0f | %s | %.0f | %.0f | %.0f | %.0f | %.0f | %.1f |\n", name, steps, of, widths[k],
                median, mean, times[k][frames / 100], times[k][frames - 1 - frames / 100], checked);
        pir_sum_destroy(sums[k]);
    }
    pir_polytope_release(p);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_region FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *csv = results_open(&results, "region.csv"), *page = results_open(&results, "region.md");
    fprintf(csv, "model,steps,axis_goes_with,half_angle,median_ns,mean_ns,p1_ns,p99_ns,checked_per_frame\n");
    fprintf(page,
            "# Region\n\nMachine: %s; one thread. Setting the region and updating, a body and itself, random axes, %d "
            "frames. "
            "Every time holds the %.0f ns that two readings of the clock take.\n\n"
            "| model | steps | axis goes with | half-angle ° | median ns | mean ns | 1%% | 99%% | checked a frame |\n"
            "|---|---:|---|---:|---:|---:|---:|---:|---:|\n",
            results.machine, FRAMES, trial_clock_cost());
    static const char *const names[] = {"gs4", "ellipse"};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            for (int carried = 0; carried < 2; carried++)
                region_of(names[i], k == 0 ? 500 : 5000, carried, csv, page);
    results_close(csv, "region.csv");
    results_close(page, "region.md");
    printf("results in %s\n", results.folder);
    return 0;
}
