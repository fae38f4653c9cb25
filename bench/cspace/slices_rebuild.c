/* SPDX-License-Identifier: MIT */
#include "slices_rebuild.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "older_walk.h"
#include "results.h"
#include "trial.h"

#if PIR_HAVE_QHULL
#include <libqhull_r/qhull_ra.h>
#endif

#define WALK_SAMPLES 800
#define HULL_SAMPLES 2
#define MESH_SAMPLES 25

static pir_sum *difference(pir_polytope *p, pir_polytope *q, pir_quat rotation) {
    const pir_sum_options options = {.size = sizeof options, .allocator = NULL, .difference = true};
    pir_sum *sum = NULL;
    trial_need(pir_sum_create(p, q, rotation, &options, &sum), "sum");
    return sum;
}

/* Rotation `i` of `samples` that are spread over the scene. */
static pir_quat sample(const struct slices_bodies *bodies, uint64_t i, uint64_t samples) {
    return pir_grid_rotation(bodies->grid, i * bodies->slices / samples);
}

static uint64_t samples_of(const struct slices_bodies *bodies, uint32_t usual) {
    uint64_t samples = (results_count(usual) + bodies->pieces - 1) / bodies->pieces;
    return samples < bodies->slices ? samples : bodies->slices;
}

double slices_walk(const struct slices_bodies *bodies) {
    uint64_t samples = samples_of(bodies, WALK_SAMPLES);
    double time = 0;
    for (uint32_t k = 0; k < bodies->pieces; k++) {
        pir_sum *sum = difference(bodies->p[k], bodies->q, pir_grid_rotation(bodies->grid, 0));
        double start = slices_cpu();
        for (uint64_t i = 0; i < samples; i++)
            trial_need(pir_sum_reset(sum, sample(bodies, i, samples)), "walk");
        time += slices_cpu() - start;
        pir_sum_destroy(sum);
    }
    return time / (double)(samples * bodies->pieces);
}

#if PIR_HAVE_OLDER_WALK
static void put(pir_quat q, double ret_rotation[4]) {
    ret_rotation[0] = q.x;
    ret_rotation[1] = q.y;
    ret_rotation[2] = q.z;
    ret_rotation[3] = q.w;
}

double slices_older_walk(const struct slices_bodies *bodies) {
    uint64_t samples = samples_of(bodies, WALK_SAMPLES);
    double time = 0, rotation[4];
    for (uint32_t k = 0; k < bodies->pieces; k++) {
        put(pir_grid_rotation(bodies->grid, 0), rotation);
        struct older_walk *walk = older_walk_new(bodies->name[k], bodies->q_name, rotation);
        double start = slices_cpu();
        for (uint64_t i = 0; i < samples; i++) {
            put(sample(bodies, i, samples), rotation);
            older_walk_rebuild(walk, rotation);
        }
        time += slices_cpu() - start;
        older_walk_free(walk);
    }
    return time / (double)(samples * bodies->pieces);
}
#else
double slices_older_walk(const struct slices_bodies *bodies) {
    (void)bodies;
    return NAN;
}
#endif

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

/* The hull of the difference of one pair of pieces. */
static void hull_at(const pir_polytope *p, const pir_polytope *q, pir_quat r, pir_vec3 *points) {
    uint32_t n = pir_polytope_vertex_count(p), m = pir_polytope_vertex_count(q);
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

double slices_hull(const struct slices_bodies *bodies) {
    uint64_t samples = results_count(HULL_SAMPLES);
    double time = 0;
    for (uint32_t k = 0; k < bodies->pieces; k++) {
        size_t count = (size_t)pir_polytope_vertex_count(bodies->p[k]) * pir_polytope_vertex_count(bodies->q);
        pir_vec3 *points = malloc(count * sizeof *points);
        if (!points)
            exit(2);
        double start = slices_cpu();
        for (uint64_t i = 0; i < samples; i++)
            hull_at(bodies->p[k], bodies->q, sample(bodies, i, samples), points);
        time += slices_cpu() - start;
        free(points);
    }
    return time / (double)(samples * bodies->pieces);
}
#else
double slices_hull(const struct slices_bodies *bodies) {
    (void)bodies;
    return NAN;
}
#endif

/* --- meshes stored whole --- */

static double deflated(const void *data, size_t size) {
    uLongf length = compressBound((uLong)size);
    Bytef *room = malloc(length);
    if (!room || compress2(room, &length, data, (uLong)size, Z_DEFAULT_COMPRESSION) != Z_OK)
        exit(2);
    free(room);
    return (double)length;
}

static double bytes_of(const pir_mesh *mesh) {
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

double slices_mesh_bytes(const struct slices_bodies *bodies) {
    uint64_t samples = samples_of(bodies, MESH_SAMPLES);
    double bytes = 0;
    for (uint32_t k = 0; k < bodies->pieces; k++)
        for (uint64_t i = 0; i < samples; i++) {
            pir_sum *sum = difference(bodies->p[k], bodies->q, sample(bodies, i, samples));
            pir_mesh *mesh = NULL;
            trial_need(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), "mesh");
            bytes += bytes_of(mesh);
            pir_mesh_destroy(mesh);
            pir_sum_destroy(sum);
        }
    return bytes / (double)(samples * bodies->pieces);
}
