/* SPDX-License-Identifier: MIT */
/* pirouette sum --solid: the sum of two models as the solids that they are. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include <pirouette/exact.h>

#include "certificate.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "pixels/solid_picture.h"
#include "pose.h"
#include "solid.h"
#include "target.h"
#include "text.h"

/* The formats whose readers take facets that are not convex, with slits to their holes. */
#define TARGET_SOLID ".off" SOLID_PICTURE

struct request {
    pir_quat rotation;
    pir_solid_sum_options options;
};

struct outcome {
    pir_mesh *mesh;
    pir_certificate *certificate; /* NULL, or what is to be written */
    pir_solid_sum_info info;
    double seconds;
};

static bool print_json(const struct args *args, const struct request *request, const struct outcome *outcome) {
    const double quat[4] = {request->rotation.x, request->rotation.y, request->rotation.z, request->rotation.w};
    const pir_solid_sum_info *info = &outcome->info;
    struct json json = json_new();
    json_add_text(&json, json.root, "p", args->positional[0]);
    json_add_text(&json, json.root, "q", args->positional[1]);
    json_add_flag(&json, json.root, "solid", true);
    json_add_numbers(&json, json.root, "quat", quat, 4);
    json_add_flag(&json, json.root, "difference", request->options.difference);
    json_add_number(&json, json.root, "vertices", info->vertices);
    json_add_number(&json, json.root, "edges", info->edges);
    json_add_number(&json, json.root, "facets", info->facets);
    json_add_number(&json, json.root, "holes", info->holes);
    json_add_flag(&json, json.root, "open", request->options.open);
    json_add_number(&json, json.root, "two_sided", info->two_sided);
    json_add_number(&json, json.root, "segments", info->segments);
    json_add_number(&json, json.root, "points", info->points);
    json_add_numbers(&json, json.root, "pieces", (const double[]){info->pieces_p, info->pieces_q}, 2);
    json_add_count(&json, json.root, "candidates", info->candidates);
    json_add_number(&json, json.root, "seconds", outcome->seconds);
    return json_print(&json, stdout);
}

static void print_text(const struct args *args, const struct request *request, const struct outcome *outcome) {
    const pir_solid_sum_info *info = &outcome->info;
    char time[TEXT_NUMBER];
    text_time(outcome->seconds * 1e9, time);
    say("%s of %s and %s, as solids\n", request->options.difference ? "difference" : "sum", args->positional[0],
        args->positional[1]);
    say("  %-10s %" PRIu32 "\n", "vertices", info->vertices);
    say("  %-10s %" PRIu32 "\n", "edges", info->edges);
    say("  %-10s %" PRIu32 ", with %" PRIu32 " holes\n", "facets", info->facets, info->holes);
    if (request->options.open)
        say("  %-10s %" PRIu32 " two-sided facets, %" PRIu32 " segments, %" PRIu32 " points\n", "left out",
            info->two_sided, info->segments, info->points);
    say("  %-10s %" PRIu32 " of P, %" PRIu32 " of Q\n", "pieces", info->pieces_p, info->pieces_q);
    say("  %-10s %s\n", "time", time);
    if (args_has(args, "-o"))
        say("  %-10s %s\n", "file", args_value(args, "-o"));
}

static int report(const struct args *args, const struct request *request, const struct outcome *outcome) {
    if (args_has(args, "--json"))
        return print_json(args, request, outcome) ? EXIT_DONE : EXIT_BAD_INPUT;
    if (!target_is_stdout(args, "-o") && !target_is_stdout(args, "--certificate"))
        print_text(args, request, outcome);
    return EXIT_DONE;
}

/* Whether doubles hold all coordinates. Rounded facets would not be planar, so that they would bound no solid. */
static bool holds_in_doubles(const pir_mesh *mesh) {
    const pir_vec3 *vertices = pir_mesh_vertices(mesh);
    mpq_t point[3], rounded;
    mpq_inits(point[0], point[1], point[2], rounded, NULL);
    bool holds = true;
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh) && holds; v++) {
        const double x[3] = {vertices[v].x, vertices[v].y, vertices[v].z};
        holds = pir_mesh_vertex_exact(mesh, v, point) == PIR_OK;
        for (int k = 0; k < 3 && holds; k++) {
            if ((holds = isfinite(x[k])))
                mpq_set_d(rounded, x[k]);
            holds = holds && mpq_equal(rounded, point[k]);
        }
    }
    mpq_clears(point[0], point[1], point[2], rounded, NULL);
    return holds;
}

static bool write(struct output_file *file, pir_mesh *mesh, bool exact) {
#if PIR_HAVE_PNG
    if (output_ends_in(file->path, ".png"))
        return solid_picture_write(file, &mesh, 1);
#endif
    return target_write_mesh(file, mesh, exact || !holds_in_doubles(mesh));
}

/* The certificate is made where `proven` says so. */
static pir_status compute(const pir_solid *p, const pir_solid *q, const struct request *request, bool proven,
                          struct outcome *outcome) {
    pir_solid_sum *sum = NULL;
    pir_status status = pir_solid_sum_create(p, q, request->rotation, &request->options, &sum);
    if (status == PIR_OK)
        status = pir_solid_sum_mesh(sum, PIR_EXACT, &outcome->mesh);
    if (status == PIR_OK)
        status = pir_solid_sum_describe(sum, &outcome->info);
    if (status == PIR_OK && proven)
        status = pir_solid_sum_certificate(sum, &outcome->certificate);
    pir_solid_sum_destroy(sum);
    return status;
}

/* Writes the certificate where there is one, which is freed. */
static bool prove(const struct args *args, struct outcome *outcome) {
    pir_certificate *certificate = outcome->certificate;
    outcome->certificate = NULL;
    return !certificate || certificate_write(args, certificate);
}

int solid_sum(const struct args *args) {
    if (args_has(args, "--method")) {
        complain("sum: --method is for hulls; with --solid models are taken as they are");
        return EXIT_BAD_INPUT;
    }
    struct request request = {.options = pir_solid_sum_options_default()};
    request.options.difference = args_has(args, "--difference");
    request.options.open = args_has(args, "--open");
    pir_report fault = {0};
    request.options.report = &fault;
    if (!pose_read(args, &request.rotation) || !target_check(args, "-o", TARGET_SOLID))
        return EXIT_BAD_INPUT;
    struct outcome outcome = {0};
    struct output_file file = {0};
    const char *path = args_value(args, "-o");
    int result = EXIT_BAD_INPUT;
    pir_solid *p = solid_load(args, 0), *q = p ? solid_load(args, 1) : NULL;
    if (p && q && (!path || output_open(&file, path))) {
        const int64_t start = clock_now();
        const pir_status status = compute(p, q, &request, args_has(args, "--certificate"), &outcome);
        outcome.seconds = (double)(clock_now() - start) / 1e9;
        if (status != PIR_OK)
            complain_status("sum", status, &fault);
        else if ((!path || write(&file, outcome.mesh, args_has(args, "--exact"))) && prove(args, &outcome))
            result = report(args, &request, &outcome);
    }
    output_discard(&file);
    pir_certificate_destroy(outcome.certificate);
    pir_mesh_destroy(outcome.mesh);
    pir_solid_release(q);
    pir_solid_release(p);
    return result;
}
