/* SPDX-License-Identifier: MIT */
/* Experiment 2: the time of an update by the number of steps to a turn, beside auto, walk and brute force. */
#include <math.h>

#include "chart.h"
#include "experiments.h"
#include "trial.h"

static const double all_steps[] = {10, 20, 50, 100, 200, 500, 1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5};
#define STEPS_COUNT (sizeof all_steps / sizeof all_steps[0])

/*
 * The step in degrees from which on a walk is as fast as an update, or the one found before: between the last row,
 * whose steps and ratio `last` holds, and this one, on a line of logarithms.
 */
static double as_fast(double last[2], double steps, double ratio, double found) {
    if (isnan(found) && last[0] > 0 && last[1] < 1 && ratio >= 1)
        found = 360 / (last[0] * pow(steps / last[0], log(last[1]) / (log(last[1]) - log(ratio))));
    last[0] = steps;
    last[1] = ratio;
    return found;
}

static void run_pair(const struct results *results, FILE *page, FILE *csv, const char *name) {
    pir_polytope *p = trial_model(name);
    char title[96], file[64];
    snprintf(title, sizeof title, "%s ⊕ %s: time by the size of a step", name, name);
    snprintf(file, sizeof file, "figure4-%s.svg", name);
    struct chart chart = {
        .title = title,
        .subtitle = "median of 2,000 frames about random axes, one thread",
        .x_label = "steps to a full turn",
        .y_label = "nanoseconds a frame",
        .count = 4,
        .series = {{.label = "update"}, {.label = "auto"}, {.label = "walk"}, {.label = "brute force"}}};
    double before[2] = {0, 0}, degrees = NAN;
    fprintf(page,
            "### %s ⊕ %s\n\n| steps | update ns | auto ns | walk ns | brute ns | walk / update | brute / update |\n"
            "|---:|---:|---:|---:|---:|---:|---:|\n",
            name, name);
    for (size_t i = 0; i < STEPS_COUNT; i++) {
        double steps = all_steps[i];
        struct trial_request request = {.frames = 2000,
                                        .warm_up = 200,
                                        .walk_samples = 200,
                                        .brute_samples = 10,
                                        .automatic = true,
                                        .steps = steps,
                                        .seed = 7};
        struct trial_result t = trial_run(&request, p, p);
        const double times[4] = {t.update.median, t.automatic.median, t.walk.median, t.brute.median};
        for (unsigned k = 0; k < 4; k++)
            chart_add(&chart.series[k], steps, times[k]);
        degrees = as_fast(before, steps, t.walk.median / t.update.median, degrees);
        fprintf(csv, "%s,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,%.2f\n", name, steps, t.update.median, t.update.mean,
                t.automatic.median, t.automatic.mean, t.walk.median, t.brute.median, t.events);
        fprintf(page, "| %.0f | %.0f | %.0f | %.0f | %.0f | %.2f | %.1f |\n", steps, times[0], times[1], times[2],
                times[3], times[2] / times[0], times[3] / times[0]);
    }
    fprintf(page, "\nAn update and a walk take the same time at steps of %.1f degrees.\n\n![](%s)\n\n", degrees, file);
    FILE *svg = results_open(results, file);
    chart_write(&chart, svg);
    results_close(svg, file);
    pir_polytope_release(p);
}

void experiment_figure4(const struct results *results, FILE *page) {
    fprintf(
        page,
        "## Figure 4: time by the number of steps to a turn\n\nThe paper names no models here; its curve falls until "
        "500 steps and stays below 0.5 ms from there on, and no lower.\n\n");
    FILE *csv = results_open(results, "figure4.csv");
    fprintf(csv, "model,steps,update_ns,update_mean_ns,auto_ns,auto_mean_ns,walk_ns,brute_ns,events_per_frame\n");
    run_pair(results, page, csv, "gs4");
    run_pair(results, page, csv, "ellipse");
    run_pair(results, page, csv, "vrod");
    results_close(csv, "figure4.csv");
}
