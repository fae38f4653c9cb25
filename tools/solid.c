/* SPDX-License-Identifier: MIT */
/* Solids by file or by name, and what they are. */
#include "solid.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "input.h"
#include "json.h"
#include "message.h"
#include "model.h"
#include "text.h"

static pir_status read_stdin(pir_solid **ret_solid) {
    pir_file_bytes file;
    pir_report report = {0};
    if (!input_begin_model(&file))
        return PIR_ERR_FILE;
    const pir_status status = pir_solid_read_bytes(&file, NULL, &report, ret_solid);
    return input_end_model(&file, status, &report);
}

static pir_status make_shape(const char *name, pir_report *report, pir_solid **ret_solid) {
    pir_polytope *shape = NULL;
    pir_solid_options options = pir_solid_options_default();
    pir_status status = pir_shape_create(name, NULL, report, &shape);
    options.report = report;
    if (status == PIR_OK)
        status = pir_solid_from_polytope(shape, &options, ret_solid);
    pir_polytope_release(shape);
    return status;
}

static bool has_option(const struct command *command, const char *name) {
    const struct option *option = command->options;
    while (option->name && strcmp(option->name, name) != 0)
        option++;
    return option->name;
}

/* Refuses options that are about hulls, of a subcommand that is for hulls without --solid. */
static bool check_options(const struct args *args) {
    static const char *const of_hulls[] = {"--merge", "--require-convex"};
    if (!has_option(args->command, "--solid"))
        return true;
    for (size_t i = 0; i < sizeof of_hulls / sizeof *of_hulls; i++)
        if (has_option(args->command, of_hulls[i]) && args_has(args, of_hulls[i])) {
            complain("%s: %s is for hulls; with --solid models are taken as they are", args->command->name,
                     of_hulls[i]);
            return false;
        }
    return true;
}

pir_solid *solid_load(const struct args *args, size_t index) {
    const char *model = args->positional[index];
    if (!check_options(args))
        return NULL;
    pir_solid *solid = NULL;
    pir_report report = {0};
    if (input_is_stdin(model))
        return read_stdin(&solid) == PIR_OK ? solid : NULL;
    const bool is_shape = strncmp(model, MODEL_SHAPE, strlen(MODEL_SHAPE)) == 0;
    const pir_status status = is_shape ? make_shape(model + strlen(MODEL_SHAPE), &report, &solid)
                                       : pir_solid_read(model, NULL, &report, &solid);
    if (status != PIR_OK)
        complain_status(model, status, &report);
    return status == PIR_OK ? solid : NULL;
}

static bool print_json(const char *model, const pir_solid_info *info) {
    struct json json = json_new();
    json_add_text(&json, json.root, "model", model);
    json_add_number(&json, json.root, "vertices", info->merged_vertices);
    json_add_number(&json, json.root, "edges", info->merged_edges);
    json_add_number(&json, json.root, "facets", info->merged_facets);
    json_add_number(&json, json.root, "reflex_edges", info->reflex_edges);
    json_add_number(&json, json.root, "shells", info->shells);
    json_add_number(&json, json.root, "genus", (double)info->genus);
    json_add_number(&json, json.root, "volume", info->volume);
    cJSON *bounds = json_add_object(&json, json.root, "bounds");
    json_add_numbers(&json, bounds, "low", (const double[]){info->low.x, info->low.y, info->low.z}, 3);
    json_add_numbers(&json, bounds, "high", (const double[]){info->high.x, info->high.y, info->high.z}, 3);
    cJSON *given = json_add_object(&json, json.root, "input");
    json_add_number(&json, given, "vertices", info->vertices);
    json_add_number(&json, given, "edges", info->edges);
    json_add_number(&json, given, "facets", info->facets);
    return json_print(&json, stdout);
}

static void print_text(const char *model, const pir_solid_info *info) {
    char volume[TEXT_NUMBER];
    text_double(info->volume, volume);
    say("%s, as a solid\n", model);
    say("  %-10s %" PRIu32 "\n", "vertices", info->merged_vertices);
    say("  %-10s %" PRIu32 ", %" PRIu32 " of them reflex\n", "edges", info->merged_edges, info->reflex_edges);
    say("  %-10s %" PRIu32 "\n", "facets", info->merged_facets);
    say("  %-10s %" PRIu32 ", genus %" PRId64 "\n", "shells", info->shells, info->genus);
    text_print_range("x", info->low.x, info->high.x);
    text_print_range("y", info->low.y, info->high.y);
    text_print_range("z", info->low.z, info->high.z);
    say("  %-10s %s\n", "volume", volume);
    say("  %-10s %" PRIu32 " vertices, %" PRIu32 " edges, %" PRIu32 " facets\n", "as given", info->vertices,
        info->edges, info->facets);
}

int solid_info(const struct args *args) {
    pir_solid *solid = solid_load(args, 0);
    if (!solid)
        return EXIT_BAD_INPUT;
    pir_solid_info info;
    pir_solid_describe(solid, &info);
    pir_solid_release(solid);
    if (args_has(args, "--json"))
        return print_json(args->positional[0], &info) ? EXIT_DONE : EXIT_BAD_INPUT;
    print_text(args->positional[0], &info);
    return EXIT_DONE;
}
