/* SPDX-License-Identifier: MIT */
/* pirouette simplify: a polytope of fewer vertices inside a model, one around it, and how far they are from it. */
#include <inttypes.h>
#include <stdio.h>

#include "args.h"
#include "cmd.h"
#include "json.h"
#include "message.h"
#include "model.h"
#include "target.h"
#include "text.h"

/* False after a complaint. */
static bool read_options(const struct args *args, pir_simplify_options *options) {
    uint64_t vertices = 0;
    *options = pir_simplify_options_default();
    if (!args_count(args, "--vertices", 4, UINT32_MAX, &vertices) || !args_numbers(args, "--error", 1, &options->error))
        return false;
    options->vertices = (uint32_t)vertices;
    if (args_has(args, "--error") && !(options->error > 0)) {
        complain("simplify: --error: a length above 0 is wanted");
        return false;
    }
    if (vertices > 0 || options->error > 0)
        return true;
    complain("simplify: --vertices N or --error E is missing; it says when to stop");
    return false;
}

/* Writes a polytope to its file, where there is one. False after a complaint. */
static bool write_body(const struct args *args, struct output_file *file, const pir_polytope *polytope) {
    pir_mesh *mesh = NULL;
    if (!file->stream)
        return true;
    pir_status status = pir_mesh_from_polytope(polytope, &mesh);
    if (status != PIR_OK)
        complain_status("simplify", status, NULL);
    bool done = status == PIR_OK && target_write_mesh(file, mesh, args_has(args, "--exact"));
    pir_mesh_destroy(mesh);
    return done;
}

static void print_body(const char *which, const pir_polytope *polytope, double error) {
    char text[TEXT_NUMBER];
    text_double(error, text);
    say("  %-10s %" PRIu32 " vertices, %" PRIu32 " facets, within %s\n", which, pir_polytope_vertex_count(polytope),
        pir_polytope_facet_count(polytope), text);
}

static void add_body(struct json *json, const char *which, const pir_polytope *polytope, double error) {
    cJSON *body = json_add_object(json, json->root, which);
    json_add_number(json, body, "vertices", pir_polytope_vertex_count(polytope));
    json_add_number(json, body, "facets", pir_polytope_facet_count(polytope));
    json_add_number(json, body, "error", error);
}

static bool print(const struct args *args, const pir_polytope *polytope, const pir_simplified *simplified) {
    const char *model = args->positional[0];
    uint32_t vertices = pir_polytope_vertex_count(polytope);
    if (args_has(args, "--json")) {
        struct json json = json_new();
        json_add_text(&json, json.root, "model", model);
        json_add_number(&json, json.root, "vertices", vertices);
        add_body(&json, "inner", simplified->inner, simplified->inner_error);
        add_body(&json, "outer", simplified->outer, simplified->outer_error);
        return json_print(&json, stdout);
    }
    say("%s: %" PRIu32 " vertices\n", model, vertices);
    print_body("inside", simplified->inner, simplified->inner_error);
    print_body("around", simplified->outer, simplified->outer_error);
    return true;
}

static bool open_target(const struct args *args, const char *name, struct output_file *file) {
    const char *path = args_value(args, name);
    return !path || output_open(file, path);
}

static int simplify(const struct args *args, pir_polytope *polytope, const pir_simplify_options *options,
                    struct output_file files[2]) {
    pir_simplified simplified = {0};
    pir_status status = pir_polytope_simplify(polytope, options, &simplified);
    if (status != PIR_OK) {
        complain_status(args->positional[0], status, NULL);
        return EXIT_BAD_INPUT;
    }
    bool silent = target_is_stdout(args, "-o") || target_is_stdout(args, "--outer");
    bool done = write_body(args, &files[0], simplified.inner) && write_body(args, &files[1], simplified.outer) &&
                (silent || print(args, polytope, &simplified));
    pir_simplified_release(&simplified);
    return done ? EXIT_DONE : EXIT_BAD_INPUT;
}

SUBCOMMAND(simplify) {
    pir_simplify_options options;
    if (!read_options(args, &options) || !target_check(args, "-o", TARGET_MESH) ||
        !target_check(args, "--outer", TARGET_MESH))
        return EXIT_BAD_INPUT;
    if (!targets_differ(args, "-o", "--outer"))
        return EXIT_BAD_INPUT;
    pir_surface surface;
    struct output_file files[2] = {{0}, {0}};
    pir_polytope *polytope = model_load(args, 0, &surface);
    bool open = polytope && open_target(args, "-o", &files[0]) && open_target(args, "--outer", &files[1]);
    int result = open ? simplify(args, polytope, &options, files) : EXIT_BAD_INPUT;
    output_discard(&files[0]);
    output_discard(&files[1]);
    pir_polytope_release(polytope);
    return result;
}
