/* SPDX-License-Identifier: MIT */
/*
 * A full turn without gaps beside a grid of 500 steps about the same axis. Usage: bench_critical FOLDER
 *
 * critical.csv: for pairs of models about an upright and an oblique axis: events, and the most facets of an interval;
 * what the critical map takes to make (the median of some runs), to write and to read, and its bytes; the same of a
 * file of slices of 500 steps, made by one thread (`grid_ms`, the file's assembly included, and `grid_bytes`); a state
 * at a random angle (`state_us`), at a double beside a random event, or at an event that is a double (`beside_us`), and
 * by a pair at all of these poses (`pair_us`); all contacts of a place around the turn. CPU time. Half of the poses are
 * at random angles. `unknown` counts poses without an answer, `wrong` those whose state is not the pair's.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <pirouette/cspace.h>
#include <pirouette/pirouette.h>

#include "results.h"

#define POSES  200000
#define PLACES 1000
#define RUNS   5
#define STEPS  500

static const double half_turn = 3.14159265358979323846;

struct turn {
    const char *p_name, *q_name, *axis_name;
    pir_vec3 axis;
    pir_polytope *p, *q;
    pir_critical_map *map;
    uint64_t seed;
    double size;
};

struct row {
    uint32_t events, most_facets, unknown, wrong;
    double make_ms, write_ms, read_ms, grid_ms, state_us, beside_us, pair_us, around_us, contacts;
    long bytes, grid_bytes;
};

struct poses {
    uint32_t count;
    double *kappa;
    pir_vec3 *t;
    uint8_t *state;
};

static void need(bool holds, const char *what) {
    if (holds)
        return;
    fprintf(stderr, "bench_critical: %s failed\n", what);
    exit(1);
}

static double milliseconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static double uniform(uint64_t *seed) {
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) * 0x1p-53;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* --- making --- */

static void bench_make(struct turn *turn, struct row *row) {
    double times[RUNS];
    const uint32_t runs = results_count(RUNS);
    for (uint32_t run = 0; run < runs; run++) {
        pir_critical_map_destroy(turn->map);
        const double begun = milliseconds();
        need(pir_critical_map_create(turn->p, turn->q, (pir_quat){0, 0, 0, 1}, turn->axis, NULL, &turn->map) == PIR_OK,
             "a map");
        times[run] = milliseconds() - begun;
    }
    qsort(times, runs, sizeof *times, compare);
    row->make_ms = times[runs / 2];
    row->events = pir_critical_map_event_count(turn->map);
    for (uint32_t i = 0; i <= row->events; i++) {
        uint32_t facets = 0;
        pir_critical_map_facets(turn->map, i, NULL, &facets);
        row->most_facets = facets > row->most_facets ? facets : row->most_facets;
    }
}

static void bench_file(const struct turn *turn, struct row *row) {
    FILE *file = tmpfile();
    pir_critical_map *again = NULL;
    need(file != NULL, "a temporary file");
    double begun = milliseconds();
    need(pir_critical_map_write(turn->map, file, NULL) == PIR_OK, "writing a map");
    row->write_ms = milliseconds() - begun;
    row->bytes = ftell(file);
    rewind(file);
    begun = milliseconds();
    need(pir_critical_map_read(file, NULL, NULL, &again) == PIR_OK, "reading a map");
    row->read_ms = milliseconds() - begun;
    pir_critical_map_destroy(again);
    fclose(file);
}

static void bench_grid(const struct turn *turn, struct row *row) {
    char path[64];
    snprintf(path, sizeof path, "/tmp/bench_critical_%ld.h5", (long)getpid());
    const pir_cspace_bodies bodies = {&turn->p, 1, &turn->q, 1};
    pir_cspace_options options = pir_cspace_options_default();
    pir_grid *grid;
    pir_cspace_job *job;
    struct stat file;
    const double begun = milliseconds();
    need(pir_grid_axis(turn->axis, STEPS, NULL, &grid) == PIR_OK, "a grid");
    need(pir_cspace_job_create(&bodies, grid, path, &options, NULL, &job) == PIR_OK &&
             pir_cspace_job_run(job, NULL) == PIR_OK && pir_cspace_job_assemble(job, NULL) == PIR_OK,
         "slices");
    row->grid_ms = milliseconds() - begun;
    need(stat(path, &file) == 0, "the file of slices");
    row->grid_bytes = (long)file.st_size;
    pir_cspace_job_destroy(job);
    pir_grid_destroy(grid);
    remove(path);
}

/* --- poses --- */

/* A place near where the bodies meet. */
static pir_vec3 any_place(struct turn *turn) {
    pir_vec3 d;
    double length;
    do {
        d = (pir_vec3){2 * uniform(&turn->seed) - 1, 2 * uniform(&turn->seed) - 1, 2 * uniform(&turn->seed) - 1};
        length = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    } while (length > 1 || length < 0.1);
    const double by = turn->size * (0.8 + 0.4 * uniform(&turn->seed)) / length;
    return (pir_vec3){d.x * by, d.y * by, d.z * by};
}

static void make_poses(struct turn *turn, struct poses *poses) {
    const pir_vec3 u = turn->axis;
    const double length = sqrt(u.x * u.x + u.y * u.y + u.z * u.z);
    const uint32_t events = pir_critical_map_event_count(turn->map);
    for (uint32_t i = 0; i < poses->count; i++) {
        poses->t[i] = any_place(turn);
        poses->kappa[i] = length / tan(half_turn * (uniform(&turn->seed) + 0x1p-60));
        pir_critical_angle angle;
        if (i >= poses->count / 2 && events > 0) {
            need(pir_critical_map_event(turn->map, (uint32_t)(uniform(&turn->seed) * events), &angle) == PIR_OK,
                 "an event");
            const double kappa = angle.kappa[i % 2];
            poses->kappa[i] = isfinite(kappa) ? kappa : 0;
        }
    }
}

/* Asks for some poses; microseconds a pose. */
static double ask_map(const struct turn *turn, struct poses *poses, uint32_t from, uint32_t to, struct row *row) {
    const double begun = milliseconds();
    for (uint32_t i = from; i < to; i++) {
        pir_state state;
        poses->state[i] = UINT8_MAX;
        if (pir_critical_map_state(turn->map, poses->kappa[i], poses->t[i], &state) == PIR_OK)
            poses->state[i] = (uint8_t)state;
        row->unknown += poses->state[i] == UINT8_MAX;
    }
    return 1e3 * (milliseconds() - begun) / (to - from);
}

/* With the start (0, 0, 0, 1) the quaternion of κ is (u, κ), which doubles hold. */
static void ask_pairs(const struct turn *turn, const struct poses *poses, struct row *row) {
    pir_pair *pair;
    pir_workspace *workspace;
    need(pir_pair_create(turn->p, turn->q, NULL, &pair) == PIR_OK && pir_workspace_create(NULL, &workspace) == PIR_OK,
         "a pair");
    const double begun = milliseconds();
    for (uint32_t i = 0; i < poses->count; i++) {
        pir_pair_input input = pir_pair_input_default();
        pir_query_result result;
        input.pose_p.translation = poses->t[i];
        input.pose_p.rotation = (pir_quat){turn->axis.x, turn->axis.y, turn->axis.z, poses->kappa[i]};
        need(pir_pair_overlap(pair, workspace, &input, &result) == PIR_OK, "a pair's state");
        row->wrong += poses->state[i] != (uint8_t)result.state;
    }
    row->pair_us = 1e3 * (milliseconds() - begun) / poses->count;
    pir_pair_destroy(pair);
    pir_workspace_destroy(workspace);
}

static void ask_around(struct turn *turn, struct row *row) {
    const uint32_t places = results_count(PLACES);
    uint64_t contacts = 0;
    const double begun = milliseconds();
    for (uint32_t i = 0; i < places; i++) {
        pir_critical_states *states;
        const pir_critical_map *const map = turn->map;
        need(pir_critical_states_create(&map, 1, any_place(turn), NULL, &states) == PIR_OK, "states");
        contacts += pir_critical_states_count(states);
        pir_critical_states_destroy(states);
    }
    row->around_us = 1e3 * (milliseconds() - begun) / places;
    row->contacts = (double)contacts / places;
}

static double reach_of(const pir_polytope *p) {
    double most = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(p); v++) {
        const pir_vec3 x = pir_polytope_vertex(p, v);
        most = fmax(most, sqrt(x.x * x.x + x.y * x.y + x.z * x.z));
    }
    return most;
}

static void bench_turn(struct turn *turn, struct poses *poses, FILE *csv) {
    struct row row = {0};
    need(pir_shape_create(turn->p_name, NULL, NULL, &turn->p) == PIR_OK &&
             pir_shape_create(turn->q_name, NULL, NULL, &turn->q) == PIR_OK,
         "a shape");
    turn->size = reach_of(turn->p) + reach_of(turn->q);
    turn->seed = 17;
    bench_make(turn, &row);
    bench_file(turn, &row);
    bench_grid(turn, &row);
    make_poses(turn, poses);
    row.state_us = ask_map(turn, poses, 0, poses->count / 2, &row);
    row.beside_us = ask_map(turn, poses, poses->count / 2, poses->count, &row);
    ask_pairs(turn, poses, &row);
    ask_around(turn, &row);
    fprintf(csv, "%s,%s,%s,%u,%u,%.3f,%.3f,%.3f,%ld,%d,%.3f,%ld,%u,%u,%u,%.3f,%.3f,%.3f,%.2f,%.2f\n", turn->p_name,
            turn->q_name, turn->axis_name, row.events, row.most_facets, row.make_ms, row.write_ms, row.read_ms,
            row.bytes, STEPS, row.grid_ms, row.grid_bytes, poses->count, row.unknown, row.wrong, row.state_us,
            row.beside_us, row.pair_us, row.around_us, row.contacts);
    printf("%-12s %-12s %-8s %6u events: %8.2f ms, %8ld bytes; grid %8.2f ms, %8ld bytes; state %6.2f us, beside "
           "%6.2f us, pair %6.2f us, around %8.1f us; %u unknown, %u wrong\n",
           turn->p_name, turn->q_name, turn->axis_name, row.events, row.make_ms, row.bytes, row.grid_ms, row.grid_bytes,
           row.state_us, row.beside_us, row.pair_us, row.around_us, row.unknown, row.wrong);
    pir_critical_map_destroy(turn->map);
    pir_polytope_release(turn->p);
    pir_polytope_release(turn->q);
}

int main(int argc, char **argv) {
    static const pir_vec3 upright = {0, 0, 1}, oblique = {0.31, -0.52, 0.7123};
    struct turn turns[] = {
        {.p_name = "cube", .q_name = "cube", .axis_name = "upright", .axis = upright},
        {.p_name = "cube", .q_name = "cube", .axis_name = "oblique", .axis = oblique},
        {.p_name = "dodecahedron", .q_name = "dodecahedron", .axis_name = "upright", .axis = upright},
        {.p_name = "dodecahedron", .q_name = "dodecahedron", .axis_name = "oblique", .axis = oblique},
        {.p_name = "cube", .q_name = "gs4", .axis_name = "oblique", .axis = oblique},
        {.p_name = "gs4", .q_name = "gs4", .axis_name = "upright", .axis = upright},
        {.p_name = "gs4", .q_name = "gs4", .axis_name = "oblique", .axis = oblique},
    };
    if (argc != 2) {
        fprintf(stderr, "usage: bench_critical FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *csv = results_open(&results, "critical.csv");
    struct poses poses = {.count = results_count(POSES)};
    poses.kappa = malloc(poses.count * sizeof *poses.kappa);
    poses.t = malloc(poses.count * sizeof *poses.t);
    poses.state = malloc(poses.count);
    need(poses.kappa && poses.t && poses.state, "memory");
    fprintf(csv, "p,q,axis,events,most_facets,make_ms,write_ms,read_ms,bytes,grid_steps,grid_ms,grid_bytes,poses,"
                 "unknown,wrong,state_us,beside_us,pair_us,around_us,contacts\n");
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++)
        bench_turn(&turns[i], &poses, csv);
    free(poses.kappa);
    free(poses.t);
    free(poses.state);
    results_close(csv, "critical.csv");
    printf("results in %s\n", results.folder);
    return 0;
}
