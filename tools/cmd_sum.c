/* SPDX-License-Identifier: MIT */
/* pirouette sum: the sum of two models at one rotation. */
#include <inttypes.h>
#include <stdio.h>

#include <pirouette/baseline.h>

#include "args.h"
#include "certificate.h"
#include "cmd.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "model.h"
#include "pose.h"
#include "solid.h"
#include "surface.h"
#include "target.h"
#include "text.h"

enum method { METHOD_WALK, METHOD_CGM, METHOD_HULL, METHOD_OBJECT };
static const char *const method_names[] = {"walk", "cgm", "hull", "object", NULL};

struct request {
    pir_quat rotation;
    pir_sum_options options;
    pir_precision precision;
    int method;
};

/* The pairing, by walk, and the mesh, by the method asked for; `seconds` is what that method took. */
struct outcome {
    pir_sum *sum;
    pir_mesh *mesh;
    double seconds;
    pir_surface surfaces[2]; /* of P and Q as given */
};

static bool read_request(const struct args *args, struct request *request) {
    *request = (struct request){.options = pir_sum_options_default(), .method = METHOD_WALK};
    request->options.difference = args_has(args, "--difference");
    request->precision = args_has(args, "--exact") ? PIR_EXACT : PIR_DOUBLE;
    return pose_read(args, &request->rotation) && args_choice(args, "--method", method_names, &request->method) &&
           target_check(args, "-o", TARGET_MESH) && certificate_check(args, (const char *const[]){"--merge", NULL});
}

/* The mesh from the overlay of two cubical Gaussian maps, the pairing as that rebuild reads it. */
static pir_status compute_by_cgm(const struct request *request, pir_polytope *p, pir_polytope *q,
                                 struct outcome *outcome) {
    pir_cgm *of_p = NULL, *of_q = NULL, *of_sum = NULL;
    pir_polytope *reflected = NULL;
    pir_status status = pir_sum_rotate(outcome->sum, request->rotation, PIR_METHOD_CGM);
    if (status == PIR_OK && request->options.difference)
        status = pir_polytope_reflect(p, &reflected);
    int64_t start = clock_now();
    if (status == PIR_OK)
        status = pir_cgm_create(reflected ? reflected : p, &request->rotation, NULL, &of_p);
    if (status == PIR_OK)
        status = pir_cgm_create(q, NULL, NULL, &of_q);
    if (status == PIR_OK)
        status = pir_cgm_overlay(of_p, of_q, &of_sum);
    if (status == PIR_OK)
        status = pir_cgm_mesh(of_sum, request->precision, &outcome->mesh);
    outcome->seconds = (double)(clock_now() - start) / 1e9;
    pir_cgm_release(of_sum);
    pir_cgm_release(of_q);
    pir_cgm_release(of_p);
    pir_polytope_release(reflected);
    return status;
}

/* Fills `outcome`. Its objects are to be released also after a failure. */
static pir_status compute(const struct request *request, pir_polytope *p, pir_polytope *q, struct outcome *outcome) {
    int64_t start = clock_now();
    pir_status status = pir_sum_create(p, q, request->rotation, &request->options, &outcome->sum);
    if (status != PIR_OK)
        return status;
    if (request->method == METHOD_CGM)
        return compute_by_cgm(request, p, q, outcome);
    if (request->method == METHOD_HULL) {
        start = clock_now();
        status = pir_hull_sum(p, q, request->rotation, &request->options, request->precision, &outcome->mesh);
    } else if (request->method == METHOD_OBJECT) {
        start = clock_now();
        status = pir_object_sum(p, q, request->rotation, &request->options, request->precision, &outcome->mesh);
    } else {
        status = pir_sum_mesh(outcome->sum, request->precision, &outcome->mesh);
    }
    outcome->seconds = (double)(clock_now() - start) / 1e9;
    return status;
}

/* Says why there is no sum. */
static void complain_sum(const struct request *request, const pir_polytope *p, const pir_polytope *q,
                         pir_status status) {
    if (request->method == METHOD_OBJECT && status == PIR_ERR_LIMIT)
        complain("sum: --method object: bodies of %" PRIu32 " vertices and %" PRIu32
                 " vertices are not simple: it looks at each vertex for each pair of edges, 2^32 times at most",
                 pir_polytope_vertex_count(p), pir_polytope_vertex_count(q));
    else
        complain_status("sum", status, NULL);
}

static bool print_json(const struct args *args, const struct request *request, const struct outcome *outcome) {
    const double quat[4] = {request->rotation.x, request->rotation.y, request->rotation.z, request->rotation.w};
    struct json json = json_new();
    json_add_text(&json, json.root, "p", args->positional[0]);
    json_add_text(&json, json.root, "q", args->positional[1]);
    json_add_numbers(&json, json.root, "quat", quat, 4);
    json_add_flag(&json, json.root, "difference", request->options.difference);
    json_add_number(&json, json.root, "vertices", pir_mesh_vertex_count(outcome->mesh));
    json_add_number(&json, json.root, "edges", pir_mesh_edge_count(outcome->mesh));
    json_add_number(&json, json.root, "facets", pir_mesh_facet_count(outcome->mesh));
    json_add_number(&json, json.root, "fv", pir_polytope_facet_count(pir_sum_p(outcome->sum)));
    json_add_number(&json, json.root, "vf", pir_polytope_facet_count(pir_sum_q(outcome->sum)));
    json_add_number(&json, json.root, "ee", pir_sum_ee_count(outcome->sum));
    json_add_text(&json, json.root, "method", method_names[request->method]);
    json_add_number(&json, json.root, "seconds", outcome->seconds);
    surface_add_inputs(&json, outcome->surfaces, 2);
    return json_print(&json, stdout);
}

static void print_text(const struct args *args, const struct request *request, const struct outcome *outcome) {
    char time[TEXT_NUMBER];
    text_time(outcome->seconds * 1e9, time);
    say("%s of %s and %s\n", request->options.difference ? "difference" : "sum", args->positional[0],
        args->positional[1]);
    surface_print_notes(outcome->surfaces, 2);
    say("  %-10s %" PRIu32 "\n", "vertices", pir_mesh_vertex_count(outcome->mesh));
    say("  %-10s %" PRIu32 "\n", "edges", pir_mesh_edge_count(outcome->mesh));
    say("  %-10s %" PRIu32 "\n", "facets", pir_mesh_facet_count(outcome->mesh));
    say("  %-10s fv %" PRIu32 ", vf %" PRIu32 ", ee %" PRIu32 "\n", "pairs",
        pir_polytope_facet_count(pir_sum_p(outcome->sum)), pir_polytope_facet_count(pir_sum_q(outcome->sum)),
        pir_sum_ee_count(outcome->sum));
    say("  %-10s %s by %s\n", "time", time, method_names[request->method]);
    if (args_has(args, "-o"))
        say("  %-10s %s\n", "file", args_value(args, "-o"));
}

/* Writes what proves the sum. */
static bool prove(const struct args *args, const struct outcome *outcome) {
    pir_certificate *certificate;
    pir_status status = pir_sum_certificate(outcome->sum, &certificate);
    if (status == PIR_OK)
        return certificate_write(args, certificate);
    complain("sum: --certificate: '%s': %s", args_value(args, "--certificate"),
             status == PIR_ERR_ARGUMENT ? "the sum is a point or a segment, which has no facets"
                                        : pir_status_text(status));
    return false;
}

SUBCOMMAND(sum) {
    struct request request;
    if (args_has(args, "--solid") && !certificate_check(args, (const char *const[]){"--open", NULL}))
        return EXIT_BAD_INPUT;
    if (args_has(args, "--solid"))
        return solid_sum(args);
    if (args_has(args, "--open"))
        return complain("sum: --open is about solids: give --solid as well"), EXIT_BAD_INPUT;
    if (!read_request(args, &request))
        return EXIT_BAD_INPUT;
    struct outcome outcome = {0};
    struct output_file file = {0};
    const char *path = args_value(args, "-o");
    int result = EXIT_BAD_INPUT;
    pir_polytope *q = NULL, *p = model_load(args, 0, &outcome.surfaces[0]);
    if (p)
        q = model_load(args, 1, &outcome.surfaces[1]);
    if (!p || !q || (path && !output_open(&file, path)))
        goto done;

    pir_status status = compute(&request, p, q, &outcome);
    if (status != PIR_OK) {
        complain_sum(&request, p, q, status);
        goto done;
    }
    if (path && !target_write_mesh(&file, outcome.mesh, args_has(args, "--exact")))
        goto done;
    if (args_has(args, "--certificate") && !prove(args, &outcome))
        goto done;
    result = EXIT_DONE;
    if (args_has(args, "--json"))
        result = print_json(args, &request, &outcome) ? EXIT_DONE : EXIT_BAD_INPUT;
    else if (!target_is_stdout(args, "-o") && !target_is_stdout(args, "--certificate"))
        print_text(args, &request, &outcome);

done:
    output_discard(&file);
    pir_mesh_destroy(outcome.mesh);
    pir_sum_destroy(outcome.sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return result;
}
