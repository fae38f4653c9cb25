/* SPDX-License-Identifier: MIT */
/*
 * The brute-force re-check (Behar and Lien, Algorithm 3.1): every facet against every vertex of the other polytope, every edge
 * against every edge. It is the baseline that updates are measured against, so it is written with care: normals are rotated once, and a
 * pair is given up at the first sign that rules it out.
 */
#include "dymsum/sum.h"

/* Whether v of Q is farthest along rotated facet f. */
static bool fv_is_compatible(pir_sum *sum, uint32_t f, uint32_t v) {
    double unused;
    for (uint32_t h = sum->pairing.q->ring_start[v]; h < sum->pairing.q->ring_start[v + 1]; h++)
        if (pir_sign_facet_half(sum, f, sum->rotated[f], h, &unused) > 0)
            return false;
    return true;
}

/* Whether v of P is farthest along facet g of Q. */
static bool vf_is_compatible(pir_sum *sum, uint32_t g, pir_vec3 turned_back, uint32_t v) {
    double unused;
    for (uint32_t h = sum->pairing.p->ring_start[v]; h < sum->pairing.p->ring_start[v + 1]; h++)
        if (pir_sign_facet_half_back(sum, g, turned_back, h, &unused) > 0)
            return false;
    return true;
}

/* The halfedge along edge e2 of Q that the arc of halfedge h of P crosses, or PIR_NO_CROSSING. */
static uint32_t crossed_half(pir_sum *sum, uint32_t h, pir_vec3 direction, uint32_t e2) {
    const pir_polytope *p = sum->pairing.p, *q = sum->pairing.q;
    uint32_t side = q->edge_half[e2], from = p->left[h], to = pir_right(p, h);
    double unused;
    int behind = pir_sign_facet_half(sum, from, sum->rotated[from], side, &unused);
    if (pir_sign_facet_half(sum, to, sum->rotated[to], side, &unused) == behind)
        return PIR_NO_CROSSING;
    // of the two halfedges, the one along which the arc goes from behind to ahead
    if (behind > 0)
        side = q->twin[side];
    if (pir_sign_half_facet(sum, h, direction, pir_right(q, side), &unused) > 0 ||
        pir_sign_half_facet(sum, h, direction, q->left[side], &unused) < 0)
        return PIR_NO_CROSSING;
    return side;
}

/* Links the slots [from, used) of edge e into a chain of cells that starts in its left one. */
static void chain_crossings(pir_sum *sum, uint32_t e, uint32_t from) {
    pir_crossings *c = &sum->pairing.crossings;
    uint32_t v = sum->pairing.fv[sum->pairing.p->left[sum->pairing.p->edge_half[e]]],
             *link = &sum->pairing.crossings.first[e];
    for (uint32_t n = c->used - from; n > 0; n--) {
        uint32_t slot = from;
        while (slot < c->used && sum->pairing.q->origin[c->half[slot]] != v)
            slot++;
        PIR_ASSERT(slot < c->used);
        *link = slot;
        link = &c->next[slot];
        v = sum->pairing.q->target[c->half[slot]];
    }
    *link = PIR_NO_CROSSING;
}

pir_status pir_brute_rebuild(pir_sum *sum) {
    const pir_polytope *p = sum->pairing.p, *q = sum->pairing.q;
    pir_crossings_clear(sum);
    pir_region_open(sum);
    for (uint32_t f = 0; f < p->facet_count; f++) {
        sum->rotated[f] = pir_rotated_normal(sum, f);
        for (uint32_t v = 0; v < q->vertex_count; v++)
            if (fv_is_compatible(sum, f, v))
                sum->pairing.fv[f] = v;
    }
    for (uint32_t g = 0; g < q->facet_count; g++) {
        pir_vec3 turned_back = pir_turned_back_normal(sum, g);
        for (uint32_t v = 0; v < p->vertex_count; v++)
            if (vf_is_compatible(sum, g, turned_back, v))
                sum->pairing.vf[g] = v;
    }
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t h = p->edge_half[e], from = sum->pairing.crossings.used;
        pir_vec3 direction = pir_rotated_direction(sum, h);
        for (uint32_t e2 = 0; e2 < q->edge_count; e2++) {
            uint32_t side = crossed_half(sum, h, direction, e2);
            if (side != PIR_NO_CROSSING && pir_crossing_new(sum, e, side) == PIR_NO_CROSSING)
                return PIR_ERR_MEMORY;
        }
        chain_crossings(sum, e, from);
    }
    pir_expire_all(sum);
    pir_region_close(sum);
    return PIR_OK;
}
