/* SPDX-License-Identifier: MIT */
/* Models by file or by name. */
#include "model.h"

#include <stdlib.h>
#include <string.h>

#include "input.h"
#include "message.h"

static const char *shape_of(const char *model) {
    size_t length = strlen(MODEL_SHAPE);
    return strncmp(model, MODEL_SHAPE, length) == 0 ? model + length : NULL;
}

/* OFF from standard input. */
static pir_polytope *load_stdin(const pir_polytope_options *options) {
    pir_polytope *polytope = NULL;
    pir_report report = {0};
    size_t size;
    char *text = input_take() ? input_read(&size) : NULL;
    if (!text)
        return NULL;
    pir_status status = pir_polytope_read_off(text, size, INPUT_NAME, options, &report, &polytope);
    if (status != PIR_OK)
        complain_status(INPUT_NAME, status, &report);
    free(text);
    return polytope;
}

/* A built-in model; its coordinates are doubles, so that its vertices say all of it. */
static pir_status make_shape(const char *name, const pir_polytope_options *options, pir_report *report,
                             pir_polytope **ret_polytope) {
    pir_polytope *shape = NULL;
    pir_status status = pir_shape_create(name, NULL, report, &shape);
    if (status != PIR_OK || options->merge_tolerance == 0) {
        *ret_polytope = shape;
        return status;
    }
    uint32_t count = pir_polytope_vertex_count(shape);
    pir_vec3 *points = malloc(count * sizeof *points);
    for (uint32_t v = 0; points && v < count; v++)
        points[v] = pir_polytope_vertex(shape, v);
    status = points ? pir_polytope_create(points, count, options, ret_polytope) : PIR_ERR_MEMORY;
    free(points);
    pir_polytope_release(shape);
    return status;
}

pir_polytope *model_load(const struct args *args, const char *model) {
    pir_polytope_options options = pir_polytope_options_default();
    if (!args_numbers(args, "--merge", 1, &options.merge_tolerance))
        return NULL;
    if (options.merge_tolerance < 0) {
        complain("%s: --merge: %g is below 0", args->command->name, options.merge_tolerance);
        return NULL;
    }
    if (input_is_stdin(model))
        return load_stdin(&options);
    pir_polytope *polytope = NULL;
    pir_report report = {0};
    const char *shape = shape_of(model);
    pir_status status = shape ? make_shape(shape, &options, &report, &polytope)
                              : pir_polytope_read(model, &options, &report, &polytope);
    if (status != PIR_OK)
        complain_status(model, status, &report);
    return status == PIR_OK ? polytope : NULL;
}

const char *model_title(const char *model) {
    const char *slash = shape_of(model) ? NULL : strrchr(model, '/');
    return slash ? slash + 1 : model;
}
