/* SPDX-License-Identifier: MIT */
/* See compound.h. Vertices are doubles within an ulp of the exact ones; boxes are wider than that. */
#include "solid/query/compound.h"

#include "base/vec.h"

/* The box of a piece, and how far it reaches. */
static pir_box box_of(const pir_polytope *piece, double *reach) {
    pir_box box = PIR_BOX_EMPTY;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++) {
        const pir_vec3 at = pir_polytope_vertex(piece, v);
        const double x[3] = {at.x, at.y, at.z};
        *reach = fmax(*reach, sqrt(pir_vec_dot(at, at)) * (1 + 0x1p-48));
        for (int k = 0; k < 3; k++) {
            const double room = fabs(x[k]) * 0x1p-50;
            box.low[k] = fmin(box.low[k], x[k] - room);
            box.high[k] = fmax(box.high[k], x[k] + room);
        }
    }
    return box;
}

pir_status pir_compound_init(pir_compound *compound, const pir_pieces *pieces, const pir_allocator *allocator) {
    const uint32_t count = pir_pieces_count(pieces);
    *compound = (pir_compound){.count = count, .piece = PIR_ZEROED(allocator, pir_polytope *, count)};
    pir_box *box = PIR_NEW(allocator, pir_box, count);
    pir_status status = box && compound->piece ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < count && status == PIR_OK; i++) {
        status = pir_pieces_polytope(pieces, i, &compound->piece[i]);
        if (status == PIR_OK)
            box[i] = box_of(compound->piece[i], &compound->reach);
    }
    if (status == PIR_OK && !pir_boxes_init(&compound->boxes, allocator, box, count))
        status = PIR_ERR_MEMORY;
    PIR_FREE(allocator, box, count);
    if (status != PIR_OK)
        pir_compound_finish(compound, allocator);
    return status;
}

void pir_compound_finish(pir_compound *compound, const pir_allocator *allocator) {
    for (uint32_t i = 0; i < compound->count && compound->piece; i++)
        pir_polytope_release(compound->piece[i]);
    pir_boxes_finish(&compound->boxes, allocator);
    PIR_FREE(allocator, compound->piece, compound->count);
    *compound = (pir_compound){0};
}
