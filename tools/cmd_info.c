/* SPDX-License-Identifier: MIT */
/* pirouette info: what the exact convex hull of a model is. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "args.h"
#include "cmd.h"
#include "json.h"
#include "message.h"
#include "model.h"
#include "solid.h"
#include "surface.h"
#include "text.h"

/* `merged`: whether merging was asked for. */
static bool print_json(const char *model, const pir_polytope *polytope, const pir_surface *surface, bool merged) {
    pir_vec3 low, high;
    pir_polytope_bounds(polytope, &low, &high);
    struct json json = json_new();
    json_add_text(&json, json.root, "model", model);
    json_add_number(&json, json.root, "dimension", pir_polytope_dimension(polytope));
    json_add_number(&json, json.root, "vertices", pir_polytope_vertex_count(polytope));
    json_add_number(&json, json.root, "edges", pir_polytope_edge_count(polytope));
    json_add_number(&json, json.root, "facets", pir_polytope_facet_count(polytope));
    cJSON *bounds = json_add_object(&json, json.root, "bounds");
    json_add_numbers(&json, bounds, "low", (const double[]){low.x, low.y, low.z}, 3);
    json_add_numbers(&json, bounds, "high", (const double[]){high.x, high.y, high.z}, 3);
    json_add_number(&json, json.root, "volume", pir_polytope_volume(polytope));
    if (merged)
        json_add_number(&json, json.root, "merge_bound", pir_polytope_merge_bound(polytope));
    surface_add_json(&json, json.root, "input", surface);
    return json_print(&json, stdout);
}

static void print_input(const pir_surface *surface) {
    char text[SURFACE_TEXT], volume[TEXT_NUMBER];
    say("  %-10s %s, %s\n", "as given", surface_text(surface, text), surface->convex ? "convex" : "not convex");
    if (isnan(surface->volume))
        return;
    text_double(surface->volume, volume);
    say("  %-10s volume %s\n", "", volume);
}

static void print_text(const char *model, const pir_polytope *polytope, const pir_surface *surface, bool merged) {
    pir_vec3 low, high;
    pir_polytope_bounds(polytope, &low, &high);
    char volume[TEXT_NUMBER];
    text_double(pir_polytope_volume(polytope), volume);
    say("%s\n", model);
    say("  %-10s %d\n", "dimension", pir_polytope_dimension(polytope));
    say("  %-10s %" PRIu32 "\n", "vertices", pir_polytope_vertex_count(polytope));
    say("  %-10s %" PRIu32 "\n", "edges", pir_polytope_edge_count(polytope));
    say("  %-10s %" PRIu32 "\n", "facets", pir_polytope_facet_count(polytope));
    text_print_range("x", low.x, high.x);
    text_print_range("y", low.y, high.y);
    text_print_range("z", low.z, high.z);
    say("  %-10s %s\n", "volume", volume);
    if (merged) {
        text_double(pir_polytope_merge_bound(polytope), volume);
        say("  %-10s within %s of the hull\n", "merged", volume);
    }
    print_input(surface);
}

SUBCOMMAND(info) {
    const char *model = args->positional[0];
    pir_surface surface;
    if (args_has(args, "--solid"))
        return solid_info(args);
    pir_polytope *polytope = model_load(args, 0, &surface);
    if (!polytope)
        return EXIT_BAD_INPUT;
    int result = EXIT_DONE;
    if (!args_has(args, "--json"))
        print_text(model, polytope, &surface, args_has(args, "--merge"));
    else if (!print_json(model, polytope, &surface, args_has(args, "--merge")))
        result = EXIT_BAD_INPUT;
    pir_polytope_release(polytope);
    return result;
}
