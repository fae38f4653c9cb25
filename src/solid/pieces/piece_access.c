/* SPDX-License-Identifier: MIT */
/* The pieces of a solid as the caller sees them: their vertices as rationals, in units of the model. */
#include <pirouette/exact.h>
#include <pirouette/solid.h>

#include "solid/body/solid.h"
#include "solid/pieces/join_pieces.h"
#include "solid/space/exact.h"

struct pir_pieces {
    pir_allocator allocator;
    uint32_t count, vertex_count;
    uint32_t *start; /* count + 1: the first vertex of each */
    mpq_t *vertex;   /* three a vertex */
};

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
    const pir_polytope_options options = {&pieces->allocator, 0};
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

static pir_status fill(pir_pieces *pieces, const pir_cells *cells, const pir_piece_list *list, const pir_scale *scale) {
    const pir_allocator *a = &pieces->allocator;
    pieces->count = list->count;
    pieces->start = PIR_ZEROED(a, uint32_t, (size_t)list->count + 1);
    if (!pieces->start)
        return PIR_ERR_MEMORY;
    uint32_t vertices = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        const pir_cell cell = cells->cell[list->cell[i]];
        for (uint32_t c = cells->face[cell.first].first; (c = next_vertex(cells, cell, c)) != PIR_SPACE_NONE; c++)
            vertices++;
    }
    pieces->vertex = PIR_NEW(a, mpq_t, 3 * (size_t)vertices);
    pieces->vertex_count = vertices;
    if (!pieces->vertex)
        return PIR_ERR_MEMORY;
    for (size_t i = 0; i < 3 * (size_t)vertices; i++)
        mpq_init(pieces->vertex[i]);
    uint32_t at = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        const pir_cell cell = cells->cell[list->cell[i]];
        for (uint32_t c = cells->face[cell.first].first; (c = next_vertex(cells, cell, c)) != PIR_SPACE_NONE; c++)
            set_vertex(pieces->vertex + 3 * (size_t)at++, cells->space, cells->corner[c], scale);
        pieces->start[i + 1] = at;
    }
    return cells->space->status;
}

static pir_status decompose(const pir_solid *solid, pir_space *space, pir_pieces *pieces) {
    pir_body body = {0};
    pir_cells cells;
    pir_piece_list list = {0};
    pir_cells_init(&cells, space);
    pir_status status = pir_solid_body(solid, space, &body);
    if (status == PIR_OK)
        status = pir_decompose(&body, &cells, &list);
    if (status == PIR_OK) {
        pir_merge_pieces(&cells, &list);
        status = space->status;
    }
    if (status == PIR_OK)
        status = fill(pieces, &cells, &list, &solid->scale);
    pir_piece_list_finish(&list, space);
    pir_cells_finish(&cells);
    pir_body_finish(&body);
    return status;
}

pir_status pir_solid_decompose(const pir_solid *solid, const pir_solid_options *options, pir_pieces **ret_pieces) {
    if (!solid || !ret_pieces)
        return PIR_ERR_ARGUMENT;
    pir_allocator allocator;
    const pir_solid_options used = pir_solid_options_or_default(options, &allocator);
    pir_pieces *pieces = PIR_ZEROED(&allocator, pir_pieces, 1);
    if (!pieces)
        return PIR_ERR_MEMORY;
    pieces->allocator = allocator;
    pir_space space;
    pir_space_init(&space, &allocator, used.memory, pir_vectors_bits(&solid->points) + 1);
    const pir_status status = decompose(solid, &space, pieces);
    pir_space_finish(&space);
    if (status != PIR_OK) {
        pir_pieces_destroy(pieces);
        return status;
    }
    *ret_pieces = pieces;
    return PIR_OK;
}
