/* SPDX-License-Identifier: MIT */
/* Models by file or by name. */
#include "model.h"

#include <stdlib.h>
#include <string.h>

#include "input.h"
#include "message.h"
#include "surface.h"

static const char *shape_of(const char *model) {
    size_t length = strlen(MODEL_SHAPE);
    return strncmp(model, MODEL_SHAPE, length) == 0 ? model + length : NULL;
}

/* OFF from standard input. */
static pir_status read_stdin(const pir_read_options *options, pir_report *report, pir_surface *ret_surface,
                             pir_polytope **ret_polytope) {
    pir_file_bytes file;
    if (!input_begin_model(&file))
        return PIR_ERR_FILE;
    pir_status status = pir_polytope_read_bytes(&file, options, report, ret_surface, ret_polytope);
    return input_end_model(&file, status, report);
}

/* A built-in model, which is convex; its coordinates are doubles, so that its vertices say all of it. */
static pir_status make_shape(const char *name, double merge_tolerance, pir_report *report, pir_surface *ret_surface,
                             pir_polytope **ret_polytope) {
    pir_polytope *shape = NULL;
    pir_status status = pir_shape_create(name, NULL, report, &shape);
    if (status == PIR_OK && ret_surface)
        *ret_surface = surface_of_hull(shape);
    if (status != PIR_OK || merge_tolerance == 0) {
        *ret_polytope = shape;
        return status;
    }
    uint32_t count = pir_polytope_vertex_count(shape);
    pir_vec3 *points = malloc(count * sizeof *points);
    for (uint32_t v = 0; points && v < count; v++)
        points[v] = pir_polytope_vertex(shape, v);
    pir_polytope_options options = pir_polytope_options_default();
    options.merge_tolerance = merge_tolerance;
    status = points ? pir_polytope_create(points, count, &options, ret_polytope) : PIR_ERR_MEMORY;
    free(points);
    pir_polytope_release(shape);
    return status;
}

/* --merge and --require-convex; false after a complaint. */
static bool read_options(const struct args *args, pir_read_options *options) {
    *options = pir_read_options_default();
    options->require_convex = args_has(args, "--require-convex");
    if (!args_numbers(args, "--merge", 1, &options->merge_tolerance))
        return false;
    if (options->merge_tolerance >= 0)
        return true;
    complain("%s: --merge: %g is below 0", args->command->name, options->merge_tolerance);
    return false;
}

pir_polytope *model_load(const struct args *args, size_t index, pir_surface *ret_surface) {
    return model_of_path(args, args->positional[index], ret_surface);
}

pir_polytope *model_of_path(const struct args *args, const char *model, pir_surface *ret_surface) {
    const char *shape = shape_of(model);
    pir_polytope *polytope = NULL;
    pir_report report = {0};
    pir_read_options options;
    if (!read_options(args, &options))
        return NULL;
    if (input_is_stdin(model))
        return read_stdin(&options, &report, ret_surface, &polytope) == PIR_OK ? polytope : NULL;
    pir_status status = shape ? make_shape(shape, options.merge_tolerance, &report, ret_surface, &polytope)
                              : pir_polytope_read(model, &options, &report, ret_surface, &polytope);
    if (status != PIR_OK)
        complain_status(model, status, &report);
    return status == PIR_OK ? polytope : NULL;
}

pir_polytope *model_of_text(const struct args *args, const char *name, const char *text, const char *format) {
    pir_polytope *polytope = NULL;
    pir_report report = {0};
    pir_read_options options;
    if (!read_options(args, &options))
        return NULL;
    const pir_file_bytes bytes = {text, strlen(text), name, format};
    pir_status status = pir_polytope_read_bytes(&bytes, &options, &report, NULL, &polytope);
    if (status != PIR_OK)
        complain_status(name, status, &report);
    return status == PIR_OK ? polytope : NULL;
}

const char *model_title(const char *model) {
    const char *slash = shape_of(model) ? NULL : strrchr(model, '/');
    return slash ? slash + 1 : model;
}
