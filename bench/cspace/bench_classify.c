/* SPDX-License-Identifier: MIT */
/*
 * Poses asked of files of slices, beside pairs. Usage: bench_classify FOLDER
 *
 * classify.csv: for some scenes and levels, 100,000 poses about where bodies meet and as many in the window
 * within 5 % of the size from contact. What a pose takes: alone, as the median; in one call, the verdict alone and all
 * that is known; and in a loop over a pair of the caller's own, three rounds in turn, the fastest of each counts. CPU
 * time, but of the median. `wrong` counts verdicts that are not the state by that loop, `resident_kib` is the most
 * that the process has taken until then, the making of the files included.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "results.h"
#include "slices_read.h"
#include "slices_scene.h"
#include "trial.h"

#define ROUNDS 3
#define POSES  100000

/* The poses, and room for what is answered. */
struct poses {
    uint32_t count;
    pir_pose *pose;
    pir_pair *pair;
    pir_workspace *workspace;
    uint8_t *by_pairs, *verdict, *state, *on_grid;
    uint64_t *slice;
    double *turn, *alone;
};

static double uniform(uint64_t *seed) {
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) * 0x1p-53;
}

/* The size of a body about its origin. */
static double reach_of(const pir_polytope *body) {
    double reach = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(body); v++) {
        pir_vec3 at = pir_polytope_vertex(body, v);
        reach = fmax(reach, sqrt(at.x * at.x + at.y * at.y + at.z * at.z));
    }
    return reach;
}

/* A pose of any rotation in the ball in which the bodies may meet; `window` moves it close to contact. */
static pir_pose pose_of(struct poses *poses, double reach, bool window, uint64_t *seed) {
    double n[8];
    for (int k = 0; k < 8; k += 2) {
        double r = sqrt(-2 * log(1 - uniform(seed))), angle = 6.283185307179586 * uniform(seed);
        n[k] = r * cos(angle);
        n[k + 1] = r * sin(angle);
    }
    double length = sqrt(n[4] * n[4] + n[5] * n[5] + n[6] * n[6]), far = reach * cbrt(uniform(seed)) / length;
    pir_pair_input input = pir_pair_input_default();
    input.pose_p = (pir_pose){{n[0], n[1], n[2], n[3]}, {far * n[4], far * n[5], far * n[6]}};
    if (!window)
        return input.pose_p;
    pir_query_result is;
    trial_need(pir_pair_signed_distance(poses->pair, poses->workspace, &input, &is), "pair");
    const double way = 0.05 * reach * (2 * uniform(seed) - 1) - is.distance;
    pir_vec3 *t = &input.pose_p.translation;
    *t = (pir_vec3){t->x + way * is.normal.x, t->y + way * is.normal.y, t->z + way * is.normal.z};
    return input.pose_p;
}

/* By a pair that was not asked for distances before, as those of files are not. */
static double ask_pairs(struct poses *poses) {
    pir_pair_input input = pir_pair_input_default();
    double start = slices_cpu();
    for (uint32_t i = 0; i < poses->count; i++) {
        pir_query_result is;
        input.pose_p = poses->pose[i];
        trial_need(pir_pair_overlap(poses->pair, poses->workspace, &input, &is), "pair");
        poses->by_pairs[i] = is.state == PIR_OUTSIDE ? PIR_VERDICT_FREE : PIR_VERDICT_BLOCKED;
    }
    return (slices_cpu() - start) / poses->count;
}

static double ask_many(pir_cspace *file, struct poses *poses, const pir_cspace_arrays *arrays) {
    const pir_pose_array array = {&poses->pose->rotation.x, sizeof *poses->pose, &poses->pose->translation.x,
                                  sizeof *poses->pose, false};
    double start = slices_cpu();
    trial_need(pir_cspace_classify_many(file, &array, poses->count, arrays, NULL, NULL), "classify");
    return (slices_cpu() - start) / poses->count;
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The median of single calls. */
static double ask_alone(pir_cspace *file, struct poses *poses) {
    for (uint32_t i = 0; i < poses->count; i++) {
        pir_configuration is;
        double start = now();
        trial_need(pir_cspace_classify(file, &poses->pose[i], NULL, &is), "classify");
        poses->alone[i] = now() - start;
    }
    qsort(poses->alone, poses->count, sizeof *poses->alone, compare);
    return poses->alone[poses->count / 2];
}

static void measure_poses(const char *name, pir_cspace *file, struct poses *poses, bool window, FILE *csv) {
    const pir_cspace_arrays all = {.verdict = poses->verdict,
                                   .state = poses->state,
                                   .on_grid = poses->on_grid,
                                   .slice = poses->slice,
                                   .turn = poses->turn};
    const pir_cspace_arrays few = {.verdict = poses->verdict};
    double alone = HUGE_VAL, verdict = HUGE_VAL, whole = HUGE_VAL, pairs = HUGE_VAL;
    for (int round = 0; round < ROUNDS; round++) {
        pairs = fmin(pairs, ask_pairs(poses));
        verdict = fmin(verdict, ask_many(file, poses, &few));
        whole = fmin(whole, ask_many(file, poses, &all));
        alone = fmin(alone, ask_alone(file, poses));
    }
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < poses->count; i++)
        wrong += poses->verdict[i] != poses->by_pairs[i];
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    fprintf(csv, "%s,%s,%u,%.0f,%.0f,%.0f,%.0f,%u,%ld\n", name, window ? "window" : "random", (unsigned)poses->count,
            alone, verdict, whole, pairs, (unsigned)wrong, used.ru_maxrss);
    fflush(csv);
}

static void *room(size_t count, size_t size) {
    void *made = calloc(count, size);
    trial_need(made ? PIR_OK : PIR_ERR_MEMORY, "poses");
    return made;
}

static struct poses poses_new(const struct slices_bodies *bodies) {
    struct poses poses = {.count = results_count(POSES)};
    trial_need(pir_pair_create(bodies->p[0], bodies->q, NULL, &poses.pair), "pair");
    trial_need(pir_workspace_create(NULL, &poses.workspace), "workspace");
    poses.pose = room(poses.count, sizeof *poses.pose);
    poses.by_pairs = room(poses.count, 1);
    poses.verdict = room(poses.count, 1);
    poses.state = room(poses.count, 1);
    poses.on_grid = room(poses.count, 1);
    poses.slice = room(poses.count, sizeof *poses.slice);
    poses.turn = room(poses.count, sizeof *poses.turn);
    poses.alone = room(poses.count, sizeof *poses.alone);
    return poses;
}

static void poses_free(struct poses *poses) {
    void *const all[] = {poses->pose,    poses->by_pairs, poses->verdict, poses->state,
                         poses->on_grid, poses->slice,    poses->turn,    poses->alone};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        free(all[k]);
    pir_pair_destroy(poses->pair);
    pir_workspace_destroy(poses->workspace);
}

static void measure(const struct slices_scene *scene, const char *folder, FILE *csv) {
    char path[1064];
    struct slices_bodies bodies;
    slices_make(scene, &bodies);
    snprintf(path, sizeof path, "%s/classify-%ld.h5", folder, (long)getpid());
    pir_cspace_job *job = slices_job(&bodies, path, 0);
    trial_need(pir_cspace_job_run(job, NULL), "job");
    trial_need(pir_cspace_job_assemble(job, NULL), "file");
    pir_cspace_job_destroy(job);
    struct poses poses = poses_new(&bodies);
    const double reach = reach_of(bodies.p[0]) + reach_of(bodies.q);
    pir_cspace *file = NULL;
    trial_need(pir_cspace_open(path, NULL, NULL, &file), "open");
    for (int window = 0; window < 2; window++) {
        uint64_t seed = 35;
        for (uint32_t i = 0; i < poses.count; i++)
            poses.pose[i] = pose_of(&poses, reach, window != 0, &seed);
        pir_pair_destroy(poses.pair);
        trial_need(pir_pair_create(bodies.p[0], bodies.q, NULL, &poses.pair), "pair");
        measure_poses(scene->name, file, &poses, window != 0, csv);
    }
    pir_cspace_destroy(file);
    poses_free(&poses);
    unlink(path);
    slices_free(&bodies);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_classify FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    static const struct slices_scene scenes[] = {
        {"cubes level 2", "shape:cube", "shape:cube", 0, 2, 1},
        {"cubes level 3", "shape:cube", "shape:cube", 0, 3, 1},
        {"dodecahedron sphere level 2", "shape:dodecahedron", "shape:geodesic?level=2", 0, 2, 1},
        {"dodecahedron sphere level 3", "shape:dodecahedron", "shape:geodesic?level=2", 0, 3, 1},
        {"gs4 level 2", "shape:gs4", "shape:gs4", 0, 2, 1},
        {"gs4 level 3", "shape:gs4", "shape:gs4", 0, 3, 1},
    };
    FILE *csv = results_open(&results, "classify.csv");
    fprintf(csv, "scene,poses,count,median_ns,verdict_ns,whole_ns,pairs_ns,wrong,resident_kib\n");
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        measure(&scenes[i], results.folder, csv);
    results_close(csv, "classify.csv");
    printf("results in %s\n", results.folder);
    return 0;
}
