/* SPDX-License-Identifier: MIT */
/* Experiment 3: time by the size of the input, two identical tessellated cubes. */
#include "bulge.h"
#include "chart.h"
#include "experiments.h"
#include "trial.h"

void experiment_figure5(const struct results *results, FILE *page) {
    struct chart chart = {.title = "Two tessellated cubes: time by their size",
                          .subtitle = "500 steps a turn, median of 2,000 frames about random axes, one thread",
                          .x_label = "triangles",
                          .y_label = "nanoseconds a frame",
                          .count = 5,
                          .series = {{.label = "update, bulging"},
                                     {.label = "walk, bulging"},
                                     {.label = "brute force, bulging"},
                                     {.label = "update, flat (6 facets)"},
                                     {.label = "brute force, flat"}}};
    FILE *csv = results_open(results, "figure5.csv");
    fprintf(csv, "triangles,flat,facets,update_ns,walk_ns,brute_ns,events_per_frame\n");
    fprintf(
        page,
        "## Figure 5: time by the size of tessellated cubes\n\nFacets here are maximal, so every tessellation of a "
        "cube is the same cube of 6 facets, and costs the same: the columns *flat*. The columns *bulging* are of a "
        "cube whose faces bulge so little, a twentieth of a ball's norm, that it still is a cube to the eye, and so "
        "much that each triangle is a facet. In the paper brute force grows rapidly and update linearly.\n\n"
        "| triangles | facets | update ns | walk ns | brute ns | brute / update | flat: facets | update ns | "
        "brute ns |\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (unsigned n = 1; n <= BULGE_LARGEST; n++) {
        unsigned triangles = 12 * n * n;
        struct trial_request request = {
            .frames = 2000, .warm_up = 200, .walk_samples = 200, .brute_samples = 20, .steps = PAPER_STEPS, .seed = n};
        struct trial_result t[2];
        uint32_t facets[2];
        for (int flat = 0; flat < 2; flat++) {
            pir_polytope *cube = bulge_cube(n, flat);
            facets[flat] = pir_polytope_facet_count(cube);
            t[flat] = trial_run(&request, cube, cube);
            pir_polytope_release(cube);
            fprintf(csv, "%u,%d,%u,%.0f,%.0f,%.0f,%.2f\n", triangles, flat, facets[flat], t[flat].update.median,
                    t[flat].walk.median, t[flat].brute.median, t[flat].events);
        }
        const double times[5] = {t[0].update.median, t[0].walk.median, t[0].brute.median, t[1].update.median,
                                 t[1].brute.median};
        for (unsigned k = 0; k < 5; k++)
            chart_add(&chart.series[k], triangles, times[k]);
        fprintf(page, "| %u | %u | %.0f | %.0f | %.0f | %.1f | %u | %.0f | %.0f |\n", triangles, facets[0], times[0],
                times[1], times[2], times[2] / times[0], facets[1], times[3], times[4]);
    }
    fprintf(page, "\n![](figure5.svg)\n");
    results_close(csv, "figure5.csv");
    FILE *svg = results_open(results, "figure5.svg");
    chart_write(&chart, svg);
    results_close(svg, "figure5.svg");
}
