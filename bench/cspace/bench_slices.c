/* SPDX-License-Identifier: MIT */
/*
 * Slices along grids of rotations, beside rebuilds. Usage: bench_slices FOLDER [P Q]
 *
 * Over the same rotations: following alone, a job with one thread that writes its part, the file made of the part, and
 * walks and hulls of all sums of vertices (qhull) at a sample of rotations. Three rounds, each way in each round, the
 * fastest round of each counts; CPU time of the process. Beside the bytes of a slice, those of a mesh stored whole, a
 * mean over a sample: vertices as doubles, corners of facets as numbers of 32 bits, both deflated as gzip does.
 * slices.csv, one row a scene.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>

#include <pirouette/pirouette.h>

#include "results.h"
#include "trial.h"

#if PIR_HAVE_QHULL
#include <libqhull_r/qhull_ra.h>
#endif

#define ROUNDS       3
#define UNIT         256
#define WALK_SAMPLES 400
#define HULL_SAMPLES 2
#define MESH_SAMPLES 25

/* What is measured: two bodies, a grid, the share of it that is visited. */
struct scene {
    const char *name, *p, *q;
    uint32_t steps, level; /* about an axis where steps > 0, else all rotations of the level */
    uint32_t share;        /* one by so many */
};

/* Nanoseconds a slice. */
struct times {
    double track, job, assemble, walk, hull;
    double bytes, mesh_bytes, turn;
    uint64_t slices;
};

static double cpu_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e9 + (double)now.tv_nsec;
}

static pir_polytope *body_of(const char *name) {
    if (strncmp(name, "shape:", 6) == 0)
        return trial_model(name + 6);
    pir_polytope *polytope = NULL;
    pir_report report = {0};
    if (pir_polytope_read(name, NULL, &report, &polytope) != PIR_OK) {
        fprintf(stderr, "bench_slices: %s\n", report.text);
        exit(2);
    }
    return polytope;
}

/* --- the ways --- */

/* Follows the difference through all slices, each unit from a walk, as a job does. */
static double track(pir_polytope *p, pir_polytope *q, const pir_grid *grid, uint64_t slices) {
    const pir_sum_options options = {.allocator = NULL, .difference = 1};
    pir_sum *sum = NULL;
    trial_need(pir_sum_create(p, q, pir_grid_rotation(grid, 0), &options, &sum), "sum");
    double start = cpu_now();
    for (uint64_t i = 0; i < slices; i++) {
        pir_quat rotation = pir_grid_rotation(grid, i);
        trial_need(i % UNIT ? pir_sum_rotate(sum, rotation, PIR_METHOD_AUTO) : pir_sum_reset(sum, rotation), "slice");
    }
    double time = cpu_now() - start;
    pir_sum_destroy(sum);
    return time / (double)slices;
}

static double walk(pir_polytope *p, pir_polytope *q, const pir_grid *grid, uint64_t slices) {
    const pir_sum_options options = {.allocator = NULL, .difference = 1};
    pir_sum *sum = NULL;
    uint64_t samples = results_count(WALK_SAMPLES);
    if (samples > slices)
        samples = slices;
    trial_need(pir_sum_create(p, q, pir_grid_rotation(grid, 0), &options, &sum), "sum");
    double start = cpu_now();
    for (uint64_t i = 0; i < samples; i++)
        trial_need(pir_sum_reset(sum, pir_grid_rotation(grid, i * (slices / samples))), "walk");
    double time = cpu_now() - start;
    pir_sum_destroy(sum);
    return time / (double)samples;
}

/* Deals the units of the slices that are visited. */
struct dealt {
    uint64_t next, end, all;
};

static uint64_t deal(void *context) {
    struct dealt *dealt = context;
    return dealt->next < dealt->end ? dealt->next++ : dealt->all;
}

static void run_job(const pir_cspace_bodies *bodies, const pir_grid *grid, const char *path, struct times *times) {
    char part[1100];
    struct stat is;
    pir_report report = {0};
    pir_cspace_job *job = NULL;
    pir_cspace_options options = pir_cspace_options_default();
    struct dealt dealt = {0, (times->slices + UNIT - 1) / UNIT, UINT64_MAX};
    options.slices_per_unit = UNIT;
    options.claim = deal;
    options.context = &dealt;
    snprintf(part, sizeof part, "%s.part0", path);
    trial_need(pir_cspace_job_create(bodies, grid, path, &options, &report, &job), "job");
    double start = cpu_now();
    trial_need(pir_cspace_job_run(job, &report), "job");
    times->job = fmin(times->job, (cpu_now() - start) / (double)times->slices);
    times->bytes = stat(part, &is) == 0 ? (double)is.st_size / (double)times->slices : NAN;
    start = cpu_now();
    if (pir_cspace_job_assemble(job, &report) == PIR_OK) {
        times->assemble = fmin(times->assemble, (cpu_now() - start) / (double)times->slices);
        times->bytes = stat(path, &is) == 0 ? (double)is.st_size / (double)times->slices : NAN;
    }
    pir_cspace_job_destroy(job);
    unlink(part);
    unlink(path);
}

#if PIR_HAVE_QHULL
static void hull_of(const pir_vec3 *points, size_t count) {
    qhT qh;
    char command[] = "qhull";
    int left, total;
    qh_zero(&qh, NULL);
    if (qh_new_qhull(&qh, 3, (int)count, (coordT *)(uintptr_t)points, False, command, NULL, NULL)) {
        fprintf(stderr, "bench_slices: qhull failed\n");
        exit(2);
    }
    qh_freeqhull(&qh, !qh_ALL);
    qh_memfreeshort(&qh, &left, &total);
}
#endif

/* qhull on all sums of vertices; NaN without qhull. */
static double hull(const pir_polytope *p, const pir_polytope *q, const pir_grid *grid, uint64_t slices) {
#if PIR_HAVE_QHULL
    uint32_t n = pir_polytope_vertex_count(p), m = pir_polytope_vertex_count(q), samples = results_count(HULL_SAMPLES);
    pir_vec3 *points = malloc((size_t)n * m * sizeof *points);
    if (!points)
        exit(2);
    double start = cpu_now();
    for (uint32_t s = 0; s < samples; s++) {
        pir_quat r = pir_grid_rotation(grid, (slices - 1) / (s + 1));
        double length2 = r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w;
        for (uint32_t i = 0; i < n; i++) {
            pir_vec3 v = pir_polytope_vertex(p, i);
            pir_vec3 t = {2 * (r.y * v.z - r.z * v.y) / length2, 2 * (r.z * v.x - r.x * v.z) / length2,
                          2 * (r.x * v.y - r.y * v.x) / length2};
            pir_vec3 turned = {v.x + r.w * t.x + r.y * t.z - r.z * t.y, v.y + r.w * t.y + r.z * t.x - r.x * t.z,
                               v.z + r.w * t.z + r.x * t.y - r.y * t.x};
            for (uint32_t j = 0; j < m; j++) {
                pir_vec3 w = pir_polytope_vertex(q, j);
                points[(size_t)i * m + j] = (pir_vec3){w.x - turned.x, w.y - turned.y, w.z - turned.z};
            }
        }
        hull_of(points, (size_t)n * m);
    }
    double time = (cpu_now() - start) / samples;
    free(points);
    return time;
#else
    (void)p;
    (void)q;
    (void)grid;
    (void)slices;
    return NAN;
#endif
}

/* --- meshes stored whole --- */

static double deflated(const void *data, size_t size) {
    uLongf length = compressBound((uLong)size);
    Bytef *room = malloc(length);
    if (!room || compress2(room, &length, data, (uLong)size, Z_DEFAULT_COMPRESSION) != Z_OK)
        exit(2);
    free(room);
    return (double)length;
}

static double mesh_bytes(const pir_mesh *mesh) {
    uint32_t facets = pir_mesh_facet_count(mesh), count, used = 0;
    size_t corners = 0;
    for (uint32_t f = 0; f < facets; f++) {
        pir_mesh_facet(mesh, f, &count);
        corners += 1 + count;
    }
    uint32_t *list = malloc((corners + 1) * sizeof *list);
    if (!list)
        exit(2);
    for (uint32_t f = 0; f < facets; f++) {
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        list[used++] = count;
        memcpy(list + used, corner, count * sizeof *list);
        used += count;
    }
    double bytes = deflated(list, used * sizeof *list) +
                   deflated(pir_mesh_vertices(mesh), pir_mesh_vertex_count(mesh) * sizeof(pir_vec3));
    free(list);
    return bytes;
}

/* The mean of some slices. */
static double meshes(pir_polytope *p, pir_polytope *q, const pir_grid *grid, uint64_t slices) {
    const pir_sum_options options = {.allocator = NULL, .difference = 1};
    uint64_t samples = results_count(MESH_SAMPLES);
    double bytes = 0;
    for (uint64_t i = 0; i < samples; i++) {
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL;
        trial_need(pir_sum_create(p, q, pir_grid_rotation(grid, i * (slices / samples)), &options, &sum), "sum");
        trial_need(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), "mesh");
        bytes += mesh_bytes(mesh);
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
    }
    return bytes / (double)samples;
}

/* --- scenes --- */

static void measure(const struct scene *scene, const char *folder, FILE *csv) {
    char path[1064];
    pir_polytope *p = body_of(scene->p), *q = body_of(scene->q);
    const pir_cspace_bodies bodies = {&p, 1, &q, 1};
    pir_grid *grid = NULL;
    struct times times = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, NAN, NAN, NAN, 0, 0};
    snprintf(path, sizeof path, "%s/slices-%ld.h5", folder, (long)getpid());
    if (scene->steps)
        trial_need(pir_grid_axis((pir_vec3){0.48, 0.6, 0.64}, scene->steps, NULL, &grid), "grid");
    else
        trial_need(pir_grid_hopf(scene->level, NULL, &grid), "grid");
    uint64_t count = pir_grid_get_info(grid).count;
    bool smoke = results_count(1000) < 1000;
    // whole units, but for the last one of a grid that is visited whole
    times.slices = scene->share > 1 || smoke ? (count / scene->share + UNIT - 1) / UNIT * UNIT : count;
    if (smoke || times.slices > count)
        times.slices = count < UNIT ? count : UNIT;
    times.turn = pir_grid_get_turns(grid).mean;
    for (int round = 0; round < ROUNDS; round++) {
        times.track = fmin(times.track, track(p, q, grid, times.slices));
        run_job(&bodies, grid, path, &times);
        times.walk = fmin(times.walk, walk(p, q, grid, times.slices));
    }
    times.hull = hull(p, q, grid, times.slices);
    times.mesh_bytes = meshes(p, q, grid, times.slices);
    // a share of a grid makes no file
    double assemble = isfinite(times.assemble) ? times.assemble : NAN;
    double all = times.job + (isfinite(assemble) ? assemble : 0), write = all - times.track;
    fprintf(csv, "%s,%s,%llu,%.4f,%.0f,%.0f,%.0f,%.0f,%.0f,%.2f,%.1f,%.0f,%.0f\n", scene->name,
            scene->steps ? "axis" : "hopf", (unsigned long long)times.slices, times.turn * 57.29577951308232,
            times.track, times.job, assemble, times.walk, times.hull, (times.walk + write) / all, times.hull / all,
            times.bytes, times.mesh_bytes);
    fflush(csv);
    pir_grid_destroy(grid);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(int argc, char **argv) {
    if (argc != 2 && argc != 4) {
        fprintf(stderr, "usage: bench_slices FOLDER [P Q]\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    static const struct scene built_in[] = {
        {"gs4 axis 500", "shape:gs4", "shape:gs4", 500, 0, 1},
        {"gs4 level 3", "shape:gs4", "shape:gs4", 0, 3, 1},
        {"gs4 level 4", "shape:gs4", "shape:gs4", 0, 4, 10},
        {"gs4 level 5", "shape:gs4", "shape:gs4", 0, 5, 10},
        {"dodecahedra level 3", "shape:dodecahedron", "shape:dodecahedron", 0, 3, 1},
    };
    FILE *csv = argc == 4 ? stdout : results_open(&results, "slices.csv");
    fprintf(csv, "scene,grid,slices,mean_turn_degrees,track_ns,job_ns,assemble_ns,walk_ns,qhull_ns,"
                 "faster_than_walks,faster_than_qhull,bytes_a_slice,mesh_bytes\n");
    if (argc == 4) {
        measure(&(struct scene){"given level 3", argv[2], argv[3], 0, 3, 1}, results.folder, csv);
        return 0;
    }
    for (size_t i = 0; i < sizeof built_in / sizeof *built_in; i++)
        measure(&built_in[i], results.folder, csv);
    results_close(csv, "slices.csv");
    printf("results in %s\n", results.folder);
    return 0;
}
