/* SPDX-License-Identifier: MIT */
/*
 * Sums of solids that turn: updates beside rebuilds, at the same rotations in one run, about an axis that changes every
 * 50 frames. Ten updates, then the ten rebuilds: each finds in the caches what its like has left there.
 *
 * solid_track.csv has a line for each pair and step: the median time of an update, of an update with facets glued
 * together, of a rebuild, which glues them; which part of all planes of candidates the updates clipped; and the kB that
 * are kept from one to the next, a candidate, GMP's own apart.
 *
 *     bench_solid_track FOLDER
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "results.h"
#include "solid/models.h"

#define FRAMES_MOST 200
#define BLOCK       10

struct pair {
    const char *name, *p, *q;
    double q_divisor;
    uint32_t frames;
};

static void check(pir_status status) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "bench_solid_track: %s\n", pir_status_text(status));
    exit(2);
}

static double now_ms(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

/* Counts the bytes in use. */
static void *resize_counted(void *context, void *block, size_t old_size, size_t new_size) {
    size_t *bytes = context;
    void *made = new_size > 0 ? realloc(block, new_size) : NULL;
    if (new_size == 0)
        free(block);
    if (made || new_size == 0)
        *bytes += new_size - old_size;
    return made;
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *ms, uint32_t count) {
    qsort(ms, count, sizeof *ms, by_size);
    return ms[count / 2];
}

/* A rotation by `angle` about the frame's axis, after q. */
static pir_quat turned(pir_quat q, uint32_t frame, double angle) {
    const double k = 1 + frame / 50, x = sin(1.3 * k), y = cos(2.1 * k), z = sin(.7 * k + 1);
    const double s = sin(angle / 2) / sqrt(x * x + y * y + z * z), c = cos(angle / 2);
    const pir_quat b = {s * x, s * y, s * z, c};
    return (pir_quat){b.w * q.x + b.x * q.w + b.y * q.z - b.z * q.y, b.w * q.y - b.x * q.z + b.y * q.w + b.z * q.x,
                      b.w * q.z + b.x * q.y - b.y * q.x + b.z * q.w, b.w * q.w - b.x * q.x - b.y * q.y - b.z * q.z};
}

/* The times of frames, in ms. */
struct times {
    double update[FRAMES_MOST], glued[FRAMES_MOST], rebuild[FRAMES_MOST];
};

/* Updates a sum through the frames first .. end; what is clipped, and of how many planes, is added. */
static pir_quat follow(pir_solid_sum *kept, pir_quat rotation, uint32_t steps, uint32_t first, uint32_t end,
                       struct times *times, uint64_t ret_clipped[2]) {
    for (uint32_t i = first; i < end; i++) {
        pir_solid_sum_info info;
        rotation = turned(rotation, i, 8 * atan(1) / steps);
        const double begun = now_ms();
        check(pir_solid_sum_rotate(kept, rotation, PIR_SOLID_UPDATE));
        times->update[i] = now_ms() - begun;
        check(pir_solid_sum_describe(kept, &info));
        times->glued[i] = now_ms() - begun;
        ret_clipped[0] += info.clipped;
        ret_clipped[1] += info.candidates;
    }
    return rotation;
}

/* Makes the sums of the same frames anew. */
static void rebuild(pir_solid_sum *fresh, pir_quat rotation, uint32_t steps, uint32_t first, uint32_t end,
                    struct times *times) {
    for (uint32_t i = first; i < end; i++) {
        rotation = turned(rotation, i, 8 * atan(1) / steps);
        const double begun = now_ms();
        check(pir_solid_sum_rotate(fresh, rotation, PIR_SOLID_REBUILD));
        times->rebuild[i] = now_ms() - begun;
    }
}

static void run(FILE *csv, const struct pair *pair, uint32_t steps) {
    static struct times times;
    const uint32_t frames = results_count(pair->frames);
    pir_solid *p = solid_model_new(pair->p, 1), *q = solid_model_new(pair->q, pair->q_divisor);
    pir_quat rotation = {.3, .1, .2, .9};
    pir_solid_sum *kept, *fresh;
    pir_solid_sum_info info = {0};
    uint64_t clipped[2] = {0};
    size_t bytes = 0;
    const pir_allocator counted = {resize_counted, &bytes};
    pir_solid_sum_options options = pir_solid_sum_options_default();
    options.allocator = &counted;
    check(pir_solid_sum_create(p, q, rotation, &options, &kept));
    const size_t bytes_at_rest = bytes;
    check(pir_solid_sum_create(p, q, rotation, NULL, &fresh));
    check(pir_solid_sum_rotate(kept, rotation, PIR_SOLID_UPDATE));
    for (uint32_t i = 0; i < frames; i += BLOCK) {
        const uint32_t end = i + BLOCK < frames ? i + BLOCK : frames;
        const pir_quat from = rotation;
        rotation = follow(kept, from, steps, i, end, &times, clipped);
        rebuild(fresh, from, steps, i, end, &times);
    }
    check(pir_solid_sum_describe(kept, &info));
    char line[256];
    snprintf(line, sizeof line, "%s,%u,%u,%llu,%u,%.3f,%.3f,%.3f,%.3g,%.3g", pair->name, steps, frames,
             (unsigned long long)info.candidates, info.facets, median(times.update, frames),
             median(times.glued, frames), median(times.rebuild, frames), (double)clipped[0] / (double)clipped[1],
             (double)(bytes - bytes_at_rest) * 1e-3 / (double)info.candidates);
    fprintf(csv, "%s\n", line);
    printf("%s\n", line);
    pir_solid_sum_destroy(kept);
    pir_solid_sum_destroy(fresh);
    pir_solid_release(p);
    pir_solid_release(q);
}

int main(int argc, char **argv) {
    static const struct pair pairs[] = {{"mushroom ⊕ cube", "mushroom", "cube", 1, 200},
                                        {"mushroom ⊕ ball128/10", "mushroom", "ball128", 10, 100},
                                        {"gear8 ⊕ star5", "gear8", "star5", 1, 200},
                                        {"spoon ⊕ spoon", "spoon", "spoon", 1, 40},
                                        {"stella ⊕ ball128", "stella", "ball128", 1, 200}};
    if (argc != 2) {
        fprintf(stderr, "usage: bench_solid_track FOLDER\n");
        return 2;
    }
    const struct results where = results_new(argv[1]);
    FILE *csv = results_open(&where, "solid_track.csv");
    fprintf(csv, "sum,steps,frames,candidates,facets,update_ms,update_glued_ms,rebuild_ms,clipped,kept_kb\n");
    printf("%s\n", where.machine);
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        for (uint32_t steps = 50; steps <= 5000; steps *= 10)
            run(csv, &pairs[i], steps);
    results_close(csv, "solid_track.csv");
    return 0;
}
