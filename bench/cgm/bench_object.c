/* SPDX-License-Identifier: MIT */
/*
 * The object-space method beside other ways to the same sum: the six pairs of Table 1 of Diktaş and Şahiner, An
 * Object-Space Method for Calculating the Minkowski Sums of Simple 3D Objects, 2006.
 *
 * Usage: bench_object FOLDER
 *
 * object.csv: for each pair the microseconds, median, from two polytopes at hand to the mesh of the sum in doubles: by
 * the object-space method, by walk, by overlay of cubical Gaussian maps, as the hull of all sums, by qhull and by CGAL
 * where the build found them (0 elsewhere); and of placing a prototype's vertices by index when sizes change; beside
 * the milliseconds that the paper gives for its method and for CGAL's hull. `same` counts the scales, of 1,000, at
 * which the prototype scaled by index is the fresh sum facet for facet. All times are CPU time of the thread.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/baseline.h>
#include <pirouette/pirouette.h>

#include "peers.h"
#include "results.h"

#define RUNS   501
#define SCALES 1000

struct row {
    const char *name, *p, *q;
    double paper_object, paper_hull; /* milliseconds */
};

static const struct row rows[] = {{"cube and rotated cube", "cube", "cube", 6.1, 173.4},
                                  {"cube and icosahedron", "cube", "icosahedron", 11.4, 150.0},
                                  {"icosahedron and icosahedron", "icosahedron", "icosahedron", 12.5, 131.2},
                                  {"cube and dodecahedron", "cube", "dodecahedron", 18.7, 192.1},
                                  {"dodecahedron and dodecahedron", "dodecahedron", "dodecahedron", 25.0, 276.5},
                                  {"icosahedron and dodecahedron", "icosahedron", "dodecahedron", 82.9, 203.1}};

static const pir_quat turned = {0.1, 0.2, 0.3, 0.9};

static void need(pir_status status, const char *what) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "bench_object: %s: %s\n", what, pir_status_text(status));
    exit(1);
}

static pir_mesh *by_object(pir_polytope *p, pir_polytope *q) {
    pir_mesh *mesh = NULL;
    need(pir_object_sum(p, q, turned, NULL, PIR_DOUBLE, &mesh), "object");
    return mesh;
}

static pir_mesh *by_walk(pir_polytope *p, pir_polytope *q) {
    pir_sum *sum = NULL;
    pir_mesh *mesh = NULL;
    need(pir_sum_create(p, q, turned, NULL, &sum), "walk");
    need(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), "walk");
    pir_sum_destroy(sum);
    return mesh;
}

static pir_mesh *by_cgm(pir_polytope *p, pir_polytope *q) {
    pir_cgm *a = NULL, *b = NULL, *sum = NULL;
    pir_mesh *mesh = NULL;
    need(pir_cgm_create(p, &turned, NULL, &a), "map of P");
    need(pir_cgm_create(q, NULL, NULL, &b), "map of Q");
    need(pir_cgm_overlay(a, b, &sum), "overlay");
    need(pir_cgm_mesh(sum, PIR_DOUBLE, &mesh), "mesh of the overlay");
    pir_cgm_release(sum);
    pir_cgm_release(b);
    pir_cgm_release(a);
    return mesh;
}

static pir_mesh *by_hull(pir_polytope *p, pir_polytope *q) {
    pir_mesh *mesh = NULL;
    need(pir_hull_sum(p, q, turned, NULL, PIR_DOUBLE, &mesh), "hull");
    return mesh;
}

/* The median of one way, in microseconds; the first mesh is told to be that of `expected`. */
static double time_way(pir_mesh *(*way)(pir_polytope *p, pir_polytope *q), pir_polytope *p, pir_polytope *q,
                       const pir_mesh *expected) {
    double times[RUNS];
    uint32_t runs = results_count(RUNS);
    for (uint32_t i = 0; i < runs; i++) {
        double start = peer_clock();
        pir_mesh *mesh = way(p, q);
        times[i] = 1e3 * (peer_clock() - start);
        if (i == 0 && expected && !pir_mesh_equal(mesh, expected)) {
            fprintf(stderr, "bench_object: two ways differ\n");
            exit(1);
        }
        pir_mesh_destroy(mesh);
    }
    return peer_median(times, runs);
}

#if PIR_HAVE_CGAL || PIR_HAVE_QHULL
static double time_peer(peer_run *run, pir_polytope *p, pir_polytope *q) {
    double times[RUNS], matrix[3][3];
    uint32_t runs = results_count(RUNS);
    peer_matrix(turned, matrix);
    for (uint32_t i = 0; i < runs; i++)
        times[i] = 1e3 * run(p, matrix, q).milliseconds;
    return peer_median(times, runs);
}
#endif

/* Places the vertices of a prototype by index: R·s·p + t·q for each pair. */
static void place(const pir_mesh *prototype, const pir_polytope *p, const pir_polytope *q, double m[3][3],
                  const double scale[2], pir_vec3 *at) {
    for (uint32_t v = 0; v < pir_mesh_vertex_count(prototype); v++) {
        uint32_t pair[2];
        pir_mesh_pair(prototype, v, pair);
        pir_vec3 x = pir_polytope_vertex(p, pair[0]), y = pir_polytope_vertex(q, pair[1]);
        at[v].x = scale[0] * (m[0][0] * x.x + m[0][1] * x.y + m[0][2] * x.z) + scale[1] * y.x;
        at[v].y = scale[0] * (m[1][0] * x.x + m[1][1] * x.y + m[1][2] * x.z) + scale[1] * y.y;
        at[v].z = scale[0] * (m[2][0] * x.x + m[2][1] * x.y + m[2][2] * x.z) + scale[1] * y.z;
    }
}

static double time_index(const pir_mesh *prototype, const pir_polytope *p, const pir_polytope *q) {
    double times[RUNS], matrix[3][3];
    uint32_t runs = results_count(RUNS), count = pir_mesh_vertex_count(prototype);
    pir_vec3 *at = calloc(count, sizeof *at);
    if (!at)
        need(PIR_ERR_MEMORY, "places");
    peer_matrix(turned, matrix);
    for (uint32_t i = 0; i < runs; i++) {
        const double scale[2] = {1 + 0.001 * i, 2 - 0.001 * i};
        double start = peer_clock();
        place(prototype, p, q, matrix, scale, at);
        times[i] = 1e3 * (peer_clock() - start);
    }
    free(at);
    return peer_median(times, runs);
}

/* Whether both have the same pairs and the same facets. */
static bool same_topology(const pir_mesh *a, const pir_mesh *b) {
    if (pir_mesh_vertex_count(a) != pir_mesh_vertex_count(b) || pir_mesh_facet_count(a) != pir_mesh_facet_count(b))
        return false;
    for (uint32_t v = 0; v < pir_mesh_vertex_count(a); v++) {
        uint32_t x[2], y[2];
        pir_mesh_pair(a, v, x);
        pir_mesh_pair(b, v, y);
        if (memcmp(x, y, sizeof x) != 0)
            return false;
    }
    for (uint32_t f = 0; f < pir_mesh_facet_count(a); f++) {
        uint32_t n, m;
        const uint32_t *x = pir_mesh_facet(a, f, &n), *y = pir_mesh_facet(b, f, &m);
        if (n != m || memcmp(x, y, n * sizeof *x) != 0)
            return false;
    }
    return true;
}

/* At how many scales of both operands the fresh sum has the topology of the prototype. */
static uint32_t count_same(const pir_mesh *prototype, pir_polytope *p, pir_polytope *q, uint32_t scales) {
    uint32_t same = 0;
    for (uint32_t i = 0; i < scales; i++) {
        pir_polytope *sp = NULL, *sq = NULL;
        need(pir_polytope_scale(p, 1e-3 * (1 + 2.7 * i), &sp), "scale");
        need(pir_polytope_scale(q, 1e3 / (1 + 1.3 * i), &sq), "scale");
        pir_mesh *fresh = by_object(sp, sq);
        same += same_topology(prototype, fresh);
        pir_mesh_destroy(fresh);
        pir_polytope_release(sq);
        pir_polytope_release(sp);
    }
    return same;
}

static void bench_row(const struct row *row, FILE *csv) {
    pir_polytope *p = NULL, *q = NULL;
    need(pir_shape_create(row->p, NULL, NULL, &p), row->p);
    need(pir_shape_create(row->q, NULL, NULL, &q), row->q);
    pir_mesh *prototype = by_object(p, q);
    double object = time_way(by_object, p, q, prototype), walk = time_way(by_walk, p, q, prototype);
    double cgm = time_way(by_cgm, p, q, NULL), hull = time_way(by_hull, p, q, prototype);
    double index = time_index(prototype, p, q), qhull = 0, cgal = 0;
#if PIR_HAVE_QHULL
    qhull = time_peer(peer_qhull, p, q);
#endif
#if PIR_HAVE_CGAL
    cgal = time_peer(peer_cgal_hull, p, q);
#endif
    uint32_t scales = results_count(SCALES), same = count_same(prototype, p, q, scales);
    fprintf(csv, "%s,%u,%.2f,%.2f,%.2f,%.2f,%.2f,%.2f,%.3f,%.1f,%.1f,%u,%u\n", row->name,
            pir_mesh_facet_count(prototype), object, walk, cgm, hull, qhull, cgal, index, row->paper_object,
            row->paper_hull, scales, same);
    printf("%-30s %3u facets: object %8.2f us, walk %7.2f, cgm %7.2f, hull %8.2f, qhull %8.2f, CGAL %8.2f, by index "
           "%.3f; the same at %u scales of %u\n",
           row->name, pir_mesh_facet_count(prototype), object, walk, cgm, hull, qhull, cgal, index, same, scales);
    pir_mesh_destroy(prototype);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_object FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *csv = results_open(&results, "object.csv");
    fprintf(csv, "pair,facets,object_us,walk_us,cgm_us,hull_us,qhull_us,cgal_us,index_us,paper_object_ms,"
                 "paper_hull_ms,scales,same\n");
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        bench_row(&rows[i], csv);
    results_close(csv, "object.csv");
    printf("results in %s\n", results.folder);
    return 0;
}
