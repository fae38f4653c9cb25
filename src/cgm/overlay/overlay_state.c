/* SPDX-License-Identifier: MIT */
/* See overlay_state.h. */
#include "cgm/overlay/overlay_state.h"

#include <string.h>

/* --- memory --- */

static bool allocate(struct pir_overlay *o) {
    const pir_allocator *allocator = &o->allocator;
    const pir_cgm *a = o->a, *b = o->b;
    size_t va = pir_cgm_vertices(a), ea = pir_cgm_edges(a), vb = pir_cgm_vertices(b), eb = pir_cgm_edges(b);
    o->where = PIR_ZEROED(allocator, struct pir_location, va);
    o->a_vertex = PIR_NEW(allocator, uint32_t, va);
    o->queue = PIR_NEW(allocator, uint32_t, va);
    o->run = PIR_NEW(allocator, struct pir_overlay_run, ea);
    o->b_vertex = PIR_NEW(allocator, uint32_t, vb);
    o->first_record = PIR_NEW(allocator, uint32_t, eb);
    o->first_cover = PIR_NEW(allocator, uint32_t, eb);
    o->piece_start = PIR_NEW(allocator, uint32_t, eb + 1);
    o->half_position = PIR_NEW(allocator, uint32_t, 2 * eb);
    o->face_position = PIR_NEW(allocator, uint32_t, pir_cgm_faces(b));
    // two rings, or twice the points within an edge of b: each is on an edge of a or at a vertex of it
    o->list = PIR_NEW(allocator, uint32_t, 2 * (ea + eb + va) + 4);
    if (!o->where || !o->a_vertex || !o->queue || !o->run || !o->b_vertex || !o->first_record || !o->first_cover ||
        !o->piece_start || !o->half_position || !o->face_position || !o->list)
        return false;
    memset(o->b_vertex, 0xff, vb * sizeof *o->b_vertex);
    memset(o->first_record, 0xff, eb * sizeof *o->first_record);
    memset(o->first_cover, 0xff, eb * sizeof *o->first_cover);
    for (size_t e = 0; e < ea; e++)
        o->run[e] = (struct pir_overlay_run){1, 0, 0};
    return pir_cgm_sides_init(&o->sides, allocator, o->result, o->result);
}

void pir_overlay_finish(struct pir_overlay *o) {
    const pir_allocator *allocator = &o->allocator;
    const pir_cgm *a = o->a, *b = o->b;
    size_t va = pir_cgm_vertices(a), ea = pir_cgm_edges(a), vb = pir_cgm_vertices(b), eb = pir_cgm_edges(b);
    PIR_FREE(allocator, o->joint, o->joint_capacity);
    PIR_FREE(allocator, o->seam, o->seam_capacity);
    PIR_FREE(allocator, o->record, o->record_capacity);
    PIR_FREE(allocator, o->piece, o->piece_capacity);
    PIR_FREE(allocator, o->where, va);
    PIR_FREE(allocator, o->a_vertex, va);
    PIR_FREE(allocator, o->queue, va);
    PIR_FREE(allocator, o->run, ea);
    PIR_FREE(allocator, o->b_vertex, vb);
    PIR_FREE(allocator, o->first_record, eb);
    PIR_FREE(allocator, o->first_cover, eb);
    PIR_FREE(allocator, o->piece_start, eb + 1);
    PIR_FREE(allocator, o->half_position, 2 * eb);
    PIR_FREE(allocator, o->face_position, pir_cgm_faces(b));
    PIR_FREE(allocator, o->list, 2 * (ea + eb + va) + 4);
    pir_cgm_sides_finish(&o->sides, allocator);
}

/* Room for what overlays usually take, so that it seldom grows: two spheres in general position add half as many
   crossings as both have arcs. */
static bool reserve(struct pir_overlay *o) {
    uint32_t vertices = pir_cgm_vertices(o->a) + pir_cgm_vertices(o->b),
             edges = pir_cgm_edges(o->a) + pir_cgm_edges(o->b);
    vertices += vertices / 2;
    edges += edges / 2;
    void *joint = NULL, *seam = NULL, *piece = NULL, *record = NULL;
    bool done = pir_cgm_reserve_vertices(o->result, 0, vertices) && pir_cgm_reserve_edges(o->result, 0, edges) &&
                pir_cgm_grow(&o->allocator, &joint, &o->joint_capacity, vertices, sizeof *o->joint) &&
                pir_cgm_grow(&o->allocator, &seam, &o->seam_capacity, edges, sizeof *o->seam) &&
                pir_cgm_grow(&o->allocator, &piece, &o->piece_capacity, edges, sizeof *o->piece) &&
                pir_cgm_grow(&o->allocator, &record, &o->record_capacity, vertices, sizeof *o->record);
    o->joint = joint;
    o->seam = seam;
    o->piece = piece;
    o->record = record;
    return done;
}

bool pir_overlay_init(struct pir_overlay *overlay, const pir_cgm *a, const pir_cgm *b) {
    *overlay = (struct pir_overlay){.a = a, .b = b, .allocator = a->allocator};
    overlay->result = pir_cgm_new(&a->allocator, a, b);
    return overlay->result && allocate(overlay) && reserve(overlay);
}

/* --- vertices, edges, records --- */

uint32_t pir_overlay_add_vertex(struct pir_overlay *o, uint32_t map, const struct pir_cgm_point *point, uint8_t place) {
    void *block = o->joint;
    bool done = pir_cgm_reserve_vertices(o->result, o->vertices, 1) &&
                pir_cgm_grow(&o->allocator, &block, &o->joint_capacity, o->vertices + 1, sizeof *o->joint);
    o->joint = block;
    if (!done)
        return PIR_CGM_NONE;
    o->result->vertex[o->vertices] =
        (struct pir_cgm_vertex){.point = *point, .out = PIR_CGM_NONE, .place = place, .map = (uint8_t)map};
    memset(&o->joint[o->vertices], 0xff, sizeof *o->joint);
    return o->vertices++;
}

uint32_t pir_overlay_vertex_of_b(struct pir_overlay *o, uint32_t w) {
    if (o->b_vertex[w] != PIR_CGM_NONE)
        return o->b_vertex[w];
    const struct pir_cgm_vertex *from = &o->b->vertex[w];
    struct pir_cgm_point point = from->point;
    // its lines and facets are numbered after those of a
    if (point.b == PIR_CGM_NONE) {
        point.a += o->a->normal_count;
    } else {
        point.a = pir_overlay_line(o, point.a);
        point.b = pir_overlay_line(o, point.b);
    }
    uint32_t v = pir_overlay_add_vertex(o, from->map, &point, from->place);
    if (v != PIR_CGM_NONE)
        o->joint[v].b = w;
    return o->b_vertex[w] = v;
}

uint32_t pir_overlay_add_edge(struct pir_overlay *o, uint32_t from, uint32_t to, uint32_t line,
                              struct pir_overlay_seam seam) {
    pir_cgm *r = o->result;
    void *block = o->seam;
    bool done = pir_cgm_reserve_edges(r, o->edges, 1) &&
                pir_cgm_grow(&o->allocator, &block, &o->seam_capacity, o->edges + 1, sizeof *o->seam);
    o->seam = block;
    if (!done)
        return PIR_CGM_NONE;
    r->half[2 * o->edges].origin = from;
    r->half[2 * o->edges + 1].origin = to;
    r->edge_line[o->edges] = line;
    o->seam[o->edges] = seam;
    return o->edges++;
}

bool pir_overlay_add_record(struct pir_overlay *o, uint32_t v, uint32_t e) {
    void *block = o->record;
    bool done = pir_cgm_grow(&o->allocator, &block, &o->record_capacity, o->record_count + 1, sizeof *o->record);
    o->record = block;
    if (!done)
        return false;
    o->record[o->record_count] = (struct pir_record){v, o->first_record[e], PIR_CGM_NONE};
    o->first_record[e] = o->joint[v].record = o->record_count++;
    return true;
}
