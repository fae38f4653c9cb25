/* SPDX-License-Identifier: MIT */
/* The report of a tracked run: as JSON, as text, as a chart. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "json.h"
#include "message.h"
#include "model.h"
#include "motion.h"
#include "plot.h"
#include "surface.h"
#include "text.h"
#include "track.h"

/* NaN where one of them is missing. */
static double ratio(double a, double b) {
    return b > 0 ? a / b : NAN;
}

static double asked(const pir_sum_statistics *did) {
    return (double)(did->by_filter + did->by_exact + did->by_perturbation);
}

/* --- JSON --- */

void track_add_request(struct json *json, const struct track_request *request, uint64_t frames, bool interrupted) {
    json_add_text(json, json->root, "p", request->p);
    json_add_text(json, json->root, "q", request->q);
    json_add_count(json, json->root, "frames", frames);
    json_add_count(json, json->root, "steps", request->steps);
    if (request->random)
        json_add_text(json, json->root, "axis", "random");
    else
        json_add_numbers(json, json->root, "axis", (const double[]){request->axis.x, request->axis.y, request->axis.z},
                         3);
    json_add_count(json, json->root, "seed", request->seed);
    json_add_flag(json, json->root, "difference", request->difference);
    json_add_flag(json, json->root, "interrupted", interrupted);
}

static void add_times(struct json *json, const struct track_result *result) {
    cJSON *update = json_add_object(json, json->root, "update_ns");
    json_add_number(json, update, "median", result->update.median);
    json_add_number(json, update, "p99", result->update.p99);
    json_add_number(json, update, "max", result->update.max);
    json_add_number(json, json->root, "rebuild_walk_ns", result->walk.median);
    json_add_number(json, json->root, "rebuild_cgm_ns", result->cgm.median);
    json_add_number(json, json->root, "speedup_walk", ratio(result->walk.median, result->update.median));
    json_add_number(json, json->root, "speedup_cgm", ratio(result->cgm.median, result->update.median));
    json_add_number(json, json->root, "brute_ns", result->brute.median);
    json_add_number(json, json->root, "seconds", result->seconds);
}

static void add_work(struct json *json, const struct track_result *result) {
    const pir_sum_statistics *did = &result->did;
    const double frames = (double)result->frames;
    json_add_number(json, json->root, "checked_per_frame", ratio((double)did->checked, frames));
    json_add_number(json, json->root, "repaired_per_frame", ratio((double)did->repaired, frames));
    json_add_count(json, json->root, "updates", did->updates);
    json_add_count(json, json->root, "rebuilds", did->rebuilds);
    json_add_count(json, json->root, "allocations", result->late_allocations);
    cJSON *signs = json_add_object(json, json->root, "signs");
    json_add_number(json, signs, "asked", asked(did));
    json_add_number(json, signs, "filter", ratio((double)did->by_filter, asked(did)));
    json_add_number(json, signs, "exact", ratio((double)did->by_exact, asked(did)));
    json_add_number(json, signs, "perturbation", ratio((double)did->by_perturbation, asked(did)));
}

bool track_print_json(const struct track_request *request, const struct track_result *result) {
    struct json json = json_new();
    track_add_request(&json, request, result->frames, result->interrupted);
    surface_add_inputs(&json, request->surfaces, 2);
    json_add_text(&json, json.root, "method", request->method_name);
    add_times(&json, result);
    add_work(&json, result);
    if (request->region_degrees < 180) {
        json_add_numbers(&json, json.root, "region",
                         (const double[]){request->region.x, request->region.y, request->region.z}, 3);
        json_add_number(&json, json.root, "region_degrees", request->region_degrees);
    }
    if (request->tolerance > 0) {
        json_add_number(&json, json.root, "tolerance", request->tolerance);
        json_add_number(&json, json.root, "shortfall", result->shortfall);
        json_add_count(&json, json.root, "kept", result->did.kept);
    }
    json_add_count(&json, json.root, "verified", result->verified);
    json_add_number(&json, json.root, "mismatches", request->verify_every ? (double)result->mismatches : NAN);
    if (request->dump)
        json_add_count(&json, json.root, "dumped", result->dumped);
    return json_print(&json, stdout);
}

/* --- text --- */

void track_print_motion(const struct track_request *request, uint64_t frames, bool interrupted) {
    say("%s turns against %s: %" PRIu64 " frames, %" PRIu64 " steps to a turn, ", request->p, request->q, frames,
        request->steps);
    if (request->random)
        say("random axes from seed %" PRIu64, request->seed);
    else
        say("axis %g,%g,%g", request->axis.x, request->axis.y, request->axis.z);
    if (request->method_name)
        say(", method %s", request->method_name);
    say("%s%s\n", request->difference ? ", difference" : "", request->open ? ", open" : "");
    if (interrupted)
        say("  interrupted, %" PRIu64 " frames were asked for\n", request->frames);
}

static void print_slower(const char *name, double time_ns, double update_ns) {
    char time[TEXT_NUMBER];
    text_time(time_ns, time);
    say("  %-18s %-10s %.3g times as long as an update\n", name, time, ratio(time_ns, update_ns));
}

static void print_times(const struct track_request *request, const struct track_result *result) {
    char median[TEXT_NUMBER], p99[TEXT_NUMBER], max[TEXT_NUMBER];
    text_time(result->update.median, median);
    text_time(result->update.p99, p99);
    text_time(result->update.max, max);
    say("  %-18s %-10s median; 99 of 100 frames within %s, all within %s\n", "update", median, p99, max);
    print_slower("rebuild by walk", result->walk.median, result->update.median);
    print_slower("rebuild by CGM", result->cgm.median, result->update.median);
    if (request->brute)
        print_slower("brute force", result->brute.median, result->update.median);
}

static void print_work(const struct track_result *result) {
    const pir_sum_statistics *did = &result->did;
    double frames = (double)result->frames, signs = asked(did);
    say("  %-18s %.4g a frame\n", "pairs checked", (double)did->checked / frames);
    say("  %-18s %.4g a frame\n", "pairs repaired", (double)did->repaired / frames);
    say("  %-18s %" PRIu64 " of %" PRIu64 " frames\n", "rebuilds", did->rebuilds, result->frames);
    say("  %-18s %" PRIu64 " after the first %" PRIu64 " frames\n", "allocations", result->late_allocations,
        result->warm_up);
    if (signs > 0)
        say("  %-18s %.4g a frame: %.3f %% by filter, %.3f %% by exact arithmetic, %.3f %% ties\n", "signs",
            signs / frames, 100 * (double)did->by_filter / signs, 100 * (double)did->by_exact / signs,
            100 * (double)did->by_perturbation / signs);
}

void track_print_text(const struct track_request *request, const struct track_result *result) {
    track_print_motion(request, result->frames, result->interrupted);
    if (request->region_degrees < 180)
        say("  kept are facets whose normals are within %g degrees of %g,%g,%g\n", request->region_degrees,
            request->region.x, request->region.y, request->region.z);
    surface_print_notes(request->surfaces, 2);
    print_times(request, result);
    print_work(result);
    if (request->tolerance > 0)
        say("  %-18s %" PRIu64 " of %" PRIu64 " frames, the support short by %.3g at most, %.3g allowed\n",
            "pairing kept", result->did.kept, result->frames, result->shortfall, request->tolerance);
    if (request->verify_every)
        say("  %-18s %" PRIu64 " frames, %" PRIu64 " differ from a rebuild\n", "verified", result->verified,
            result->mismatches);
    if (result->mismatches)
        say("  %-18s frame %" PRIu64 "\n", "first difference", result->first_mismatch);
    if (request->dump)
        say("  %-18s %" PRIu64 " frames in %s\n", "dumped", result->dumped, request->dump);
    if (request->plot)
        say("  %-18s %s\n", "plot", request->plot);
}

/* --- chart --- */

bool track_plot(const struct track_request *request, const struct track_result *result, FILE *file) {
    char axis[128], title[256], subtitle[256];
    if (request->random)
        snprintf(axis, sizeof axis, "a new random axis every %d frames", MOTION_AXIS_FRAMES);
    else
        snprintf(axis, sizeof axis, "axis %g,%g,%g", request->axis.x, request->axis.y, request->axis.z);
    snprintf(title, sizeof title, "%s turning against %s", model_title(request->p), model_title(request->q));
    snprintf(subtitle, sizeof subtitle, "%" PRIu64 " steps to a turn, %" PRIu64 " frames, %s, method %s",
             request->steps, result->frames, axis, request->method_name);

    struct plot plot = {.title = title,
                        .subtitle = subtitle,
                        .frames = (size_t)((result->frames - 1) / result->update_times.stride + 1),
                        .stride = result->update_times.stride};
    plot.series[plot.count++] = (struct plot_series){.label = "tracked sum",
                                                     .colour = "#0072b2",
                                                     .times = result->update_times.kept,
                                                     .median = result->update.median};
    plot.series[plot.count++] = (struct plot_series){.label = "rebuild by walk",
                                                     .colour = "#d55e00",
                                                     .times = result->walk_times.kept,
                                                     .median = result->walk.median};
    if (request->brute)
        plot.series[plot.count++] = (struct plot_series){
            .label = "brute-force re-check", .colour = "#007f5c", .times = NULL, .median = result->brute.median};
    return plot_write(&plot, file);
}
