/* SPDX-License-Identifier: MIT */
/* pirouette track: its arguments. The run is in track.c, its report in track_report.c. */
#include <string.h>

#include "args.h"
#include "cmd.h"
#include "message.h"
#include "model.h"
#include "pose.h"
#include "target.h"
#include "track.h"

/* Times are kept for every frame. */
#define FRAMES_MOST 10000000
#define STEPS_MOST  1000000000

/* Of hulls, and of solids: auto and update stand first in both. */
static const char *const method_names[] = {"auto", "update", "walk", "cgm", NULL};
static const pir_method methods[] = {PIR_METHOD_AUTO, PIR_METHOD_UPDATE, PIR_METHOD_WALK, PIR_METHOD_CGM};
static const char *const solid_method_names[] = {"auto", "update", "rebuild", NULL};
static const pir_solid_method solid_methods[] = {PIR_SOLID_AUTO, PIR_SOLID_UPDATE, PIR_SOLID_REBUILD};

static bool read_motion(const struct args *args, struct track_request *request) {
    const char *axis = args_value(args, "--axis");
    request->random = !axis || strcmp(axis, "random") == 0;
    return args_count(args, "--steps", 1, STEPS_MOST, &request->steps) &&
           args_count(args, "--frames", 1, FRAMES_MOST, &request->frames) &&
           args_count(args, "--seed", 0, UINT64_MAX, &request->seed) &&
           (request->random || axis_read(args, "--axis", &request->axis));
}

static bool read_outputs(const struct args *args, struct track_request *request) {
    request->dump = args_value(args, "--dump");
    request->dump_exact = args_has(args, "--exact");
    request->plot = args_value(args, "--plot");
    if ((args_has(args, "--every") || request->dump_exact) && !request->dump) {
        complain("track: %s needs --dump DIR beside it", request->dump_exact ? "--exact" : "--every");
        return false;
    }
    if (request->dump && strcmp(request->dump, "-") == 0) {
        complain("track: --dump: '-' is standard output, and frames go to a folder");
        return false;
    }
    return target_check(args, "--plot", ".svg") && args_count(args, "--every", 1, FRAMES_MOST, &request->dump_every);
}

/* The region, all of the sphere where none is asked for. */
static bool read_region(const struct args *args, struct track_request *request) {
    double given[4] = {0, 0, 1, 180};
    if (!args_numbers(args, "--region", 4, given))
        return false;
    request->region = (pir_vec3){given[0], given[1], given[2]};
    request->region_degrees = given[3];
    if (given[0] == 0 && given[1] == 0 && given[2] == 0) {
        complain("track: --region: an axis 0,0,0 has no direction");
        return false;
    }
    if (!(given[3] >= 0 && given[3] <= 180)) {
        complain("track: --region: %g is not between 0 and 180 degrees", given[3]);
        return false;
    }
    return true;
}

static bool read_request(const struct args *args, struct track_request *request) {
    int method = 0;
    const bool solid = args_has(args, "--solid");
    *request = (struct track_request){
        .p = args->positional[0],
        .q = args->positional[1],
        .frames = 1000,
        .steps = 500,
        .seed = 1,
        .difference = args_has(args, "--difference"),
        .brute = args_has(args, "--brute"),
        .open = args_has(args, "--open"),
        .verify_every = args_has(args, "--verify") ? 1 : 0,
        .dump_every = 1,
    };
    if (!read_motion(args, request) || !read_outputs(args, request) ||
        !args_count(args, "--verify-every", 1, FRAMES_MOST, &request->verify_every) ||
        !args_choice(args, "--method", solid ? solid_method_names : method_names, &method))
        return false;
    if (!read_region(args, request) || !args_numbers(args, "--tolerance", 1, &request->tolerance))
        return false;
    if (request->tolerance < 0) {
        complain("track: --tolerance: %g is less than 0", request->tolerance);
        return false;
    }
    if (request->tolerance > 0 && request->dump) {
        complain("track: --dump writes exact frames, and --tolerance %g allows others", request->tolerance);
        return false;
    }
    request->method = methods[solid ? 0 : method];
    request->solid_method = solid_methods[solid ? method : 0];
    request->method_name = (solid ? solid_method_names : method_names)[method];
    return true;
}

/* Options that do not go together: those of hulls and --solid. False after a complaint. */
static bool check_solid(const struct args *args, bool solid) {
    static const char *const of_hulls[] = {"--tolerance", "--region", "--brute", "--plot"};
    for (size_t i = 0; i < sizeof of_hulls / sizeof *of_hulls && solid; i++)
        if (args_has(args, of_hulls[i])) {
            complain("track: %s is for hulls, and not for --solid", of_hulls[i]);
            return false;
        }
    if (args_has(args, "--open") && !solid) {
        complain("track: --open is about solids: give --solid as well");
        return false;
    }
    return true;
}

SUBCOMMAND(track) {
    struct track_request request;
    struct track_result result = {0};
    const bool solid = args_has(args, "--solid");
    if (!read_request(args, &request) || !check_solid(args, solid))
        return EXIT_BAD_INPUT;
    if (solid)
        return solid_track(args, &request);
    int status = EXIT_BAD_INPUT;
    pir_polytope *q = NULL, *p = model_load(args, 0, &request.surfaces[0]);
    if (p)
        q = model_load(args, 1, &request.surfaces[1]);
    if (p && q && track_run(&request, p, q, &result)) {
        status = result.mismatches ? EXIT_CHECK_FAILED : EXIT_DONE;
        if (args_has(args, "--json"))
            status = track_print_json(&request, &result) ? status : EXIT_BAD_INPUT;
        else if (!target_is_stdout(args, "--plot"))
            track_print_text(&request, &result);
    }
    track_finish(&result);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return status;
}
