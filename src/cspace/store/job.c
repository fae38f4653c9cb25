/* SPDX-License-Identifier: MIT */
/*
 * Jobs: threads that make units, one part that they append to, and the file at the end.
 *
 * All that threads share stands behind one lock: which unit is next, the part, what has been done, the first error.
 * A unit is made outside of it. The run ends when no unit is left, when the caller says so, or at the first error; the
 * units that other threads are making then are still appended.
 */
#include <errno.h>
#include <pthread.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <pirouette/cspace.h>

#include "base/options.h"
#include "base/report.h"
#include "cspace/parts/maker.h"
#include "cspace/parts/parts.h"
#include "cspace/store/assemble.h"
#include "cspace/store/job_lock.h"
#include "polytope/file/file_name.h"
#include "polytope/file/target.h"

#define THREADS_MOST 1024u

struct pir_cspace_job {
    pir_allocator allocator;
    pir_cspace_options options;
    pir_plan plan;
    pir_parts parts;
    pir_job_lock lock; /* of the first process of those that share the job */
    char *file;
    size_t file_size;
    uint64_t left; /* units, when it was created */
    uint64_t next; /* unit, where the job deals them itself */
    bool is_made;  /* the file is there: nothing is left to do but to remove parts */
};

uint64_t pir_cspace_job_units(const pir_cspace_job *job) {
    return job ? job->plan.units : 0;
}

uint64_t pir_cspace_job_left(const pir_cspace_job *job) {
    return job ? job->left : 0;
}

void pir_cspace_job_destroy(pir_cspace_job *job) {
    if (!job)
        return;
    const pir_allocator a = job->allocator;
    pir_job_lock_drop(&job->lock, &a);
    pir_parts_finish(&job->parts);
    pir_plan_finish(&job->plan);
    if (job->file)
        PIR_FREE(&a, job->file, job->file_size);
    PIR_FREE(&a, job, 1);
}

/*
 * Follows the links of a path to the file to be made. Refuses the job, before any work, where something stands there
 * that is no regular file or may not be replaced.
 */
static pir_status find_target(const char *path, char ret_target[PIR_PATH_SIZE], pir_report *report) {
    struct stat there;
    if (!pir_follow_links(path, ret_target))
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot write: %s", pir_short_name(path), strerror(errno));
    if (stat(ret_target, &there) != 0)
        return PIR_OK;
    if (!S_ISREG(there.st_mode))
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot write: it is no regular file", pir_short_name(path));
    if (access(ret_target, W_OK) != 0)
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot write: %s", pir_short_name(path), strerror(errno));
    return PIR_OK;
}

/* Takes over what an earlier run has left. */
static pir_status take_over(pir_cspace_job *job, pir_report *report) {
    const bool is_first = job->options.part == 0;
    job->is_made = is_first && pir_assembled(&job->parts);
    if (job->is_made) {
        job->parts.done = job->plan.units;
        job->parts.done_slices = job->plan.pairs * job->plan.slices;
        return PIR_OK;
    }
    pir_status status = pir_parts_scan(&job->parts, report);
    // the first run of this job may have been ended before it could replace an older file: then it has left a part
    if (status == PIR_OK && is_first && job->parts.found == 0 && access(job->file, F_OK) == 0)
        return pir_fail(report, PIR_ERR_FORMAT, "%s: it is of another job; without resuming it is replaced",
                        pir_short_name(job->file));
    return status;
}

static pir_status begin(pir_cspace_job *job, const pir_cspace_bodies *bodies, const pir_grid *grid, const char *path,
                        pir_report *report) {
    char target[PIR_PATH_SIZE];
    pir_status status = find_target(path, target, report);
    if (status == PIR_OK)
        status = pir_plan_init(&job->plan, bodies, grid, &job->options, report);
    if (status != PIR_OK)
        return status;
    job->file_size = strlen(target) + 1;
    job->file = PIR_NEW(&job->allocator, char, job->file_size);
    if (!job->file || !pir_parts_init(&job->parts, &job->plan, job->file))
        return pir_fail(report, PIR_ERR_MEMORY, "slices: out of memory");
    memcpy(job->file, target, job->file_size);
    // a file is that of one job at a time, from before the first look at what stands beside it to the end
    if (job->options.part == 0)
        status = pir_job_lock_take(&job->lock, job->file, &job->allocator, report);
    if (status == PIR_OK && job->options.part == 0)
        status = pir_parts_remove(&job->parts, job->options.resume ? PIR_LEFT_ASSEMBLING : PIR_LEFT_ALL, report);
    return status == PIR_OK && job->options.resume ? take_over(job, report) : status;
}

pir_status pir_cspace_job_create(const pir_cspace_bodies *bodies, const pir_grid *grid, const char *path,
                                 const pir_cspace_options *options, pir_report *report, pir_cspace_job **ret_job) {
    if (!path || !*path || !ret_job)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, or nowhere to put the job");
    if (!PIR_HAVE_HDF5)
        return pir_fail(report, PIR_ERR_NOT_BUILT, "%s: this build has no HDF5", path);
    pir_cspace_options used = pir_cspace_options_default();
    pir_status status = pir_options_take("pir_cspace_options", options, &used, &report);
    if (status != PIR_OK)
        return status;
    if (used.threads == 0 || used.threads > THREADS_MOST)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: threads must be 1 to %u", THREADS_MOST);
    const pir_allocator a = pir_allocator_or_default(used.allocator);
    pir_cspace_job *job = PIR_ZEROED(&a, pir_cspace_job, 1);
    if (!job)
        return pir_fail(report, PIR_ERR_MEMORY, "slices: out of memory");
    job->allocator = a;
    job->options = used;
    status = begin(job, bodies, grid, path, report);
    if (status != PIR_OK) {
        pir_cspace_job_destroy(job);
        return status;
    }
    job->left = job->plan.units - job->parts.done;
    *ret_job = job;
    return PIR_OK;
}

/* --- the run --- */

/* State that the threads of a run share behind the lock; `job->plan` needs none. */
struct run {
    pthread_mutex_t lock;
    pir_cspace_job *job;
    pir_part part;
    uint64_t done, resumed; /* slices */
    struct timespec began;
    pir_status status; /* the first error */
    pir_report report;
    bool stopped;
};

static double seconds_since(const struct timespec *began) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - began->tv_sec) + (double)(now.tv_nsec - began->tv_nsec) / 1e9;
}

static void tell_progress(struct run *run) {
    const pir_cspace_options *options = &run->job->options;
    const pir_plan *plan = &run->job->plan;
    const pir_cspace_progress progress = {run->done, plan->pairs * plan->slices, run->resumed,
                                          seconds_since(&run->began)};
    if (options->progress && !options->progress(options->context, &progress))
        run->stopped = true;
}

/* The next unit that no part has; the count of units where there is none, or the run is to end. */
static uint64_t claim(struct run *run) {
    pir_cspace_job *job = run->job;
    while (!run->stopped) {
        uint64_t unit = job->options.claim ? job->options.claim(job->options.context) : job->next;
        if (unit >= job->plan.units)
            break;
        job->next += !job->options.claim;
        if (job->parts.unit[unit].part == 0)
            return unit;
    }
    return job->plan.units;
}

static void fail(struct run *run, pir_status status, const pir_report *report) {
    if (run->status == PIR_OK) {
        run->status = status;
        run->report = *report;
    }
    run->stopped = true;
}

/* Appends a unit to the part, and notes where it stands. */
static pir_status append(struct run *run, const pir_unit *unit, pir_report *report) {
    const uint64_t at = run->part.end;
    pir_status status = pir_part_append(&run->part, unit, report);
    if (status != PIR_OK)
        return status;
    pir_parts_note(&run->job->parts, unit, run->job->options.part, at);
    run->done += unit->slices;
    return PIR_OK;
}

static void *work(void *context) {
    struct run *run = context;
    const pir_plan *plan = &run->job->plan;
    pir_report report = {0};
    pir_maker maker;
    pir_status status = PIR_OK;
    if (!pir_maker_init(&maker, plan))
        status = pir_fail(&report, PIR_ERR_MEMORY, "slices: out of memory");
    pthread_mutex_lock(&run->lock);
    for (uint64_t unit; status == PIR_OK && (unit = claim(run)) < plan->units;) {
        pthread_mutex_unlock(&run->lock);
        status = pir_maker_make(&maker, unit, UINT32_MAX);
        if (status == PIR_OK && !pir_unit_pack(&maker.unit, maker.packer, &plan->allocator))
            status = PIR_ERR_MEMORY;
        if (status != PIR_OK)
            pir_fail(&report, status, "slices: unit %llu: %s", (unsigned long long)unit, pir_status_text(status));
        pthread_mutex_lock(&run->lock);
        if (status == PIR_OK)
            status = append(run, &maker.unit, &report);
        tell_progress(run);
    }
    if (status != PIR_OK)
        fail(run, status, &report);
    pthread_mutex_unlock(&run->lock);
    pir_maker_finish(&maker);
    return NULL;
}

/* Starts the other threads, works along, and waits for them. Fewer threads than asked for do the same. */
static void run_threads(struct run *run) {
    uint32_t others = run->job->options.threads - 1, started = 0;
    pthread_t thread[THREADS_MOST];
    while (started < others && pthread_create(&thread[started], NULL, work, run) == 0)
        started++;
    work(run);
    for (uint32_t i = 0; i < started; i++)
        pthread_join(thread[i], NULL);
}

pir_status pir_cspace_job_run(pir_cspace_job *job, pir_report *report) {
    if (!job)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no job");
    struct run run = {.job = job, .done = job->parts.done_slices, .resumed = job->parts.done_slices};
    clock_gettime(CLOCK_MONOTONIC, &run.began);
    tell_progress(&run);
    if (job->is_made)
        return PIR_OK;
    pir_status status = pir_part_open(&run.part, &job->parts, job->options.part, report);
    if (status == PIR_OK && pthread_mutex_init(&run.lock, NULL) != 0)
        status = pir_fail(report, PIR_ERR_MEMORY, "slices: out of memory");
    if (status == PIR_OK) {
        job->next = 0;
        run_threads(&run);
        pthread_mutex_destroy(&run.lock);
        status = run.status == PIR_OK ? PIR_OK : pir_fail(report, run.status, "%s", run.report.text);
    }
    pir_status closed = pir_part_close(&run.part, &job->allocator, status == PIR_OK ? report : NULL);
    return status == PIR_OK ? closed : status;
}

pir_status pir_cspace_job_assemble(pir_cspace_job *job, pir_report *report) {
    if (!job)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no job");
    if (job->is_made)
        return pir_parts_remove(&job->parts, PIR_LEFT_ALL, report);
    // other processes may have made what this one has not
    pir_status status = job->parts.done < job->plan.units ? pir_parts_scan(&job->parts, report) : PIR_OK;
    if (status == PIR_OK && job->parts.done < job->plan.units)
        status =
            pir_fail(report, PIR_ERR_EMPTY, "%s: %llu of %llu units are still to be made", pir_short_name(job->file),
                     (unsigned long long)(job->plan.units - job->parts.done), (unsigned long long)job->plan.units);
    if (status == PIR_OK)
        status = pir_assemble(&job->parts, &job->options, report);
    if (status == PIR_OK)
        status = pir_parts_remove(&job->parts, PIR_LEFT_ALL, report);
    return status;
}
