/* SPDX-License-Identifier: MIT */
/* See compound.h. Vertices are doubles within an ulp of the exact ones; boxes are wider than that. */
#include "solid/pieces/compound.h"

#include "base/vec.h"

/* The box of a piece, and how far it reaches. */
static pir_space_box box_of(const pir_polytope *piece, double *reach) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++) {
        const pir_vec3 at = pir_polytope_vertex(piece, v);
        const double x[3] = {at.x, at.y, at.z};
        *reach = fmax(*reach, sqrt(pir_vec_dot(at, at)) * (1 + 0x1p-48));
        for (int k = 0; k < 3; k++) {
            const double error = fabs(x[k]) * 0x1p-50;
            box.low[k] = fmin(box.low[k], x[k] - error);
            box.high[k] = fmax(box.high[k], x[k] + error);
        }
    }
    return box;
}

static bool reserve_faces(pir_compound *c, const pir_allocator *a) {
    c->vertex_start = PIR_ZEROED(a, uint32_t, (size_t)c->count + 1);
    c->face_start = PIR_ZEROED(a, uint32_t, (size_t)c->count + 1);
    if (!c->vertex_start || !c->face_start)
        return false;
    for (uint32_t i = 0; i < c->count; i++) {
        c->vertex_start[i + 1] = c->vertex_start[i] + pir_polytope_vertex_count(c->piece[i]);
        c->face_start[i + 1] = c->face_start[i] + pir_polytope_facet_count(c->piece[i]);
    }
    c->vertex = (double(*)[3])PIR_NEW(a, double, 3 * (size_t)c->vertex_start[c->count]);
    c->face = PIR_NEW(a, pir_compound_face, c->face_start[c->count]);
    c->middle = (double(*)[3])PIR_NEW(a, double, 3 * (size_t)c->count);
    return c->vertex && c->face && c->middle;
}

/* The vertices and faces of a piece. A plane's height is that of the piece's highest vertex along the normal. */
static void fill_faces(pir_compound *c, uint32_t i) {
    const pir_polytope *piece = c->piece[i];
    const uint32_t vertices = pir_polytope_vertex_count(piece);
    double(*vertex)[3] = c->vertex + c->vertex_start[i];
    pir_vec3 sum = {0, 0, 0};
    for (uint32_t v = 0; v < vertices; v++) {
        const pir_vec3 at = pir_polytope_vertex(piece, v);
        vertex[v][0] = at.x;
        vertex[v][1] = at.y;
        vertex[v][2] = at.z;
        sum = pir_vec_add(sum, at);
    }
    c->middle[i][0] = sum.x / vertices;
    c->middle[i][1] = sum.y / vertices;
    c->middle[i][2] = sum.z / vertices;
    for (uint32_t f = 0; f < pir_polytope_facet_count(piece); f++) {
        const pir_vec3 n = pir_polytope_normal(piece, f);
        double highest = -HUGE_VAL;
        for (uint32_t v = 0; v < vertices; v++)
            highest = fmax(highest, n.x * vertex[v][0] + n.y * vertex[v][1] + n.z * vertex[v][2]);
        c->face[c->face_start[i] + f] = (pir_compound_face){{n.x, n.y, n.z}, highest};
    }
}

pir_status pir_compound_init(pir_compound *compound, const pir_pieces *pieces, const pir_allocator *allocator) {
    const uint32_t count = pir_pieces_count(pieces);
    *compound = (pir_compound){.count = count, .piece = PIR_ZEROED(allocator, pir_polytope *, count)};
    pir_space_box *box = PIR_NEW(allocator, pir_space_box, count);
    pir_status status = box && compound->piece ? PIR_OK : PIR_ERR_MEMORY;
    for (uint32_t i = 0; i < count && status == PIR_OK; i++) {
        status = pir_pieces_polytope(pieces, i, &compound->piece[i]);
        if (status == PIR_OK)
            box[i] = box_of(compound->piece[i], &compound->reach);
    }
    if (status == PIR_OK && !pir_boxes_init(&compound->boxes, allocator, box, count))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        compound->turned = PIR_ZEROED(allocator, pir_turned_box, (size_t)compound->boxes.node_count + count);
        if (!compound->turned || !reserve_faces(compound, allocator))
            status = PIR_ERR_MEMORY;
    }
    for (uint32_t i = 0; i < count && status == PIR_OK; i++)
        fill_faces(compound, i);
    PIR_FREE(allocator, box, count);
    if (status != PIR_OK)
        pir_compound_finish(compound, allocator);
    return status;
}

void pir_compound_finish(pir_compound *compound, const pir_allocator *allocator) {
    const size_t ends = (size_t)compound->count + 1;
    if (compound->vertex_start && compound->face_start) {
        PIR_FREE(allocator, (double *)compound->vertex, 3 * (size_t)compound->vertex_start[compound->count]);
        PIR_FREE(allocator, compound->face, compound->face_start[compound->count]);
        PIR_FREE(allocator, (double *)compound->middle, 3 * (size_t)compound->count);
    }
    if (compound->turned)
        PIR_FREE(allocator, compound->turned, (size_t)compound->boxes.node_count + compound->count);
    PIR_FREE(allocator, compound->vertex_start, ends);
    PIR_FREE(allocator, compound->face_start, ends);
    for (uint32_t i = 0; i < compound->count && compound->piece; i++)
        pir_polytope_release(compound->piece[i]);
    pir_boxes_finish(&compound->boxes, allocator);
    PIR_FREE(allocator, compound->piece, compound->count);
    *compound = (pir_compound){0};
}
