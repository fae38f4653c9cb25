/* SPDX-License-Identifier: MIT */
/*
 * track --solid: a sum of solids brought from frame to frame, timed, and on request held against a sum that is made
 * anew at the frame's rotation, decompositions included.
 */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "dump.h"
#include "interrupt.h"
#include "json.h"
#include "message.h"
#include "motion.h"
#include "progress.h"
#include "solid.h"
#include "text.h"
#include "track.h"

#define WARM_UP_MOST 100

struct solid_run {
    const struct track_request *request;
    const pir_solid *p, *q;
    pir_solid_sum_options options, counted; /* of sums made anew; of the one that is followed */
    pir_report fault;
    pir_solid_sum *sum;
    struct motion motion;
    struct dump dump;
    struct progress progress;
    struct times rotate_times, fresh_times;
    struct order rotate, fresh;
    pir_solid_sum_info info; /* of the last frame */
    uint64_t frames, verified, mismatches, first_mismatch, dumped, warm_up, blocks, late_allocations;
    bool interrupted;
    double seconds;
};

/* malloc that counts, for the sum that is followed. */
static void *resize_counted(void *context, void *block, size_t old_size, size_t new_size) {
    (void)old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    ++*(uint64_t *)context;
    return realloc(block, new_size);
}

static bool told(struct solid_run *run, uint64_t frame, pir_status status) {
    char name[48];
    if (status == PIR_OK)
        return true;
    progress_end(&run->progress);
    snprintf(name, sizeof name, "track: frame %" PRIu64, frame);
    complain_status(name, status, run->fault.status == status ? &run->fault : NULL);
    return false;
}

static bool prepare(struct solid_run *run) {
    const struct track_request *request = run->request;
    run->options = pir_solid_sum_options_default();
    run->options.difference = request->difference;
    run->options.open = request->open;
    run->options.report = &run->fault;
    run->counted = run->options;
    run->motion = motion_new(request->random ? NULL : &request->axis, request->steps, request->seed);
    run->warm_up = request->frames / 10 < WARM_UP_MOST ? request->frames / 10 : WARM_UP_MOST;
    if (!times_init(&run->rotate_times, request->frames) || !times_init(&run->fresh_times, request->frames))
        return told(run, 0, PIR_ERR_MEMORY);
    const pir_allocator counting = {.resize = resize_counted, .context = &run->blocks};
    run->counted.allocator = &counting;
    const pir_status status =
        pir_solid_sum_create(run->p, run->q, motion_before(&run->motion), &run->counted, &run->sum);
    run->counted.allocator = NULL;
    return told(run, 0, status);
}

/* Whether a sum made anew has the same mesh. */
static pir_status verify(struct solid_run *run, uint64_t frame, pir_quat rotation) {
    pir_solid_sum *fresh = NULL;
    pir_mesh *tracked = NULL, *made = NULL;
    const int64_t start = clock_now();
    pir_status status = pir_solid_sum_create(run->p, run->q, rotation, &run->options, &fresh);
    times_add(&run->fresh_times, frame, clock_now() - start);
    if (status == PIR_OK)
        status = pir_solid_sum_mesh(fresh, PIR_EXACT, &made);
    if (status == PIR_OK)
        status = pir_solid_sum_mesh(run->sum, PIR_EXACT, &tracked);
    if (status == PIR_OK) {
        run->verified++;
        if (!pir_mesh_equal(tracked, made) && run->mismatches++ == 0)
            run->first_mismatch = frame;
    }
    pir_mesh_destroy(tracked);
    pir_mesh_destroy(made);
    pir_solid_sum_destroy(fresh);
    return status;
}

static bool dump(struct solid_run *run, uint64_t frame) {
    pir_mesh *mesh = NULL;
    bool good = told(run, frame, pir_solid_sum_mesh(run->sum, PIR_EXACT, &mesh));
    progress_end(&run->progress);
    good = good && dump_frame(&run->dump, mesh, pir_solid_sum_rotation(run->sum), frame);
    pir_mesh_destroy(mesh);
    run->dumped += good;
    return good;
}

static bool run_frame(struct solid_run *run, uint64_t frame) {
    const struct track_request *request = run->request;
    const pir_quat rotation = motion_next(&run->motion);
    const uint64_t blocks = run->blocks;
    const int64_t start = clock_now();
    pir_status status = pir_solid_sum_rotate(run->sum, rotation, request->solid_method);
    times_add(&run->rotate_times, frame, clock_now() - start);
    if (frame >= run->warm_up)
        run->late_allocations += run->blocks - blocks;
    if (status == PIR_OK && request->verify_every && frame % request->verify_every == 0)
        status = verify(run, frame, rotation);
    return told(run, frame, status) && (!request->dump || frame % request->dump_every != 0 || dump(run, frame));
}

/* Runs until the last frame, or until a signal asks for an end after the frame that it came in. */
static bool run_frames(struct solid_run *run) {
    bool good = true;
    interrupt_put_off(true);
    run->progress = progress_new(run->request->frames);
    for (run->frames = 0; run->frames < run->request->frames && good && !interrupt_asked();) {
        good = run_frame(run, run->frames);
        run->frames += good;
        progress_show(&run->progress, run->frames);
    }
    run->interrupted = interrupt_asked() && run->frames < run->request->frames;
    progress_end(&run->progress);
    good = good && told(run, run->frames, pir_solid_sum_describe(run->sum, &run->info));
    return good && ((times_order(&run->rotate_times, &run->rotate) && times_order(&run->fresh_times, &run->fresh)) ||
                    told(run, run->frames, PIR_ERR_MEMORY));
}

static bool print_json(const struct solid_run *run) {
    struct json json = json_new();
    track_add_request(&json, run->request, run->frames, run->interrupted);
    json_add_flag(&json, json.root, "solid", true);
    json_add_text(&json, json.root, "method", run->request->method_name);
    json_add_flag(&json, json.root, "open", run->request->open);
    cJSON *update = json_add_object(&json, json.root, "update_ns");
    json_add_number(&json, update, "median", run->rotate.median);
    json_add_number(&json, update, "p99", run->rotate.p99);
    json_add_number(&json, update, "max", run->rotate.max);
    json_add_number(&json, json.root, "create_ns", run->fresh.median);
    json_add_number(&json, json.root, "seconds", run->seconds);
    json_add_count(&json, json.root, "allocations", run->late_allocations);
    json_add_count(&json, json.root, "candidates", run->info.candidates);
    json_add_count(&json, json.root, "facets", run->info.facets);
    json_add_count(&json, json.root, "verified", run->verified);
    json_add_number(&json, json.root, "mismatches", run->request->verify_every ? (double)run->mismatches : NAN);
    if (run->request->dump)
        json_add_count(&json, json.root, "dumped", run->dumped);
    return json_print(&json, stdout);
}

static void print_text(const struct solid_run *run) {
    char median[TEXT_NUMBER], p99[TEXT_NUMBER], max[TEXT_NUMBER], fresh[TEXT_NUMBER];
    track_print_motion(run->request, run->frames, run->interrupted);
    text_time(run->rotate.median, median);
    text_time(run->rotate.p99, p99);
    text_time(run->rotate.max, max);
    say("  %-18s %-10s median; 99 of 100 frames within %s, all within %s\n", "rotation", median, p99, max);
    say("  %-18s %" PRIu64 " candidates, %" PRIu32 " facets at the last frame\n", "sum", run->info.candidates,
        run->info.facets);
    if (run->request->verify_every) {
        text_time(run->fresh.median, fresh);
        say("  %-18s %-10s with the decompositions\n", "made anew", fresh);
        say("  %-18s %" PRIu64 " frames, %" PRIu64 " differ from a sum made anew\n", "verified", run->verified,
            run->mismatches);
    }
    if (run->mismatches)
        say("  %-18s frame %" PRIu64 "\n", "first difference", run->first_mismatch);
    if (run->request->dump)
        say("  %-18s %" PRIu64 " frames in %s\n", "dumped", run->dumped, run->request->dump);
}

static bool run_all(struct solid_run *run) {
    const int64_t start = clock_now();
    if ((run->request->dump && !dump_open(&run->dump, run->request->dump, run->request->dump_exact)) || !prepare(run) ||
        !run_frames(run))
        return false;
    run->seconds = (double)(clock_now() - start) / 1e9;
    return !run->request->dump || dump_commit(&run->dump);
}

int solid_track(const struct args *args, const struct track_request *request) {
    pir_solid *p = solid_load(args, 0), *q = p ? solid_load(args, 1) : NULL;
    struct solid_run run = {.request = request, .p = p, .q = q};
    int result = EXIT_BAD_INPUT;
    if (p && q && run_all(&run)) {
        result = run.mismatches ? EXIT_CHECK_FAILED : EXIT_DONE;
        if (args_has(args, "--json"))
            result = print_json(&run) ? result : EXIT_BAD_INPUT;
        else
            print_text(&run);
    }
    dump_discard(&run.dump);
    times_finish(&run.rotate_times);
    times_finish(&run.fresh_times);
    pir_solid_sum_destroy(run.sum);
    pir_solid_release(q);
    pir_solid_release(p);
    return result;
}
