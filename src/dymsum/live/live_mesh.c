/* SPDX-License-Identifier: MIT */
/*
 * The live mesh. Its slots and invariants stand in live_mesh.h.
 *
 * A refresh looks at the slots that the sum's journal names, in rising order, and compares its copy of the pairing with
 * the sum's there: so it costs what changed. Where the journal does not reach back, and with a region, into which
 * facets turn, all slots are compared: two loads a pair, against the hash and the four writes that a changed one takes.
 * Either way the mesh comes out the same, slot for slot.
 *
 * A vertex that loses its last corner and then is given another, all in one refresh, stays in its slot: slots are
 * emptied last. Each vertex has two corners at least, so half of all corners is room for the old vertices, and as much
 * for the new.
 *
 * A rebuild gives crossings other slots; then slots are rewritten though their pairs are still there, and a pair that
 * both went and came is in neither list.
 */
#include "dymsum/live/live_mesh.h"

#include <string.h>

/* --- making it --- */

/* Words of 64 bits for so many slots. */
static size_t words_for(uint32_t slots) {
    return (size_t)slots / 64 + 1;
}

static bool reserve_crossings(pir_live_mesh *live, uint32_t least) {
    if (live->corner && least <= live->capacity)
        return true;
    const pir_allocator *a = &live->allocator;
    uint32_t capacity = least, fixed = live->corners_fixed, slots = live->facets_p + live->facets_q;
    uint32_t *edge = PIR_NEW(a, uint32_t, capacity), *half = PIR_NEW(a, uint32_t, capacity),
             *corner = PIR_NEW(a, uint32_t, (size_t)fixed + 4 * (size_t)capacity),
             *rewritten = PIR_NEW(a, uint32_t, (size_t)slots + capacity);
    uint64_t *dirty = PIR_ZEROED(a, uint64_t, words_for(slots + capacity));
    bool done = edge && half && corner && rewritten && dirty;
    if (done) {
        for (uint32_t i = 0; i < capacity; i++)
            edge[i] = i < live->used ? live->edge[i] : PIR_NO_CROSSING;
        if (live->used > 0)
            memcpy(half, live->half, live->used * sizeof *half);
        if (live->corner)
            memcpy(corner, live->corner, ((size_t)fixed + 4 * (size_t)live->used) * sizeof *corner);
    }
    PIR_FREE(a, done ? live->edge : edge, done ? live->capacity : capacity);
    PIR_FREE(a, done ? live->half : half, done ? live->capacity : capacity);
    PIR_FREE(a, done ? live->corner : corner, (size_t)fixed + 4 * (size_t)(done ? live->capacity : capacity));
    PIR_FREE(a, done ? live->rewritten : rewritten, (size_t)slots + (done ? live->capacity : capacity));
    PIR_FREE(a, done ? live->dirty : dirty, words_for(slots + (done ? live->capacity : capacity)));
    if (done) {
        live->edge = edge;
        live->half = half;
        live->corner = corner;
        live->rewritten = rewritten;
        live->dirty = dirty;
        live->capacity = capacity;
    }
    return done;
}

/* Room for whatever the sum may hold now, so that the rest of a refresh cannot fail. */
static bool reserve(pir_live_mesh *live) {
    // as much as the sum itself has room for: grows when the sum grows
    uint32_t crossings = live->pairing->crossings.capacity, slots = live->facets_p + live->facets_q + crossings;
    uint32_t corners = live->corners_fixed + 4 * crossings;
    return reserve_crossings(live, crossings) && pir_live_pairs_reserve(&live->appeared, &live->allocator, slots) &&
           pir_live_pairs_reserve(&live->disappeared, &live->allocator, slots) &&
           pir_live_vertices_reserve(&live->vertices, &live->allocator, corners + 8);
}

void pir_live_mesh_destroy(pir_live_mesh *live) {
    if (!live)
        return;
    const pir_allocator allocator = live->allocator, *a = &allocator;
    PIR_FREE(a, live->fv, live->facets_p);
    PIR_FREE(a, live->vf, live->facets_q);
    if (live->corner) {
        PIR_FREE(a, live->edge, live->capacity);
        PIR_FREE(a, live->half, live->capacity);
        PIR_FREE(a, live->corner, (size_t)live->corners_fixed + 4 * (size_t)live->capacity);
        PIR_FREE(a, live->rewritten, (size_t)live->facets_p + live->facets_q + live->capacity);
        PIR_FREE(a, live->dirty, words_for(live->facets_p + live->facets_q + live->capacity));
    }
    pir_live_pairs_finish(&live->appeared, a);
    pir_live_pairs_finish(&live->disappeared, a);
    PIR_FREE(a, live->turned, live->vertices_p);
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
    live->facets_p = pairing->p->facet_count;
    live->facets_q = pairing->q->facet_count;
    live->vertices_p = pairing->p->vertex_count;
    live->corners_fixed = pairing->p->half_count + pairing->q->half_count;
    live->vertices.free = PIR_NO_SLOT;
    live->fv = PIR_NEW(a, uint32_t, live->facets_p);
    live->vf = PIR_NEW(a, uint32_t, live->facets_q);
    live->turned = PIR_NEW(a, pir_vec3, live->vertices_p);
    pir_status status = PIR_ERR_MEMORY;
    if (live->fv && live->vf && live->turned) {
        for (uint32_t f = 0; f < live->facets_p; f++)
            live->fv[f] = PIR_NO_SLOT;
        for (uint32_t g = 0; g < live->facets_q; g++)
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
            pir_live_vertex_drop(&live->vertices, live->corner[first + i]);
        if (v != PIR_NO_SLOT)
            live->corner[first + i] = pir_live_vertex_take(&live->vertices, of_p ? own : v, of_p ? v : own);
    }
    live->rewritten[live->rewritten_count++] = of_p ? f : live->facets_p + f;
    // the facets of a segment are there to hold its edges only
    if (!of->artificial && before != PIR_NO_SLOT)
        pir_live_pairs_note(&live->disappeared, kind, of_p ? f : before, of_p ? before : f);
    if (!of->artificial && v != PIR_NO_SLOT)
        pir_live_pairs_note(&live->appeared, kind, of_p ? f : v, of_p ? v : f);
    held[f] = v;
}

/* The parallelogram of a crossing, counter-clockwise from outside. */
static void write_crossing(pir_live_mesh *live, uint32_t slot) {
    const pir_polytope *p = live->pairing->p, *q = live->pairing->q;
    uint32_t half = p->edge_half[live->edge[slot]], h = live->half[slot];
    uint32_t *corner = live->corner + live->corners_fixed + 4 * (size_t)slot;
    corner[0] = pir_live_vertex_take(&live->vertices, p->origin[half], q->origin[h]);
    corner[1] = pir_live_vertex_take(&live->vertices, p->origin[half], q->target[h]);
    corner[2] = pir_live_vertex_take(&live->vertices, p->target[half], q->target[h]);
    corner[3] = pir_live_vertex_take(&live->vertices, p->target[half], q->origin[h]);
}

/* The edge in a crossing's slot now, or PIR_NO_CROSSING where it is empty or not to be held. */
static uint32_t edge_now(const pir_live_mesh *live, uint32_t slot) {
    const pir_pairing *pairing = live->pairing;
    const pir_crossings *c = &pairing->crossings;
    if (slot >= c->used || c->edge[slot] == PIR_NO_CROSSING)
        return PIR_NO_CROSSING;
    if (live->cone.set) {
        pir_vec3 e = pir_mat_apply(pir_live_matrix(live), pairing->p->direction[pairing->p->edge_half[c->edge[slot]]]);
        if (!pir_cone_has(&live->cone, pir_vec_cross(pairing->q->direction[c->half[slot]], e)))
            return PIR_NO_CROSSING;
    }
    return c->edge[slot];
}

static void refresh_crossing(pir_live_mesh *live, uint32_t slot) {
    const pir_crossings *c = &live->pairing->crossings;
    uint32_t edge = edge_now(live, slot), held = live->edge[slot];
    if (edge == held && (edge == PIR_NO_CROSSING || c->half[slot] == live->half[slot]))
        return;
    if (held != PIR_NO_CROSSING) {
        note_ee(live, &live->disappeared, held, live->half[slot]);
        for (size_t i = 0; i < 4; i++)
            pir_live_vertex_drop(&live->vertices, live->corner[live->corners_fixed + 4 * (size_t)slot + i]);
    }
    live->edge[slot] = edge;
    if (edge != PIR_NO_CROSSING) {
        live->half[slot] = c->half[slot];
        note_ee(live, &live->appeared, edge, c->half[slot]);
        write_crossing(live, slot);
    }
    live->rewritten[live->rewritten_count++] = live->facets_p + live->facets_q + slot;
}

static void refresh_all(pir_live_mesh *live) {
    uint32_t used = live->pairing->crossings.used, slots = used > live->used ? used : live->used;
    for (uint32_t f = 0; f < live->facets_p; f++)
        refresh_facet(live, true, f);
    for (uint32_t g = 0; g < live->facets_q; g++)
        refresh_facet(live, false, g);
    for (uint32_t slot = 0; slot < slots; slot++)
        refresh_crossing(live, slot);
}

/* Looks at the slots that the journal names since the last refresh, each once. */
static void refresh_noted(pir_live_mesh *live) {
    const pir_journal *journal = pir_sum_journal(live->sum);
    uint32_t facets = live->facets_p + live->facets_q;
    size_t words = words_for(facets + live->pairing->crossings.used);
    for (uint64_t n = live->seen; n < journal->count; n++) {
        uint32_t slot = journal->slot[n % PIR_JOURNAL_ROOM];
        live->dirty[slot / 64] |= (uint64_t)1 << slot % 64;
    }
    for (size_t w = 0; w < words; w++) {
        for (uint64_t left = live->dirty[w]; left; left &= left - 1) {
            uint32_t slot = (uint32_t)w * 64 + (uint32_t)__builtin_ctzll(left);
            if (slot < live->facets_p)
                refresh_facet(live, true, slot);
            else if (slot < facets)
                refresh_facet(live, false, slot - live->facets_p);
            else
                refresh_crossing(live, slot - facets);
        }
        live->dirty[w] = 0;
    }
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
    live->used = live->pairing->crossings.used;
    pir_live_vertices_sweep(&live->vertices);
    pir_live_pairs_settle(&live->appeared, &live->disappeared);
    return PIR_OK;
}
