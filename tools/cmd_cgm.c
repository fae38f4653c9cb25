/* SPDX-License-Identifier: MIT */
/* pirouette cgm: the cubical Gaussian map of a model, or the overlay of two, which is that of their sum. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "args.h"
#include "cgm_picture.h"
#include "cmd.h"
#include "file.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "model.h"
#include "pose.h"
#include "surface.h"
#include "target.h"
#include "text.h"

struct outcome {
    pir_cgm *cgm;
    pir_mesh *mesh;
    pir_surface surfaces[2]; /* of P and Q as given */
    double seconds;          /* from the polytopes to the mesh */
};

static pir_status compute(pir_polytope *p, pir_polytope *q, pir_quat rotation, struct outcome *outcome) {
    int64_t start = clock_now();
    pir_cgm *of_p = NULL, *of_q = NULL;
    pir_status status = pir_cgm_create(p, &rotation, NULL, &of_p);
    if (status == PIR_OK && q)
        status = pir_cgm_create(q, NULL, NULL, &of_q);
    if (status == PIR_OK && q)
        status = pir_cgm_overlay(of_p, of_q, &outcome->cgm);
    if (!q) {
        outcome->cgm = of_p;
        of_p = NULL;
    }
    if (status == PIR_OK)
        status = pir_cgm_mesh(outcome->cgm, PIR_DOUBLE, &outcome->mesh);
    outcome->seconds = (double)(clock_now() - start) / 1e9;
    pir_cgm_release(of_p);
    pir_cgm_release(of_q);
    return status;
}

static void add_counts(struct json *json, cJSON *parent, pir_cgm_counts counts) {
    json_add_number(json, parent, "vertices", counts.vertices);
    json_add_number(json, parent, "halfedges", counts.halfedges);
    json_add_number(json, parent, "faces", counts.faces);
}

static bool print_json(const struct args *args, const struct outcome *outcome) {
    struct json json = json_new();
    pir_quat r = pir_cgm_source_rotation(outcome->cgm, 0);
    json_add_text(&json, json.root, "p", args->positional[0]);
    if (args->positional_count > 1)
        json_add_text(&json, json.root, "q", args->positional[1]);
    json_add_numbers(&json, json.root, "quat", (const double[]){r.x, r.y, r.z, r.w}, 4);
    cJSON *maps = json_add_array(&json, json.root, "maps");
    for (uint32_t map = 0; map < 6; map++) {
        cJSON *entry = json_add_object(&json, maps, NULL);
        json_add_text(&json, entry, "face", pir_cgm_map_name(map));
        add_counts(&json, entry, pir_cgm_map_counts(outcome->cgm, map));
    }
    add_counts(&json, json_add_object(&json, json.root, "total"), pir_cgm_total_counts(outcome->cgm));
    cJSON *mesh = json_add_object(&json, json.root, "mesh");
    json_add_number(&json, mesh, "vertices", pir_mesh_vertex_count(outcome->mesh));
    json_add_number(&json, mesh, "edges", pir_mesh_edge_count(outcome->mesh));
    json_add_number(&json, mesh, "facets", pir_mesh_facet_count(outcome->mesh));
    json_add_number(&json, json.root, "seconds", outcome->seconds);
    surface_add_inputs(&json, outcome->surfaces, args->positional_count);
    return json_print(&json, stdout);
}

static void print_counts(const char *name, pir_cgm_counts counts) {
    say("  %-10s %8" PRIu32 " %10" PRIu32 " %8" PRIu32 "\n", name, counts.vertices, counts.halfedges, counts.faces);
}

static void print_text(const struct args *args, const struct outcome *outcome) {
    char time[TEXT_NUMBER];
    text_time(outcome->seconds * 1e9, time);
    say("cubical Gaussian map of %s", args->positional[0]);
    say(args->positional_count > 1 ? " and %s\n" : "\n", args->positional[1]);
    surface_print_notes(outcome->surfaces, args->positional_count);
    say("  %-10s %8s %10s %8s\n", "map", "vertices", "halfedges", "faces");
    for (uint32_t map = 0; map < 6; map++)
        print_counts(pir_cgm_map_name(map), pir_cgm_map_counts(outcome->cgm, map));
    print_counts("total", pir_cgm_total_counts(outcome->cgm));
    say("  %-10s vertices %" PRIu32 ", edges %" PRIu32 ", facets %" PRIu32 "\n",
        args->positional_count > 1 ? "sum" : "polytope", pir_mesh_vertex_count(outcome->mesh),
        pir_mesh_edge_count(outcome->mesh), pir_mesh_facet_count(outcome->mesh));
    say("  %-10s %s\n", "time", time);
    if (args_has(args, "-o"))
        say("  %-10s %s\n", "file", args_value(args, "-o"));
}

/* P, reflected when the difference is asked for, and Q when there is one; false after a complaint. */
static bool load(const struct args *args, struct outcome *outcome, pir_polytope **p, pir_polytope **q) {
    *p = model_load(args, 0, &outcome->surfaces[0]);
    if (*p && args_has(args, "--difference")) {
        pir_polytope *reflected = NULL;
        pir_status status = pir_polytope_reflect(*p, &reflected);
        pir_polytope_release(*p);
        *p = reflected;
        if (status != PIR_OK)
            complain_status("cgm", status, NULL);
    }
    if (*p && args->positional_count > 1)
        *q = model_load(args, 1, &outcome->surfaces[1]);
    return *p && (*q || args->positional_count == 1);
}

SUBCOMMAND(cgm) {
    pir_quat rotation;
    struct outcome outcome = {0};
    struct output_file file = {0};
    pir_polytope *p = NULL, *q = NULL;
    const char *path = args_value(args, "-o");
    int result = EXIT_BAD_INPUT;
    if (!pose_read(args, &rotation) || !target_check(args, "-o", ".svg") || !load(args, &outcome, &p, &q))
        goto done;
    if (path && !output_open(&file, path))
        goto done;

    pir_status status = compute(p, q, rotation, &outcome);
    if (status != PIR_OK) {
        complain_status("cgm", status, NULL);
        goto done;
    }
    if (path) {
        cgm_picture_write(file.stream, outcome.cgm);
        if (!output_commit(&file))
            goto done;
    }
    result = EXIT_DONE;
    if (args_has(args, "--json"))
        result = print_json(args, &outcome) ? EXIT_DONE : EXIT_BAD_INPUT;
    else if (!target_is_stdout(args, "-o"))
        print_text(args, &outcome);

done:
    output_discard(&file);
    pir_mesh_destroy(outcome.mesh);
    pir_cgm_release(outcome.cgm);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return result;
}
