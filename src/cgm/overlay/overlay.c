/* SPDX-License-Identifier: MIT */
/*
 * The overlay of two maps: the map of the Minkowski sum. Six times, for each face of the cube: merge the two rims, walk
 * a's edges through b's faces, put the pieces together.
 */
#include "cgm/overlay/overlay.h"

#include <string.h>

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

uint32_t pir_overlay_add_edge(struct pir_overlay *o, uint32_t from, uint32_t to, uint32_t line, struct pir_seam seam) {
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

/* --- rims --- */

/* Adds the vertices of one side but for its last corner, in order; *va and *vb go on to that corner. */
static bool merge_side(struct pir_overlay *o, uint32_t map, uint32_t side, uint32_t *va, uint32_t *vb) {
    const pir_cgm *a = o->a, *b = o->b;
    uint32_t line = pir_side_line(map, side), i = *va, j = *vb;
    uint32_t a_end = a->vertex_start[map] + a->rim[map], b_end = b->vertex_start[map] + b->rim[map];
    do {
        // the corner first: it is in both
        bool more_a = i < a_end && (i == *va || a->vertex[i].place == PIR_CGM_EDGE);
        bool more_b = j < b_end && (j == *vb || b->vertex[j].place == PIR_CGM_EDGE);
        if (!more_a && !more_b)
            break;
        int order = !more_b ? 1 : !more_a ? -1 : 0;
        if (more_a && more_b && i != *va)
            order = pir_cgm_ahead(&o->sides, a, line, a, &a->vertex[i].point, b, &b->vertex[j].point);
        uint32_t v = order <= 0 ? pir_overlay_vertex_of_b(o, j)
                                : pir_overlay_add_vertex(o, map, &a->vertex[i].point, PIR_CGM_EDGE);
        if (v == PIR_CGM_NONE)
            return false;
        if (order >= 0) {
            o->joint[v].a = i;
            o->a_vertex[i] = v;
            o->where[i] = (struct pir_location){PIR_AT_VERTEX, j};
            if (order > 0) {
                // alone it is within the side that the last vertex of b starts
                uint32_t on = b->vertex[j - 1].out;
                o->where[i] = (struct pir_location){PIR_ON_EDGE, on};
                if (!pir_overlay_add_record(o, v, on >> 1))
                    return false;
            }
            i++;
        }
        j += order <= 0;
    } while (true);
    *va = i, *vb = j;
    return true;
}

static bool merge_rims(struct pir_overlay *o, uint32_t map) {
    pir_cgm *r = o->result;
    const pir_cgm *a = o->a, *b = o->b;
    uint32_t first = o->vertices, i = a->vertex_start[map], j = b->vertex_start[map];
    for (uint32_t side = 0; side < 4; side++) {
        r->corner[map][pir_side_corner(side)] = o->vertices;
        if (!merge_side(o, map, side, &i, &j))
            return false;
    }
    // the sides between them, each part of one side of a and of one of b
    uint32_t n = r->rim[map] = o->vertices - first, side = PIR_CGM_NONE, half_a = 0, half_b = 0;
    for (uint32_t k = 0; k < n; k++) {
        uint32_t v = first + k, half = 2 * o->edges;
        struct pir_joint *joint = &o->joint[v];
        side += r->vertex[v].place == PIR_CGM_CORNER;
        half_a = joint->a != PIR_CGM_NONE ? a->vertex[joint->a].out : half_a;
        half_b = joint->b != PIR_CGM_NONE ? b->vertex[joint->b].out : half_b;
        struct pir_run *run = &o->run[half_a >> 1];
        if (joint->a != PIR_CGM_NONE)
            *run = (struct pir_run){o->edges, o->edges, half_a};
        else
            joint->a_mid = half;
        run->last = o->edges;
        if (joint->b != PIR_CGM_NONE)
            o->first_cover[half_b >> 1] = half;
        else
            o->record[joint->record].cover = half;
        r->vertex[v].out = half;
        if (pir_overlay_add_edge(o, v, k + 1 == n ? first : v + 1, pir_side_line(map, side),
                                 (struct pir_seam){half_a, half_b, PIR_CGM_NONE}) == PIR_CGM_NONE)
            return false;
    }
    return true;
}

/* --- all of it --- */

static bool allocate(struct pir_overlay *o) {
    const pir_allocator *allocator = &o->allocator;
    const pir_cgm *a = o->a, *b = o->b;
    size_t va = pir_cgm_vertices(a), ea = pir_cgm_edges(a), vb = pir_cgm_vertices(b), eb = pir_cgm_edges(b);
    o->where = PIR_ZEROED(allocator, struct pir_location, va);
    o->a_vertex = PIR_NEW(allocator, uint32_t, va);
    o->queue = PIR_NEW(allocator, uint32_t, va);
    o->run = PIR_NEW(allocator, struct pir_run, ea);
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
        o->run[e] = (struct pir_run){1, 0, 0};
    return pir_cgm_sides_init(&o->sides, allocator, o->result, o->result);
}

static void release(struct pir_overlay *o) {
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

pir_status pir_cgm_overlay(const pir_cgm *a, const pir_cgm *b, pir_cgm **ret_cgm) {
    if (!a || !b || !ret_cgm)
        return PIR_ERR_ARGUMENT;
    struct pir_overlay overlay = {.a = a, .b = b, .allocator = a->allocator};
    overlay.result = pir_cgm_new(&a->allocator, a, b);
    if (!overlay.result)
        return PIR_ERR_MEMORY;
    bool done = allocate(&overlay) && reserve(&overlay);
    for (uint32_t map = 0; map < 6 && done; map++)
        done = merge_rims(&overlay, map) && pir_overlay_walk(&overlay, map) && pir_overlay_join(&overlay, map);
    done = done && pir_overlay_attribute(&overlay);
    if (done) {
        pir_cgm_flag_vertices(overlay.result);
        pir_cgm_trim(overlay.result);
        overlay.result->by_filter = overlay.sides.by_filter;
        overlay.result->by_exact = overlay.sides.by_exact;
        *ret_cgm = overlay.result;
    } else {
        pir_cgm_destroy(overlay.result);
    }
    release(&overlay);
    return done ? PIR_OK : PIR_ERR_MEMORY;
}
