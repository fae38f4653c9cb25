/* SPDX-License-Identifier: MIT */
/*
 * The rebuild by CGM: the pairing read off the overlay of two cubical Gaussian maps.
 *
 * The overlay is exact but not perturbed. A facet whose normal is strictly inside one cell of the other map, and two
 * arcs that cross at no other feature, are in general position: an infinitely small turn leaves them so, and the
 * overlay shows their perturbed pairing. The rest are ties. They are settled by perturbed signs, from where the overlay
 * has located them: a facet by descent, an arc that touches a tie anywhere by a walk from the cell of one end to that
 * of the other.
 *
 * The crossings of an arc need no sorting: each leads from one cell to the next, and an arc is in no cell twice.
 */
#include "dymsum/rebuild/cgm_rebuild.h"
#include "cgm/build.h"

#include "dymsum/pairing/crossings.h"
#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/descent.h"
#include "dymsum/rebuild/walk.h"

#include <string.h>

struct reading {
    pir_tracked *tracked;
    const pir_cgm *overlay; /* source 0 is P, source 1 is Q */
    uint8_t *tied[2];       /* per facet of P and of Q */
    uint8_t *tied_edge;     /* per edge of P */
    uint32_t *slot_at;      /* per vertex of Q: the slot that leaves its cell, of the edge being linked */
};

static uint32_t facet_at(const pir_cgm *cgm, uint32_t vertex, uint32_t source) {
    return cgm->vertex_facet[(size_t)vertex * cgm->source_count + source];
}

/*
 * Pairs the facets of `source` with the vertices of the other operand by the cells around their normals. Where those
 * differ there is a tie.
 */
static void read_facets(struct reading *reading, uint32_t source, uint32_t *pairs, uint32_t count) {
    const pir_cgm *cgm = reading->overlay;
    uint8_t *tied = reading->tied[source];
    for (uint32_t f = 0; f < count; f++)
        pairs[f] = PIR_CGM_NONE;
    for (uint32_t v = 0; v < pir_cgm_vertices(cgm); v++) {
        uint32_t f = facet_at(cgm, v, source);
        if (f == PIR_CGM_NONE)
            continue;
        struct pir_cgm_around around = pir_cgm_around_new(cgm, v);
        do {
            uint32_t other = pir_cgm_source_vertex(cgm, cgm->half[around.half].face, 1 - source);
            tied[f] = tied[f] || (pairs[f] != PIR_CGM_NONE && pairs[f] != other);
            pairs[f] = other;
        } while (pir_cgm_around_next(cgm, &around));
    }
    // the hidden facets of a segment are in no map
    for (uint32_t f = 0; f < count; f++)
        if (pairs[f] == PIR_CGM_NONE) {
            pairs[f] = 0;
            tied[f] = 1;
        }
}

static void settle_facets(struct reading *reading) {
    pir_tracked *tracked = reading->tracked;
    pir_pairing *pairing = &tracked->pairing;
    pir_expiry unused;
    for (uint32_t f = 0; f < pairing->p->facet_count; f++)
        if (reading->tied[0][f])
            pairing->fv[f] = pir_descend_fv(tracked, f, pir_rotated_normal(pairing, f), pairing->fv[f], &unused);
    for (uint32_t g = 0; g < pairing->q->facet_count; g++)
        if (reading->tied[1][g])
            pairing->vf[g] = pir_descend_vf(tracked, g, pairing->vf[g], &unused);
}

/* Marks the edges of P whose arcs start or end in a tie, overlap an arc of Q, or pass through a normal of Q. */
static void mark_tied_edges(struct reading *reading) {
    const pir_cgm *cgm = reading->overlay;
    const pir_polytope *p = reading->tracked->pairing.p;
    bool all = p->artificial || reading->tracked->pairing.q->artificial;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t h = p->edge_half[e];
        reading->tied_edge[e] = all || reading->tied[0][p->left[h]] || reading->tied[0][pir_right(p, h)];
    }
    for (uint32_t h = 0; h < 2 * pir_cgm_edges(cgm); h++) {
        uint32_t of_p = pir_cgm_source_half(cgm, h, 0);
        if (of_p != PIR_CGM_NONE &&
            (pir_cgm_source_half(cgm, h, 1) != PIR_CGM_NONE || facet_at(cgm, cgm->half[h].origin, 1) != PIR_CGM_NONE))
            reading->tied_edge[p->edge[of_p]] = 1;
    }
}

/* Stores the crossing at vertex v of the overlay, if there is one. */
static bool read_crossing(struct reading *reading, uint32_t v) {
    pir_tracked *tracked = reading->tracked;
    pir_pairing *pairing = &tracked->pairing;
    const pir_cgm *cgm = reading->overlay;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    uint32_t of_p = PIR_CGM_NONE, of_q = PIR_CGM_NONE, cell = 0;
    struct pir_cgm_around around = pir_cgm_around_new(cgm, v);
    do {
        // of copies on cube edges and corners the first is read
        if (around.vertex < v)
            return true;
        uint32_t h = pir_cgm_source_half(cgm, around.half, 0), k = pir_cgm_source_half(cgm, around.half, 1);
        if (h != PIR_CGM_NONE) {
            of_p = h;
            cell = pir_cgm_source_vertex(cgm, cgm->half[around.half].face, 1);
        }
        of_q = k != PIR_CGM_NONE ? k : of_q;
    } while (pir_cgm_around_next(cgm, &around));
    if (of_p == PIR_CGM_NONE || of_q == PIR_CGM_NONE || reading->tied_edge[p->edge[of_p]])
        return true;
    // the arc of P that leaves v is in the cell after the crossing, or before it when it leaves against the edge
    uint32_t e = p->edge[of_p], end = p->edge_half[e] == of_p ? q->target[of_q] : q->origin[of_q];
    uint32_t slot = pir_crossing_new(tracked, e, end == cell ? of_q : q->twin[of_q]);
    if (slot == PIR_NO_CROSSING)
        return false;
    pairing->crossings.at[slot].next = pairing->crossings.first[e];
    pairing->crossings.first[e] = slot;
    return true;
}

/* Puts the crossings of edge e in order. */
static void link_crossings(struct reading *reading, uint32_t e) {
    pir_tracked *tracked = reading->tracked;
    pir_pairing *pairing = &tracked->pairing;
    pir_crossings *c = &pairing->crossings;
    uint32_t count = 0, v = pairing->fv[pairing->p->left[pairing->p->edge_half[e]]],
             *link = &pairing->crossings.first[e];
    for (uint32_t slot = pairing->crossings.first[e]; slot != PIR_NO_CROSSING; slot = c->at[slot].next, count++)
        reading->slot_at[pairing->q->origin[c->at[slot].half]] = slot;
    for (; count > 0; count--) {
        uint32_t slot = reading->slot_at[v];
        *link = slot;
        link = &c->at[slot].next;
        v = pairing->q->target[c->at[slot].half];
    }
    *link = PIR_NO_CROSSING;
}

/* Walks the arc of edge e by perturbed signs; the cells of both ends are known. */
static bool walk_edge(pir_tracked *tracked, uint32_t e) {
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    uint32_t h = p->edge_half[e], v = pairing->fv[p->left[h]], end = pairing->fv[pir_right(p, h)];
    uint32_t entered = PIR_NO_CROSSING, last = PIR_NO_CROSSING;
    pir_vec3 direction = pir_rotated_direction(pairing, h);
    while (v != end) {
        uint32_t side = pir_leave_cell(tracked, h, direction, v, entered), slot = pir_crossing_new(tracked, e, side);
        if (slot == PIR_NO_CROSSING)
            return false;
        *(last == PIR_NO_CROSSING ? &pairing->crossings.first[e] : &pairing->crossings.at[last].next) = slot;
        last = slot;
        entered = side;
        v = q->target[side];
    }
    return true;
}

static bool read_pairing(struct reading *reading) {
    pir_tracked *tracked = reading->tracked;
    pir_pairing *pairing = &tracked->pairing;
    read_facets(reading, 0, pairing->fv, pairing->p->facet_count);
    read_facets(reading, 1, pairing->vf, pairing->q->facet_count);
    settle_facets(reading);
    mark_tied_edges(reading);
    for (uint32_t v = 0; v < pir_cgm_vertices(reading->overlay); v++)
        if (!read_crossing(reading, v))
            return false;
    for (uint32_t e = 0; e < pairing->p->edge_count; e++) {
        if (!reading->tied_edge[e])
            link_crossings(reading, e);
        else if (!walk_edge(tracked, e))
            return false;
    }
    return true;
}

static bool read_overlay(pir_tracked *tracked, const pir_cgm *overlay) {
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    const pir_allocator *a = &pairing->allocator;
    size_t flags = (size_t)p->facet_count + q->facet_count + p->edge_count;
    uint8_t *flag = PIR_ZEROED(a, uint8_t, flags);
    struct reading reading = {.tracked = tracked, .overlay = overlay, .slot_at = PIR_NEW(a, uint32_t, q->vertex_count)};
    bool done = flag && reading.slot_at;
    if (done) {
        reading.tied[0] = flag;
        reading.tied[1] = flag + p->facet_count;
        reading.tied_edge = flag + p->facet_count + q->facet_count;
        done = read_pairing(&reading);
    }
    PIR_FREE(a, flag, flags);
    PIR_FREE(a, reading.slot_at, q->vertex_count);
    return done;
}

pir_status pir_cgm_rebuild(pir_tracked *tracked, pir_cgm **map_q) {
    pir_pairing *pairing = &tracked->pairing;
    pir_cgm *map = NULL, *overlay = NULL;
    pir_status status = PIR_OK;
    // Q does not rotate and keeps its directions at every scale: its map is made once
    if (!*map_q)
        status = pir_cgm_create(pairing->q, NULL, &pairing->allocator, map_q);
    if (status == PIR_OK)
        status = pir_cgm_create(pairing->p, &pairing->signs.rotation.given, &pairing->allocator, &map);
    if (status == PIR_OK)
        status = pir_cgm_overlay(map, *map_q, &overlay);
    if (status == PIR_OK && !read_overlay(tracked, overlay))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        pairing->signs.by_filter += overlay->by_filter + map->by_filter;
        pairing->signs.by_exact += overlay->by_exact + map->by_exact;
        pir_tracked_expire_all(tracked);
    }
    pir_cgm_release(overlay);
    pir_cgm_release(map);
    return status;
}
