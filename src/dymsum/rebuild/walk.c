/* SPDX-License-Identifier: MIT */
/*
 * The rebuild by walk: one Gaussian map traversed through the other, in time proportional to the result.
 *
 * The facets of P are located first, each by descent from the cell of one beside it (facet_cells.c). An arc whose
 * ends are in one cell stays in it, since cells are convex. Most others cross one side, which leads from cell to
 * cell. The rest are walked: an arc leaves a convex cell of Q through the one side that has a corner on either side
 * of the arc's circle: counter-clockwise, the side at which s(e, ·) turns from negative to positive. From the side by
 * which the arc entered, the corners' signs are first negative, then positive. So the side is found by bisection when
 * the cell has many. The cells of Q's facets follow from the crossings. Where a region leaves features out,
 * region/region_walk.c rebuilds instead.
 */
#include "dymsum/rebuild/walk.h"

#include "dymsum/pairing/crossings.h"
#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/facet_cells.h"

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

/*
 * Whether the arc of edge e, its halfedge h rotated to `direction`, crosses one side only, from its first cell v into
 * the last, which is beside it. The corners of the side are on either side of the arc's circle, and the ends of the arc
 * are in the two cells: that proves the crossing, and cells are convex. *ret_side: the side.
 */
static bool crosses_once(pir_tracked *tracked, uint32_t h, pir_vec3 direction, uint32_t v, uint32_t last,
                         uint32_t *ret_side) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t start = q->ring_start[v], end = q->ring_start[v + 1];
    for (uint32_t side = start; side < end; side++) {
        if (q->target[side] != last)
            continue;
        uint32_t before = side > start ? side - 1 : end - 1;
        if (corner_sign(tracked, h, direction, before) < 0 && corner_sign(tracked, h, direction, side) > 0) {
            *ret_side = side;
            return true;
        }
    }
    return false;
}

bool pir_walk_arc(pir_tracked *tracked, uint32_t e, uint32_t from, uint32_t to) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t h = tracked->pairing.p->edge_half[e], side, last = PIR_NO_CROSSING;
    pir_vec3 direction = pir_rotated_direction(&tracked->pairing, h);
    if (crosses_once(tracked, h, direction, from, to, &side))
        return pir_crossing_push(tracked, e, side, &last);
    uint32_t entered = PIR_NO_CROSSING;
    for (uint32_t v = from; v != to; v = q->target[side]) {
        side = pir_leave_cell(tracked, h, direction, v, entered);
        if (!pir_crossing_push(tracked, e, side, &last))
            return false;
        entered = side;
    }
    return true;
}

pir_status pir_walk_rebuild(pir_tracked *tracked) {
    pir_tracked_turn_facets(tracked);
    pir_locate_facets_of_p(tracked);
    for (uint32_t e = 0; e < tracked->pairing.p->edge_count; e++)
        if (!pir_walk_edge(tracked, e))
            return PIR_ERR_MEMORY;
    pir_locate_facets_of_q(tracked);
    pir_tracked_expire_all(tracked);
    return PIR_OK;
}
