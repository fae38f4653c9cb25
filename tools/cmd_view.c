/* SPDX-License-Identifier: MIT */
/* pirouette view: slices of a file as a mesh, a contact sheet, a page or a file of VTK. */
#include <inttypes.h>
#include <stdio.h>

#include "args.h"
#include "cmd.h"
#include "json.h"
#include "message.h"
#include "target.h"
#include "views/page.h"
#include "views/planar.h"
#include "views/sheet.h"
#include "views/slices.h"
#if PIR_HAVE_HDF5
#include "views/vtk.h"
#endif

/* The most slices that are shown where --every does not say which. */
#define SHEET_MOST 60
#define PAGE_MOST  2000

enum kind { KIND_MESH, KIND_SHEET, KIND_PAGE, KIND_VTK };

struct request {
    enum kind kind;
    const char *path; /* of -o */
    bool one;         /* --slice was given */
    uint64_t slice, every, pair[2];
    struct planar planar;
};

/* Reads what to make from the ending of the path. */
static bool read_kind(const struct args *args, struct request *request) {
    static const struct {
        const char *ending;
        enum kind kind;
    } kinds[] = {{".off", KIND_MESH},  {".obj", KIND_MESH},  {".stl", KIND_MESH},  {".ply", KIND_MESH},
                 {".svg", KIND_SHEET}, {".html", KIND_PAGE}, {".vtkhdf", KIND_VTK}};
    request->path = args_value(args, "-o");
    if (!request->path) {
        complain("view: -o FILE is missing; its ending says what to make");
        return false;
    }
    if (output_is_stream(request->path))
        return target_check(args, "-o", NULL);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (output_ends_in(request->path, kinds[i].ending)) {
            request->kind = kinds[i].kind;
            return true;
        }
    complain("view: -o: '%s' does not end in .off, .obj, .stl, .ply, .svg, .html or .vtkhdf", request->path);
    return false;
}

/* Which pair of pieces --pair names. */
static bool read_pair(const struct args *args, struct request *request) {
    double pair[2] = {0, 0};
    if (!args_numbers(args, "--pair", 2, pair))
        return false;
    for (int i = 0; i < 2; i++) {
        if (!(pair[i] >= 0 && pair[i] <= UINT32_MAX) || pair[i] != (double)(uint32_t)pair[i]) {
            complain("view: --pair: %g is not the number of a piece", pair[i]);
            return false;
        }
        request->pair[i] = (uint64_t)pair[i];
    }
    return true;
}

static bool read_request(const struct args *args, struct request *request) {
    *request = (struct request){.one = args_has(args, "--slice")};
    if (!read_kind(args, request) || !read_pair(args, request) ||
        !args_count(args, "--slice", 0, UINT64_MAX >> 11, &request->slice) ||
        !args_count(args, "--every", 1, UINT64_MAX >> 11, &request->every) || !planar_read(args, &request->planar))
        return false;
    const char *wrong = NULL;
    if (request->kind == KIND_MESH && !request->one)
        wrong = "a mesh is of one slice; --slice K says which";
    else if (request->kind != KIND_MESH && args_has(args, "--pair"))
        wrong = "--pair is for a mesh; pictures show all pairs";
    else if (request->kind != KIND_MESH && args_has(args, "--exact"))
        wrong = "--exact is for a mesh in .off";
    else if (request->kind != KIND_SHEET && request->planar.given)
        wrong = "--planar is for a sheet, .svg";
    else if (request->one && args_has(args, "--every"))
        wrong = "--slice and --every exclude each other";
    if (wrong)
        complain("view: %s", wrong);
    return !wrong;
}

/* Holds what was asked for against what the file has. */
static bool check_request(const struct request *request, struct slices *slices) {
    if (request->one && request->slice >= slices->info.grid.count) {
        complain("%s: there is no slice %" PRIu64 "; there are %" PRIu64 ", counted from 0", slices->path,
                 request->slice, slices->info.grid.count);
        return false;
    }
    const uint32_t counts[2] = {slices->info.robot_count, slices->info.obstacle_count};
    for (int i = 0; i < 2; i++)
        if (request->pair[i] >= counts[i]) {
            complain("%s: the %s has no piece %" PRIu64 "; there are %u, counted from 0", slices->path,
                     i == 0 ? "robot" : "obstacle", request->pair[i], counts[i]);
            return false;
        }
    if (request->one) {
        slices->first = request->slice;
        slices->count = 1;
    }
    return true;
}

static bool write_mesh(struct output_file *file, const struct request *request, const struct slices *slices,
                       bool exact) {
    uint32_t pair = (uint32_t)(request->pair[0] * slices->info.obstacle_count + request->pair[1]);
    pir_mesh *mesh = slices_mesh(slices, 0, pair, exact ? PIR_EXACT : PIR_DOUBLE);
    bool done = mesh && target_write_mesh(file, mesh, exact);
    pir_mesh_destroy(mesh);
    return done;
}

static bool write_vtk(const struct request *request, const struct slices *slices) {
#if PIR_HAVE_HDF5
    return vtk_write(request->path, slices);
#else
    (void)slices;
    complain("%s: this build has no HDF5", request->path);
    return false;
#endif
}

static bool write_view(const struct args *args, const struct request *request, const struct slices *slices) {
    struct output_file file = {0};
    if (request->kind == KIND_VTK)
        return write_vtk(request, slices);
    bool done = output_open(&file, request->path);
    if (done && request->kind == KIND_MESH)
        done = write_mesh(&file, request, slices, args_has(args, "--exact"));
    else if (done)
        done = (request->kind == KIND_PAGE ? page_write(file.stream, slices)
                                           : sheet_write(file.stream, slices, &request->planar)) &&
               output_commit(&file);
    output_discard(&file);
    return done;
}

static bool print_written(const struct args *args, const struct request *request, const struct slices *slices) {
    if (target_is_stdout(args, "-o"))
        return true;
    if (!args_has(args, "--json")) {
        say("%s: %" PRIu64 " of %" PRIu64 " slices, written to %s\n", slices->path, slices->count,
            slices->info.grid.count, request->path);
        return true;
    }
    struct json json = json_new();
    json_add_text(&json, json.root, "file", request->path);
    json_add_count(&json, json.root, "slices", slices->info.grid.count);
    json_add_count(&json, json.root, "shown", slices->count);
    json_add_count(&json, json.root, "first", slices->first);
    json_add_count(&json, json.root, "every", slices->every);
    return json_print(&json, stdout);
}

SUBCOMMAND(view) {
    struct request request;
    struct slices slices = {0};
    if (!read_request(args, &request))
        return EXIT_BAD_INPUT;
    uint64_t most = request.kind == KIND_SHEET ? SHEET_MOST : request.kind == KIND_PAGE ? PAGE_MOST : UINT64_MAX / 2;
    bool done = slices_open(&slices, args->positional[0], request.every, most) && check_request(&request, &slices) &&
                write_view(args, &request, &slices) && print_written(args, &request, &slices);
    slices_close(&slices);
    return done ? EXIT_DONE : EXIT_BAD_INPUT;
}
