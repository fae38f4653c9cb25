/* SPDX-License-Identifier: MIT */
/*
 * The live mesh. Its slots and invariants stand in live_mesh.h.
 *
 * A refresh reads the slots that the sum's journal names, in rising order, and compares its copy of the pairing with
 * the sum's there. So it costs what changed. Where the journal does not reach back, and with a region, which facets
 * enter as they rotate, all slots are compared: that takes two loads a pair, against a hash and four writes for one
 * that has changed. Either way the mesh is the same, slot for slot.
 *
 * A vertex that loses its last corner and is given another in the same refresh stays in its slot, because slots are
 * emptied last. Each vertex has at least two corners, so half of all corners is room for the old vertices, and as much
 * for the new.
 *
 * A rebuild puts crossings into other slots. Then slots are rewritten although their pairs are the same, and a pair
 * that both disappeared and appeared is in neither list.
 */
#include "dymsum/live/live_mesh.h"

#include "base/layout.h"

#include <string.h>

/* --- making it --- */

/* Words of 64 bits for so many slots. */
static size_t words_for(size_t slots) {
    return slots / 64 + 1;
}

static pir_layout layout_of(pir_live_mesh *live) {
    return (pir_layout){{PIR_ROW(live->fv, live->sizes.facets_p), PIR_ROW(live->vf, live->sizes.facets_q),
                         PIR_ROW(live->turned, live->sizes.vertices_p)}};
}

static pir_layout layout_of_slots(pir_live_slots *slots, const pir_live_sizes *sizes) {
    uint32_t crossings = slots->capacity;
    size_t facets = (size_t)sizes->facets_p + sizes->facets_q + crossings;
    return (pir_layout){{PIR_ROW(slots->edge, crossings), PIR_ROW(slots->half, crossings),
                         PIR_ROW(slots->corner, sizes->corners_fixed + 4 * (size_t)crossings),
                         PIR_ROW(slots->rewritten, facets), PIR_ROW(slots->dirty, words_for(facets))}};
}

static bool reserve_slots(pir_live_mesh *live, uint32_t least) {
    if (live->slots.corner && least <= live->slots.capacity)
        return true;
    const pir_live_slots *before = &live->slots;
    pir_live_slots grown = {.capacity = least, .used = before->used};
    pir_layout fresh = layout_of_slots(&grown, &live->sizes);
    if (!pir_layout_new(&live->allocator, &fresh)) {
        pir_layout_free(&live->allocator, &fresh);
        return false;
    }
    for (uint32_t i = 0; i < least; i++)
        grown.edge[i] = i < before->used ? before->edge[i] : PIR_NO_CROSSING;
    if (before->used > 0)
        memcpy(grown.half, before->half, before->used * sizeof *grown.half);
    size_t corners = live->sizes.corners_fixed + 4 * (size_t)before->used;
    if (before->corner)
        memcpy(grown.corner, before->corner, corners * sizeof *grown.corner);
    pir_layout old = layout_of_slots(&live->slots, &live->sizes);
    pir_layout_free(&live->allocator, &old);
    live->slots = grown;
    return true;
}

/* Room for whatever the sum may hold now, so that the rest of a refresh cannot fail. */
static bool reserve(pir_live_mesh *live) {
    // as much as the sum itself has room for: it grows when the sum grows
    uint32_t crossings = live->pairing->crossings.capacity,
             slots = live->sizes.facets_p + live->sizes.facets_q + crossings;
    uint32_t corners = live->sizes.corners_fixed + 4 * crossings;
    return reserve_slots(live, crossings) && pir_live_pairs_reserve(&live->appeared, &live->allocator, slots) &&
           pir_live_pairs_reserve(&live->disappeared, &live->allocator, slots) &&
           pir_live_vertices_reserve(&live->vertices, &live->allocator, corners + 8);
}

void pir_live_mesh_destroy(pir_live_mesh *live) {
    if (!live)
        return;
    const pir_allocator allocator = live->allocator, *a = &allocator;
    pir_layout layout = layout_of(live), slots = layout_of_slots(&live->slots, &live->sizes);
    pir_layout_free(a, &layout);
    pir_layout_free(a, &slots);
    pir_live_pairs_finish(&live->appeared, a);
    pir_live_pairs_finish(&live->disappeared, a);
    pir_live_vertices_finish(&live->vertices, a);
    pir_sum_destroy(live->sum);
    PIR_FREE(a, live, 1);
}

pir_status pir_live_mesh_create(const pir_sum *sum, pir_live_mesh **ret_live) {
    if (!sum || !ret_live)
        return PIR_ERR_ARGUMENT;
    const pir_pairing *pairing = pir_sum_pairing(sum);
    const pir_allocator *a = &pairing->allocator;
    pir_live_mesh *live = PIR_ZEROED(a, pir_live_mesh, 1);
    if (!live)
        return PIR_ERR_MEMORY;
    live->sum = pir_sum_retain(sum);
    live->pairing = pairing;
    live->allocator = *a;
    live->sizes = (pir_live_sizes){pairing->p->facet_count, pairing->q->facet_count, pairing->p->vertex_count,
                                   pairing->p->half_count + pairing->q->half_count};
    live->vertices.free = PIR_NO_SLOT;
    pir_layout layout = layout_of(live);
    pir_status status = PIR_ERR_MEMORY;
    if (pir_sum_keep_journal(sum) == PIR_OK && pir_layout_new(a, &layout)) {
        for (uint32_t f = 0; f < live->sizes.facets_p; f++)
            live->fv[f] = PIR_NO_SLOT;
        for (uint32_t g = 0; g < live->sizes.facets_q; g++)
            live->vf[g] = PIR_NO_SLOT;
        live->stale = true;
        status = pir_live_mesh_refresh(live);
    }
    if (status != PIR_OK) {
        pir_live_mesh_destroy(live);
        return status;
    }
    *ret_live = live;
    return PIR_OK;
}

pir_status pir_live_mesh_set_region(pir_live_mesh *live, pir_vec3 axis, double half_angle) {
    if (!live)
        return PIR_ERR_ARGUMENT;
    pir_status status = pir_cone_make(axis, half_angle, &live->cone);
    live->stale |= status == PIR_OK;
    return status;
}

void pir_live_mesh_clear_region(pir_live_mesh *live) {
    if (!live)
        return;
    live->cone.set = false;
    live->stale = true;
}

/* --- the refresh --- */

static void note_ee(pir_live_mesh *live, pir_live_pairs *pairs, uint32_t e, uint32_t h) {
    const pir_polytope *p = live->pairing->p, *q = live->pairing->q;
    // a segment's two edges are one to callers
    pir_live_pairs_note(pairs, PIR_FACET_EE, p->artificial ? 0 : e, q->artificial ? 0 : q->edge[h]);
}

/* Compares a facet with the vertex that it is paired with now. */
static void refresh_facet(pir_live_mesh *live, bool of_p, uint32_t f) {
    const pir_polytope *of = of_p ? live->pairing->p : live->pairing->q;
    uint32_t *held = of_p ? live->fv : live->vf;
    uint32_t v = of_p ? live->pairing->fv[f] : live->pairing->vf[f], before = held[f];
    if (live->cone.set &&
        !pir_cone_has(&live->cone, of_p ? pir_mat_apply(pir_live_matrix(live), of->normal[f]) : of->normal[f]))
        v = PIR_NO_SLOT;
    if (v == before)
        return;
    uint32_t first = of_p ? 0 : live->pairing->p->half_count;
    pir_facet_kind kind = of_p ? PIR_FACET_FV : PIR_FACET_VF;
    for (uint32_t i = of->loop_start[f]; i < of->loop_start[f + 1]; i++) {
        uint32_t own = of->origin[of->loop[i]];
        if (before != PIR_NO_SLOT)
            pir_live_vertex_drop(&live->vertices, live->slots.corner[first + i]);
        if (v != PIR_NO_SLOT)
            live->slots.corner[first + i] = pir_live_vertex_take(&live->vertices, of_p ? own : v, of_p ? v : own);
    }
    live->slots.rewritten[live->rewritten_count++] = of_p ? f : live->sizes.facets_p + f;
    // the facets of a segment only hold its edges
    if (!of->artificial && before != PIR_NO_SLOT)
        pir_live_pairs_note(&live->disappeared, kind, of_p ? f : before, of_p ? before : f);
    if (!of->artificial && v != PIR_NO_SLOT)
        pir_live_pairs_note(&live->appeared, kind, of_p ? f : v, of_p ? v : f);
    held[f] = v;
}

/* The parallelogram of a crossing, counter-clockwise from outside. */
static void write_crossing(pir_live_mesh *live, uint32_t slot) {
    const pir_polytope *p = live->pairing->p, *q = live->pairing->q;
    uint32_t half = p->edge_half[live->slots.edge[slot]], h = live->slots.half[slot];
    uint32_t *corner = live->slots.corner + live->sizes.corners_fixed + 4 * (size_t)slot;
    corner[0] = pir_live_vertex_take(&live->vertices, p->origin[half], q->origin[h]);
    corner[1] = pir_live_vertex_take(&live->vertices, p->origin[half], q->target[h]);
    corner[2] = pir_live_vertex_take(&live->vertices, p->target[half], q->target[h]);
    corner[3] = pir_live_vertex_take(&live->vertices, p->target[half], q->origin[h]);
}

/*
 * The edge in a crossing's slot now, or PIR_NO_CROSSING where the slot is empty or its normal is outside of the cone.
 */
static uint32_t edge_now(const pir_live_mesh *live, uint32_t slot) {
    const pir_pairing *pairing = live->pairing;
    const pir_crossings *c = &pairing->crossings;
    if (slot >= c->used || c->at[slot].edge == PIR_NO_CROSSING)
        return PIR_NO_CROSSING;
    if (live->cone.set) {
        pir_vec3 e =
            pir_mat_apply(pir_live_matrix(live), pairing->p->direction[pairing->p->edge_half[c->at[slot].edge]]);
        if (!pir_cone_has(&live->cone, pir_vec_cross(pairing->q->direction[c->at[slot].half], e)))
            return PIR_NO_CROSSING;
    }
    return c->at[slot].edge;
}

static void refresh_crossing(pir_live_mesh *live, uint32_t slot) {
    const pir_crossings *c = &live->pairing->crossings;
    uint32_t edge = edge_now(live, slot), held = live->slots.edge[slot];
    if (edge == held && (edge == PIR_NO_CROSSING || c->at[slot].half == live->slots.half[slot]))
        return;
    if (held != PIR_NO_CROSSING) {
        note_ee(live, &live->disappeared, held, live->slots.half[slot]);
        for (size_t i = 0; i < 4; i++)
            pir_live_vertex_drop(&live->vertices, live->slots.corner[live->sizes.corners_fixed + 4 * (size_t)slot + i]);
    }
    live->slots.edge[slot] = edge;
    if (edge != PIR_NO_CROSSING) {
        live->slots.half[slot] = c->at[slot].half;
        note_ee(live, &live->appeared, edge, c->at[slot].half);
        write_crossing(live, slot);
    }
    live->slots.rewritten[live->rewritten_count++] = live->sizes.facets_p + live->sizes.facets_q + slot;
}

static void refresh_all(pir_live_mesh *live) {
    uint32_t used = live->pairing->crossings.used, slots = used > live->slots.used ? used : live->slots.used;
    for (uint32_t f = 0; f < live->sizes.facets_p; f++)
        refresh_facet(live, true, f);
    for (uint32_t g = 0; g < live->sizes.facets_q; g++)
        refresh_facet(live, false, g);
    for (uint32_t slot = 0; slot < slots; slot++)
        refresh_crossing(live, slot);
}

/* Compares the slots that the journal names since the last refresh, each once. */
static void refresh_noted(pir_live_mesh *live) {
    const pir_journal *journal = pir_sum_journal(live->sum);
    uint32_t facets = live->sizes.facets_p + live->sizes.facets_q;
    size_t words = words_for(facets + live->pairing->crossings.used);
    for (uint64_t n = live->seen; n < journal->count; n++) {
        uint32_t slot = journal->slot[n % PIR_JOURNAL_ROOM];
        live->slots.dirty[slot / 64] |= (uint64_t)1 << slot % 64;
    }
    for (size_t w = 0; w < words; w++) {
        for (uint64_t left = live->slots.dirty[w]; left; left &= left - 1) {
            uint32_t slot = (uint32_t)w * 64 + (uint32_t)__builtin_ctzll(left);
            if (slot < live->sizes.facets_p)
                refresh_facet(live, true, slot);
            else if (slot < facets)
                refresh_facet(live, false, slot - live->sizes.facets_p);
            else
                refresh_crossing(live, slot - facets);
        }
        live->slots.dirty[w] = 0;
    }
}

/*
 * Two segments have one pair and two facets, on either side of it. A region may hold one of these. So of the facets
 * that came and went, which are counted here, at most one is told: where there was none before, or is none now.
 */
static void tell_once(pir_live_mesh *live) {
    uint32_t now = 0;
    for (uint32_t slot = 0; slot < live->slots.used; slot++)
        now += live->slots.edge[slot] != PIR_NO_CROSSING;
    uint32_t before = now + live->disappeared.count - live->appeared.count;
    live->appeared.count = before == 0 && now > 0;
    live->disappeared.count = before > 0 && now == 0;
}

pir_status pir_live_mesh_refresh(pir_live_mesh *live) {
    if (!live)
        return PIR_ERR_ARGUMENT;
    if (!reserve(live))
        return PIR_ERR_MEMORY;
    live->appeared.count = live->disappeared.count = live->rewritten_count = 0;
    const pir_journal *journal = pir_sum_journal(live->sum);
    if (live->stale || live->cone.set || journal->count - live->seen > PIR_JOURNAL_ROOM)
        refresh_all(live);
    else
        refresh_noted(live);
    live->stale = false;
    live->seen = journal->count;
    live->slots.used = live->pairing->crossings.used;
    pir_live_vertices_sweep(&live->vertices);
    pir_live_pairs_settle(&live->appeared, &live->disappeared);
    if (live->pairing->p->artificial && live->pairing->q->artificial)
        tell_once(live);
    return PIR_OK;
}
