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

#include "base/fetching.h"
#include "dymsum/pairing/crossings.h"
#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/facet_cells.h"

/* Cells with more sides than this are bisected. */
#define MANY_SIDES 12

/* An arc of P: its halfedge, and that rotated. */
struct arc {
    uint32_t half;
    pir_vec3 direction;
    float x, y, z;
};

static inline struct arc arc_of(uint32_t half, pir_vec3 direction) {
    return (struct arc){half, direction, (float)direction.x, (float)direction.y, (float)direction.z};
}

/* The sign of the arc and a facet of Q: by floats, and where those are not certain as every other. */
static inline int corner_sign(pir_tracked *tracked, const struct arc *arc, uint32_t corner_half) {
    uint32_t g = tracked->pairing.q->left[corner_half];
    const float *n = tracked->pairing.q->normal4 + (size_t)4 * g;
    float s = arc->x * n[0] + arc->y * n[1] + arc->z * n[2];
    double unused;
    if (!(fabsf(s) > PIR_FLOAT_BOUND))
        return pir_sign_half_facet(&tracked->pairing, arc->half, arc->direction, g, &unused);
    tracked->pairing.signs.by_filter++;
    return s > 0 ? 1 : -1;
}

uint32_t pir_leave_cell(pir_tracked *tracked, uint32_t h, pir_vec3 direction, uint32_t v, uint32_t entered) {
    const pir_polytope *q = tracked->pairing.q;
    const struct arc arc = arc_of(h, direction);
    uint32_t start = q->ring_start[v], n = q->ring_start[v + 1] - start;
    if (entered == PIR_NO_CROSSING) {
        // the corner before side i is that of side i − 1
        int before = corner_sign(tracked, &arc, start + n - 1);
        for (uint32_t i = 0; i < n; i++) {
            int sign = corner_sign(tracked, &arc, start + i);
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
        if (corner_sign(tracked, &arc, start + (first + middle) % n) < 0)
            low = middle;
        else
            high = middle;
    }
    for (uint32_t i = low + 1; i < high; i++) {
        uint32_t side = first + i < n ? first + i : first + i - n;
        if (corner_sign(tracked, &arc, start + side) > 0)
            return start + side;
    }
    return start + (first + high) % n;
}

/* --- arcs of P --- */

/* Listed and fetched, sides found, crossed: each in a turn of its own. */
#define STAGES 3

/* Bodies with so many halfedges are larger than a cache of the first level by far. */
#define MANY_HALVES 12288

/* Lists those of `count` edges from `first` on, as pir_walk_edges, whose arcs leave a cell. Crossings begin empty. */
static void list_arcs(pir_tracked *tracked, const uint32_t *edge, uint32_t first, uint32_t count, pir_arcs *arcs) {
    const pir_polytope *p = tracked->pairing.p;
    const uint32_t *fv = tracked->pairing.fv;
    uint32_t listed = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t e = edge ? edge[first + i] : first + i;
        const pir_arc_ends ends = p->arc_ends[e];
        tracked->pairing.crossings.first[e] = PIR_NO_CROSSING;
        arcs->edge[listed] = e;
        arcs->half[listed] = p->edge_half[e];
        arcs->from[listed] = fv[ends.from];
        arcs->to[listed] = fv[ends.to];
        // an arc whose ends are in one cell stays in it
        listed += fv[ends.from] != fv[ends.to];
    }
    arcs->count = listed;
}

/* Fetches what the sides of the arcs' first cells are found and measured by. */
PIR_FETCHING void fetch_cells(const pir_polytope *p, const pir_polytope *q, const pir_arcs *arcs) {
    for (uint32_t k = 0; k < arcs->count; k++) {
        uint32_t start = q->ring_start[arcs->from[k]];
        __builtin_prefetch(q->target + start);
        __builtin_prefetch(q->left + start);
        __builtin_prefetch(q->edge + start);
        __builtin_prefetch(p->direction + arcs->half[k]);
    }
}

/* Fetches the corners of the sides that have been found, and what crossings of them are noted in. */
PIR_FETCHING void fetch_sides(const pir_tracked *tracked, const pir_arcs *arcs) {
    const float *normal = tracked->pairing.q->normal4;
    for (uint32_t k = 0; k < arcs->count; k++) {
        __builtin_prefetch(&tracked->work->met[arcs->met[k]], 1);
        __builtin_prefetch(normal + 4 * (size_t)arcs->right[k]);
        __builtin_prefetch(normal + 4 * (size_t)arcs->left[k]);
    }
}

/* As crosses_once, where floats are not certain. */
static bool crosses_once_surely(pir_tracked *tracked, const pir_arcs *arcs, uint32_t k) {
    uint32_t h = arcs->half[k];
    pir_vec3 direction = pir_rotated_direction(&tracked->pairing, h);
    double unused;
    return pir_sign_half_facet(&tracked->pairing, h, direction, arcs->right[k], &unused) < 0 &&
           pir_sign_half_facet(&tracked->pairing, h, direction, arcs->left[k], &unused) > 0;
}

/*
 * Whether arc k crosses one side only. The corners of the side are on either side of the arc's circle, and the ends of
 * the arc are in the two cells: that proves the crossing, and cells are convex.
 */
static inline bool crosses_once(pir_tracked *tracked, const pir_arcs *arcs, uint32_t k) {
    float before = arcs->value[k][0], after = arcs->value[k][1];
    if (arcs->side[k] == PIR_NO_SIDE)
        return false;
    if (fabsf(before) > PIR_FLOAT_BOUND && (before > 0 || fabsf(after) > PIR_FLOAT_BOUND)) {
        tracked->pairing.signs.by_filter += before > 0 ? 1 : 2;
        return before < 0 && after > 0;
    }
    return crosses_once_surely(tracked, arcs, k);
}

/* Walks arc k from cell to cell; `notes` crossings for the facets of Q, as do all that follow. */
static bool walk_arc(pir_tracked *tracked, const pir_arcs *arcs, uint32_t k, bool notes) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t h = arcs->half[k], entered = PIR_NO_CROSSING, last = PIR_NO_CROSSING;
    pir_vec3 direction = pir_rotated_direction(&tracked->pairing, h);
    for (uint32_t v = arcs->from[k]; v != arcs->to[k]; v = q->target[entered]) {
        entered = pir_leave_cell(tracked, h, direction, v, entered);
        if (!pir_crossing_push(tracked, arcs->edge[k], entered, &last))
            return false;
        if (!notes)
            continue;
        // the facet right of a side is left of the side before it
        uint32_t before = (entered > q->ring_start[v] ? entered : q->ring_start[v + 1]) - 1;
        pir_note_met(tracked, h, q->edge[entered], q->left[before], q->left[entered]);
    }
    return true;
}

/* Lists the crossings of the arcs, whose sides have been measured. */
static bool cross_arcs(pir_tracked *tracked, const pir_arcs *arcs, bool notes) {
    for (uint32_t k = 0; k < arcs->count; k++) {
        uint32_t last = PIR_NO_CROSSING;
        if (!crosses_once(tracked, arcs, k)) {
            if (!walk_arc(tracked, arcs, k, notes))
                return false;
            continue;
        }
        if (!pir_crossing_push(tracked, arcs->edge[k], arcs->side[k], &last))
            return false;
        if (notes)
            pir_note_met(tracked, arcs->half[k], arcs->met[k], arcs->right[k], arcs->left[k]);
    }
    return true;
}

/* While some arcs are walked, what the next ones are walked by is fetched. */
bool pir_walk_edges(pir_tracked *tracked, const uint32_t *edge, uint32_t count) {
    const pir_polytope *p = tracked->pairing.p, *q = tracked->pairing.q;
    bool many = q->half_count >= MANY_HALVES;
    uint32_t chunks = count / PIR_ARCS + (count % PIR_ARCS != 0);
    pir_arcs arcs[STAGES];
    for (uint32_t c = 0; c < chunks + STAGES - 1; c++) {
        if (c < chunks) {
            pir_arcs *next = &arcs[c % STAGES];
            list_arcs(tracked, edge, c * PIR_ARCS, count - c * PIR_ARCS < PIR_ARCS ? count - c * PIR_ARCS : PIR_ARCS,
                      next);
            if (many)
                fetch_cells(p, q, next);
        }
        if (c >= 1 && c <= chunks) {
            tracked->kernels->find_sides(q, &arcs[(c - 1) % STAGES]);
            if (many)
                fetch_sides(tracked, &arcs[(c - 1) % STAGES]);
        }
        if (c >= 2) {
            tracked->kernels->measure_sides(&tracked->p_facets, p, q, &arcs[(c - 2) % STAGES]);
            if (!cross_arcs(tracked, &arcs[(c - 2) % STAGES], !edge))
                return false;
        }
    }
    return true;
}

pir_status pir_walk_rebuild(pir_tracked *tracked) {
    pir_tracked_turn_facets(tracked);
    pir_locate_facets_of_p(tracked);
    pir_forget_met(tracked);
    if (!pir_walk_edges(tracked, NULL, tracked->pairing.p->edge_count))
        return PIR_ERR_MEMORY;
    pir_locate_facets_of_q(tracked);
    pir_tracked_expire_all(tracked);
    return PIR_OK;
}
