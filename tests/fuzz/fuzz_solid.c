/* SPDX-License-Identifier: MIT */
/*
 * Bytes as a file of a model, or as cells of a grid, read as a solid: it is refused with a report of one line, or
 *
 *     its pieces, cut either way, have its volume exactly;
 *     the sum with another solid has the same volume when the other is turned back instead, and when both are open;
 *     what is written of the sum is read as a solid of that volume;
 *     the state of a placement, by pieces, is where the translation is in the open difference, by rationals.
 *
 * An engine finds LLVMFuzzerTestOneInput; standalone.c runs it over kept files. Work is bounded by refusing large
 * inputs, and solids of many facets or pieces.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/exact.h>
#include <pirouette/pirouette.h>

#include "fuzz/input.h"
#include "fuzz/solid_oracle.h"
#include "support/solid_sums.h"

#define SIZE_LIMIT   2048
#define FACET_LIMIT  80
#define PIECE_LIMIT  20
#define MEMORY_LIMIT ((size_t)1 << 28)

static pir_solid_options limits(void) {
    pir_solid_options options = pir_solid_options_default();
    options.memory = MEMORY_LIMIT;
    return options;
}

/* What may end for its size alone. */
static int is_done(pir_status status, const char *what) {
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, what);
    return status == PIR_OK;
}

/* --- solids of bytes --- */

static pir_solid *solid_of_file(const uint8_t *data, size_t size, const char *format) {
    const pir_solid_options options = limits();
    pir_report report = {PIR_OK, ""};
    pir_solid *solid = NULL;
    const pir_status status =
        pir_solid_read_bytes(&(pir_file_bytes){data, size, "fuzz", format}, &options, &report, &solid);
    if (status != PIR_OK) {
        fuzz_require(!solid && report.status == status, "a refusal makes nothing and is reported");
        fuzz_require(strncmp(report.text, "fuzz:", 5) == 0 && !strpbrk(report.text, "\n\r"),
                     "a report is one line that says where");
    }
    return solid;
}

/* The cells of a grid of `side` cells a side that bits of the input fill, as OFF with a facet for each side of a cell
 * that is not another's. */
static pir_solid *solid_of_cells(struct fuzz_input *input, int side) {
    static const int way[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    static const int loop[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    char facets[32 * 162], text[128 * 27 + sizeof facets];
    int full[5][5][5] = {{{0}}}, points = 0, count = 0, at = 0, end = 0;
    for (int i = 0; i < side * side * side; i++)
        full[1 + i % side][1 + i / side % side][1 + i / side / side] = fuzz_byte(input) & 1;
    char body[128 * 27] = "";
    for (int i = 0; i < 27; i++) {
        const int c[3] = {1 + i % 3, 1 + i / 3 % 3, 1 + i / 9};
        if (!full[c[0]][c[1]][c[2]])
            continue;
        for (int f = 0; f < 6; f++)
            if (!full[c[0] + way[f][0]][c[1] + way[f][1]][c[2] + way[f][2]]) {
                end += snprintf(facets + end, sizeof facets - (size_t)end, "4 %d %d %d %d\n", points + loop[f][0],
                                points + loop[f][1], points + loop[f][2], points + loop[f][3]);
                count++;
            }
        for (int k = 0; k < 8; k++)
            at += snprintf(body + at, sizeof body - (size_t)at, "%d %d %d\n", c[0] + (k & 1), c[1] + (k >> 1 & 1),
                           c[2] + (k >> 2));
        points += 8;
    }
    const int size = count == 0 ? 0 : snprintf(text, sizeof text, "OFF %d %d 0\n%s%s", points, count, body, facets);
    pir_solid *solid = size > 0 ? solid_of_file((const uint8_t *)text, (size_t)size, "off") : NULL;
    fuzz_require(size == 0 || solid, "cells are a solid, however they touch");
    return solid;
}

/* One of a few solids to add. */
static pir_solid *solid_by_number(unsigned number) {
    static const char *const shapes[] = {"cube", "octahedron", "box?x=1&y=1&z=1", "tetrahedron"};
    static const char hook[] =
        "OFF 12 8 0\n0 0 0\n3 0 0\n3 1 0\n1 1 0\n1 3 0\n0 3 0\n0 0 1\n3 0 1\n3 1 1\n1 1 1\n1 3 1\n"
        "0 3 1\n6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n4 0 1 7 6\n4 1 2 8 7\n4 2 3 9 8\n4 3 4 10 9\n"
        "4 4 5 11 10\n4 5 0 6 11\n";
    pir_polytope *shape = NULL;
    pir_solid *solid = NULL;
    if (number % 5 == 4)
        return solid_of_file((const uint8_t *)hook, sizeof hook - 1, "off");
    if (pir_shape_create(shapes[number % 5], NULL, NULL, &shape) == PIR_OK)
        pir_solid_from_polytope(shape, NULL, &solid);
    pir_polytope_release(shape);
    return solid;
}

/* --- what must hold --- */

/* The pieces, of the solid's volume; NULL where there are too many. */
static pir_pieces *check_pieces(const pir_solid *solid, pir_decompose_method method) {
    pir_decompose_options options = pir_decompose_options_default();
    pir_pieces *pieces = NULL;
    options.memory = MEMORY_LIMIT;
    options.method = method;
    if (!is_done(pir_solid_decompose(solid, &options, NULL, &pieces), "a solid has pieces"))
        return NULL;
    mpq_t sum, volume, middle[3], inertia[6];
    mpq_inits(sum, volume, NULL);
    for (int k = 0; k < 9; k++)
        mpq_init(k < 3 ? middle[k] : inertia[k - 3]);
    int whole = 1;
    for (uint32_t k = 0; k < pir_pieces_count(pieces) && whole; k++) {
        pir_polytope *piece = NULL;
        whole = is_done(pir_pieces_polytope(pieces, k, &piece), "a piece is a polytope") &&
                is_done(pir_polytope_mass_exact(piece, volume, middle, inertia), "a piece has a volume");
        mpq_add(sum, sum, volume);
        pir_polytope_release(piece);
    }
    pir_solid_volume_exact(solid, volume);
    fuzz_require(!whole || mpq_equal(sum, volume), "volumes of pieces add up to the solid's");
    for (int k = 0; k < 9; k++)
        mpq_clear(k < 3 ? middle[k] : inertia[k - 3]);
    mpq_clears(sum, volume, NULL);
    if (whole && pir_pieces_count(pieces) <= PIECE_LIMIT)
        return pieces;
    pir_pieces_destroy(pieces);
    return NULL;
}

/* What is written is read again. */
static void check_again(const pir_mesh *mesh, mpq_t volume) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    pir_report report = {PIR_OK, ""};
    pir_solid *solid = NULL;
    mpq_t again;
    mpq_init(again);
    fuzz_require(file && pir_mesh_write_stream(mesh, file, "sum", "off", 1, &report) == PIR_OK, report.text);
    fclose(file);
    const pir_status status = pir_solid_read_bytes(&(pir_file_bytes){text, size, "sum", "off"}, NULL, &report, &solid);
    fuzz_require(status == PIR_OK || status == PIR_ERR_LIMIT, report.text);
    if (solid)
        pir_solid_volume_exact(solid, again);
    fuzz_require(!solid || mpq_equal(again, volume), "a sum that is read again has its volume");
    pir_solid_release(solid);
    mpq_clear(again);
    free(text);
}

static void check_sum(const pir_solid *p, const pir_solid *q, pir_quat turn) {
    pir_solid_sum_options options = pir_solid_sum_options_default();
    const pir_quat back = {-turn.x, -turn.y, -turn.z, turn.w};
    pir_mesh *mesh[3] = {NULL, NULL, NULL};
    mpq_t volume[3];
    mpq_inits(volume[0], volume[1], volume[2], NULL);
    options.memory = MEMORY_LIMIT;
    int done = 1;
    for (int k = 0; k < 3 && done; k++) {
        options.open = k == 2;
        done = is_done(solid_sum_mesh(k == 1 ? q : p, k == 1 ? p : q, k == 1 ? back : turn, &options, NULL, &mesh[k]),
                       "two solids have a sum");
        if (done)
            oracle_volume(mesh[k], volume[k]);
    }
    fuzz_require(!done || mpq_equal(volume[0], volume[1]), "a sum has the volume of that turned back");
    fuzz_require(!done || mpq_equal(volume[0], volume[2]), "an open sum has the volume of the closed one");
    if (done)
        check_again(mesh[0], volume[0]);
    for (int k = 0; k < 3; k++)
        pir_mesh_destroy(mesh[k]);
    mpq_clears(volume[0], volume[1], volume[2], NULL);
}

struct scene {
    const pir_solid *p, *q;
    const pir_pieces *of_p, *of_q;
    pir_quat turn;
};

static void check_states(const struct scene *scene, struct fuzz_input *input) {
    pir_solid_sum_options options = pir_solid_sum_options_default();
    pir_mesh *mesh = NULL;
    pir_solid_query *query = NULL;
    pir_workspace *workspace = NULL;
    options.memory = MEMORY_LIMIT;
    options.open = options.difference = true;
    if (!is_done(solid_sum_mesh(scene->p, scene->q, scene->turn, &options, NULL, &mesh), "a difference"))
        return;
    fuzz_require(pir_solid_query_create(scene->of_p, scene->of_q, NULL, &query) == PIR_OK &&
                     pir_workspace_create(NULL, &workspace) == PIR_OK,
                 "a query is made");
    const uint32_t count = pir_mesh_vertex_count(mesh);
    for (uint32_t n = 0; n < 8; n++) {
        pir_pair_input at = pir_pair_input_default();
        pir_solid_distance distance;
        pir_state state;
        const pir_vec3 corner = pir_mesh_vertices(mesh)[(fuzz_byte(input) + 97 * n) % count];
        at.pose_p.rotation = scene->turn;
        // half of them at what may be a vertex, or between it and others
        at.pose_p.translation =
            n % 2 ? corner
                  : (pir_vec3){fuzz_small(input) / 8.0, fuzz_small(input) / 8.0, (fuzz_small(input) + (int)n) / 8.0};
        if (pir_solid_query_overlap(query, workspace, &at, &state) != PIR_OK)
            continue;
        fuzz_require(state == oracle_state(mesh, at.pose_p.translation), "the state is that of the difference");
        fuzz_require(pir_solid_query_distance(query, workspace, &at, &distance) != PIR_OK ||
                         distance.result.state == state,
                     "the state is that of the distance");
    }
    pir_workspace_destroy(workspace);
    pir_solid_query_destroy(query);
    pir_mesh_destroy(mesh);
}

static void check_solids(const pir_solid *p, const pir_solid *q, pir_quat turn, struct fuzz_input *input) {
    pir_solid_info info;
    pir_solid_describe(p, &info);
    if (info.facets > FACET_LIMIT)
        return;
    pir_pieces *walls = check_pieces(p, PIR_DECOMPOSE_WALLS);
    struct scene scene = {.p = p, .q = q, .turn = turn};
    pir_pieces *of_p = check_pieces(p, PIR_DECOMPOSE_FACETS), *of_q = check_pieces(q, PIR_DECOMPOSE_FACETS);
    scene.of_p = of_p;
    scene.of_q = of_q;
    if (of_p && of_q) {
        check_sum(p, q, turn);
        check_states(&scene, input);
    }
    pir_pieces_destroy(of_q);
    pir_pieces_destroy(of_p);
    pir_pieces_destroy(walls);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const formats[] = {"off", "obj", "stl", "ply"};
    struct fuzz_input input = {data, size, 0};
    if (size > SIZE_LIMIT || size < 24)
        return 0;
    const unsigned kind = fuzz_byte(&input);
    pir_quat turn = {fuzz_small(&input) % 4, fuzz_small(&input) % 4, fuzz_small(&input) % 4, fuzz_small(&input) % 4};
    if (!fuzz_is_rotation(turn))
        turn.w = 1;
    // places come from the 16 bytes after, what is left is the file
    struct fuzz_input places = {data + input.at, 16, 0};
    input.at += 16;
    pir_solid *p =
        kind & 1 ? solid_of_cells(&input, 3) : solid_of_file(data + input.at, size - input.at, formats[kind >> 1 & 3]);
    pir_solid *q = kind & 64 ? solid_of_cells(&places, 2) : solid_by_number(kind >> 3 & 7);
    places.at = 0;
    if (p && q)
        check_solids(p, q, turn, &places);
    pir_solid_release(q);
    pir_solid_release(p);
    return 0;
}
