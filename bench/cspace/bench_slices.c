/* SPDX-License-Identifier: MIT */
/*
 * Slices along grids of rotations, beside rebuilds. Usage: bench_slices FOLDER [P [Q]]
 *
 * Over the same rotations: following alone, a job with one thread that writes its part, the file made of the part, and
 * rebuilds at a sample of rotations: walks, those of before pairs by need where -Dpeers_dir names a build of that time,
 * and hulls of all sums of vertices (qhull). Three rounds, each way in each round, the fastest round of each counts;
 * CPU time of the process. A rebuild that is written takes the same time to write. slices.csv, one row a scene.
 *
 * slices_read.csv: what reading takes, by how often a slice is written whole. slices_scale.csv: one pair on fine grids;
 * `record_bytes` leaves out what a file of slices holds but once, rotations above all.
 *
 * P and Q: one more scene. P may be a folder of convex pieces, each of which meets Q, or the first of them.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "results.h"
#include "slices_read.h"
#include "slices_rebuild.h"
#include "trial.h"

#define ROUNDS 3

/* Nanoseconds a slice of a pair of pieces. */
struct times {
    double track, make, file, walk, older, bytes;
};

static struct times times_none(void) {
    return (struct times){HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, NAN};
}

/* Follows the differences through all slices, each unit from a walk, as a job does. */
static double track(const struct slices_bodies *bodies) {
    const pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = true};
    double start = slices_cpu();
    for (uint32_t k = 0; k < bodies->pieces; k++) {
        pir_sum *sum = NULL;
        for (uint64_t i = 0; i < bodies->slices; i++) {
            pir_quat rotation = pir_grid_rotation(bodies->grid, i);
            if (i == 0)
                trial_need(pir_sum_create(bodies->p[k], bodies->q, rotation, &options, &sum), "sum");
            else
                trial_need(i % SLICES_UNIT ? pir_sum_rotate(sum, rotation, PIR_METHOD_AUTO)
                                           : pir_sum_reset(sum, rotation),
                           "slice");
        }
        pir_sum_destroy(sum);
    }
    return (slices_cpu() - start) / (double)(bodies->slices * bodies->pieces);
}

/* Makes the file: what that takes, and its bytes. */
static void run_job(const struct slices_bodies *bodies, const char *path, struct times *times) {
    const double slices = (double)(bodies->slices * bodies->pieces);
    pir_cspace_job *job = slices_job(bodies, path, 0);
    struct stat is;
    double start = slices_cpu();
    trial_need(pir_cspace_job_run(job, NULL), "job");
    double made = slices_cpu();
    trial_need(pir_cspace_job_assemble(job, NULL), "file");
    times->file = fmin(times->file, (slices_cpu() - made) / slices);
    times->make = fmin(times->make, (made - start) / slices);
    times->bytes = stat(path, &is) == 0 ? (double)is.st_size / slices : NAN;
    pir_cspace_job_destroy(job);
    unlink(path);
}

static void measure(const struct slices_scene *scene, const char *folder, FILE *csv) {
    char path[1064];
    struct slices_bodies bodies;
    struct times times = times_none();
    slices_make(scene, &bodies);
    snprintf(path, sizeof path, "%s/slices-%ld.h5", folder, (long)getpid());
    for (int round = 0; round < ROUNDS; round++) {
        times.older = fmin(times.older, slices_older_walk(&bodies));
        times.track = fmin(times.track, track(&bodies));
        run_job(&bodies, path, &times);
        times.walk = fmin(times.walk, slices_walk(&bodies));
    }
    double hull = slices_hull(&bodies), mesh_bytes = slices_mesh_bytes(&bodies);
    double all = times.make + times.file, write = all - times.track;
    if (!isfinite(times.older))
        times.older = NAN;
    fprintf(csv, "%s,%s,%u,%llu,%.4f,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,%.2f,%.2f,%.1f,%.2f,%.0f,%.0f\n", scene->name,
            scene->steps ? "axis" : "hopf", (unsigned)bodies.pieces, (unsigned long long)bodies.slices, bodies.turn,
            times.track, times.make, times.file, times.walk, times.older, hull, (times.older + write) / all,
            (times.walk + write) / all, (hull + write) / all, write / times.track, times.bytes, mesh_bytes);
    fflush(csv);
    slices_free(&bodies);
}

/* One pair on a fine grid: the job has it twice, so that what a second pair adds to the file is seen. */
static void measure_scale(const struct slices_scene *scene, const char *folder, FILE *csv) {
    char path[1064];
    struct slices_bodies bodies;
    struct times once = times_none(), twice = times_none();
    slices_make(scene, &bodies);
    snprintf(path, sizeof path, "%s/slices-%ld.h5", folder, (long)getpid());
    run_job(&bodies, path, &once);
    bodies.p[bodies.pieces++] = pir_polytope_retain(bodies.p[0]);
    for (int round = 0; round < ROUNDS; round++)
        run_job(&bodies, path, &twice);
    fprintf(csv, "%s,%u,%llu,%.0f,%.0f,%.2f\n", scene->name, (unsigned)scene->level, (unsigned long long)bodies.slices,
            twice.make, twice.file, 2 * twice.bytes - once.bytes);
    slices_free(&bodies);
}

static void measure_scales(const struct results *results) {
    static const struct {
        const char *name, *p, *q;
    } pairs[] = {{"dodecahedra", "shape:dodecahedron", "shape:dodecahedron"},
                 {"cube gs4", "shape:cube", "shape:gs4"},
                 {"gs4", "shape:gs4", "shape:gs4"}};
    FILE *csv = results_open(results, "slices_scale.csv");
    fprintf(csv, "scene,level,slices,make_ns,file_ns,record_bytes\n");
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        for (uint32_t level = 5; level <= 6; level++) {
            // the first 100,000 rotations or so
            const uint32_t share = (uint32_t)(72ull << 3 * level) / 100000;
            measure_scale(&(struct slices_scene){pairs[i].name, pairs[i].p, pairs[i].q, 0, level, share},
                          results->folder, csv);
        }
    results_close(csv, "slices_scale.csv");
}

static const char head[] =
    "scene,grid,pairs,slices,mean_turn_degrees,track_ns,make_ns,file_ns,walk_ns,older_walk_ns,qhull_ns,"
    "faster_than_older_walks,faster_than_walks,faster_than_qhull,write_by_track,bytes_a_slice,mesh_bytes\n";

int main(int argc, char **argv) {
    if (argc < 2 || argc > 4) {
        fprintf(stderr, "usage: bench_slices FOLDER [P [Q]]\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    static const struct slices_scene built_in[] = {
        {"gs4 axis 500", "shape:gs4", "shape:gs4", 500, 0, 1},
        {"gs4 level 3", "shape:gs4", "shape:gs4", 0, 3, 1},
        {"gs4 level 4", "shape:gs4", "shape:gs4", 0, 4, 10},
        {"gs4 level 5", "shape:gs4", "shape:gs4", 0, 5, 10},
        {"dodecahedra level 3", "shape:dodecahedron", "shape:dodecahedron", 0, 3, 1},
    };
    FILE *csv = results_open(&results, "slices.csv");
    fputs(head, csv);
    for (size_t i = 0; i < sizeof built_in / sizeof *built_in; i++)
        measure(&built_in[i], results.folder, csv);
    if (argc > 2)
        measure(&(struct slices_scene){"given level 3", argv[2], argc == 4 ? argv[3] : NULL, 0, 3, 1}, results.folder,
                csv);
    results_close(csv, "slices.csv");
    slices_read_all(&results);
    measure_scales(&results);
    printf("results in %s\n", results.folder);
    return 0;
}
