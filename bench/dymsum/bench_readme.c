/* SPDX-License-Identifier: MIT */
/*
 * The table of README.md, row by row. Usage: bench_readme FOLDER MODELS [BODIES STEPS]
 *
 * Each row turns P as `pirouette track --axis random` does, so that its counters are those of the command. MODELS is
 * the folder of the game controller and the mug. readme.csv holds the figures, readme.md the table as it stands in
 * README.md. With BODIES (controller or gs4) and STEPS (to a full turn) only that row is made, and printed.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "motion.h"
#include "results.h"
#include "trial.h"

struct bodies {
    const char *name, *title;
    uint32_t frames;
    pir_polytope *p, *q;
};

static const double all_steps[] = {500, 5000, 50000};

static pir_polytope *read_model(const char *folder, const char *file) {
    char path[1024];
    pir_report report;
    pir_polytope *polytope = NULL;
    snprintf(path, sizeof path, "%s/%s", folder, file);
    if (pir_polytope_read(path, NULL, &report, &polytope) != PIR_OK) {
        fprintf(stderr, "bench: %s\n", report.text);
        exit(1);
    }
    return polytope;
}

/* A row's motion, begun anew for frame 0. */
struct turning {
    uint64_t steps;
    struct motion motion;
};

static pir_quat turn(void *context, uint64_t frame) {
    struct turning *turning = context;
    if (frame > 0)
        return motion_next(&turning->motion);
    turning->motion = motion_new(NULL, turning->steps, 1);
    return motion_before(&turning->motion);
}

/* Two digits, or all before the point. */
static void write_number(FILE *page, double x) {
    fprintf(page, x < 1 ? " %.2f |" : x < 10 ? " %.1f |" : " %.0f |", x);
}

/* One row of readme.md, and of readme.csv unless `csv` is NULL. */
static void write_row(const struct bodies *bodies, double steps, bool titled, FILE *csv, FILE *page) {
    struct trial_request request = {.frames = bodies->frames, .walk_samples = 200, .brute_samples = 20, .choose = true};
    struct turning turning = {.steps = (uint64_t)steps};
    struct trial_result t = trial_run_along(&request, bodies->p, bodies->q, turn, &turning);
    const double numbers[] = {t.update.median / 1e3, t.walk.median / 1e3, t.brute.median / 1e3, t.checked, t.repaired};
    fprintf(page, "| %s | %.0f |", titled ? bodies->title : "", steps);
    for (int k = 0; k < 5; k++)
        write_number(page, numbers[k]);
    fprintf(page, "\n");
    if (csv)
        fprintf(csv, "%s,%.0f,%.1f,%.1f,%.1f,%.1f,%.0f,%.0f,%.2f,%.2f,%u,%u\n", bodies->name, steps, t.update.median,
                t.update.fastest, t.walk.median, t.walk.fastest, t.brute.median, t.brute.fastest, t.checked, t.repaired,
                t.compared, t.mismatches);
}

static void write_head(FILE *page) {
    fprintf(page,
            "| bodies | frames to a full turn | update | rebuild by walk | brute-force re-check | pairs looked at "
            "| pairs repaired |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
}

static void write_table(const char *folder, const struct bodies bodies[2]) {
    struct results results = results_new(folder);
    FILE *csv = results_open(&results, "readme.csv"), *page = results_open(&results, "readme.md");
    fprintf(csv, "bodies,steps,update_ns,update_fastest_ns,walk_ns,walk_fastest_ns,brute_ns,brute_fastest_ns,"
                 "checked_per_frame,repaired_per_frame,compared,mismatches\n");
    fprintf(
        page,
        "# The table of README.md\n\nMachine: %s; one thread. Medians in µs of %u frames (gs4: %u) about random "
        "axes, a new one every 50 frames; of 200 walks and of 20 brute-force re-checks in the same run, in CPU "
        "time. Each sum that was re-checked was held against the updated one: readme.csv has how many differed.\n\n",
        results.machine, (unsigned)bodies[0].frames, (unsigned)bodies[1].frames);
    write_head(page);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
            write_row(&bodies[i], all_steps[k], k == 0, csv, page);
    results_close(csv, "readme.csv");
    results_close(page, "readme.md");
    printf("results in %s\n", results.folder);
}

/* The bodies of a row by name, and its steps; NULL when there is no such row. */
static const struct bodies *find_row(const struct bodies bodies[2], const char *name, double steps) {
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
            if (strcmp(bodies[i].name, name) == 0 && all_steps[k] == steps)
                return &bodies[i];
    return NULL;
}

int main(int argc, char **argv) {
    if (argc != 3 && argc != 5) {
        fprintf(stderr, "usage: bench_readme FOLDER MODELS [controller|gs4 500|5000|50000]\n");
        return 2;
    }
    struct bodies bodies[2] = {
        {"controller", "controller, mug", 2000, read_model(argv[2], "gamepad.off"), read_model(argv[2], "mug.off")},
        {"gs4", "gs4, gs4", 3000, trial_model("gs4"), trial_model("gs4")}};
    int status = 0;
    if (argc == 5) {
        const struct bodies *row = find_row(bodies, argv[3], strtod(argv[4], NULL));
        if (row) {
            write_head(stdout);
            write_row(row, strtod(argv[4], NULL), true, NULL, stdout);
        } else {
            fprintf(stderr, "bench_readme: README.md has no row for %s at %s steps\n", argv[3], argv[4]);
            status = 2;
        }
    } else {
        write_table(argv[1], bodies);
    }
    for (int i = 0; i < 2; i++) {
        pir_polytope_release(bodies[i].p);
        pir_polytope_release(bodies[i].q);
    }
    return status;
}
