/* SPDX-License-Identifier: MIT */
/*
 * How fast the ways to bring a sum from frame to frame are, and what an update costs by its work. Usage: bench_speed
 * FOLDER
 *
 * speed.csv: by steps to a turn; events.csv: time over certificates checked and pairs repaired, by size; rest.csv: a
 * box turning on a box, and a body that jitters; live.csv: live meshes and tolerances. speed.md says it all in tables.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "results.h"
#include "spin.h"
#include "trial.h"

/* --- by steps --- */

static const double all_steps[] = {500, 5e3, 5e4, 5e5};

static void speed_of(const char *name, bool from_identity, FILE *csv, FILE *page) {
    pir_polytope *p = trial_model(name);
    double before = 0;
    for (int i = 0; i < 4; i++) {
        struct trial_request request = {.frames = 10000,
                                        .warm_up = 1000,
                                        .walk_samples = 200,
                                        .brute_samples = 20,
                                        .automatic = true,
                                        .steps = all_steps[i],
                                        .seed = 1,
                                        .from_identity = from_identity};
        struct trial_result t = trial_run(&request, p, p);
        double update = t.update.median, walk = t.walk.median;
        char exponent[16] = "";
        if (i > 0)
            snprintf(exponent, sizeof exponent, "%.2f", log10(before / update));
        fprintf(csv, "%s,%s,%.0f,%.1f,%.1f,%.1f,%.1f,%.0f,%.0f,%.3g,%.3g,%.2f,%u,%u,%u\n", name,
                from_identity ? "identity" : "random", all_steps[i], update, t.update.mean, t.automatic.median,
                t.automatic.mean, walk, t.brute.median, walk / update, t.brute.median / walk, t.events,
                (unsigned)t.allocations, t.compared, t.mismatches);
        fprintf(page, "| %s | %s | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f | %.1f | %.1f | %s | %.2f |\n", name,
                from_identity ? "identity" : "random", all_steps[i], update, t.update.mean, t.automatic.median, walk,
                t.brute.median, walk / update, t.brute.median / walk, exponent, t.events);
        before = update;
    }
    pir_polytope_release(p);
}

static void write_speed(const struct results *results, FILE *page) {
    FILE *csv = results_open(results, "speed.csv");
    fprintf(csv, "model,start,steps,update_ns,update_mean_ns,auto_ns,auto_mean_ns,walk_ns,brute_ns,walk_over_update,"
                 "brute_over_walk,events_per_frame,allocations,compared,mismatches\n");
    fprintf(
        page,
        "## By steps to a turn\n\nA body and itself, random axes, from a random pose or from the identity, "
        "where they are all ties; medians of 10,000 frames (walk 200, brute force 20, "
        "in the same run). The exponent is that of the time's fall with the steps since the row before.\n\n"
        "| model | start | steps | update ns | its mean | auto ns | walk ns | brute ns | walk / update | "
        "brute / walk | exponent | events a frame |\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (int from_identity = 0; from_identity < 2; from_identity++) {
        speed_of("gs4", from_identity, csv, page);
        speed_of("ellipse", from_identity, csv, page);
    }
    results_close(csv, "speed.csv");
}

/* --- by events --- */

static void write_events(const struct results *results, FILE *page) {
    static const int levels[] = {2, 3, 5, 8, 12, 16, 20};
    FILE *csv = results_open(results, "events.csv");
    fprintf(csv, "level,facets,update_mean_ns,events_per_frame,ns_per_event\n");
    fprintf(page,
            "\n## By events\n\nGeodesic spheres and themselves, 5,000 steps a turn: mean time over mean number of "
            "certificates checked and pairs repaired.\n\n"
            "| level | facets | update, mean ns | events a frame | ns an event |\n|---:|---:|---:|---:|---:|\n");
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; i++) {
        char name[32];
        snprintf(name, sizeof name, "geodesic?level=%d", levels[i]);
        pir_polytope *p = trial_model(name);
        struct trial_request request = {.frames = 4000, .warm_up = 500, .steps = 5000, .seed = 3};
        struct trial_result t = trial_run(&request, p, p);
        unsigned facets = pir_polytope_facet_count(p);
        fprintf(csv, "%d,%u,%.1f,%.2f,%.2f\n", levels[i], facets, t.update.mean, t.events, t.update.mean / t.events);
        fprintf(page, "| %d | %u | %.0f | %.1f | %.1f |\n", levels[i], facets, t.update.mean, t.events,
                t.update.mean / t.events);
        pir_polytope_release(p);
    }
    results_close(csv, "events.csv");
}

/* --- bodies at rest --- */

static const pir_vec3 up = {0, 0, 1}, oblique = {0.48, 0.6, 0.64};

/* Turns about the normal that both boxes share. */
static pir_quat turn_upright(void *context, uint64_t frame) {
    (void)context;
    return spin_turn((pir_quat){0, 0, 0, 1}, up, 6.28318530717958647692 / 500 * (double)(frame % 500));
}

/* 1e-4 one way and the other about one axis, from a pose in general position. */
static pir_quat jitter(void *context, uint64_t frame) {
    (void)context;
    return spin_turn((pir_quat){0.1, 0.7, -0.3, 0.6}, oblique, frame % 2 ? 1e-4 : -1e-4);
}

/* By 1e-4 about a new random axis in every frame. */
static pir_quat tremble(void *context, uint64_t frame) {
    (void)context;
    uint64_t state = frame;
    pir_vec3 axis = {spin_random(&state), spin_random(&state), spin_random(&state)};
    double length = sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
    axis = (pir_vec3){axis.x / length, axis.y / length, axis.z / length};
    return spin_turn((pir_quat){0.1, 0.7, -0.3, 0.6}, axis, 1e-4);
}

static void rest_of(const char *label, const char *name, trial_motion *motion, FILE *csv, FILE *page) {
    pir_polytope *p = trial_model(name);
    struct trial_request request = {.frames = 10000, .warm_up = 1000, .walk_samples = 200, .automatic = true};
    struct trial_result t = trial_run_along(&request, p, p, motion, NULL);
    fprintf(csv, "%s,%s,%.1f,%.1f,%.1f,%.2f\n", label, name, t.update.median, t.automatic.median, t.walk.median,
            t.events);
    fprintf(page, "| %s | %s | %.0f | %.0f | %.0f | %.2f |\n", label, name, t.update.median, t.automatic.median,
            t.walk.median, t.events);
    pir_polytope_release(p);
}

static void write_rest(const struct results *results, FILE *page) {
    FILE *csv = results_open(results, "rest.csv");
    fprintf(csv, "motion,model,update_ns,auto_ns,walk_ns,events_per_frame\n");
    fprintf(page, "\n## At rest\n\n| motion | body and itself | update ns | auto ns | walk ns | events a frame |\n"
                  "|---|---|---:|---:|---:|---:|\n");
    rest_of("about the shared normal at 500 steps", "cube", turn_upright, csv, page);
    rest_of("to and fro by 1e-4 about one axis", "gs4", jitter, csv, page);
    rest_of("by 1e-4 about a new axis in every frame", "gs4", tremble, csv, page);
    rest_of("to and fro by 1e-4 about one axis", "ellipse", jitter, csv, page);
    rest_of("by 1e-4 about a new axis in every frame", "ellipse", tremble, csv, page);
    results_close(csv, "rest.csv");
}

/* --- live meshes and tolerances --- */

#define LIVE_FRAMES 4000

/* The median times of a rotation within `tolerance`, of bringing a live mesh along, and of all its coordinates. */
static void live_of(const char *name, double tolerance, FILE *csv, FILE *page) {
    static double rotate[LIVE_FRAMES], refresh[LIVE_FRAMES], place[LIVE_FRAMES];
    pir_polytope *p = trial_model(name);
    pir_sum *sum;
    pir_live_mesh *live;
    struct spin spin = spin_new(5000, 9, 0);
    trial_need(pir_sum_create(p, p, spin.now, NULL, &sum), "sum");
    trial_need(pir_sum_set_tolerance(sum, tolerance), "tolerance");
    trial_need(pir_live_mesh_create(sum, &live), "live mesh");
    uint32_t vertices = 0;
    pir_vec3 *room = NULL;
    double rewritten = 0, bound = 0, total = 0;
    uint32_t frames = results_count(LIVE_FRAMES);
    for (uint32_t i = 0; i < frames; i++) {
        uint32_t count;
        pir_quat rotation = spin_next(&spin);
        double start = trial_now();
        trial_need(pir_sum_rotate(sum, rotation, PIR_METHOD_AUTO), "rotation");
        double turned = trial_now();
        trial_need(pir_live_mesh_refresh(live), "refresh");
        double refreshed = trial_now();
        if (pir_live_mesh_vertex_slots(live) > vertices) {
            vertices = 2 * pir_live_mesh_vertex_slots(live);
            free(room);
            room = malloc(vertices * sizeof *room);
            trial_need(room ? PIR_OK : PIR_ERR_MEMORY, "vertices");
        }
        double before = trial_now();
        pir_live_mesh_vertices(live, room);
        place[i] = trial_now() - before;
        rotate[i] = turned - start;
        refresh[i] = refreshed - turned;
        total += rotate[i];
        pir_live_mesh_rewritten(live, &count);
        rewritten += count;
        bound = fmax(bound, pir_sum_shortfall_bound(sum));
    }
    fprintf(csv, "%s,%g,%.3g,%.0f,%.0f,%.0f,%.0f,%.2f,%u\n", name, tolerance, bound, trial_median(rotate, frames),
            total / frames, trial_median(refresh, frames), trial_median(place, frames), rewritten / frames,
            pir_live_mesh_facet_slots(live));
    fprintf(page, "| %s | %g | %.2g | %.0f | %.0f | %.0f | %.0f | %.1f of %u |\n", name, tolerance, bound,
            trial_median(rotate, frames), total / frames, trial_median(refresh, frames), trial_median(place, frames),
            rewritten / frames, pir_live_mesh_facet_slots(live));
    free(room);
    pir_live_mesh_destroy(live);
    pir_sum_destroy(sum);
    pir_polytope_release(p);
}

static void write_live(const struct results *results, FILE *page) {
    FILE *csv = results_open(results, "live.csv");
    fprintf(csv, "model,tolerance,bound,update_ns,update_mean_ns,refresh_ns,vertices_ns,rewritten_per_frame,slots\n");
    fprintf(page, "\n## Live mesh and tolerance\n\n5,000 steps a turn, a body and itself: an update, or a walk where "
                  "that is cheaper, within the "
                  "tolerance (a length; the "
                  "bodies' radius is 1), the refresh of a live mesh, and the pass that places all its vertices. "
                  "Medians, and the mean of the "
                  "update.\n\n| model | tolerance | bound attained | update ns | mean ns | refresh ns | vertices ns | "
                  "slots rewritten |\n"
                  "|---|---:|---:|---:|---:|---:|---:|---:|\n");
    static const double tolerances[] = {0, 0.001, 0.01, 0.05, 0.2};
    for (int i = 0; i < 5; i++)
        live_of("gs4", tolerances[i], csv, page);
    for (int i = 0; i < 5; i++)
        live_of("ellipse", tolerances[i], csv, page);
    results_close(csv, "live.csv");
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_speed FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *page = results_open(&results, "speed.md");
    fprintf(
        page,
        "# Speed\n\nMachine: %s; one thread. Times of updates hold the %.0f ns that two readings of the clock take; "
        "walks and "
        "brute force are in CPU time.\n\n",
        results.machine, trial_clock_cost());
    write_speed(&results, page);
    write_events(&results, page);
    write_rest(&results, page);
    write_live(&results, page);
    results_close(page, "speed.md");
    printf("results in %s\n", results.folder);
    return 0;
}
