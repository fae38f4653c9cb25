/* SPDX-License-Identifier: MIT */
/*
 * Convex hulls of many points beside qhull's, where the build found it.
 *
 * Usage: bench_hull FOLDER
 *
 * hull.csv: for random points of a sphere and of a ball, 10^4 to 10^6, the CPU time of the thread that a polytope
 * takes, exact normals and edges and all, and that of qhull's facets alone. The two take turns in one run; medians
 * and minima.
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <pirouette/polytope.h>

#if PIR_HAVE_QHULL
#include <libqhull_r/libqhull_r.h>
#endif

#include "results.h"

#define RUNS 7

static double milliseconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* xorshift64 (Marsaglia, 2003), in [−1, 1). */
static double next_random(uint64_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) * 0x1p-52 - 1;
}

/* Random points of the unit ball, or pushed out to its sphere. */
static void fill(pir_vec3 *points, uint32_t count, bool sphere) {
    uint64_t state = 88172645463325252u;
    for (uint32_t i = 0; i < count;) {
        pir_vec3 d = {next_random(&state), next_random(&state), next_random(&state)};
        double r = d.x * d.x + d.y * d.y + d.z * d.z;
        if (r > 1 || r < 1e-4)
            continue;
        double by = sphere ? 1 / sqrt(r) : 1;
        points[i++] = (pir_vec3){by * d.x, by * d.y, by * d.z};
    }
}

static double time_of_ours(const pir_vec3 *points, uint32_t count, uint32_t *ret_vertices) {
    double start = milliseconds();
    pir_polytope *polytope;
    if (pir_polytope_create(points, count, NULL, &polytope) != PIR_OK) {
        fprintf(stderr, "bench_hull: no hull\n");
        exit(1);
    }
    double taken = milliseconds() - start;
    *ret_vertices = pir_polytope_vertex_count(polytope);
    pir_polytope_release(polytope);
    return taken;
}

#if PIR_HAVE_QHULL
static double time_of_qhull(const pir_vec3 *points, uint32_t count, uint32_t *ret_vertices) {
    double start = milliseconds();
    qhT qh;
    qh_zero(&qh, NULL);
    char command[] = "qhull";
    if (qh_new_qhull(&qh, 3, (int)count, (coordT *)(uintptr_t)points, False, command, NULL, NULL)) {
        fprintf(stderr, "bench_hull: qhull failed\n");
        exit(1);
    }
    double taken = milliseconds() - start;
    *ret_vertices = (uint32_t)qh.num_vertices;
    qh_freeqhull(&qh, !qh_ALL);
    int left, total;
    qh_memfreeshort(&qh, &left, &total);
    return taken;
}
#endif

static void bench(FILE *csv, uint32_t count, bool sphere) {
    pir_vec3 *points = malloc(count * sizeof *points);
    if (!points) {
        fprintf(stderr, "bench_hull: out of memory\n");
        exit(1);
    }
    fill(points, count, sphere);
    double ours[RUNS], theirs[RUNS] = {0};
    uint32_t vertices = 0, runs = results_count(count < 1000000 ? RUNS : 3);
    for (uint32_t run = 0; run < runs; run++) {
        ours[run] = time_of_ours(points, count, &vertices);
#if PIR_HAVE_QHULL
        uint32_t of_qhull;
        theirs[run] = time_of_qhull(points, count, &of_qhull);
        if (of_qhull != vertices)
            printf("  qhull finds %u vertices\n", of_qhull);
#endif
    }
    qsort(ours, runs, sizeof *ours, compare);
    qsort(theirs, runs, sizeof *theirs, compare);
    const char *body = sphere ? "sphere" : "ball";
    double ratio = theirs[0] > 0 ? ours[0] / theirs[0] : 0;
    printf(
        "%-6s %8u points %8u vertices: %9.2f ms (least %.2f), qhull %9.2f ms (least %.2f), ratio of the least %.2f\n",
        body, count, vertices, ours[runs / 2], ours[0], theirs[runs / 2], theirs[0], ratio);
    fprintf(csv, "%s,%u,%u,%.3f,%.3f,%.3f,%.3f,%.3f\n", body, count, vertices, ours[runs / 2], ours[0],
            theirs[runs / 2], theirs[0], ratio);
    free(points);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_hull FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *csv = results_open(&results, "hull.csv");
    fprintf(csv, "body,points,vertices,median ms,least ms,qhull median ms,qhull least ms,ratio of the least\n");
    for (uint32_t count = 10000; count <= 1000000; count *= 10)
        for (int sphere = 0; sphere < 2; sphere++)
            // where only tables are shown to be written, the smallest is enough
            if (count == 10000 || results_count(RUNS) == RUNS)
                bench(csv, count, sphere);
    results_close(csv, "hull.csv");
    printf("results in %s\n", results.folder);
    return 0;
}
