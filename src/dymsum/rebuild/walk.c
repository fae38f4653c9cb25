/* SPDX-License-Identifier: MIT */
/*
 * The rebuild by walk: one Gaussian map traversed through the other, in time proportional to the result.
 *
 * One facet of P is located by descent. From there every arc of P is walked once, breadth first, and the walk locates
 * the facet at its other end. An arc leaves a convex cell of Q through the one side that has a corner on either side of
 * the arc's circle: counter-clockwise, the side at which s(e, ·) turns from negative to positive. From the side by
 * which the arc entered, the corners' signs are first negative, then positive. So the side is found by bisection when
 * the cell has many. Facets of Q are located last, by descent from an end of an edge whose arc crosses beside them.
 * Where a region leaves features out, region/region.c rebuilds instead.
 */
#include "dymsum/rebuild/walk.h"

#include "dymsum/pairing/crossings.h"
#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/descent.h"

/* Cells with more sides than this are bisected. */
#define MANY_SIDES 12

static int corner_sign(pir_tracked *tracked, uint32_t h, pir_vec3 direction, uint32_t corner_half) {
    double unused;
    return pir_sign_half_facet(&tracked->pairing, h, direction, tracked->pairing.q->left[corner_half], &unused);
}

uint32_t pir_leave_cell(pir_tracked *tracked, uint32_t h, pir_vec3 direction, uint32_t v, uint32_t entered) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t start = q->ring_start[v], n = q->ring_start[v + 1] - start;
    if (entered == PIR_NO_CROSSING) {
        // the corner before side i is that of side i − 1
        int before = corner_sign(tracked, h, direction, start + n - 1);
        for (uint32_t i = 0; i < n; i++) {
            int sign = corner_sign(tracked, h, direction, start + i);
            if (before < 0 && sign > 0)
                return start + i;
            before = sign;
        }
        PIR_ASSERT(false);
    }
    // sides in order from the one by which the arc entered; corner `low` is negative, corner `high` positive
    uint32_t first = q->twin[entered] - start, low = 0, high = n - 1;
    while (high - low > MANY_SIDES) {
        uint32_t middle = low + (high - low) / 2;
        if (corner_sign(tracked, h, direction, start + (first + middle) % n) < 0)
            low = middle;
        else
            high = middle;
    }
    for (uint32_t i = low + 1; i < high; i++) {
        uint32_t side = first + i < n ? first + i : first + i - n;
        if (corner_sign(tracked, h, direction, start + side) > 0)
            return start + side;
    }
    return start + (first + high) % n;
}

/* A flag in work.mark: the facet has a cell. */
enum { LOCATED = 1 };

/*
 * Walks the arc along halfedge h of P from the facet left of it, which is located, to the one right of it, which may
 * not be located yet. The crossings are listed in the edge's own direction.
 */
static bool walk_arc(pir_tracked *tracked, uint32_t h) {
    pir_pairing_work *work = &tracked->work;
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    uint32_t e = p->edge[h], from = p->left[h], to = pir_right(p, h);
    bool forward = p->edge_half[e] == h, located = work->mark[to] & LOCATED;
    pir_vec3 direction = pir_rotated_direction(pairing, h), end = work->rotated[to];
    uint32_t v = pairing->fv[from], entered = PIR_NO_CROSSING, last = PIR_NO_CROSSING;
    while (q->half_count > 0 && !(located && v == pairing->fv[to])) {
        uint32_t side = pir_leave_cell(tracked, h, direction, v, entered);
        double unused;
        if (!located && pir_sign_facet_half(pairing, to, end, side, &unused) < 0)
            break;
        uint32_t slot = pir_crossing_new(tracked, e, forward ? side : q->twin[side]);
        if (slot == PIR_NO_CROSSING)
            return false;
        // append when walking forward, prepend when walking back
        if (!forward) {
            pairing->crossings.next[slot] = pairing->crossings.first[e];
            pairing->crossings.first[e] = slot;
        } else if (last == PIR_NO_CROSSING) {
            pairing->crossings.first[e] = slot;
        } else {
            pairing->crossings.next[last] = slot;
        }
        last = slot;
        entered = side;
        v = q->target[side];
    }
    pairing->fv[to] = v;
    work->mark[to] |= LOCATED;
    return true;
}

/* Locates every facet of P and walks every arc. */
static bool walk_arcs(pir_tracked *tracked) {
    pir_pairing_work *work = &tracked->work;
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *p = pairing->p;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        work->rotated[f] = pir_rotated_normal(pairing, f);
        work->mark[f] = 0;
    }
    if (p->facet_count == 0)
        return true;
    pir_expiry unused;
    pairing->fv[0] = pir_descend_fv(tracked, 0, work->rotated[0], 0, &unused);
    work->mark[0] = LOCATED;
    uint32_t head = 0, tail = 0;
    work->queue[tail++] = 0;
    while (head < tail) {
        uint32_t f = work->queue[head++];
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
            uint32_t h = p->loop[i], to = pir_right(p, h);
            bool is_new = !(work->mark[to] & LOCATED);
            // an arc between two located facets is walked from the edge's own left one
            if (!is_new && (p->edge_half[p->edge[h]] != h || pairing->crossings.first[p->edge[h]] != PIR_NO_CROSSING))
                continue;
            if (!walk_arc(tracked, h))
                return false;
            if (is_new)
                work->queue[tail++] = to;
        }
    }
    return true;
}

/* Locates the facets of Q: those beside a crossing first, the rest from a neighbour. */
static void locate_facets_of_q(pir_tracked *tracked) {
    pir_pairing_work *work = &tracked->work;
    pir_pairing *pairing = &tracked->pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    for (uint32_t g = 0; g < q->facet_count; g++)
        work->mark[g] = 0;
    for (uint32_t i = 0; i < pairing->crossings.used; i++) {
        uint32_t half = p->edge_half[pairing->crossings.edge[i]], h = pairing->crossings.half[i];
        pairing->vf[pir_right(q, h)] = p->origin[half];
        pairing->vf[q->left[h]] = p->target[half];
        work->mark[pir_right(q, h)] = work->mark[q->left[h]] = LOCATED;
    }
    uint32_t head = 0, tail = 0;
    for (uint32_t g = 0; g < q->facet_count; g++)
        if (work->mark[g] & LOCATED)
            work->queue[tail++] = g;
    if (tail == 0 && q->facet_count > 0) {
        pairing->vf[0] = 0;
        work->mark[0] = LOCATED;
        work->queue[tail++] = 0;
    }
    while (head < tail) {
        uint32_t g = work->queue[head++];
        pir_expiry unused;
        pairing->vf[g] = pir_descend_vf(tracked, g, pairing->vf[g], &unused);
        for (uint32_t i = q->loop_start[g]; i < q->loop_start[g + 1]; i++) {
            uint32_t beside = pir_right(q, q->loop[i]);
            if (work->mark[beside] & LOCATED)
                continue;
            work->mark[beside] = LOCATED;
            pairing->vf[beside] = pairing->vf[g];
            work->queue[tail++] = beside;
        }
    }
}

pir_status pir_walk_rebuild(pir_tracked *tracked) {
    if (!walk_arcs(tracked))
        return PIR_ERR_MEMORY;
    locate_facets_of_q(tracked);
    pir_tracked_expire_all(tracked);
    return PIR_OK;
}
