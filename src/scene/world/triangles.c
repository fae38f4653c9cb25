/* SPDX-License-Identifier: MIT */
/*
 * Triangles of surfaces as pieces: see triangles.h. The table is open, at most half full; a piece that is taken out is
 * replaced by those behind it that may stand there, so that no gap is left on the way to any.
 */
#include "scene/world/triangles.h"

#include "scene/world/surfaces.h"

static uint32_t slot_of(const pir_bodies *bodies, uint32_t body, uint32_t triangle) {
    uint64_t mixed = ((uint64_t)body << 32 | triangle) * UINT64_C(0x9e3779b97f4a7c15);
    return (uint32_t)(mixed >> 32) & (bodies->triangle_slots - 1);
}

static uint32_t next_slot(const pir_bodies *bodies, uint32_t slot) {
    return (slot + 1) & (bodies->triangle_slots - 1);
}

/* Where a triangle stands in the table, or the gap where it would. */
static uint32_t seek(const pir_bodies *bodies, uint32_t body, uint32_t triangle) {
    uint32_t slot = slot_of(bodies, body, triangle);
    for (; bodies->triangle[slot] != PIR_PIECE_NONE; slot = next_slot(bodies, slot)) {
        const pir_scene_piece *piece = &bodies->piece[bodies->triangle[slot]];
        if (piece->number == triangle && piece->body == body)
            break;
    }
    return slot;
}

uint32_t pir_triangles_find(const pir_bodies *bodies, uint32_t body, uint32_t triangle) {
    return bodies->triangle_count > 0 ? bodies->triangle[seek(bodies, body, triangle)] : PIR_PIECE_NONE;
}

static bool grow(pir_bodies *bodies, const pir_allocator *allocator) {
    const uint32_t old = bodies->triangle_slots, slots = old > 0 ? 2 * old : 64;
    uint32_t *before = bodies->triangle, *table = PIR_NEW(allocator, uint32_t, slots);
    if (!table)
        return false;
    for (uint32_t i = 0; i < slots; i++)
        table[i] = PIR_PIECE_NONE;
    bodies->triangle = table;
    bodies->triangle_slots = slots;
    for (uint32_t i = 0; i < old; i++)
        if (before[i] != PIR_PIECE_NONE) {
            const pir_scene_piece *piece = &bodies->piece[before[i]];
            table[seek(bodies, piece->body, piece->number)] = before[i];
        }
    PIR_FREE(allocator, before, old);
    return true;
}

pir_scene_piece pir_triangle_piece(const pir_bodies *bodies, uint32_t body, uint32_t triangle) {
    pir_vec3 corner[3];
    double reach = 0;
    pir_surface_triangle(pir_body_surface_of(&bodies->body[body]), triangle, corner);
    for (int k = 0; k < 3; k++)
        reach = fmax(reach, sqrt(pir_vec_dot(corner[k], corner[k])));
    return (pir_scene_piece){.extent.reach = reach * (1 + 0x1p-40),
                             .body = body,
                             .number = triangle,
                             .next = PIR_PIECE_NONE,
                             .node = PIR_PIECE_NONE,
                             .first = PIR_NO_END,
                             .kind = PIR_PIECE_TRIANGLE,
                             .moved = bodies->body[body].moved};
}

pir_status pir_triangles_add(pir_bodies *bodies, const pir_allocator *allocator, const pir_scene_piece *piece,
                             uint32_t *ret_piece) {
    pir_status status = pir_pieces_reserve(bodies, allocator, 1);
    if (status == PIR_OK && 2 * bodies->triangle_count >= bodies->triangle_slots && !grow(bodies, allocator))
        status = PIR_ERR_MEMORY;
    if (status != PIR_OK)
        return status;
    const uint32_t added = bodies->piece_unused;
    uint32_t *first = &bodies->body[piece->body].surface.triangles;
    bodies->piece_unused = bodies->piece[added].next;
    bodies->piece[added] = *piece;
    bodies->piece[added].next = *first;
    if (*first != PIR_PIECE_NONE)
        bodies->piece[*first].node = added;
    *first = added;
    bodies->triangle[seek(bodies, piece->body, piece->number)] = added;
    bodies->triangle_count++;
    *ret_piece = added;
    return PIR_OK;
}

/* Closes the gap at a slot. */
static void close_gap(pir_bodies *bodies, uint32_t gap) {
    const uint32_t around = bodies->triangle_slots - 1;
    for (uint32_t slot = next_slot(bodies, gap); bodies->triangle[slot] != PIR_PIECE_NONE;
         slot = next_slot(bodies, slot)) {
        const pir_scene_piece *piece = &bodies->piece[bodies->triangle[slot]];
        const uint32_t home = slot_of(bodies, piece->body, piece->number);
        if (((slot - home) & around) >= ((slot - gap) & around)) {
            bodies->triangle[gap] = bodies->triangle[slot];
            gap = slot;
        }
    }
    bodies->triangle[gap] = PIR_PIECE_NONE;
}

void pir_triangles_remove(pir_bodies *bodies, uint32_t piece) {
    pir_scene_piece *p = &bodies->piece[piece];
    close_gap(bodies, seek(bodies, p->body, p->number));
    if (p->next != PIR_PIECE_NONE)
        bodies->piece[p->next].node = p->node;
    if (p->node != PIR_PIECE_NONE)
        bodies->piece[p->node].next = p->next;
    else
        bodies->body[p->body].surface.triangles = p->next;
    pir_polytope_release(p->extent.polytope);
    *p = (pir_scene_piece){.next = bodies->piece_unused};
    bodies->piece_unused = piece;
    bodies->triangle_count--;
}

pir_status pir_piece_ready(const pir_scene_body *body, const pir_allocator *allocator, pir_scene_piece *piece) {
    if (piece->extent.polytope)
        return PIR_OK;
    pir_vec3 corner[3];
    pir_polytope_options options = pir_polytope_options_default();
    options.allocator = allocator;
    uint32_t count = pir_surface_triangle(pir_body_surface_of(body), piece->number, corner);
    return pir_polytope_create(corner, count, &options, &piece->extent.polytope);
}

/* --- what queries leave --- */

static uint32_t kept_slot(uint32_t body, uint32_t triangle) {
    return (triangle + 97 * body) % PIR_TRIANGLES_KEPT;
}

pir_polytope *pir_triangles_recall(const pir_bodies *bodies, uint32_t body, uint32_t triangle) {
    const pir_kept_triangle *kept = bodies->kept ? &bodies->kept[kept_slot(body, triangle)] : NULL;
    if (!kept || !kept->polytope || kept->body != body || kept->number != triangle)
        return NULL;
    return pir_polytope_retain(kept->polytope);
}

void pir_triangles_keep(pir_bodies *bodies, const pir_allocator *allocator, const pir_scene_piece *piece) {
    if (!piece->extent.polytope)
        return;
    if (!bodies->kept)
        bodies->kept = PIR_ZEROED(allocator, pir_kept_triangle, PIR_TRIANGLES_KEPT);
    if (!bodies->kept) {
        pir_polytope_release(piece->extent.polytope);
        return;
    }
    pir_kept_triangle *kept = &bodies->kept[kept_slot(piece->body, piece->number)];
    pir_polytope_release(kept->polytope);
    *kept = (pir_kept_triangle){piece->body, piece->number, piece->extent.polytope};
}

void pir_triangles_forget(pir_bodies *bodies, uint32_t body) {
    for (uint32_t i = 0; bodies->kept && i < PIR_TRIANGLES_KEPT; i++)
        if (bodies->kept[i].polytope && bodies->kept[i].body == body) {
            pir_polytope_release(bodies->kept[i].polytope);
            bodies->kept[i] = (pir_kept_triangle){0, 0, NULL};
        }
}
