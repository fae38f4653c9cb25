/* SPDX-License-Identifier: MIT */
/* pirouette decompose: a solid in convex pieces, into one OBJ file or a folder of OFF files. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "cmd.h"
#include "file.h"
#include "json.h"
#include "measure.h"
#include "message.h"
#include "pixels/solid_picture.h"
#include "solid.h"
#include "target.h"
#include "text.h"

struct outcome {
    pir_pieces *pieces;
    pir_decompose_info did;
    pir_solid_info info;
    double seconds;
};

static const char *const method_names[] = {"best", "facets", "walls", NULL};

/* False after a complaint. */
static bool read_options(const struct args *args, pir_decompose_options *options) {
    uint64_t pieces = 0;
    int method = PIR_DECOMPOSE_BEST;
    *options = pir_decompose_options_default();
    if (!args_choice(args, "--method", method_names, &method) ||
        !args_count(args, "--pieces", 1, UINT32_MAX, &pieces) ||
        !args_numbers(args, "--tolerance", 1, &options->tolerance))
        return false;
    options->method = (pir_decompose_method)method;
    options->pieces = (uint32_t)pieces;
    if (options->tolerance >= 0)
        return true;
    complain("decompose: --tolerance: a length of 0 or more is wanted");
    return false;
}

/* A piece's boundary, exact; NULL after a complaint. */
static pir_mesh *mesh_of(const pir_pieces *pieces, uint32_t number) {
    pir_polytope *piece = NULL;
    pir_mesh *mesh = NULL;
    pir_status status = pir_pieces_polytope(pieces, number, &piece);
    if (status == PIR_OK)
        status = pir_mesh_from_polytope(piece, &mesh);
    pir_polytope_release(piece);
    if (status != PIR_OK)
        complain_status("decompose", status, NULL);
    return mesh;
}

/* Writes one piece as an object of an OBJ file, whose vertices are numbered from 1 through the whole file. */
static void write_object(FILE *file, const pir_mesh *mesh, uint32_t number, uint32_t *vertices) {
    fprintf(file, "o piece_%" PRIu32 "\n", number);
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        const pir_vec3 x = pir_mesh_vertices(mesh)[v];
        fprintf(file, "v %.17g %.17g %.17g\n", x.x, x.y, x.z);
    }
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corners = pir_mesh_facet(mesh, f, &count);
        fputc('f', file);
        for (uint32_t i = 0; i < count; i++)
            fprintf(file, " %" PRIu32, *vertices + corners[i] + 1);
        fputc('\n', file);
    }
    *vertices += pir_mesh_vertex_count(mesh);
}

static bool write_objects(const pir_pieces *pieces, const char *path) {
    struct output_file file = {0};
    bool good = output_open(&file, path);
    uint32_t vertices = 0;
    for (uint32_t k = 0; good && k < pir_pieces_count(pieces); k++) {
        pir_mesh *mesh = mesh_of(pieces, k);
        good = mesh;
        if (good)
            write_object(file.stream, mesh, k, &vertices);
        pir_mesh_destroy(mesh);
    }
    good = good && output_commit(&file);
    output_discard(&file);
    return good;
}

static bool write_piece(const pir_pieces *pieces, const char *folder, uint32_t number) {
    char name[32];
    snprintf(name, sizeof name, "piece-%06" PRIu32 ".off", number);
    struct output_file file = {0};
    char *path = path_join(folder, name);
    pir_mesh *mesh = path ? mesh_of(pieces, number) : NULL;
    const bool good = mesh && output_open(&file, path) && target_write_mesh(&file, mesh, true);
    output_discard(&file);
    pir_mesh_destroy(mesh);
    free(path);
    return good;
}

static bool write_folder(const pir_pieces *pieces, const char *folder) {
    int lock;
    bool good = folder_take(folder, &lock);
    for (uint32_t k = 0; good && k < pir_pieces_count(pieces); k++)
        good = write_piece(pieces, folder, k);
    folder_leave(lock);
    return good;
}

static bool print_json(const struct args *args, const struct outcome *outcome) {
    struct json json = json_new();
    json_add_text(&json, json.root, "model", args->positional[0]);
    json_add_number(&json, json.root, "reflex_edges", outcome->info.reflex_edges);
    json_add_text(&json, json.root, "method", method_names[outcome->did.method]);
    json_add_number(&json, json.root, "exact_pieces", outcome->did.exact_pieces);
    json_add_number(&json, json.root, "pieces", pir_pieces_count(outcome->pieces));
    json_add_number(&json, json.root, "error", outcome->did.error);
    json_add_number(&json, json.root, "volume", outcome->info.volume);
    json_add_number(&json, json.root, "seconds", outcome->seconds);
    return json_print(&json, stdout);
}

static void print_text(const struct args *args, const struct outcome *outcome) {
    char time[TEXT_NUMBER], error[TEXT_NUMBER];
    text_time(outcome->seconds * 1e9, time);
    text_double(outcome->did.error, error);
    say("%s in convex pieces\n", args->positional[0]);
    say("  %-10s %" PRIu32 ", by %s\n", "pieces", pir_pieces_count(outcome->pieces), method_names[outcome->did.method]);
    if (outcome->did.error > 0)
        say("  %-10s within %s of the solid, for %" PRIu32 " exact pieces\n", "error", error,
            outcome->did.exact_pieces);
    say("  %-10s %" PRIu32 "\n", "reflex", outcome->info.reflex_edges);
    say("  %-10s %s\n", "time", time);
    if (args_has(args, "-o"))
        say("  %-10s %s\n", "written to", args_value(args, "-o"));
}

#if PIR_HAVE_PNG
/* Each piece in a colour of its own. */
static bool write_picture(const pir_pieces *pieces, const char *path) {
    const uint32_t count = pir_pieces_count(pieces);
    struct output_file file = {0};
    pir_mesh **meshes = calloc(count, sizeof *meshes);
    bool good = meshes && output_open(&file, path);
    for (uint32_t k = 0; good && k < count; k++)
        good = (meshes[k] = mesh_of(pieces, k)) != NULL;
    good = good && solid_picture_write(&file, meshes, count);
    if (!meshes)
        complain_status("decompose", PIR_ERR_MEMORY, NULL);
    output_discard(&file);
    for (uint32_t k = 0; k < count && meshes; k++)
        pir_mesh_destroy(meshes[k]);
    free(meshes);
    return good;
}
#endif

static bool write(const pir_pieces *pieces, const char *path) {
#if PIR_HAVE_PNG
    if (output_ends_in(path, ".png"))
        return write_picture(pieces, path);
#endif
    const bool one_file = output_ends_in(path, ".obj") || output_is_stream(path);
    return one_file ? write_objects(pieces, path) : write_folder(pieces, path);
}

static int decompose(const struct args *args, const pir_solid *solid, const pir_decompose_options *options) {
    struct outcome outcome = {0};
    const char *path = args_value(args, "-o");
    pir_solid_describe(solid, &outcome.info);
    const int64_t start = clock_now();
    const pir_status status = pir_solid_decompose(solid, options, &outcome.did, &outcome.pieces);
    outcome.seconds = (double)(clock_now() - start) / 1e9;
    if (status != PIR_OK)
        return complain_status("decompose", status, options->report);
    int result = !path || write(outcome.pieces, path) ? EXIT_DONE : EXIT_BAD_INPUT;
    if (result == EXIT_DONE && args_has(args, "--json"))
        result = print_json(args, &outcome) ? EXIT_DONE : EXIT_BAD_INPUT;
    else if (result == EXIT_DONE && !target_is_stdout(args, "-o"))
        print_text(args, &outcome);
    pir_pieces_destroy(outcome.pieces);
    return result;
}

SUBCOMMAND(decompose) {
    pir_decompose_options options;
    pir_report report = {0};
    if (!target_check(args, "-o", NULL) || !read_options(args, &options))
        return EXIT_BAD_INPUT;
    pir_solid *solid = solid_load(args, 0);
    options.report = &report;
    const int result = solid ? decompose(args, solid, &options) : EXIT_BAD_INPUT;
    pir_solid_release(solid);
    return result;
}
