/* SPDX-License-Identifier: MIT */
/*
 * Putting an overlay together, once the edges of a are cut and placed.
 *
 * Edges of b. The points within an edge, crossings and vertices of a, are sorted along it; what lies between two of
 * them is an edge of the result, one that is there already where a runs along.
 *
 * Rings. The halfedges of a around a point are listed clockwise, and so are those of b. The walk has found, for each of
 * a's, the halfedge of b that it lies on, or the face of b that it lies in, which is right of one of b's halfedges. So
 * the two lists merge without another sign.
 *
 * Faces. A face of the result lies in one face of a and one of b. Its edges name both. A face that no edge of a bounds
 * takes its face of a from the face beyond any of its edges.
 */
#include "cgm/overlay/overlay_join.h"

#include <string.h>

#include "base/sort.h"

/* --- edges of b --- */

struct overlay_along {
    struct pir_overlay *overlay;
    uint32_t line;
};

static bool record_before(void *context, uint32_t x, uint32_t y) {
    const struct overlay_along *along = context;
    struct pir_overlay *o = along->overlay;
    const pir_cgm *r = o->result;
    return pir_cgm_ahead(&o->sides, o->b, along->line, r, &r->vertex[o->record[x].vertex].point, r,
                         &r->vertex[o->record[y].vertex].point) > 0;
}

/* The piece of edge e of b from vertex `from` to `to`: `covering` if a has an edge there, else a new one. */
static bool add_piece(struct pir_overlay *o, uint32_t e, uint32_t from, uint32_t to, uint32_t covering) {
    if (covering == PIR_CGM_NONE) {
        uint32_t line = pir_overlay_line(o, pir_cgm_half_line(o->b, 2 * e));
        uint32_t made =
            pir_overlay_add_edge(o, from, to, line, (struct pir_overlay_seam){PIR_CGM_NONE, 2 * e, PIR_CGM_NONE});
        if (made == PIR_CGM_NONE)
            return false;
        covering = 2 * made;
    }
    void *block = o->piece;
    bool done = pir_cgm_grow(&o->allocator, &block, &o->piece_capacity, o->piece_count + 1, sizeof *o->piece);
    o->piece = block;
    if (done)
        o->piece[o->piece_count++] = covering;
    return done;
}

static bool cut_edge(struct pir_overlay *o, uint32_t e) {
    uint32_t count = 0;
    for (uint32_t r = o->first_record[e]; r != PIR_CGM_NONE; r = o->record[r].next)
        o->list[count++] = r;
    struct overlay_along along = {o, pir_cgm_half_line(o->b, 2 * e)};
    pir_sort(o->list, count, o->list + count, record_before, &along);
    o->piece_start[e] = o->piece_count;
    uint32_t from = o->b_vertex[o->b->half[2 * e].origin], covering = o->first_cover[e];
    for (uint32_t i = 0; i < count; i++) {
        const struct pir_record *record = &o->record[o->list[i]];
        if (!add_piece(o, e, from, record->vertex, covering))
            return false;
        from = record->vertex;
        covering = record->cover;
        o->joint[from].b_mid = o->piece_count;
    }
    return add_piece(o, e, from, o->b_vertex[o->b->half[2 * e + 1].origin], covering);
}

static bool add_b(struct pir_overlay *o, uint32_t map) {
    const pir_cgm *b = o->b;
    for (uint32_t w = b->vertex_start[map]; w < b->vertex_start[map + 1]; w++)
        if (pir_overlay_vertex_of_b(o, w) == PIR_CGM_NONE)
            return false;
    for (uint32_t e = b->edge_start[map]; e < b->edge_start[map + 1]; e++)
        if (!cut_edge(o, e))
            return false;
    o->piece_start[b->edge_start[map + 1]] = o->piece_count;
    return true;
}

/* --- rings --- */

/* The result's halfedges that leave vertex v on edges of a, clockwise, into `list`; their number. */
static uint32_t list_a(const struct pir_overlay *o, uint32_t v, uint32_t *list) {
    const struct pir_joint *joint = &o->joint[v];
    uint32_t count = 0;
    if (joint->a != PIR_CGM_NONE) {
        uint32_t start = o->a->vertex[joint->a].out, h = start;
        do {
            const struct pir_overlay_run *run = &o->run[h >> 1];
            list[count++] = run->half == h ? 2 * run->first : 2 * run->last + 1;
            h = pir_cgm_clockwise(o->a, h);
        } while (h != start);
    } else if (joint->a_mid != PIR_CGM_NONE) {
        list[count++] = joint->a_mid;
        list[count++] = joint->a_mid - 1;
    }
    return count;
}

/* Lists b's halfedges around v; notes places in the ring for the halfedges and for the faces right of them. */
static uint32_t list_b(struct pir_overlay *o, uint32_t v, uint32_t *list) {
    const struct pir_joint *joint = &o->joint[v];
    const pir_cgm *b = o->b;
    uint32_t count = 0;
    if (joint->b != PIR_CGM_NONE) {
        uint32_t start = b->vertex[joint->b].out, h = start;
        do {
            uint32_t e = h >> 1;
            o->half_position[h] = o->face_position[b->half[h ^ 1].face] = count;
            list[count++] = h & 1 ? o->piece[o->piece_start[e + 1] - 1] ^ 1 : o->piece[o->piece_start[e]];
            h = pir_cgm_clockwise(b, h);
        } while (h != start);
    } else if (joint->b_mid != PIR_CGM_NONE) {
        uint32_t on = o->piece[joint->b_mid], back = o->piece[joint->b_mid - 1] ^ 1;
        uint32_t h = o->seam[on >> 1].b ^ (on & 1);
        o->half_position[h] = o->face_position[b->half[h ^ 1].face] = 0;
        o->half_position[h ^ 1] = o->face_position[b->half[h].face] = 1;
        list[count++] = on;
        list[count++] = back;
    }
    return count;
}

/* The place among b's of a halfedge of the result on an edge of a: even on one of b's, odd right of one. */
static uint32_t position(const struct pir_overlay *o, uint32_t half) {
    const struct pir_overlay_seam *seam = &o->seam[half >> 1];
    return seam->b != PIR_CGM_NONE ? 2 * o->half_position[seam->b ^ (half & 1)] : 2 * o->face_position[seam->cell] + 1;
}

static void link(pir_cgm *cgm, uint32_t half, uint32_t clockwise) {
    cgm->half[half ^ 1].next = clockwise;
}

/* Links one ring, each list clockwise, merged. */
static void merge(struct pir_overlay *o, const uint32_t *of_a, uint32_t a_count, const uint32_t *of_b,
                  uint32_t b_count) {
    // a's list from where its places begin anew
    uint32_t start = 0;
    if (b_count > 0 && a_count > 0)
        while (position(o, of_a[start]) >= position(o, of_a[(start + a_count - 1) % a_count]))
            start++;
    uint32_t first = b_count > 0 ? of_b[0] : of_a[0], last = PIR_CGM_NONE, i = 0;
    for (uint32_t k = 0; k < (b_count > 0 ? b_count : 1); k++) {
        if (b_count > 0) {
            if (last != PIR_CGM_NONE)
                link(o->result, last, of_b[k]);
            last = of_b[k];
        }
        for (; i < a_count; i++) {
            uint32_t half = of_a[(start + i) % a_count];
            if (b_count > 0 && position(o, half) > 2 * k + 1)
                break;
            // on an edge of b it is the halfedge that is there already
            if (half == last)
                continue;
            if (last != PIR_CGM_NONE)
                link(o->result, last, half);
            last = half;
        }
    }
    link(o->result, last, first);
}

static void link_rings(struct pir_overlay *o, uint32_t map) {
    pir_cgm *r = o->result;
    for (uint32_t v = r->vertex_start[map]; v < o->vertices; v++) {
        uint32_t *of_a = o->list, a_count = list_a(o, v, of_a);
        uint32_t *of_b = of_a + a_count, b_count = list_b(o, v, of_b);
        merge(o, of_a, a_count, of_b, b_count);
        if (r->vertex[v].place == PIR_CGM_INTERIOR)
            r->vertex[v].out = a_count > 0 ? of_a[0] : of_b[0];
    }
}

bool pir_overlay_join(struct pir_overlay *o, uint32_t map) {
    pir_cgm *r = o->result;
    if (!add_b(o, map))
        return false;
    r->vertex_start[map + 1] = o->vertices;
    r->edge_start[map + 1] = o->edges;
    link_rings(o, map);
    return pir_cgm_trace_faces(r, map);
}

/* --- what the sources contribute --- */

/* The faces of a and b that each face of the result is in. */
static void find_parents(const struct pir_overlay *o, uint32_t *in_a, uint32_t *in_b, uint32_t *queue) {
    const pir_cgm *r = o->result;
    memset(in_a, 0xff, pir_cgm_faces(r) * sizeof *in_a);
    for (uint32_t h = 0; h < 2 * pir_cgm_edges(r); h++) {
        const struct pir_overlay_seam *seam = &o->seam[h >> 1];
        uint32_t face = r->half[h].face;
        if (seam->a != PIR_CGM_NONE)
            in_a[face] = o->a->half[seam->a ^ (h & 1)].face;
        in_b[face] = seam->b != PIR_CGM_NONE ? o->b->half[seam->b ^ (h & 1)].face : seam->cell;
    }
    uint32_t head = 0, tail = 0;
    for (uint32_t f = 0; f < pir_cgm_faces(r); f++)
        if (in_a[f] != PIR_CGM_NONE)
            queue[tail++] = f;
    while (tail < pir_cgm_faces(r)) {
        uint32_t face = queue[head++], start = r->face_half[face], h = start;
        do {
            uint32_t other = r->half[h ^ 1].face;
            if (o->seam[h >> 1].a == PIR_CGM_NONE && in_a[other] == PIR_CGM_NONE) {
                in_a[other] = in_a[face];
                queue[tail++] = other;
            }
            h = r->half[h].next;
        } while (h != start);
    }
}

/* Copies to entry `index` what entries `i` of a and `j` of b hold, either of which may be absent. */
static void copy_attributes(const struct pir_overlay *o, uint32_t *to, uint32_t index, const uint32_t *of_a, uint32_t i,
                            const uint32_t *of_b, uint32_t j) {
    uint32_t ka = o->a->source_count, kb = o->b->source_count;
    to += (size_t)index * (ka + kb);
    if (i != PIR_CGM_NONE)
        memcpy(to, of_a + (size_t)i * ka, ka * sizeof *to);
    if (j != PIR_CGM_NONE)
        memcpy(to + ka, of_b + (size_t)j * kb, kb * sizeof *to);
}

/* Turns what an edge holds about when the result's edge goes against it: halfedges of the
   polytopes become their twins. */
static void turn_edge(const pir_cgm *r, uint32_t edge, uint32_t from, uint32_t count) {
    uint32_t *half = &r->edge_half[(size_t)edge * r->source_count];
    for (uint32_t s = from; s < from + count; s++)
        if (half[s] != PIR_CGM_NONE)
            half[s] = r->source[s].polytope->twin[half[s]];
}

static uint32_t edge_of(uint32_t half) {
    return half == PIR_CGM_NONE ? half : half >> 1;
}

bool pir_overlay_attribute(struct pir_overlay *o) {
    pir_cgm *r = o->result;
    const pir_allocator *allocator = &o->allocator;
    if (!pir_cgm_connect(r))
        return false;
    uint32_t faces = pir_cgm_faces(r);
    uint32_t *work = PIR_NEW(allocator, uint32_t, (size_t)faces * 3);
    if (!work)
        return false;
    uint32_t *in_a = work, *in_b = work + faces;
    find_parents(o, in_a, in_b, work + 2 * (size_t)faces);
    for (uint32_t f = 0; f < faces; f++)
        copy_attributes(o, r->face_vertex, f, o->a->face_vertex, in_a[f], o->b->face_vertex, in_b[f]);
    PIR_FREE(allocator, work, (size_t)faces * 3);
    for (uint32_t e = 0; e < pir_cgm_edges(r); e++) {
        uint32_t a = o->seam[e].a, b = o->seam[e].b, ka = o->a->source_count;
        copy_attributes(o, r->edge_half, e, o->a->edge_half, edge_of(a), o->b->edge_half, edge_of(b));
        if (a != PIR_CGM_NONE && a & 1)
            turn_edge(r, e, 0, ka);
        if (b != PIR_CGM_NONE && b & 1)
            turn_edge(r, e, ka, o->b->source_count);
    }
    for (uint32_t v = 0; v < pir_cgm_vertices(r); v++)
        copy_attributes(o, r->vertex_facet, v, o->a->vertex_facet, o->joint[v].a, o->b->vertex_facet, o->joint[v].b);
    return true;
}
