/* SPDX-License-Identifier: MIT */
/*
 * The inner loops, every version that this processor runs beside the scalar reference: those of an update
 * (dymsum/kernels/kernels.h) and those over planes of a query (query/depth/scan.h). Usage: bench_kernels FOLDER
 *
 * kernels.csv holds the times, kernels.md the same as tables. A pass goes over all items of a real sum; versions take
 * turns from pass to pass, so that what else the machine does falls on all alike, and what a pass changes is put back
 * before the next one.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/processor.h"
#include "dymsum/sum.h"
#include "query/depth/scan.h"
#include "results.h"
#include "spin.h"
#include "trial.h"

#define PASSES       401
#define VERSIONS_MAX 4

/* --- measuring --- */

/* A pass by version `index`; it leaves things as they were. Returns the nanoseconds that the loop itself took. */
typedef double pass_run(void *context, unsigned index);

struct pass {
    const char *loop, *model;
    pass_run *run;
    void *context;
    uint32_t items;    /* that a pass goes over */
    unsigned versions; /* and their names */
    const char *names[VERSIONS_MAX];
};

/* One row of both tables. */
static void measure(const struct pass *pass, FILE *csv, FILE *page) {
    static double times[VERSIONS_MAX][PASSES];
    double clock = trial_clock_cost(), reference = 0;
    uint32_t passes = results_count(PASSES);
    for (uint32_t i = 0; i < passes; i++)
        for (unsigned k = 0; k < pass->versions; k++)
            times[k][i] = pass->run(pass->context, k) - clock;
    fprintf(page, "| %s | %s | %u |", pass->loop, pass->model, (unsigned)pass->items);
    for (unsigned k = 0; k < pass->versions; k++) {
        // the fastest is the first once they are sorted
        double median = trial_median(times[k], passes) / pass->items, fastest = times[k][0] / pass->items;
        reference = k == 0 ? median : reference;
        fprintf(csv, "%s,%s,%u,%s,%.3f,%.3f,%.2f\n", pass->loop, pass->model, (unsigned)pass->items, pass->names[k],
                median, fastest, reference / median);
        fprintf(page, k == 0 ? " %.2f |" : " %.2f (%.1f) |", median, reference / median);
    }
    fprintf(page, "\n");
}

static void write_head(FILE *page, const char *title, const struct pass *pass) {
    fprintf(page, "\n## %s\n\n| loop | of | items |", title);
    for (unsigned k = 0; k < pass->versions; k++)
        fprintf(page, " %s |", pass->names[k]);
    fprintf(page, "\n|---|---|---:|");
    for (unsigned k = 0; k < pass->versions; k++)
        fprintf(page, "---:|");
    fprintf(page, "\n");
}

static void *room_for(size_t count, size_t size) {
    void *room = calloc(count + 1, size);
    trial_need(room ? PIR_OK : PIR_ERR_MEMORY, "memory");
    return room;
}

/* --- the loops of an update --- */

struct scene {
    pir_sum *sum;
    uint32_t *cells, *expired; /* P's cells as they are; all its facets by their certificates */
    pir_suspect *suspects;
    float *bounds[2]; /* of the blocks of certificates */
    uint32_t blocks;
    pir_turned_angle time; /* for collecting */
};

/* A body and itself, 50 frames on from a random pose at 5,000 steps to a turn. */
static struct scene scene_make(const char *model) {
    struct scene scene = {0};
    struct spin spin = spin_new(5000, 5, 0);
    pir_polytope *p = trial_model(model);
    trial_need(pir_sum_create(p, p, spin.now, NULL, &scene.sum), "sum");
    pir_polytope_release(p);
    for (int i = 0; i < SPIN_AXIS_FRAMES; i++)
        trial_need(pir_sum_rotate(scene.sum, spin_next(&spin), PIR_METHOD_UPDATE), "rotation");
    const pir_facets *facets = &scene.sum->tracked.p_facets;
    scene.cells = room_for(facets->count, sizeof *scene.cells);
    scene.expired = room_for(facets->count, sizeof *scene.expired);
    scene.suspects = room_for(facets->count, sizeof *scene.suspects);
    memcpy(scene.cells, facets->cell, facets->count * sizeof *scene.cells);
    for (uint32_t f = 0; f < facets->count; f++)
        scene.expired[f] = facets->first_certificate + f;
    scene.blocks = scene.sum->tracked.certificates.capacity / PIR_CERTIFICATE_BLOCK;
    for (int k = 0; k < 2; k++)
        scene.bounds[k] = room_for(scene.blocks, sizeof *scene.bounds[k]);
    memcpy(scene.bounds[0], scene.sum->tracked.certificates.block_ahead, scene.blocks * sizeof *scene.bounds[0]);
    memcpy(scene.bounds[1], scene.sum->tracked.certificates.block_behind, scene.blocks * sizeof *scene.bounds[1]);
    scene.time = pir_turned_angle_of(&scene.sum->tracked.epoch);
    return scene;
}

static void scene_free(struct scene *scene) {
    pir_sum_destroy(scene->sum);
    free(scene->cells);
    free(scene->expired);
    free(scene->suspects);
    free(scene->bounds[0]);
    free(scene->bounds[1]);
}

static double run_review(void *context, unsigned index) {
    struct scene *scene = context;
    const pir_facets *facets = &scene->sum->tracked.p_facets;
    const pir_due due = {scene->expired, facets->count, 0, false};
    uint64_t sides = 0;
    double start = trial_now();
    pir_processor_version(index)->kernels->review(facets, &scene->sum->tracked.step, &scene->sum->tracked.certificates,
                                                  &due, scene->suspects, &sides);
    double taken = trial_now() - start;
    memcpy(facets->cell, scene->cells, facets->count * sizeof *scene->cells);
    return taken;
}

static double run_probe(void *context, unsigned index) {
    struct scene *scene = context;
    const pir_facets *facets = &scene->sum->tracked.p_facets;
    const pir_kernels *kernels = pir_processor_version(index)->kernels;
    pir_cell_probe seen;
    double start = trial_now();
    for (uint32_t f = 0; f < facets->count; f++)
        kernels->probe(facets, &scene->sum->tracked.step, facets->cell[f], facets->turn[f % 3], &seen);
    return trial_now() - start;
}

static double run_collect(void *context, unsigned index) {
    struct scene *scene = context;
    pir_certificates *certificates = &scene->sum->tracked.certificates;
    memcpy(certificates->block_ahead, scene->bounds[0], scene->blocks * sizeof *scene->bounds[0]);
    memcpy(certificates->block_behind, scene->bounds[1], scene->blocks * sizeof *scene->bounds[1]);
    double start = trial_now();
    pir_processor_version(index)->kernels->collect(certificates, scene->blocks, scene->time);
    return trial_now() - start;
}

static void write_update_loops(const char *model, FILE *csv, FILE *page, bool first) {
    struct scene scene = scene_make(model);
    uint32_t facets = scene.sum->tracked.p_facets.count, certificates = scene.blocks * PIR_CERTIFICATE_BLOCK;
    struct pass pass = {"collect (none expires)", model, run_collect, &scene, certificates, 0, {NULL}};
    for (; pass.versions < VERSIONS_MAX && pir_processor_version(pass.versions); pass.versions++)
        pass.names[pass.versions] = pir_processor_version(pass.versions)->kernels->name;
    if (first)
        write_head(page, "Of an update: ns a facet or certificate (times as fast as scalar)", &pass);
    measure(&pass, csv, page);
    // so much later, at the steady axis of these frames, that some have to be looked at
    scene.time.ahead += 0.01;
    scene.time.behind += 0.01;
    pass.loop = "collect (8 steps on)";
    measure(&pass, csv, page);
    pass.loop = "probe";
    pass.run = run_probe;
    pass.items = facets;
    measure(&pass, csv, page);
    pass.loop = "review";
    pass.run = run_review;
    measure(&pass, csv, page);
    scene_free(&scene);
}

/* --- the loops over planes --- */

#define PLANES 1024

struct planes {
    double room[18][PLANES + PIR_SCAN_LANES];
    int loop;
};

static pir_lanes lanes(struct planes *planes, int at) {
    return (pir_lanes){planes->room[at], planes->room[at + 1], planes->room[at + 2]};
}

static const char *const scan_loops[] = {"turn",  "offset", "cross", "look", "slacks",
                                         "least", "bounds", "boxes", "caps"};

static double run_scan(void *context, unsigned index) {
    struct planes *planes = context;
    const pir_scan *scan = pir_processor_version(index)->scan;
    const pir_mat3 r = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
    const pir_vec3 x = {0.3, -0.2, 0.5};
    double(*a)[PLANES + PIR_SCAN_LANES] = planes->room, least[3];
    const pir_facet_lanes facets = {lanes(planes, 3), a[9]};
    pir_slack_lanes slacks = {.to = lanes(planes, 12), .s = a[15]};
    const pir_lasting_lanes lasting = {a[9], a[10], a[11], a[3], lanes(planes, 6)};
    const pir_box_lanes boxes = {lanes(planes, 0), lanes(planes, 3), a[9], a[10]};
    const pir_cap_lanes caps = {lanes(planes, 0), lanes(planes, 3), a[9], a[10]};
    double start = trial_now();
    switch (planes->loop) {
    case 0:
        scan->turn(PLANES, &r, lanes(planes, 0), lanes(planes, 12));
        break;
    case 1:
        scan->offset(PLANES, lanes(planes, 0), a[9], lanes(planes, 3), a[15]);
        break;
    case 2:
        scan->cross(PLANES, lanes(planes, 0), lanes(planes, 3), lanes(planes, 6), lanes(planes, 12), a[15], a[16]);
        break;
    case 3:
        scan->look(PLANES, lanes(planes, 0), a[9], a[10], x, 0x1p-46, least);
        break;
    case 4:
        scan->slacks(PLANES, &r, lanes(planes, 0), x, &facets, &slacks);
        break;
    case 5:
        scan->least(PLANES, lanes(planes, 0), a[9], x);
        break;
    case 6:
        scan->bounds(PLANES, &lasting, 0.5, x, 0x1p-46, a[15]);
        break;
    case 7:
        scan->boxes(PLANES, &boxes, x, 0x1p-46, a[15]);
        break;
    default:
        scan->caps(0, PLANES, &caps, x, 0x1p-46, a[15]);
    }
    return trial_now() - start;
}

static void write_query_loops(FILE *csv, FILE *page) {
    static struct planes planes;
    uint64_t state = 7;
    for (int i = 0; i < 18; i++)
        for (int k = 0; k < PLANES + PIR_SCAN_LANES; k++)
            planes.room[i][k] = spin_random(&state);
    struct pass pass = {NULL, "random planes", run_scan, &planes, PLANES, 0, {NULL}};
    for (; pass.versions < VERSIONS_MAX && pir_processor_version(pass.versions); pass.versions++)
        pass.names[pass.versions] = pir_processor_version(pass.versions)->scan->name;
    write_head(page, "Of a query: ns a plane (times as fast as plain)", &pass);
    for (; planes.loop < (int)(sizeof scan_loops / sizeof scan_loops[0]); planes.loop++) {
        pass.loop = scan_loops[planes.loop];
        measure(&pass, csv, page);
    }
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_kernels FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *csv = results_open(&results, "kernels.csv"), *page = results_open(&results, "kernels.md");
    fprintf(csv, "loop,of,items,version,median_ns,fastest_ns,times_as_fast\n");
    fprintf(page,
            "# Inner loops\n\nMachine: %s; one thread. Medians of %d passes, versions in turns, what two looks at the "
            "clock "
            "take (%.0f ns) taken off.\n",
            results.machine, PASSES, trial_clock_cost());
    static const char *const models[] = {"gs4", "ellipse"};
    for (int i = 0; i < 2; i++)
        write_update_loops(models[i], csv, page, i == 0);
    write_query_loops(csv, page);
    results_close(csv, "kernels.csv");
    results_close(page, "kernels.md");
    printf("results in %s\n", results.folder);
    return 0;
}
