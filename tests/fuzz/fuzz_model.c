/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as a model of each format: they are refused with a report of one line, or make a valid polytope; and a
 * model that passes for convex is still one when its hull is written and read again.
 *
 * An engine finds LLVMFuzzerTestOneInput; standalone.c runs it over kept files. Work is bounded by refusing large
 * inputs.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "fuzz/input.h"

#define SIZE_LIMIT 65536

/* The hull as OFF in rationals. It is convex, of the same volume, and nothing of it is lost. */
static void check_hull(const pir_polytope *polytope) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    pir_mesh *mesh = NULL;
    pir_report report = {PIR_OK, ""};
    fuzz_require(file != NULL && pir_mesh_from_polytope(polytope, &mesh) == PIR_OK, "a mesh is made");
    fuzz_require(pir_mesh_write_stream(mesh, file, "hull", "off", 1, &report) == PIR_OK, report.text);
    fclose(file);
    pir_read_options options = pir_read_options_default();
    options.require_convex = true;
    pir_surface surface;
    pir_polytope *again = NULL;
    pir_status status =
        pir_polytope_read_bytes(&(pir_file_bytes){text, size, "hull", "off"}, &options, &report, &surface, &again);
    // a reduced fraction may be longer than the text that it came from
    if (status != PIR_ERR_LIMIT) {
        fuzz_require(status == PIR_OK, report.text);
        fuzz_require(pir_polytope_vertex_count(again) == pir_polytope_vertex_count(polytope), "no vertex is lost");
        fuzz_require(surface.convex && (surface.form == PIR_SURFACE_CLOSED) == (surface.facets > 0),
                     "a hull is convex");
    }
    pir_polytope_release(again);
    pir_mesh_destroy(mesh);
    free(text);
}

/* What a surface says of itself must hold together. */
static void check_surface(const pir_surface *surface, const pir_polytope *polytope) {
    fuzz_require(surface->points >= pir_polytope_vertex_count(polytope), "vertices are points");
    fuzz_require((surface->form == PIR_SURFACE_POINTS) == (surface->facets == 0), "points have no facets");
    fuzz_require(surface->form != PIR_SURFACE_OPEN || !surface->convex, "what is open is not convex");
    fuzz_require(surface->form != PIR_SURFACE_POINTS || isnan(surface->volume), "points enclose nothing");
    fuzz_require(surface->form != PIR_SURFACE_CLOSED || !surface->convex || !isnan(surface->volume),
                 "what is convex has a volume");
}

static void run_format(const uint8_t *data, size_t size, const char *format) {
    pir_polytope *polytope = NULL, *convex = NULL;
    pir_report report = {PIR_OK, ""};
    pir_surface surface;
    pir_read_options options = pir_read_options_default();
    pir_status status =
        pir_polytope_read_bytes(&(pir_file_bytes){data, size, "fuzz", format}, &options, &report, &surface, &polytope);
    if (status != PIR_OK) {
        fuzz_require(polytope == NULL && report.status == status, "a refusal makes nothing and is reported");
        fuzz_require(strncmp(report.text, "fuzz:", 5) == 0 && !strpbrk(report.text, "\n\r"),
                     "a report is one line that says where");
        return;
    }
    fuzz_require(pir_polytope_is_valid(polytope) == 1, "the polytope is valid");
    check_surface(&surface, polytope);
    options.require_convex = true;
    status = pir_polytope_read_bytes(&(pir_file_bytes){data, size, "fuzz", format}, &options, &report, NULL, &convex);
    fuzz_require((status == PIR_OK) == (surface.convex != 0), "require_convex refuses what is not convex");
    fuzz_require(status == PIR_OK || (status == PIR_ERR_NOT_CLOSED) == (surface.form == PIR_SURFACE_OPEN),
                 "what is open is refused for that");
    check_hull(polytope);
    pir_polytope_release(convex);
    pir_polytope_release(polytope);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const formats[] = {"off", "obj", "stl", "ply"};
    for (size_t i = 0; size <= SIZE_LIMIT && i < sizeof formats / sizeof *formats; i++)
        run_format(data, size, formats[i]);
    return 0;
}
