/* SPDX-License-Identifier: MIT */
/*
 * The crossings of one edge, brought up to date.
 *
 * Along a continuous turn the crossings of an arc change only where one facet, a point, passes through an arc. When an
 * end of edge e crosses the arc of h, from one cell to the next, the list of e loses the crossing of h at that end or,
 * if it had none, gains the reverse crossing. When facet g of Q crosses the arc of e, e passes g on the other side: its
 * crossings of g's arcs, which are consecutive, are replaced by crossings of all other arcs of g. So an edge with one
 * event is repaired without a sign.
 *
 * Moves of both ends may come in any order. As long as no facet of Q passes through it, an arc whose ends move keeps
 * its homotopy class on the sphere less the facets of Q. That sphere shrinks to the graph of cells and sides. On this
 * graph a class has exactly one list in which no crossing stands next to its reverse. An arc has such a list, for cells
 * are convex, and the moves below keep it so. Where a facet of Q passes and other events touch the same arc, the
 * crossings are derived again from the left cell to the right one, and the old ones are tried first.
 */
#include "dymsum/update/repair.h"

#include "dymsum/pairing/crossings.h"
#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/walk.h"

bool pir_move_start(pir_tracked *tracked, uint32_t e, uint32_t h) {
    pir_pairing *pairing = &tracked->pairing;
    pir_crossings *c = &pairing->crossings;
    uint32_t first = pairing->crossings.first[e];
    if (first != PIR_NO_CROSSING && c->at[first].half == h) {
        pairing->crossings.first[e] = c->at[first].next;
        pir_crossing_free(tracked, first);
        tracked->statistics.repaired++;
        return true;
    }
    uint32_t slot = pir_crossing_new(tracked, e, pairing->q->twin[h]);
    if (slot == PIR_NO_CROSSING)
        return false;
    c->at[slot].next = first;
    pairing->crossings.first[e] = slot;
    return true;
}

bool pir_move_end(pir_tracked *tracked, uint32_t e, uint32_t h) {
    pir_pairing *pairing = &tracked->pairing;
    pir_crossings *c = &pairing->crossings;
    uint32_t *link = &pairing->crossings.first[e], back = pairing->q->twin[h];
    while (*link != PIR_NO_CROSSING && c->at[*link].next != PIR_NO_CROSSING)
        link = &c->at[*link].next;
    if (*link != PIR_NO_CROSSING && c->at[*link].half == back) {
        pir_crossing_free(tracked, *link);
        *link = PIR_NO_CROSSING;
        tracked->statistics.repaired++;
        return true;
    }
    // the slots may be reallocated: the link is found by its slot
    uint32_t last = *link, slot = pir_crossing_new(tracked, e, h);
    if (slot == PIR_NO_CROSSING)
        return false;
    *(last == PIR_NO_CROSSING ? &pairing->crossings.first[e] : &c->at[last].next) = slot;
    return true;
}

/* a where the mask is all ones, b where it is 0. Which it is is not foreseen. */
static inline uint32_t choose(uint32_t mask, uint32_t a, uint32_t b) {
    return b ^ ((a ^ b) & mask);
}

bool pir_move_either(pir_tracked *tracked, uint32_t e, bool start, uint32_t h) {
    pir_crossings *c = &tracked->pairing.crossings;
    const uint32_t back = tracked->pairing.q->twin[h], at_start = -(uint32_t)start;
    uint32_t *link = &c->first[e], slot = *link;
    const uint32_t is = -(uint32_t)(slot != PIR_NO_CROSSING);
    uint32_t here = slot & is;
    // to the last, unless it is about the first, or there is none
    while ((c->at[here].next | at_start | ~is) != PIR_NO_CROSSING) {
        link = &c->at[here].next;
        here = slot = *link;
    }
    if (slot != PIR_NO_CROSSING && c->at[slot].half == choose(at_start, h, back)) {
        *link = c->at[slot].next;
        pir_crossing_free(tracked, slot);
        tracked->statistics.repaired++;
        return true;
    }
    uint32_t taken = pir_crossing_new(tracked, e, choose(at_start, back, h));
    if (taken == PIR_NO_CROSSING)
        return false;
    // the slots may have been reallocated
    c->at[taken].next = choose(at_start, slot, PIR_NO_CROSSING);
    *(is & ~at_start ? &c->at[here].next : &c->first[e]) = taken;
    return true;
}

static uint32_t ring_before(const pir_polytope *p, uint32_t half) {
    uint32_t v = p->origin[half];
    return half == p->ring_start[v] ? p->ring_start[v + 1] - 1 : half - 1;
}

bool pir_pass_facet(pir_tracked *tracked, uint32_t e, uint32_t g, bool to_left) {
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *q = pairing->q;
    pir_crossings *c = &pairing->crossings;
    // the first crossing of an arc of g, on the side where g was
    uint32_t before = PIR_NO_CROSSING, at = pairing->crossings.first[e];
    while (at != PIR_NO_CROSSING && (to_left ? pir_right(q, c->at[at].half) : q->left[c->at[at].half]) != g) {
        before = at;
        at = c->at[at].next;
    }
    PIR_ASSERT(at != PIR_NO_CROSSING);
    uint32_t from = c->at[at].half, to = q->origin[from];
    // remove all consecutive crossings of g's arcs
    while (at != PIR_NO_CROSSING && (to_left ? pir_right(q, c->at[at].half) : q->left[c->at[at].half]) == g) {
        uint32_t next = c->at[at].next;
        to = q->target[c->at[at].half];
        pir_crossing_free(tracked, at);
        tracked->statistics.repaired++;
        at = next;
    }
    // insert crossings of g's other arcs, from the cell where the removed ones began to the one where they ended
    uint32_t half = to_left ? ring_before(q, from) : pir_ring_next(q, from);
    for (;;) {
        uint32_t slot = pir_crossing_new(tracked, e, half);
        if (slot == PIR_NO_CROSSING)
            return false;
        c->at[slot].next = at;
        *(before == PIR_NO_CROSSING ? &pairing->crossings.first[e] : &c->at[before].next) = slot;
        before = slot;
        if (q->target[half] == to)
            return true;
        half = to_left ? ring_before(q, q->twin[half]) : pir_ring_next(q, q->twin[half]);
    }
}

/*
 * Whether the arc along halfedge `half` of P, which leaves the cell of h's origin, leaves it through h. The corners of
 * h tell.
 */
static bool leaves_through(pir_tracked *tracked, uint32_t half, pir_vec3 direction, uint32_t h) {
    double unused;
    return pir_sign_half_facet(&tracked->pairing, half, direction, pir_right(tracked->pairing.q, h), &unused) < 0 &&
           pir_sign_half_facet(&tracked->pairing, half, direction, tracked->pairing.q->left[h], &unused) > 0;
}

/*
 * Takes the crossing out of cell v from the list at *list, or gives PIR_NO_CROSSING where the list has none that still
 * holds.
 */
static uint32_t take_crossing(pir_tracked *tracked, uint32_t *list, uint32_t half, pir_vec3 direction, uint32_t v) {
    pir_crossings *c = &tracked->pairing.crossings;
    for (uint32_t *at = list; *at != PIR_NO_CROSSING; at = &c->at[*at].next) {
        uint32_t slot = *at;
        if (tracked->pairing.q->origin[c->at[slot].half] != v)
            continue;
        if (!leaves_through(tracked, half, direction, c->at[slot].half))
            break;
        *at = c->at[slot].next;
        return slot;
    }
    return PIR_NO_CROSSING;
}

bool pir_derive_edge(pir_tracked *tracked, uint32_t e) {
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    pir_crossings *c = &pairing->crossings;
    uint32_t half = p->edge_half[e], end = pairing->fv[p->arc_ends[e].to], v = pairing->fv[p->arc_ends[e].from];
    pir_vec3 direction = pir_rotated_direction(pairing, half);
    uint32_t old = pairing->crossings.first[e], last = PIR_NO_CROSSING, entered = PIR_NO_CROSSING;
    pairing->crossings.first[e] = PIR_NO_CROSSING;
    while (v != end) {
        uint32_t slot = take_crossing(tracked, &old, half, direction, v);
        if (slot == PIR_NO_CROSSING)
            slot = pir_crossing_new(tracked, e, pir_leave_cell(tracked, half, direction, v, entered));
        if (slot == PIR_NO_CROSSING)
            return false;
        c->at[slot].next = PIR_NO_CROSSING;
        *(last == PIR_NO_CROSSING ? &pairing->crossings.first[e] : &c->at[last].next) = slot;
        last = slot;
        entered = c->at[slot].half;
        v = q->target[entered];
    }
    // the arc no longer crosses the rest of the old list
    while (old != PIR_NO_CROSSING) {
        uint32_t next = c->at[old].next;
        pir_crossing_free(tracked, old);
        tracked->statistics.repaired++;
        old = next;
    }
    return true;
}
