/* SPDX-License-Identifier: MIT */
/*
 * The table of README.md, row by row. Usage: bench_readme FOLDER MODELS [BODIES STEPS]
 *
 * Each row turns P as `pirouette track --axis random` does, so that its counters are those of the command. MODELS is
 * the folder of the game controller and the mug. readme.csv holds the figures; docs/figures puts them into README.md.
 * With BODIES (controller or gs4) and STEPS (to a full turn) only that row is made, and printed.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "motion.h"
#include "results.h"
#include "trial.h"

struct bodies {
    const char *name;
    uint32_t frames;
    pir_polytope *p, *q;
};

static const double all_steps[] = {500, 5000, 50000};

static pir_polytope *read_model(const char *folder, const char *file) {
    char path[1024];
    pir_report report;
    pir_polytope *polytope = NULL;
    snprintf(path, sizeof path, "%s/%s", folder, file);
    if (pir_polytope_read(path, NULL, &report, NULL, &polytope) != PIR_OK) {
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

static void write_row(const struct bodies *bodies, double steps, FILE *csv) {
    struct trial_request request = {.frames = bodies->frames, .walk_samples = 200, .brute_samples = 20, .choose = true};
    struct turning turning = {.steps = (uint64_t)steps};
    struct trial_result t = trial_run_along(&request, bodies->p, bodies->q, turn, &turning);
    fprintf(csv, "%s,%.0f", bodies->name, steps);
    const struct trial_times *times[] = {&t.update, &t.walk, &t.brute};
    for (int k = 0; k < 3; k++)
        fprintf(csv, ",%.1f,%.1f,%.1f", times[k]->median, times[k]->mean, times[k]->fastest);
    fprintf(csv, ",%.2f,%.2f,%u,%u\n", t.checked, t.repaired, t.compared, t.mismatches);
}

static void write_head(FILE *csv) {
    fprintf(csv, "bodies,steps,update_ns,update_mean_ns,update_fastest_ns,walk_ns,walk_mean_ns,walk_fastest_ns,"
                 "brute_ns,brute_mean_ns,brute_fastest_ns,checked_per_frame,repaired_per_frame,compared,mismatches\n");
}

static void write_table(const char *folder, const struct bodies bodies[2]) {
    struct results results = results_new(folder);
    FILE *csv = results_open(&results, "readme.csv");
    write_head(csv);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
            write_row(&bodies[i], all_steps[k], csv);
    results_close(csv, "readme.csv");
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
    struct bodies bodies[2] = {{"controller", 2000, read_model(argv[2], "gamepad.off"), read_model(argv[2], "mug.off")},
                               {"gs4", 3000, trial_model("gs4"), trial_model("gs4")}};
    int status = 0;
    if (argc == 5) {
        const struct bodies *row = find_row(bodies, argv[3], strtod(argv[4], NULL));
        if (row) {
            write_head(stdout);
            write_row(row, strtod(argv[4], NULL), stdout);
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
