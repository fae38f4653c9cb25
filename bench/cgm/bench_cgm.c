/* SPDX-License-Identifier: MIT */
/*
 * Cubical Gaussian maps: what an exact sum by overlay costs beside other ways to one, and how the cost grows with the
 * result.
 *
 * Usage: bench_cgm FOLDER [MODEL...]
 *
 * cgm.csv: for pairs of models, the time of overlay and mesh from two finished maps, the share of signs that the filter
 * settled, bytes per halfedge, and the peers that the build found. cgm_growth.csv: for geodesic spheres of rising
 * level, time against the size of the result. Printed is the same, and the exponent of a least-squares fit on
 * logarithms. With models, shapes or files, only those pairs are printed, each with itself turned. All times are CPU
 * time of the thread.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <pirouette/pirouette.h>

#include "peers.h"
#include "results.h"

#define RUNS_OF_OURS  51
#define RUNS_OF_PEERS 5

static void need(pir_status status, const char *what) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "bench_cgm: %s: %s\n", what, pir_status_text(status));
    exit(1);
}

/* One way of ours, measured. */
struct measured {
    double milliseconds, fastest, maps; /* overlay and mesh; both maps */
    uint32_t vertices, edges, facets;
    pir_cgm_counts counts;
    double filter, bytes;
};

static struct measured measure(pir_polytope *p, pir_polytope *q, pir_quat rotation) {
    double times[RUNS_OF_OURS], maps[RUNS_OF_OURS];
    struct measured m = {0};
    uint32_t runs = results_count(RUNS_OF_OURS);
    for (uint32_t run = 0; run < runs; run++) {
        pir_cgm *a, *b, *sum;
        pir_mesh *mesh;
        double start = peer_clock();
        need(pir_cgm_create(p, &rotation, NULL, &a), "map of P");
        need(pir_cgm_create(q, NULL, NULL, &b), "map of Q");
        double made = peer_clock();
        need(pir_cgm_overlay(a, b, &sum), "overlay");
        need(pir_cgm_mesh(sum, PIR_DOUBLE, &mesh), "mesh");
        times[run] = peer_clock() - made;
        maps[run] = made - start;
        pir_cgm_statistics s = pir_cgm_get_statistics(sum);
        m.counts = pir_cgm_total_counts(sum);
        m.vertices = pir_mesh_vertex_count(mesh);
        m.edges = pir_mesh_edge_count(mesh);
        m.facets = pir_mesh_facet_count(mesh);
        m.filter = (double)s.by_filter / (double)(s.by_filter + s.by_exact);
        m.bytes = (double)s.bytes / m.counts.halfedges;
        pir_mesh_destroy(mesh);
        pir_cgm_release(sum);
        pir_cgm_release(b);
        pir_cgm_release(a);
    }
    m.milliseconds = peer_median(times, runs);
    m.fastest = times[0];
    m.maps = peer_median(maps, runs);
    return m;
}

/* The rebuild of a tracked sum's pairing, by walk or from the overlay, median. */
static double measure_rebuild(pir_polytope *p, pir_polytope *q, pir_quat rotation, pir_method method) {
    double times[RUNS_OF_OURS];
    pir_sum *sum;
    need(pir_sum_create(p, q, rotation, NULL, &sum), "sum");
    need(pir_sum_rotate(sum, rotation, method), "rebuild");
    uint32_t runs = results_count(RUNS_OF_OURS);
    for (uint32_t run = 0; run < runs; run++) {
        double start = peer_clock();
        need(pir_sum_rotate(sum, rotation, method), "rebuild");
        times[run] = peer_clock() - start;
    }
    pir_sum_destroy(sum);
    return peer_median(times, runs);
}

#if PIR_HAVE_CGAL || PIR_HAVE_QHULL
/* What the rows of one pair share: the table, or NULL, the pair's name, the facets of the sum, the
   median of overlay and mesh. */
struct row {
    FILE *csv;
    const char *name;
    uint32_t facets;
    double ours;
};

static void run_peer(const char *name, peer_run *run, pir_polytope *p, double matrix[3][3], pir_polytope *q,
                     const struct row *row) {
    double times[RUNS_OF_PEERS];
    struct peer_result result = {0, 0, 0};
    uint32_t runs = results_count(RUNS_OF_PEERS);
    for (uint32_t i = 0; i < runs; i++) {
        result = run(p, matrix, q);
        times[i] = result.milliseconds;
    }
    double time = peer_median(times, runs);
    printf("  %-34s %10.3f ms %8.1f times   %u vertices, %u facets\n", name, time, time / row->ours, result.vertices,
           result.facets);
    if (row->csv)
        fprintf(row->csv, "%s,%u,%s,%.3f,%.1f,,\n", row->name, row->facets, name, time, time / row->ours);
}
#endif

/* A model file when the name has an ending, else a built-in shape. */
static pir_polytope *make_model(const char *name) {
    pir_polytope *p = NULL;
    need(strchr(name, '.') ? pir_polytope_read(name, NULL, NULL, NULL, &p) : pir_shape_create(name, NULL, NULL, &p),
         name);
    return p;
}

static void bench_pair(const char *name, pir_quat rotation, FILE *csv) {
    pir_polytope *p = make_model(name), *q = make_model(name);
    double matrix[3][3];
    peer_matrix(rotation, matrix);
    struct measured m = measure(p, q, rotation);
    printf("%s and itself turned: %u vertices, %u edges, %u facets; map %u/%u/%u\n", name, m.vertices, m.edges,
           m.facets, m.counts.vertices, m.counts.halfedges, m.counts.faces);
    printf("  %-34s %10.3f ms  (fastest %.3f; both maps %.3f; filter %.4f; %.1f bytes a halfedge)\n",
           "overlay and mesh", m.milliseconds, m.fastest, m.maps, m.filter, m.bytes);
    double by_cgm = measure_rebuild(p, q, rotation, PIR_METHOD_CGM),
           by_walk = measure_rebuild(p, q, rotation, PIR_METHOD_WALK);
    printf("  %-34s %10.3f ms by cgm, %.3f ms by walk\n", "pairing of a tracked sum", by_cgm, by_walk);
    if (csv) {
        fprintf(csv, "%s,%u,overlay and mesh,%.3f,1,%.4f,%.1f\n", name, m.facets, m.milliseconds, m.filter, m.bytes);
        fprintf(csv, "%s,%u,pairing by cgm,%.3f,,,\n", name, m.facets, by_cgm);
        fprintf(csv, "%s,%u,pairing by walk,%.3f,,,\n", name, m.facets, by_walk);
    }
#if PIR_HAVE_CGAL || PIR_HAVE_QHULL
    struct row row = {csv, name, m.facets, m.milliseconds};
#endif
#if PIR_HAVE_CGAL
    run_peer("CGAL spherical map overlay", peer_cgal_sgm, p, matrix, q, &row);
    run_peer("CGAL convex_hull_3 of all sums", peer_cgal_hull, p, matrix, q, &row);
#endif
#if PIR_HAVE_QHULL
    run_peer("qhull of all sums", peer_qhull, p, matrix, q, &row);
#endif
    pir_polytope_release(q);
    pir_polytope_release(p);
}

/* A least-squares line through logarithms. */
struct fit {
    double x, y, xx, xy, count;
};

static void fit_add(struct fit *fit, double size, double time) {
    double x = log(size), y = log(time);
    fit->x += x;
    fit->y += y;
    fit->xx += x * x;
    fit->xy += x * y;
    fit->count++;
}

static double fit_exponent(const struct fit *fit) {
    return (fit->count * fit->xy - fit->x * fit->y) / (fit->count * fit->xx - fit->x * fit->x);
}

static void bench_growth(pir_quat rotation, FILE *csv) {
    struct fit features = {0}, halfedges = {0};
    printf("geodesic spheres: level, facets of each, facets of the sum, halfedges, overlay and mesh in ms (median, "
           "fastest)\n");
    fprintf(csv, "level,facets of each,facets of the sum,halfedges,median ms,fastest ms\n");
    for (uint32_t level = 2; level < 2 + results_count(19); level++) {
        char name[32];
        snprintf(name, sizeof name, "geodesic?level=%u", (unsigned)level);
        pir_polytope *p;
        need(pir_shape_create(name, NULL, NULL, &p), name);
        struct measured m = measure(p, p, rotation);
        printf("  %2u %5u %6u %7u %9.3f %9.3f\n", (unsigned)level, pir_polytope_facet_count(p), m.facets,
               m.counts.halfedges, m.milliseconds, m.fastest);
        fprintf(csv, "%u,%u,%u,%u,%.3f,%.3f\n", (unsigned)level, pir_polytope_facet_count(p), m.facets,
                m.counts.halfedges, m.milliseconds, m.fastest);
        fit_add(&features, m.vertices + m.edges + m.facets, m.milliseconds);
        fit_add(&halfedges, m.counts.halfedges, m.milliseconds);
        pir_polytope_release(p);
    }
    printf("  time grows as the features of the sum to the power %.3f, as the halfedges of its map to the power %.3f\n",
           fit_exponent(&features), fit_exponent(&halfedges));
}

int main(int argc, char **argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: bench_cgm FOLDER [MODEL...]\n");
        return 2;
    }
#ifdef __GLIBC__
    // memory once had stays with the process, whoever asks for it: what is measured is not the kernel handing out pages
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
    // a turn that ties nothing, and the one that ties everything
    const pir_quat turned = {0.1, 0.2, 0.3, 0.9}, identity = {0, 0, 0, 1};
    for (int i = 2; i < argc; i++)
        bench_pair(argv[i], turned, NULL);
    if (argc > 2)
        return 0;
    struct results results = results_new(argv[1]);
    FILE *pairs = results_open(&results, "cgm.csv"), *growth = results_open(&results, "cgm_growth.csv");
    fprintf(pairs, "pair,facets of the sum,way,median ms,times overlay and mesh,filter share,bytes a halfedge\n");
    bench_pair("gs4", turned, pairs);
    bench_pair("ellipse", turned, pairs);
    bench_pair("gs4", identity, pairs);
    bench_growth(turned, growth);
    results_close(pairs, "cgm.csv");
    results_close(growth, "cgm_growth.csv");
    printf("results in %s\n", results.folder);
    return 0;
}
