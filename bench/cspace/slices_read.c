/* SPDX-License-Identifier: MIT */
#include "slices_read.h"

#include <math.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "trial.h"

#define ROUNDS  3
#define OPENED  5
#define SAMPLES 2000

pir_cspace_job *slices_job(const struct slices_bodies *bodies, const char *path, uint32_t slices_per_key) {
    const pir_cspace_bodies given = {bodies->p, bodies->pieces, &bodies->q, 1};
    pir_cspace_options options = pir_cspace_options_default();
    pir_cspace_job *job = NULL;
    options.slices_per_unit = SLICES_UNIT;
    options.slices_per_key = slices_per_key;
    trial_need(pir_cspace_job_create(&given, bodies->grid, path, &options, NULL, &job), "job");
    return job;
}

static double open_file(const char *path) {
    uint32_t count = results_count(OPENED);
    double start = slices_cpu();
    for (uint32_t i = 0; i < count; i++) {
        pir_cspace *file = NULL;
        trial_need(pir_cspace_open(path, NULL, NULL, &file), "open");
        pir_cspace_destroy(file);
    }
    return (slices_cpu() - start) / count;
}

/* Nanoseconds of a slice, one after another, or far from the one before. */
static double read_slices(const char *path, uint64_t slices, bool alone) {
    uint64_t count = results_count(SAMPLES);
    pir_cspace *file = NULL;
    trial_need(pir_cspace_open(path, NULL, NULL, &file), "open");
    double start = slices_cpu();
    for (uint64_t i = 0; i < count; i++) {
        const pir_cspace_place place = {0, 0, (alone ? i * UINT64_C(0x9e3779b97f4a7c15) >> 20 : i) % slices};
        pir_slice slice;
        trial_need(pir_cspace_slice(file, place, NULL, &slice), "slice");
    }
    double time = slices_cpu() - start;
    pir_cspace_destroy(file);
    return time / (double)count;
}

static void measure(const struct slices_scene *scene, uint32_t slices_per_key, const char *folder, FILE *csv) {
    char path[1064];
    struct slices_bodies bodies;
    struct stat is;
    double opened = HUGE_VAL, alone = HUGE_VAL, next = HUGE_VAL;
    slices_make(scene, &bodies);
    snprintf(path, sizeof path, "%s/slices-%ld.h5", folder, (long)getpid());
    pir_cspace_job *job = slices_job(&bodies, path, slices_per_key);
    trial_need(pir_cspace_job_run(job, NULL), "job");
    trial_need(pir_cspace_job_assemble(job, NULL), "file");
    pir_cspace_job_destroy(job);
    for (int round = 0; round < ROUNDS; round++) {
        opened = fmin(opened, open_file(path));
        alone = fmin(alone, read_slices(path, bodies.slices, true));
        next = fmin(next, read_slices(path, bodies.slices, false));
    }
    double bytes = stat(path, &is) == 0 ? (double)is.st_size / (double)bodies.slices : NAN;
    fprintf(csv, "%s,%u,%.0f,%.0f,%.0f,%.0f\n", scene->name, (unsigned)slices_per_key, bytes, opened, alone, next);
    unlink(path);
    slices_free(&bodies);
}

void slices_read_all(const struct results *results) {
    static const struct slices_scene scenes[] = {
        {"gs4 axis 500", "shape:gs4", "shape:gs4", 500, 0, 1},
        {"gs4 level 3", "shape:gs4", "shape:gs4", 0, 3, 1},
        {"gs4 level 5", "shape:gs4", "shape:gs4", 0, 5, 100},
        {"dodecahedra level 3", "shape:dodecahedron", "shape:dodecahedron", 0, 3, 1},
    };
    static const uint32_t keys[] = {1, 16, 64, SLICES_UNIT};
    FILE *csv = results_open(results, "slices_read.csv");
    fprintf(csv, "scene,slices_per_key,bytes_a_slice,open_ns,alone_ns,next_ns\n");
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
            measure(&scenes[i], keys[k], results->folder, csv);
    results_close(csv, "slices_read.csv");
}
