/* SPDX-License-Identifier: MIT */
/*
 * Contacts of a box, a capsule, a hull of 20 points, a ball and a plate as wide as all with a field of 64 × 64 cells,
 * flat or rough, by pir_surface_contacts: mesh_contacts.csv has a line for each body, field, size of cells and place:
 * apart by a thousandth of the body or overlapping by that, likewise where all is aligned, and, of bodies with a
 * radius, half of the radius deep and with the core behind. Bodies are tilted by 10^-4 unless they are aligned, and
 * move over the field.
 *
 *     bench_contacts FOLDER
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <pirouette/trimesh_contact.h>

#include "results.h"

#define SIDE 65

/* This thread's time: on a machine that others use as well it is what a call takes. */
static double now_us(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

static void check(pir_status status) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "bench_contacts: %s\n", pir_status_text(status));
    exit(2);
}

static double rough_height(uint32_t i, uint32_t j) {
    return 0.1 * sin(1.7 * i) * cos(1.3 * j);
}

static pir_height_field *make_field(double cell, int rough) {
    static double heights[SIDE * SIDE];
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++)
            heights[j * SIDE + i] = rough ? cell * rough_height(i, j) : 0;
    pir_height_samples samples = {.heights = heights, .columns = SIDE, .rows = SIDE, .step_x = cell, .step_y = cell};
    pir_height_field *field;
    check(pir_height_field_create(&samples, NULL, NULL, &field));
    return field;
}

typedef struct bench_body {
    const char *name;
    pir_polytope *shape;
    double radius, low;
} bench_body;

static bench_body make_body(int kind) {
    static const char *const names[5] = {"box", "capsule", "20 points", "ball", "plate"};
    static const size_t counts[5] = {8, 2, 20, 1, 8};
    pir_vec3 point[20];
    size_t count = counts[kind];
    for (int i = 0; i < (int)count; i++) {
        double z = 1 - 2 * (i + 0.5) / 20, a = 2.399963 * i, r = sqrt(1 - z * z);
        if (kind == 0)
            point[i] = (pir_vec3){i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5};
        else if (kind == 1)
            point[i] = (pir_vec3){i ? 0.4 : -0.4, 0, 0};
        else if (kind == 3)
            point[i] = (pir_vec3){0, 0, 0};
        else if (kind == 4)
            point[i] = (pir_vec3){i & 1 ? 33 : -33, i & 2 ? 33 : -33, i & 4 ? 0.5 : -0.5};
        else
            point[i] = (pir_vec3){0.5 * r * cos(a), 0.5 * r * sin(a), 0.5 * z};
    }
    bench_body body = {names[kind], NULL, kind == 1 ? 0.3 : kind == 3 ? 0.5 : 0, 0};
    check(pir_polytope_create(point, count, NULL, &body.shape));
    for (size_t i = 0; i < count; i++)
        body.low = fmin(body.low, point[i].z);
    body.low -= body.radius;
    return body;
}

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static double distance_of(const bench_body *body, pir_workspace *workspace, pir_surface_contact_input *input) {
    pir_surface_contact_result result;
    check(pir_surface_contacts(body->shape, workspace, input, 0, NULL, &result));
    return result.distance;
}

typedef struct bench_place {
    const char *name;
    double gap, cell;
    int rough, aligned;
} bench_place;

/* Where call `i` of `count` has a body: on its way over the field, the plate over its middle. */
static pir_vec3 place_of(const bench_body *body, const bench_place *at, uint32_t i, uint32_t count) {
    const double part = strcmp(body->name, "plate") == 0 ? 0.5 : 0.2 + 0.6 * i / count;
    pir_vec3 t = {64 * at->cell * part, 64 * at->cell * (0.3 + 0.4 * part), at->gap - body->low};
    if (at->aligned) {
        t.x = rint(4 * t.x) / 4;
        t.y = rint(4 * t.y) / 4;
    }
    return t;
}

/* Calls along a way over the field; a body on a rough one is first brought down to the gap. */
static void run(FILE *csv, const bench_body *body, pir_workspace *workspace, const bench_place *at) {
    pir_height_field *field = make_field(at->cell, at->rough);
    const pir_posed_surface surface = {{NULL, field}, pir_pose_identity()};
    pir_surface_contact_input input = pir_surface_contact_input_default();
    uint32_t count = results_count(strcmp(body->name, "plate") == 0 ? 40 : 2000);
    double *us = calloc(count, sizeof *us), triangles = 0, contacts = 0;
    if (!us)
        exit(2);
    if (!at->aligned)
        input.pose.rotation = (pir_quat){1e-4, 7e-5, 0.1, 1};
    input.radius = body->radius;
    input.surfaces = &surface;
    input.surface_count = 1;
    for (uint32_t i = 0; i < count; i++) {
        pir_surface_contact points[32];
        pir_surface_contact_result result;
        input.pose.translation = place_of(body, at, i, count);
        input.margin = 0.3;
        if (at->rough)
            for (int step = 0; step < 3; step++)
                input.pose.translation.z -= distance_of(body, workspace, &input) - at->gap;
        input.margin = 0.02;
        double begin = now_us();
        check(pir_surface_contacts(body->shape, workspace, &input, 32, points, &result));
        us[i] = now_us() - begin;
        triangles += result.counts.triangles;
        contacts += (double)result.contacts;
    }
    qsort(us, count, sizeof *us, compare);
    fprintf(csv, "%s,%s,%g,%s,%.1f,%.2f,%.2f,%.2f\n", body->name, at->rough ? "rough" : "flat", at->cell, at->name,
            triangles / count, contacts / count, us[count / 2], us[(uint64_t)count * 99 / 100]);
    printf("%s on %s cells of %g, %s: median %.2f us, 99th %.2f us\n", body->name, at->rough ? "rough" : "flat",
           at->cell, at->name, us[count / 2], us[(uint64_t)count * 99 / 100]);
    free(us);
    pir_height_field_release(field);
}

/* All places of a body. */
static void run_places(FILE *csv, const bench_body *body, pir_workspace *workspace) {
    const int is_plate = strcmp(body->name, "plate") == 0;
    for (int i = 0; i < 4; i++)
        for (int rough = 0; rough < (i & 2 || is_plate ? 1 : 2); rough++)
            for (int fine = 0; fine < (is_plate ? 1 : 2); fine++) {
                static const char *const names[4] = {"apart", "overlapping", "apart and aligned",
                                                     "overlapping and aligned"};
                run(csv, body, workspace,
                    &(bench_place){names[i], i & 1 ? -0.001 : 0.001, fine ? 0.25 : 1, rough, i >= 2});
            }
    for (int rough = 0; rough < 2 && body->radius > 0; rough++) {
        run(csv, body, workspace, &(bench_place){"half of the radius deep", -0.5 * body->radius, 0.25, rough, 0});
        run(csv, body, workspace, &(bench_place){"core behind", -1.2 * body->radius, 0.25, rough, 0});
    }
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_contacts FOLDER\n");
        return 2;
    }
    const struct results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "mesh_contacts.csv");
    fprintf(csv, "body,field,cell,place,triangles,contacts,median_us,p99_us\n");
    pir_workspace *workspace;
    check(pir_workspace_create(NULL, &workspace));
    for (int kind = 0; kind < 5; kind++) {
        bench_body body = make_body(kind);
        run_places(csv, &body, workspace);
        pir_polytope_release(body.shape);
    }
    pir_workspace_destroy(workspace);
    results_close(csv, "mesh_contacts.csv");
    return 0;
}
