/* SPDX-License-Identifier: MIT */
/* pirouette slice: the differences of a robot's and obstacles' pieces at every rotation of a grid, into one file. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "args.h"
#include "cmd.h"
#include "critical.h"
#include "file.h"
#include "interrupt.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "pieces.h"
#include "pose.h"
#include "progress.h"
#include "ranks/ranks.h"
#include "text.h"
#include "views/planar_file.h"

#define DEGREES (180 / 3.14159265358979323846)

static const char *const grid_names[] = {"axis", "hopf", "list"};

/* The objects of a run, and how far it is. */
struct slicing {
    const struct args *args;
    struct pieces robot, obstacles;
    pir_grid *grid;
    pir_cspace_options options;
    struct ranks ranks;
    struct planar planar; /* sections that the file gets as well */
    struct progress bar;
    pir_cspace_progress progress; /* the last one told */
    bool has_bar;
    bool has_sections, told; /* whether sections have been written, and why not has been said */
};

/* --- what is asked for --- */

/* The grid: one of three ways to name it. */
static bool read_grid(const struct args *args, pir_grid **ret_grid) {
    static const char *const names[] = {"hopf", NULL};
    bool axis = args_has(args, "--axis"), named = args_has(args, "--grid"), file = args_has(args, "--rotations");
    if (axis + named + file != 1) {
        complain("slice: give one grid: --axis x,y,z --steps N, --grid hopf --level L, or --rotations FILE");
        return false;
    }
    if (axis != args_has(args, "--steps") || named != args_has(args, "--level")) {
        complain("slice: --axis needs --steps N beside it, --grid needs --level L, and neither goes with the other");
        return false;
    }
    pir_vec3 about = {0, 0, 1};
    uint64_t steps = 0, level = 0;
    int name = 0;
    if ((axis && !axis_read(args, "--axis", &about)) || !args_choice(args, "--grid", names, &name) ||
        !args_count(args, "--steps", 1, PIR_GRID_STEPS_MAX, &steps) ||
        !args_count(args, "--level", 0, PIR_GRID_LEVEL_MAX, &level))
        return false;
    pir_report report = {0};
    const char *where = axis ? "--axis" : named ? "--grid" : args_value(args, "--rotations");
    pir_status status = axis    ? pir_grid_axis(about, steps, NULL, ret_grid)
                        : named ? pir_grid_hopf((uint32_t)level, NULL, ret_grid)
                                : pir_grid_read(where, NULL, &report, ret_grid);
    if (status != PIR_OK)
        complain_status(where, status, &report);
    return status == PIR_OK;
}

/* The file that is made. */
static bool check_file(const struct args *args) {
    const char *path = args_value(args, "-o");
    if (args_has(args, "--dry-run"))
        return true;
    if (path && (output_ends_in(path, ".h5") || output_ends_in(path, ".hdf5")))
        return true;
    if (path)
        complain("slice: -o: '%s' ends in neither .h5 nor .hdf5", path);
    else
        complain("slice: -o FILE.h5 is missing; see pirouette slice --help");
    return false;
}

static uint64_t on_claim(void *context) {
    return ranks_next(&((struct slicing *)context)->ranks);
}

static bool on_progress(void *context, const pir_cspace_progress *progress) {
    struct slicing *run = context;
    if (run->ranks.number > 0)
        return !interrupt_asked();
    if (!run->has_bar) {
        run->bar = progress_new(progress->total - progress->resumed);
        run->has_bar = true;
    }
    run->progress = *progress;
    progress_show(&run->bar, progress->done - progress->resumed);
    return !interrupt_asked();
}

/* Adds the sections, where they were asked for, to the file at a path. */
static bool add_sections(void *context, const char *path) {
    struct slicing *run = context;
#if PIR_HAVE_HDF5
    run->has_sections = !run->planar.given || planar_file_write(path, args_value(run->args, "-o"), &run->planar);
#else
    (void)path;
    run->has_sections = !run->planar.given;
#endif
    run->told = !run->has_sections;
    return run->has_sections;
}

static bool read_request(const struct args *args, struct slicing *run) {
    uint64_t threads = 1, per_unit = 0;
    run->options = pir_cspace_options_default();
    if (!check_file(args) || !args_count(args, "--threads", 1, 1024, &threads) ||
        !args_count(args, "--slices-per-unit", 1, PIR_CSPACE_UNIT_MAX, &per_unit) || !read_grid(args, &run->grid) ||
        !pieces_load(args, 0, &run->robot))
        return false;
    for (size_t i = 1; i < args->positional_count; i++)
        if (!pieces_load(args, i, &run->obstacles))
            return false;
    run->options.threads = (uint32_t)threads;
    run->options.slices_per_unit = (uint32_t)per_unit;
    run->options.resume = args_has(args, "--resume");
    run->options.planes = args_has(args, "--planes");
    run->options.vertices = args_has(args, "--vertices");
    run->options.progress = on_progress;
    run->options.complete = add_sections;
    run->options.context = run;
    run->options.part = run->ranks.number;
    run->options.claim = run->ranks.count > 1 ? on_claim : NULL;
    return planar_read(args, &run->planar);
}

static pir_cspace_bodies bodies_of(const struct slicing *run) {
    return (pir_cspace_bodies){run->robot.at, run->robot.count, run->obstacles.at, run->obstacles.count};
}

/* --- what is told --- */

static void add_common(struct json *json, const struct slicing *run) {
    pir_grid_info info = pir_grid_get_info(run->grid);
    pir_grid_turns turns = pir_grid_get_turns(run->grid);
    json_add_text(json, json->root, "robot", run->args->positional[0]);
    json_add_count(json, json->root, "robot_pieces", run->robot.count);
    json_add_count(json, json->root, "obstacle_pieces", run->obstacles.count);
    json_add_text(json, json->root, "grid", grid_names[info.kind]);
    json_add_count(json, json->root, "rotations", info.count);
    json_add_number(json, json->root, "spacing", info.spacing);
    json_add_number(json, json->root, "turn_mean", turns.mean);
    json_add_number(json, json->root, "turn_most", turns.most);
}

static void print_common(const struct slicing *run) {
    pir_grid_info info = pir_grid_get_info(run->grid);
    pir_grid_turns turns = pir_grid_get_turns(run->grid);
    say("slices of %s, %" PRIu32 " by %" PRIu32 " pieces\n", run->args->positional[0], run->robot.count,
        run->obstacles.count);
    say("  %-10s %s, %" PRIu64 " rotations, %.3g degrees apart\n", "grid", grid_names[info.kind], info.count,
        info.spacing * DEGREES);
    say("  %-10s mean %.3g degrees, most %.3g\n", "turns", turns.mean * DEGREES, turns.most * DEGREES);
}

static int foresee(struct slicing *run) {
    pir_report report = {0};
    pir_cspace_estimate estimate;
    const pir_cspace_bodies bodies = bodies_of(run);
    pir_status status = pir_cspace_get_estimate(&bodies, run->grid, &run->options, &report, &estimate);
    if (status != PIR_OK)
        return complain_status("slice", status, &report);
    double seconds = estimate.seconds / run->options.threads;
    if (args_has(run->args, "--json")) {
        struct json json = json_new();
        add_common(&json, run);
        json_add_count(&json, json.root, "slices", estimate.slices);
        json_add_count(&json, json.root, "units", estimate.units);
        json_add_number(&json, json.root, "seconds", seconds);
        json_add_number(&json, json.root, "bytes", estimate.bytes);
        return json_print(&json, stdout) ? EXIT_DONE : EXIT_BAD_INPUT;
    }
    char time[TEXT_NUMBER];
    text_time(seconds * 1e9, time);
    print_common(run);
    say("  %-10s %" PRIu64 " in %" PRIu64 " units\n", "slices", estimate.slices, estimate.units);
    say("  %-10s about %s with %" PRIu32 " thread%s\n", "time", time, run->options.threads,
        run->options.threads == 1 ? "" : "s");
    say("  %-10s about %.3g MB\n", "size", estimate.bytes / 1e6);
    return EXIT_DONE;
}

static int report_done(const struct slicing *run, double seconds) {
    const char *path = args_value(run->args, "-o");
    struct stat file = {0};
    uint64_t slices = (uint64_t)run->robot.count * run->obstacles.count * pir_grid_get_info(run->grid).count;
    uint64_t resumed = run->progress.resumed;
    double bytes = stat(path, &file) == 0 ? (double)file.st_size : 0;
    if (args_has(run->args, "--json")) {
        struct json json = json_new();
        add_common(&json, run);
        json_add_count(&json, json.root, "slices", slices);
        json_add_count(&json, json.root, "resumed", resumed);
        json_add_number(&json, json.root, "seconds", seconds);
        json_add_number(&json, json.root, "bytes", bytes);
        json_add_text(&json, json.root, "file", path);
        return json_print(&json, stdout) ? EXIT_DONE : EXIT_BAD_INPUT;
    }
    char time[TEXT_NUMBER];
    text_time(seconds * 1e9, time);
    print_common(run);
    say("  %-10s %" PRIu64 ", %" PRIu64 " of them from an earlier run\n", "slices", slices, resumed);
    say("  %-10s %s, %.3g slices a second\n", "time", time, (double)(slices - resumed) / seconds);
    say("  %-10s %s, %.3g MB, %.3g bytes a slice\n", "file", path, bytes / 1e6, bytes / (double)slices);
    return EXIT_DONE;
}

/* --- the run --- */

/* The job, of all ranks: the first may remove what an earlier run left, then others join. NULL after a complaint. */
static pir_cspace_job *create_job(struct slicing *run) {
    pir_report report = {0};
    pir_cspace_job *job = NULL;
    const pir_cspace_bodies bodies = bodies_of(run);
    const char *path = args_value(run->args, "-o");
    for (int turn = 0; turn < 2; turn++) {
        pir_status status = PIR_OK;
        if (run->ranks.number > 0)
            run->options.resume = true;
        if ((run->ranks.number > 0) == (turn > 0))
            status = pir_cspace_job_create(&bodies, run->grid, path, &run->options, &report, &job);
        if (ranks_agree(&run->ranks, status == PIR_OK))
            continue;
        if (status != PIR_OK)
            complain_status("slice", status, &report);
        pir_cspace_job_destroy(job);
        return NULL;
    }
    return job;
}

/* Runs the job to its end, or to that of the run. False after a complaint. */
static bool run_job(struct slicing *run, pir_cspace_job *job) {
    pir_report report = {0};
    // rank 0 alone knows whether a file that is complete leaves nothing to share
    bool shared = ranks_agree(&run->ranks, run->ranks.number > 0 || pir_cspace_job_left(job) > 0);
    pir_status status = PIR_OK;
    if (shared)
        status = ranks_run(&run->ranks, job, (uint64_t)run->robot.count * run->obstacles.count, &report);
    else if (run->ranks.number == 0)
        status = pir_cspace_job_run(job, &report);
    progress_end(&run->bar);
    if (status == PIR_OK && interrupt_asked()) {
        complain("slice: ended after %" PRIu64 " of %" PRIu64 " slices, which are kept; --resume goes on",
                 run->progress.done, run->progress.total);
        return false;
    }
    if (status == PIR_OK && run->ranks.number == 0)
        status = pir_cspace_job_assemble(job, &report);
    if (status != PIR_OK && !run->told)
        complain_status("slice", status, &report);
    return status == PIR_OK;
}

/* A signal is put off from before the job has its lock until it has none, so that it leaves no file that is no part. */
static int make_slices(struct slicing *run) {
    int64_t start = clock_now();
    interrupt_put_off(true);
    pir_cspace_job *job = create_job(run);
    bool done = job && run_job(run, job) &&
                (run->ranks.number > 0 || run->has_sections || add_sections(run, args_value(run->args, "-o")));
    pir_cspace_job_destroy(job);
    interrupt_put_off(false);
    if (done && run->ranks.number == 0)
        return report_done(run, (double)(clock_now() - start) / 1e9);
    return done ? EXIT_DONE : EXIT_BAD_INPUT;
}

SUBCOMMAND(slice) {
    struct slicing run = {.args = args};
    int result = EXIT_BAD_INPUT;
    if (args_has(args, "--critical") || args_has(args, "--quat"))
        return critical_slice(args);
    if (!ranks_begin(&run.ranks))
        return EXIT_BAD_INPUT;
    bool good = read_request(args, &run);
    if (!ranks_agree(&run.ranks, good))
        result = EXIT_BAD_INPUT;
    else if (args_has(args, "--dry-run"))
        result = run.ranks.number == 0 ? foresee(&run) : EXIT_DONE;
    else
        result = make_slices(&run);
    ranks_end(&run.ranks);
    pir_grid_destroy(run.grid);
    pieces_release(&run.obstacles);
    pieces_release(&run.robot);
    return result;
}
