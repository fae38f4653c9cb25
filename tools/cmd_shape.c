/* SPDX-License-Identifier: MIT */
/* pirouette shape: writes a built-in model, or lists all. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "args.h"
#include "cmd.h"
#include "json.h"
#include "message.h"
#include "model.h"
#include "target.h"

static int list_shapes(bool as_json) {
    if (!as_json) {
        for (size_t i = 0; i < pir_shape_count(); i++)
            say("%-32s %s\n", pir_shape_name(i), pir_shape_help(i));
        return EXIT_DONE;
    }
    struct json json = json_new();
    cJSON *list = json_add_array(&json, json.root, "shapes");
    for (size_t i = 0; i < pir_shape_count(); i++) {
        cJSON *shape = json_add_object(&json, list, NULL);
        json_add_text(&json, shape, "name", pir_shape_name(i));
        json_add_text(&json, shape, "help", pir_shape_help(i));
    }
    return json_print(&json, stdout) ? EXIT_DONE : EXIT_BAD_INPUT;
}

static bool print_written(const pir_polytope *polytope, const char *name, const char *file, bool as_json) {
    uint32_t vertices = pir_polytope_vertex_count(polytope), facets = pir_polytope_facet_count(polytope);
    if (!as_json) {
        say("%s: %" PRIu32 " vertices, %" PRIu32 " facets, written to %s\n", name, vertices, facets, file);
        return true;
    }
    struct json json = json_new();
    json_add_text(&json, json.root, "name", name);
    json_add_number(&json, json.root, "vertices", vertices);
    json_add_number(&json, json.root, "edges", pir_polytope_edge_count(polytope));
    json_add_number(&json, json.root, "facets", facets);
    json_add_text(&json, json.root, "file", file);
    return json_print(&json, stdout);
}

/* Whether the shape was written, and is told of where that does not go to the same place. */
static bool write_mesh(const struct args *args, const char *name, const pir_polytope *polytope, const pir_mesh *mesh) {
    const char *path = args_value(args, "-o");
    struct output_file file = {0};
    bool done = output_open(&file, path) && target_write_mesh(&file, mesh, args_has(args, "--exact"));
    output_discard(&file);
    return done && (target_is_stdout(args, "-o") || print_written(polytope, name, path, args_has(args, "--json")));
}

static int write_shape(const struct args *args, const char *name) {
    pir_polytope *polytope = NULL;
    pir_mesh *mesh = NULL;
    int result = EXIT_BAD_INPUT;
    pir_report report = {0};
    pir_status status = pir_shape_create(name, NULL, &report, &polytope);
    if (status == PIR_OK)
        status = pir_mesh_from_polytope(polytope, &mesh);
    if (status != PIR_OK)
        complain_status(name, status, &report);
    else if (write_mesh(args, name, polytope, mesh))
        result = EXIT_DONE;
    pir_mesh_destroy(mesh);
    pir_polytope_release(polytope);
    return result;
}

SUBCOMMAND(shape) {
    const char *name = args->positional[0], *file = args_value(args, "-o");
    if (!name && !file)
        return list_shapes(args_has(args, "--json"));
    if (args_has(args, "--list"))
        return complain("shape: --list stands alone, without NAME and -o FILE");
    if (!name)
        return complain("shape: NAME is missing; pirouette shape --list shows all");
    if (!file)
        return complain("shape: %s: -o FILE is missing; it says where to write the model", name);
    if (strncmp(name, MODEL_SHAPE, strlen(MODEL_SHAPE)) == 0)
        name += strlen(MODEL_SHAPE);
    return target_check(args, "-o", TARGET_MESH) ? write_shape(args, name) : EXIT_BAD_INPUT;
}
