/* SPDX-License-Identifier: MIT */
/*
 * The run. Up to four sums of the same polytopes go through the same rotations: the tracked one; one that is rebuilt
 * by walk, on the frames where that is timed or compared; one rebuilt by CGM and one re-checked by brute force, on a
 * few frames. A region is kept by the first two; the others are whole. Each timed call stands alone between two
 * readings of the clock. All are timed in turn in one run, so that what else the machine does falls on all alike.
 */
#include "track.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/baseline.h>

#include "dump.h"
#include "interrupt.h"
#include "message.h"
#include "motion.h"
#include "progress.h"

/* Frames on which a rebuild and a brute-force re-check are timed, or up to twice as many; all when there are fewer. */
#define WALK_SAMPLES  200
#define CGM_SAMPLES   20
#define BRUTE_SAMPLES 20

#define WARM_UP_MOST 100

struct run {
    const struct track_request *request;
    struct track_result *result;
    pir_sum *tracked, *rebuilt, *overlaid, *brute;
    struct motion motion;
    struct dump dump;
    struct progress progress;
    uint64_t walk_stride, cgm_stride, brute_stride;
    uint64_t blocks; /* that the tracked sum has asked for */
};

/* malloc that counts, for the tracked sum. */
static void *resize_counted(void *context, void *block, size_t old_size, size_t new_size) {
    (void)old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    ++*(uint64_t *)context;
    return realloc(block, new_size);
}

static uint64_t stride(uint64_t frames, uint64_t samples) {
    return frames > samples ? frames / samples : 1;
}

static bool told(uint64_t frame, pir_status status) {
    if (status == PIR_OK)
        return true;
    complain("track: frame %" PRIu64 ": %s", frame, pir_status_text(status));
    return false;
}

static pir_status set_region(const struct run *run, pir_sum *sum) {
    const double radians = 3.14159265358979323846 / 180, whole = 4;
    double degrees = run->request->region_degrees;
    return pir_sum_set_region(sum, run->request->region, degrees < 180 ? degrees * radians : whole);
}

/* Sums at the rotation before the first frame, and room for the times. */
static bool prepare(struct run *run, pir_polytope *p, pir_polytope *q) {
    const struct track_request *request = run->request;
    struct track_result *result = run->result;
    struct times *const times[] = {&result->update_times, &result->walk_times, &result->cgm_times,
                                   &result->brute_times};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++)
        if (!times_init(times[i], request->frames))
            return told(0, PIR_ERR_MEMORY);

    run->motion = motion_new(request->random ? NULL : &request->axis, request->steps, request->seed);
    run->walk_stride = stride(request->frames, WALK_SAMPLES);
    run->cgm_stride = stride(request->frames, CGM_SAMPLES);
    run->brute_stride = stride(request->frames, BRUTE_SAMPLES);
    result->warm_up = request->frames / 10 < WARM_UP_MOST ? request->frames / 10 : WARM_UP_MOST;

    pir_quat before = motion_before(&run->motion);
    pir_sum_options plain = pir_sum_options_default();
    plain.difference = request->difference;
    pir_sum_options counted = plain;
    counted.allocator = &(pir_allocator){.resize = resize_counted, .context = &run->blocks};
    pir_status status = pir_sum_create(p, q, before, &counted, &run->tracked);
    if (status == PIR_OK)
        status = pir_sum_set_tolerance(run->tracked, request->tolerance);
    if (status == PIR_OK)
        status = set_region(run, run->tracked);
    if (status == PIR_OK)
        status = pir_sum_create(p, q, before, &plain, &run->rebuilt);
    if (status == PIR_OK)
        status = set_region(run, run->rebuilt);
    if (status == PIR_OK)
        status = pir_sum_create(p, q, before, &plain, &run->overlaid);
    if (status == PIR_OK && request->brute)
        status = pir_sum_create(p, q, before, &plain, &run->brute);
    return told(0, status);
}

static pir_status rotate_timed(pir_sum *sum, pir_quat rotation, pir_method method, struct times *times,
                               uint64_t frame) {
    int64_t start = clock_now();
    pir_status status = pir_sum_rotate(sum, rotation, method);
    times_add(times, frame, clock_now() - start);
    return status;
}

static pir_status brute_timed(pir_sum *sum, pir_quat rotation, struct times *times, uint64_t frame) {
    int64_t start = clock_now();
    pir_status status = pir_sum_rotate_brute_force(sum, rotation);
    times_add(times, frame, clock_now() - start);
    return status;
}

/* Whether a tolerance has let the tracked pairing stay behind. */
static bool is_behind(const struct run *run) {
    pir_quat asked = pir_sum_rotation(run->tracked), exact = pir_sum_pairing_rotation(run->tracked);
    return memcmp(&asked, &exact, sizeof asked) != 0;
}

/*
 * Whether the tracked and the rebuilt sum are the same, as pairings and as meshes. A pairing that stayed behind is
 * that of another rotation: the rebuilt sum goes there. Of a region there is no mesh.
 */
static pir_status compare(const struct run *run, bool *ret_same) {
    if (is_behind(run)) {
        pir_status status = pir_sum_rotate(run->rebuilt, pir_sum_pairing_rotation(run->tracked), PIR_METHOD_WALK);
        if (status == PIR_OK)
            *ret_same = pir_sum_same_pairing(run->tracked, run->rebuilt);
        return status;
    }
    if (run->request->region_degrees < 180) {
        *ret_same = pir_sum_same_pairing(run->tracked, run->rebuilt);
        return PIR_OK;
    }
    pir_mesh *tracked = NULL, *rebuilt = NULL;
    pir_status status = pir_sum_mesh(run->tracked, PIR_DOUBLE, &tracked);
    if (status == PIR_OK)
        status = pir_sum_mesh(run->rebuilt, PIR_DOUBLE, &rebuilt);
    if (status == PIR_OK)
        *ret_same = pir_sum_same_pairing(run->tracked, run->rebuilt) && pir_mesh_equal(tracked, rebuilt);
    pir_mesh_destroy(tracked);
    pir_mesh_destroy(rebuilt);
    return status;
}

/* Whether a third sum is rebuilt by CGM in this frame. */
static bool is_overlaid(const struct run *run, uint64_t frame) {
    return frame % run->cgm_stride == 0;
}

static pir_status verify(struct run *run, uint64_t frame) {
    struct track_result *result = run->result;
    bool same;
    pir_status status = compare(run, &same);
    if (status != PIR_OK)
        return status;
    if (is_overlaid(run, frame) && !is_behind(run))
        same = same && pir_sum_same_pairing(run->tracked, run->overlaid);
    result->verified++;
    if (!same && result->mismatches++ == 0)
        result->first_mismatch = frame;
    return PIR_OK;
}

/* Adds what the tracked sum did between two looks at its counters. */
static void add_work(pir_sum_statistics *did, const pir_sum_statistics *before, const pir_sum_statistics *after) {
    did->updates += after->updates - before->updates;
    did->rebuilds += after->rebuilds - before->rebuilds;
    did->kept += after->kept - before->kept;
    did->checked += after->checked - before->checked;
    did->repaired += after->repaired - before->repaired;
    did->by_filter += after->by_filter - before->by_filter;
    did->by_exact += after->by_exact - before->by_exact;
    did->by_perturbation += after->by_perturbation - before->by_perturbation;
    did->allocations += after->allocations - before->allocations;
}

/*
 * The rotation that all is about. Its work is counted by itself: comparing and writing meshes ask for signs and
 * memory, too.
 */
static pir_status rotate_tracked(struct run *run, uint64_t frame, pir_quat rotation) {
    struct track_result *result = run->result;
    uint64_t blocks = run->blocks;
    pir_sum_statistics before = pir_sum_get_statistics(run->tracked);
    pir_status status = rotate_timed(run->tracked, rotation, run->request->method, &result->update_times, frame);
    pir_sum_statistics after = pir_sum_get_statistics(run->tracked);
    add_work(&result->did, &before, &after);
    result->shortfall = fmax(result->shortfall, pir_sum_shortfall_bound(run->tracked));
    if (frame >= result->warm_up)
        result->late_allocations += run->blocks - blocks;
    return status;
}

static bool is_verified(const struct run *run, uint64_t frame) {
    return run->request->verify_every && frame % run->request->verify_every == 0;
}

/* Whether the second sum is rebuilt, and timed, in this frame. */
static bool is_rebuilt(const struct run *run, uint64_t frame) {
    return frame % run->walk_stride == 0 || is_verified(run, frame);
}

/*
 * All sums of one frame. The rebuild comes before the tracked sum, after which the processor would know the way, and
 * after a rebuild of the frame before, as it would if every frame were rebuilt.
 */
static pir_status rotate_all(struct run *run, uint64_t frame, pir_quat rotation) {
    struct track_result *result = run->result;
    pir_status status = PIR_OK;
    if (is_rebuilt(run, frame))
        status = rotate_timed(run->rebuilt, rotation, PIR_METHOD_WALK, &result->walk_times, frame);
    if (status == PIR_OK)
        status = rotate_tracked(run, frame, rotation);
    if (status == PIR_OK && is_overlaid(run, frame))
        status = rotate_timed(run->overlaid, rotation, PIR_METHOD_CGM, &result->cgm_times, frame);
    if (status == PIR_OK && run->brute && frame % run->brute_stride == 0)
        status = brute_timed(run->brute, rotation, &result->brute_times, frame);
    if (status == PIR_OK && is_verified(run, frame))
        status = verify(run, frame);
    if (status == PIR_OK && !is_rebuilt(run, frame) && is_rebuilt(run, frame + 1))
        status = pir_sum_rotate(run->rebuilt, rotation, PIR_METHOD_WALK);
    return status;
}

static bool dump_sum(struct run *run, uint64_t frame) {
    pir_mesh *mesh = NULL;
    const bool good = told(frame, pir_sum_mesh(run->tracked, PIR_EXACT, &mesh)) &&
                      dump_frame(&run->dump, mesh, pir_sum_rotation(run->tracked), frame);
    pir_mesh_destroy(mesh);
    return good;
}

static bool run_frame(struct run *run, uint64_t frame) {
    const struct track_request *request = run->request;
    pir_status status = rotate_all(run, frame, motion_next(&run->motion));
    bool dumped = status == PIR_OK && request->dump && frame % request->dump_every == 0;
    // nothing may complain behind the bar
    if (status != PIR_OK || dumped)
        progress_end(&run->progress);
    run->result->dumped += dumped;
    return told(frame, status) && (!dumped || dump_sum(run, frame));
}

/* Runs until the last frame, or until a signal asks for an end after the frame that it came in. */
static bool run_frames(struct run *run) {
    struct track_result *result = run->result;
    run->progress = progress_new(run->request->frames);
    bool good = true;
    interrupt_put_off(true);
    do {
        progress_show(&run->progress, result->frames);
        good = run_frame(run, result->frames++);
    } while (result->frames < run->request->frames && good && !interrupt_asked());
    interrupt_put_off(false);
    result->interrupted = interrupt_asked() && result->frames < run->request->frames;
    progress_end(&run->progress);
    return good;
}

static bool summarise(struct track_result *result, uint64_t frames) {
    return (times_order(&result->update_times, &result->update) && times_order(&result->walk_times, &result->walk) &&
            times_order(&result->cgm_times, &result->cgm) && times_order(&result->brute_times, &result->brute)) ||
           told(frames, PIR_ERR_MEMORY);
}

bool track_run(const struct track_request *request, pir_polytope *p, pir_polytope *q, struct track_result *result) {
    *result = (struct track_result){0};
    struct run run = {.request = request, .result = result};
    struct output_file plot = {0};
    int64_t start = clock_now();
    bool good = false;

    // whatever cannot be written is known before the run
    if (request->plot && !output_open(&plot, request->plot))
        goto done;
    if (request->dump && !dump_open(&run.dump, request->dump, request->dump_exact))
        goto done;
    if (!prepare(&run, p, q))
        goto done;

    if (!run_frames(&run) || !summarise(result, request->frames))
        goto done;
    result->seconds = (double)(clock_now() - start) / 1e9;
    if (request->dump && !dump_commit(&run.dump))
        goto done;
    if (request->plot && !(track_plot(request, result, plot.stream) && output_commit(&plot)))
        goto done;
    good = true;

done:
    dump_discard(&run.dump);
    output_discard(&plot);
    pir_sum_destroy(run.brute);
    pir_sum_destroy(run.overlaid);
    pir_sum_destroy(run.rebuilt);
    pir_sum_destroy(run.tracked);
    return good;
}

void track_finish(struct track_result *result) {
    times_finish(&result->update_times);
    times_finish(&result->walk_times);
    times_finish(&result->cgm_times);
    times_finish(&result->brute_times);
}
