/* SPDX-License-Identifier: MIT */
/* The pieces of a solid as the caller sees them. */
#include <pirouette/exact.h>
#include <pirouette/solid.h>

#include <math.h>

#include "base/options.h"
#include "base/report.h"
#include "solid/body/solid.h"
#include "solid/pieces/approximate.h"
#include "solid/pieces/join_pieces.h"
#include "solid/pieces/piece_list.h"
#include "solid/space/exact.h"

pir_pieces *pir_pieces_new(const pir_allocator *allocator, uint32_t count, uint32_t vertex_count) {
    pir_pieces *pieces = PIR_ZEROED(allocator, pir_pieces, 1);
    if (!pieces)
        return NULL;
    pieces->allocator = *allocator;
    pieces->count = count;
    pieces->vertex_count = vertex_count;
    pieces->start = PIR_ZEROED(allocator, uint32_t, (size_t)count + 1);
    pieces->vertex = PIR_NEW(allocator, mpq_t, 3 * (size_t)vertex_count);
    for (size_t i = 0; i < 3 * (size_t)vertex_count && pieces->vertex; i++)
        mpq_init(pieces->vertex[i]);
    if (pieces->start && pieces->vertex)
        return pieces;
    pir_pieces_destroy(pieces);
    return NULL;
}

void pir_pieces_destroy(pir_pieces *pieces) {
    if (!pieces)
        return;
    const pir_allocator a = pieces->allocator;
    const size_t numbers = 3 * (size_t)pieces->vertex_count;
    for (size_t i = 0; i < numbers && pieces->vertex; i++)
        mpq_clear(pieces->vertex[i]);
    PIR_FREE(&a, pieces->vertex, numbers);
    PIR_FREE(&a, pieces->start, (size_t)pieces->count + 1);
    PIR_FREE(&a, pieces, 1);
}

uint32_t pir_pieces_count(const pir_pieces *pieces) {
    return pieces->count;
}

pir_status pir_pieces_polytope(const pir_pieces *pieces, uint32_t index, pir_polytope **ret_polytope) {
    if (!pieces || index >= pieces->count || !ret_polytope)
        return PIR_ERR_ARGUMENT;
    const uint32_t first = pieces->start[index];
    const pir_polytope_options options = {sizeof options, &pieces->allocator, 0};
    return pir_polytope_create_exact((const mpq_t *)pieces->vertex + 3 * (size_t)first,
                                     pieces->start[index + 1] - first, &options, ret_polytope);
}

/* Whether this corner of the cell is the first with its point. */
static bool is_first(const pir_cells *cells, pir_cell cell, uint32_t corner) {
    for (uint32_t c = cells->face[cell.first].first; c < corner; c++)
        if (cells->corner[c] == cells->corner[corner])
            return false;
    return true;
}

/* The vertices of a cell one after the other: a corner from `from` on, or none. The corners of a cell are in a row. */
static uint32_t next_vertex(const pir_cells *cells, pir_cell cell, uint32_t from) {
    const pir_face *last = &cells->face[cell.first + cell.count - 1];
    while (from < last->first + last->count && !is_first(cells, cell, from))
        from++;
    return from < last->first + last->count ? from : PIR_SPACE_NONE;
}

static void set_vertex(mpq_t *vertex, pir_space *space, uint32_t point, const pir_scale *scale) {
    const uint32_t exact = pir_space_exact_point(space, point);
    mpz_t num, den;
    mpz_roinit_n(num, scale->num.limb, scale->num.size);
    mpz_roinit_n(den, scale->den.limb, scale->den.size);
    for (uint32_t k = 0; k < 3; k++) {
        mpz_mul(mpq_numref(vertex[k]), space->number[exact + k], num);
        mpz_mul(mpq_denref(vertex[k]), space->number[exact + 3], den);
        mpq_canonicalize(vertex[k]);
    }
}

static uint32_t vertices_of(const pir_cells *cells, pir_cell cell) {
    uint32_t count = 0;
    for (uint32_t c = cells->face[cell.first].first; (c = next_vertex(cells, cell, c)) != PIR_SPACE_NONE; c++)
        count++;
    return count;
}

/* The pieces of a list of cells. */
static pir_status keep(const pir_cells *cells, const pir_piece_list *list, const pir_scale *scale,
                       const pir_allocator *allocator, pir_pieces **ret_pieces) {
    uint32_t vertices = 0;
    for (uint32_t i = 0; i < list->count; i++)
        vertices += vertices_of(cells, cells->cell[list->cell[i]]);
    pir_pieces *pieces = pir_pieces_new(allocator, list->count, vertices);
    if (!pieces)
        return PIR_ERR_MEMORY;
    uint32_t at = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        const pir_cell cell = cells->cell[list->cell[i]];
        for (uint32_t c = cells->face[cell.first].first; (c = next_vertex(cells, cell, c)) != PIR_SPACE_NONE; c++)
            set_vertex(pieces->vertex + 3 * (size_t)at++, cells->space, cells->corner[c], scale);
        pieces->start[i + 1] = at;
    }
    *ret_pieces = pieces;
    return cells->space->status;
}

/* The exact pieces by one method, not the best. */
static pir_status decompose(const pir_solid *solid, const pir_solid_options *options, pir_decompose_method method,
                            pir_report *report, pir_pieces **ret_pieces) {
    pir_space space;
    pir_shell_body body = {0};
    pir_cells cells;
    pir_piece_list list = {0};
    pir_space_init(&space, options->allocator, options->memory, pir_vectors_bits(&solid->points) + 1);
    pir_cells_init(&cells, &space);
    pir_status status = pir_solid_body(solid, &space, &body);
    pir_space_begin_stage(&space, "dividing the solid", 0);
    if (status == PIR_OK)
        status = pir_decompose(&body, method, &cells, &list);
    if (status == PIR_OK) {
        pir_merge_pieces(&cells, &list);
        status = space.status;
    }
    if (status == PIR_OK)
        status = keep(&cells, &list, &solid->scale, options->allocator, ret_pieces);
    pir_piece_list_finish(&list, &space);
    pir_cells_finish(&cells);
    pir_shell_body_finish(&body);
    status = pir_space_outcome(&space, status, "decompose", report);
    pir_space_finish(&space);
    return status;
}

/* Decomposes by the method asked for; *method becomes the one that was used. */
static pir_status decompose_by(const pir_solid *solid, const pir_solid_options *options, pir_decompose_method *method,
                               pir_pieces **ret_pieces) {
    const bool both = *method == PIR_DECOMPOSE_BEST;
    *method = both ? PIR_DECOMPOSE_FACETS : *method;
    pir_status status = decompose(solid, options, *method, options->report, ret_pieces);
    if (status != PIR_OK || !both || (*ret_pieces)->count == 1)
        return status;
    pir_pieces *other = NULL;
    // one way that takes too much leaves the other
    status = decompose(solid, options, PIR_DECOMPOSE_WALLS, NULL, &other);
    if (status == PIR_OK && other->count < (*ret_pieces)->count) {
        pir_pieces *kept = other;
        other = *ret_pieces;
        *ret_pieces = kept;
        *method = PIR_DECOMPOSE_WALLS;
    }
    pir_pieces_destroy(other);
    return status == PIR_OK || status == PIR_ERR_LIMIT
               ? PIR_OK
               : pir_fail(options->report, status, "decompose: by walls: %s", pir_status_text(status));
}

static pir_status check(const pir_decompose_options *options) {
    if (options->method != PIR_DECOMPOSE_BEST && options->method != PIR_DECOMPOSE_FACETS &&
        options->method != PIR_DECOMPOSE_WALLS)
        return PIR_ERR_ARGUMENT;
    if (!isfinite(options->tolerance))
        return PIR_ERR_NOT_FINITE;
    return options->tolerance < 0 ? PIR_ERR_ARGUMENT : PIR_OK;
}

static pir_status approximate(pir_pieces **pieces, const pir_decompose_options *options, pir_decompose_info *info) {
    const pir_status status = pir_pieces_approximate(pieces, options->pieces, options->tolerance, &info->error);
    return status == PIR_OK ? status
                            : pir_fail(options->report, status, "decompose: into fewer pieces, of %u: %s",
                                       (unsigned)info->exact_pieces, pir_status_text(status));
}

pir_status pir_solid_decompose(const pir_solid *solid, const pir_decompose_options *options,
                               pir_decompose_info *ret_info, pir_pieces **ret_pieces) {
    if (!solid || !ret_pieces)
        return PIR_ERR_ARGUMENT;
    pir_decompose_options used = pir_decompose_options_default();
    pir_status status = pir_options_take("pir_decompose_options", options, &used, &used.report);
    if (status == PIR_OK)
        status = check(&used);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    const pir_solid_options common = {sizeof common, &allocator, used.memory, used.report};
    pir_decompose_info info = {.method = used.method};
    pir_pieces *pieces = NULL;
    status = decompose_by(solid, &common, &info.method, &pieces);
    if (status == PIR_OK)
        info.exact_pieces = pieces->count;
    if (status == PIR_OK && (used.tolerance > 0 || used.pieces > 0))
        status = approximate(&pieces, &used, &info);
    if (status != PIR_OK) {
        pir_pieces_destroy(pieces);
        return status;
    }
    if (ret_info)
        *ret_info = info;
    *ret_pieces = pieces;
    return PIR_OK;
}
