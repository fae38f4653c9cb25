/* SPDX-License-Identifier: MIT */
/*
 * The brute-force rebuild (Behar and Lien, Algorithm 3.1): every facet against every vertex of the other polytope,
 * every edge against every edge. Updates are measured against it, so it is written with care: normals are rotated once,
 * and a pair is abandoned at the first sign that excludes it.
 */
#include "dymsum/rebuild/brute.h"

#include "dymsum/pairing/crossings.h"
#include "dymsum/pairing/predicates.h"

/* Whether v of Q is farthest along rotated facet f. */
static bool fv_is_compatible(pir_tracked *tracked, uint32_t f, uint32_t v) {
    double unused;
    for (uint32_t h = tracked->pairing.q->ring_start[v]; h < tracked->pairing.q->ring_start[v + 1]; h++)
        if (pir_sign_facet_half(&tracked->pairing, f, tracked->work->rotated[f], h, &unused) > 0)
            return false;
    return true;
}

/* Whether v of P is farthest along facet g of Q. */
static bool vf_is_compatible(pir_tracked *tracked, uint32_t g, pir_vec3 turned_back, uint32_t v) {
    double unused;
    for (uint32_t h = tracked->pairing.p->ring_start[v]; h < tracked->pairing.p->ring_start[v + 1]; h++)
        if (pir_sign_facet_half_back(&tracked->pairing, g, turned_back, h, &unused) > 0)
            return false;
    return true;
}

/* The halfedge along edge e2 of Q that the arc of halfedge h of P crosses, or PIR_NO_CROSSING. */
static uint32_t crossed_half(pir_tracked *tracked, uint32_t h, pir_vec3 direction, uint32_t e2) {
    const pir_polytope *p = tracked->pairing.p, *q = tracked->pairing.q;
    uint32_t side = q->edge_half[e2], from = p->left[h], to = pir_right(p, h);
    double unused;
    int behind = pir_sign_facet_half(&tracked->pairing, from, tracked->work->rotated[from], side, &unused);
    if (pir_sign_facet_half(&tracked->pairing, to, tracked->work->rotated[to], side, &unused) == behind)
        return PIR_NO_CROSSING;
    // of the two halfedges, the one along which the arc goes from behind to ahead
    if (behind > 0)
        side = q->twin[side];
    if (pir_sign_half_facet(&tracked->pairing, h, direction, pir_right(q, side), &unused) > 0 ||
        pir_sign_half_facet(&tracked->pairing, h, direction, q->left[side], &unused) < 0)
        return PIR_NO_CROSSING;
    return side;
}

/* Links the slots [from, used) of edge e into a chain of cells that starts in its left one. */
static void chain_crossings(pir_tracked *tracked, uint32_t e, uint32_t from) {
    pir_pairing *pairing = &tracked->pairing;
    pir_crossings *c = &pairing->crossings;
    uint32_t v = pairing->fv[pairing->p->left[pairing->p->edge_half[e]]], *link = &pairing->crossings.first[e];
    for (uint32_t n = c->used - from; n > 0; n--) {
        uint32_t slot = from;
        while (slot < c->used && pairing->q->origin[c->at[slot].half] != v)
            slot++;
        PIR_ASSERT(slot < c->used);
        *link = slot;
        link = &c->at[slot].next;
        v = pairing->q->target[c->at[slot].half];
    }
    *link = PIR_NO_CROSSING;
}

pir_status pir_brute_rebuild(pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        tracked->work->rotated[f] = pir_rotated_normal(pairing, f);
        for (uint32_t v = 0; v < q->vertex_count; v++)
            if (fv_is_compatible(tracked, f, v))
                pairing->fv[f] = v;
    }
    for (uint32_t g = 0; g < q->facet_count; g++) {
        pir_vec3 turned_back = pir_turned_back_normal(pairing, g);
        for (uint32_t v = 0; v < p->vertex_count; v++)
            if (vf_is_compatible(tracked, g, turned_back, v))
                pairing->vf[g] = v;
    }
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t h = p->edge_half[e], from = pairing->crossings.used;
        pir_vec3 direction = pir_rotated_direction(pairing, h);
        for (uint32_t e2 = 0; e2 < q->edge_count; e2++) {
            uint32_t side = crossed_half(tracked, h, direction, e2);
            if (side != PIR_NO_CROSSING && pir_crossing_new(tracked, e, side) == PIR_NO_CROSSING)
                return PIR_ERR_MEMORY;
        }
        chain_crossings(tracked, e, from);
    }
    pir_tracked_expire_all(tracked);
    return PIR_OK;
}
