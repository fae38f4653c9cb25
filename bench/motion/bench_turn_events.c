/* SPDX-License-Identifier: MIT */
/*
 * Critical angles: what the events of a turn take, beside an update run through the turn, which makes the changes of
 * the facets without telling when.
 *
 * Usage: bench_turn_events FOLDER
 *
 * turn_events.csv: for pairs of models, about an axis and from a rotation that are random, and from the models as they
 * stand: how many events and changes of facets there are; the time to make the events and go to the fifth, of which
 * `create_us` is the first part; to go to a random place of the turn and the event after that (`seek_us`); from event
 * to event (`next_us`, all of the turn over their number); of the whole turn; and of 50,000 updates of a sum. Medians
 * of CPU time of the thread.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/pirouette.h>

#include "peers.h"
#include "results.h"

#define RUNS  21
#define STEPS 50000

static const double half_turn = 3.14159265358979323846;
static const pir_vec3 axis = {0.31, -0.52, 0.7123};

static void need(pir_status status, const char *what) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "bench_turn_events: %s: %s\n", what, pir_status_text(status));
    exit(1);
}

struct pair {
    const char *p, *q, *pose;
    pir_quat start;
};

static bool next(pir_events *events, uint64_t *changes) {
    pir_event event;
    bool found;
    need(pir_events_next(events, &event, &found), "next");
    if (found)
        *changes += event.lost_count + event.gained_count;
    return found;
}

static double time_create(pir_polytope *p, pir_polytope *q, pir_quat start, uint32_t events_after) {
    double times[RUNS];
    const uint32_t runs = results_count(RUNS), repeat = results_count(50);
    for (uint32_t run = 0; run < runs; run++) {
        const double begun = peer_clock();
        for (uint32_t i = 0; i < repeat; i++) {
            pir_events *events;
            uint64_t changes = 0;
            need(pir_events_create(p, q, start, axis, NULL, &events), "events");
            for (uint32_t k = 0; k < events_after; k++)
                next(events, &changes);
            pir_events_destroy(events);
        }
        times[run] = (peer_clock() - begun) / repeat;
    }
    return 1e3 * peer_median(times, runs);
}

static double time_seek(pir_events *events) {
    double times[RUNS];
    const uint32_t runs = results_count(RUNS), repeat = results_count(50);
    uint64_t changes = 0;
    for (uint32_t run = 0; run < runs; run++) {
        const double begun = peer_clock();
        for (uint32_t i = 0; i < repeat; i++) {
            const double angle = half_turn * (i + 0.5 + 0.9 * run / RUNS) / (repeat + 1);
            need(pir_events_seek(events, cos(angle) / sin(angle)), "seek");
            next(events, &changes);
        }
        times[run] = (peer_clock() - begun) / repeat;
    }
    return 1e3 * peer_median(times, runs);
}

/* The whole turn, in milliseconds. */
static double time_turn(pir_events *events, uint32_t *count, uint64_t *changes) {
    double times[RUNS];
    const uint32_t runs = results_count(RUNS);
    for (uint32_t run = 0; run < runs; run++) {
        need(pir_events_seek(events, INFINITY), "seek");
        *count = 0;
        *changes = 0;
        const double begun = peer_clock();
        while (next(events, changes))
            ++*count;
        times[run] = peer_clock() - begun;
    }
    return peer_median(times, runs);
}

static double time_updates(pir_polytope *p, pir_polytope *q, pir_quat s) {
    const double length = sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
    double times[5];
    const uint32_t runs = results_count(5), steps = results_count(STEPS);
    pir_sum *sum;
    pir_quat *rotation = malloc(steps * sizeof *rotation);
    if (!rotation)
        need(PIR_ERR_MEMORY, "rotations");
    for (uint32_t i = 0; i < steps; i++) {
        const double half = half_turn * (i + 1) / steps, by = sin(half) / length;
        const pir_quat d = {axis.x * by, axis.y * by, axis.z * by, cos(half)};
        rotation[i] =
            (pir_quat){d.w * s.x + d.x * s.w + d.y * s.z - d.z * s.y, d.w * s.y - d.x * s.z + d.y * s.w + d.z * s.x,
                       d.w * s.z + d.x * s.y - d.y * s.x + d.z * s.w, d.w * s.w - d.x * s.x - d.y * s.y - d.z * s.z};
    }
    need(pir_sum_create(p, q, s, NULL, &sum), "sum");
    for (uint32_t run = 0; run < runs; run++) {
        need(pir_sum_reset(sum, s), "reset");
        const double begun = peer_clock();
        for (uint32_t i = 0; i < steps; i++)
            need(pir_sum_rotate(sum, rotation[i], PIR_METHOD_UPDATE), "update");
        times[run] = peer_clock() - begun;
    }
    pir_sum_destroy(sum);
    free(rotation);
    return peer_median(times, runs);
}

static void bench_pair(const struct pair *pair, FILE *csv) {
    pir_polytope *p, *q;
    pir_events *events;
    uint32_t count = 0;
    uint64_t changes = 0;
    need(pir_shape_create(pair->p, NULL, NULL, &p), pair->p);
    need(pir_shape_create(pair->q, NULL, NULL, &q), pair->q);
    const double create = time_create(p, q, pair->start, 0), five = time_create(p, q, pair->start, 5);
    need(pir_events_create(p, q, pair->start, axis, NULL, &events), "events");
    const double seek = time_seek(events), turn = time_turn(events, &count, &changes);
    const double update = time_updates(p, q, pair->start), each = count > 0 ? 1e3 * turn / count : 0;
    fprintf(csv, "%s,%s,%s,%u,%llu,%.2f,%.2f,%.2f,%.3f,%.3f,%.3f\n", pair->p, pair->q, pair->pose, count,
            (unsigned long long)changes, create, five, seek, each, turn, update);
    printf("%-12s %-12s %-8s %6u events, %7llu changes: create %8.2f us, to the fifth %8.2f, seek and next %8.2f, "
           "next %6.3f; turn %8.3f ms, updates %8.3f ms\n",
           pair->p, pair->q, pair->pose, count, (unsigned long long)changes, create, five, seek, each, turn, update);
    pir_events_destroy(events);
    pir_polytope_release(p);
    pir_polytope_release(q);
}

int main(int argc, char **argv) {
    static const pir_quat random = {0.1, 0.2, -0.3, 0.9}, straight = {0, 0, 0, 1};
    const struct pair pairs[] = {
        {"icosahedron", "cube", "random", random}, {"icosahedron", "cube", "straight", straight},
        {"cube", "cube", "random", random},        {"cube", "cube", "straight", straight},
        {"gs4", "gs4", "random", random},          {"gs4", "gs4", "straight", straight},
        {"gs4", "cube", "random", random},         {"geodesic?level=8", "gs4", "random", random},
    };
    if (argc != 2) {
        fprintf(stderr, "usage: bench_turn_events FOLDER\n");
        return 2;
    }
    struct results results = results_new(argv[1]);
    FILE *csv = results_open(&results, "turn_events.csv");
    fprintf(csv, "p,q,pose,events,changes,create_us,fifth_us,seek_us,next_us,turn_ms,update_ms\n");
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        bench_pair(&pairs[i], csv);
    results_close(csv, "turn_events.csv");
    printf("results in %s\n", results.folder);
    return 0;
}
