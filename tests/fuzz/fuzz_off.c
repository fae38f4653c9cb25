/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as OFF text: they are refused with a report of one line, or make a valid polytope that survives being
 * written, exactly and as doubles, and read again.
 *
 * An engine finds LLVMFuzzerTestOneInput; standalone.c runs it over kept files. Work is bounded by refusing large
 * inputs.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "fuzz/input.h"
#include "polytope/write/write_off.h"

#define SIZE_LIMIT   65536
#define VERTEX_LIMIT 512

/* More points than the limit, as far as the text's first two numbers say. */
static int promises_too_much(const char *text, size_t size) {
    char head[256];
    unsigned long vertices = 0;
    size_t length = size < sizeof head - 1 ? size : sizeof head - 1;
    memcpy(head, text, length);
    head[length] = '\0';
    const char *off = strstr(head, "OFF");
    return !off || (sscanf(off + 3, "%lu", &vertices) == 1 && vertices > VERTEX_LIMIT);
}

/* The mesh as OFF, read again. */
static pir_polytope *write_and_read(const pir_mesh *mesh, bool exact) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    fuzz_require(file != NULL, "a stream in memory");
    fuzz_require(pir_mesh_write_off(mesh, file, exact) == PIR_OK, "the mesh is written");
    fclose(file);
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    pir_status status =
        pir_polytope_read_bytes(&(pir_file_bytes){text, size, "written", "off"}, NULL, &report, NULL, &polytope);
    if (status == PIR_ERR_LIMIT && exact)
        polytope = NULL; // a reduced fraction may be longer than the text that it came from
    else
        fuzz_require(status == PIR_OK, report.text);
    free(text);
    return polytope;
}

/* Exact text brings back the same mesh; doubles bring back a hull of no more vertices than were written. */
static void check_round_trips(const pir_polytope *polytope) {
    pir_mesh *mesh = NULL, *again = NULL;
    fuzz_require(pir_mesh_from_polytope(polytope, &mesh) == PIR_OK, "a mesh is made");
    pir_polytope *copy = write_and_read(mesh, true);
    if (copy) {
        fuzz_require(pir_mesh_from_polytope(copy, &again) == PIR_OK, "a mesh is made again");
        fuzz_require(pir_mesh_equal(mesh, again), "exact text brings back the same mesh");
        pir_mesh_destroy(again);
        pir_polytope_release(copy);
    }
    copy = write_and_read(mesh, false);
    fuzz_require(pir_polytope_is_valid(copy) == 1, "the polytope of the rounded vertices is valid");
    fuzz_require(pir_polytope_vertex_count(copy) <= pir_mesh_vertex_count(mesh), "rounding makes no vertices");
    pir_polytope_release(copy);
    pir_mesh_destroy(mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size > SIZE_LIMIT || promises_too_much((const char *)data, size))
        return 0;
    pir_polytope *polytope = NULL;
    pir_report report = {PIR_OK, ""};
    pir_status status = pir_polytope_read_bytes(&(pir_file_bytes){(const char *)data, size, "fuzz", "off"}, NULL,
                                                &report, NULL, &polytope);
    if (status != PIR_OK) {
        fuzz_require(polytope == NULL && report.status == status, "a refusal makes nothing and is reported");
        fuzz_require(strncmp(report.text, "fuzz:", 5) == 0 && !strchr(report.text, '\n'),
                     "a report is one line that says where");
        return 0;
    }
    fuzz_require(pir_polytope_is_valid(polytope) == 1, "the polytope is valid");
    check_round_trips(polytope);
    pir_polytope_release(polytope);
    return 0;
}
