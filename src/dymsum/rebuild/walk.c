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
struct turned_arc {
    uint32_t half;
    float x, y, z;
};

static inline struct turned_arc arc_of_edge(const pir_tracked *tracked, uint32_t e) {
    const pir_edge_arc *d = &tracked->pairing.p->edge_arc[e];
    const float(*turn)[8] = tracked->p_facets.turn;
    struct turned_arc arc = {.half = d->half};
    arc.x = turn[0][0] * d->x + turn[1][0] * d->y + turn[2][0] * d->z;
    arc.y = turn[0][1] * d->x + turn[1][1] * d->y + turn[2][1] * d->z;
    arc.z = turn[0][2] * d->x + turn[1][2] * d->y + turn[2][2] * d->z;
    return arc;
}

/* The sign of the arc and a facet of Q: by floats, and where those are not certain as every other. */
static inline int corner_sign(pir_tracked *tracked, const struct turned_arc *arc, uint32_t corner_half) {
    uint32_t g = tracked->pairing.q->left[corner_half];
    const float *n = tracked->pairing.q->normal4 + (size_t)4 * g;
    float s = arc->x * n[0] + arc->y * n[1] + arc->z * n[2];
    double unused;
    if (!(fabsf(s) > PIR_FLOAT_BOUND))
        return pir_sign_half_facet(&tracked->pairing, arc->half, pir_rotated_direction(&tracked->pairing, arc->half), g,
                                   &unused);
    tracked->pairing.signs.by_filter++;
    return s > 0 ? 1 : -1;
}

/* As pir_leave_cell, with `by` the halfedge of v by which the arc came, or PIR_NO_SIDE. */
static uint32_t leave_cell(pir_tracked *tracked, const struct turned_arc *arc, uint32_t v, uint32_t by) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t start = q->ring_start[v], n = q->ring_start[v + 1] - start;
    if (by == PIR_NO_SIDE) {
        // the corner before side i is that of side i − 1
        int before = corner_sign(tracked, arc, start + n - 1);
        for (uint32_t i = 0; i < n; i++) {
            int sign = corner_sign(tracked, arc, start + i);
            if (before < 0 && sign > 0)
                return start + i;
            before = sign;
        }
        PIR_ASSERT(false);
    }
    // sides in order from the one by which the arc entered; corner `low` is negative, corner `high` positive
    uint32_t first = by - start, low = 0, high = n - 1;
    while (high - low > MANY_SIDES) {
        uint32_t middle = low + (high - low) / 2;
        if (corner_sign(tracked, arc, start + (first + middle) % n) < 0)
            low = middle;
        else
            high = middle;
    }
    for (uint32_t i = low + 1; i < high; i++) {
        uint32_t side = first + i < n ? first + i : first + i - n;
        if (corner_sign(tracked, arc, start + side) > 0)
            return start + side;
    }
    return start + (first + high) % n;
}

uint32_t pir_leave_cell(pir_tracked *tracked, uint32_t h, pir_vec3 direction, uint32_t v, uint32_t entered) {
    const struct turned_arc arc = {h, (float)direction.x, (float)direction.y, (float)direction.z};
    return leave_cell(tracked, &arc, v, entered == PIR_NO_CROSSING ? PIR_NO_SIDE : tracked->pairing.q->twin[entered]);
}

/*
 * The halfedge of v by which an arc came from vertex `from` through `side` of its cell: the twin of that, which on a
 * large body is far from all else that is read.
 */
static uint32_t entered_by(const pir_polytope *q, uint32_t v, uint32_t from, uint32_t side) {
    uint32_t by = q->ring_start[v], sides = q->ring_start[v + 1] - by;
    if (sides <= 2 || sides > MANY_SIDES)
        return q->twin[side];
    while (q->target[by] != from)
        by++;
    return by;
}

/* --- arcs of P --- */

/*
 * Arcs, and the first steps of those that no one side leads to the end. On large bodies each of these is a turn of its
 * own: arcs are listed; their sides are found; they leave their first cells; the next cells' corners are fetched; they
 * are crossed.
 */
struct chunk {
    pir_arcs arcs;
    uint32_t led;                            /* arcs without a side */
    uint32_t arc[PIR_ARCS];                  /* which those are */
    uint32_t side[PIR_ARCS], cell[PIR_ARCS]; /* the side by which each leaves its first cell, and the cell beyond */
};

#define TURNS 5

/* Edges are fetched so many arcs before they are listed. */
#define FETCHED_BEFORE (3 * PIR_ARCS)

/*
 * Lists those of `count` edges from `first` on, as pir_walk_edges, whose arcs leave a cell. fresh: crossings begin
 * empty.
 */
static void list_arcs(pir_tracked *tracked, const uint32_t *edge, uint32_t first, uint32_t count, bool fresh,
                      pir_arcs *arcs) {
    const pir_polytope *p = tracked->pairing.p;
    const uint32_t *fv = tracked->pairing.fv;
    uint32_t listed = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t e = edge ? edge[first + i] : first + i;
        const pir_arc_ends ends = p->edge_arc[e].ends;
        if (fresh)
            tracked->pairing.crossings.first[e] = PIR_NO_CROSSING;
        arcs->edge[listed] = e;
        arcs->from[listed] = fv[ends.from];
        arcs->to[listed] = fv[ends.to];
        // an arc whose ends are in one cell stays in it
        listed += fv[ends.from] != fv[ends.to];
    }
    arcs->count = listed;
}

/* Fetches the corners of the side found of arc k, and what a crossing of it is noted in. */
PIR_FETCHING void fetch_side(const pir_tracked *tracked, const pir_arcs *arcs, uint32_t k) {
    const float *normal = tracked->pairing.q->normal4;
    __builtin_prefetch(&tracked->pairing.vf[arcs->left[k]], 1);
    __builtin_prefetch(&tracked->pairing.q->beside[arcs->left[k]]);
    __builtin_prefetch(normal + 4 * (size_t)arcs->right[k]);
    __builtin_prefetch(normal + 4 * (size_t)arcs->left[k]);
}

/* Edges of P, listed or all, from a place on. */
struct edges {
    const uint32_t *edge; /* NULL: all */
    uint32_t count, first;
};

/* Fetches what is read of an edge. */
PIR_FETCHING void fetch_edge(const pir_polytope *p, const struct edges *edges, uint32_t k) {
    uint32_t i = edges->first + k;
    if (i < edges->count)
        PIR_FETCH(&p->edge_arc[edges->edge ? edges->edge[i] : i]);
}

/* The ring of a cell of so many sides often begins in one line of a cache and ends in the next. */
#define USUAL_SIDES 6

/* Fetches what the side of arc k's first cell is found by. */
PIR_FETCHING void fetch_cell(const pir_polytope *q, const pir_arcs *arcs, uint32_t k) {
    uint32_t start = q->ring_start[arcs->from[k]];
    __builtin_prefetch(q->target + start);
    __builtin_prefetch(q->target + start + USUAL_SIDES - 1);
    __builtin_prefetch(q->left + start);
    __builtin_prefetch(q->left + start + USUAL_SIDES - 1);
}

/* Fetches the corners of a cell. */
PIR_FETCHING void fetch_corners(const pir_polytope *q, uint32_t v) {
    for (uint32_t h = q->ring_start[v]; h < q->ring_start[v + 1]; h++)
        __builtin_prefetch(q->normal4 + 4 * (size_t)q->left[h]);
}

/* Lists the arcs without a side, and fetches what they leave their first cells by. */
static void list_led(const pir_polytope *q, struct chunk *chunk) {
    uint32_t led = 0;
    for (uint32_t k = 0; k < chunk->arcs.count; k++) {
        chunk->arc[led] = k;
        led += chunk->arcs.side[k] == PIR_NO_SIDE;
    }
    for (uint32_t i = 0; i < led; i++)
        fetch_corners(q, chunk->arcs.from[chunk->arc[i]]);
    chunk->led = led;
}

/* Leads them out of their first cells, and fetches the sides of the next. */
static void leave_first_cells(pir_tracked *tracked, struct chunk *chunk) {
    const pir_polytope *q = tracked->pairing.q;
    for (uint32_t i = 0; i < chunk->led; i++) {
        uint32_t k = chunk->arc[i];
        const struct turned_arc arc = arc_of_edge(tracked, chunk->arcs.edge[k]);
        uint32_t side = leave_cell(tracked, &arc, chunk->arcs.from[k], PIR_NO_SIDE);
        uint32_t start = q->ring_start[q->target[side]];
        chunk->side[i] = side;
        chunk->cell[i] = q->target[side];
        __builtin_prefetch(&tracked->pairing.vf[q->left[side]], 1);
        __builtin_prefetch(q->target + start);
        __builtin_prefetch(q->left + start);
    }
}

static void fetch_next_cells(const pir_polytope *q, const struct chunk *chunk) {
    for (uint32_t i = 0; i < chunk->led; i++)
        fetch_corners(q, chunk->cell[i]);
}

/* As crosses_once, where floats are not certain. */
static bool crosses_once_surely(pir_tracked *tracked, const pir_arcs *arcs, uint32_t k) {
    uint32_t h = tracked->pairing.p->edge_arc[arcs->edge[k]].half;
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

/* Where crossings are listed: in the sum's store, which has been forgotten, noted for the facets of Q or not; aside. */
enum listing { NOTED, UNNOTED, ASIDE };

static inline bool list_crossing(pir_tracked *tracked, uint32_t e, uint32_t h, uint32_t *last, enum listing listing,
                                 pir_walked *walked) {
    if (listing != ASIDE)
        return pir_crossing_push(tracked, e, h, last);
    if (walked->count == PIR_WALKED_MOST)
        return false;
    walked->at[walked->count++] = (pir_walked_crossing){e, h};
    return true;
}

/*
 * Walks arc k from cell to cell; `side` is the one by which it leaves the first, or PIR_NO_SIDE. many: Q is a large
 * body.
 */
static inline __attribute__((always_inline)) bool walk_arc(pir_tracked *tracked, const pir_arcs *arcs, uint32_t k,
                                                           uint32_t side, bool many, enum listing listing,
                                                           pir_walked *walked) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t v = arcs->from[k], by = PIR_NO_SIDE, last = PIR_NO_CROSSING;
    const struct turned_arc arc = arc_of_edge(tracked, arcs->edge[k]);
    while (v != arcs->to[k]) {
        if (!many || by != PIR_NO_SIDE || side == PIR_NO_SIDE)
            side = leave_cell(tracked, &arc, v, by);
        if (!list_crossing(tracked, arcs->edge[k], side, &last, listing, walked))
            return false;
        uint32_t from = v;
        if (listing == NOTED) {
            // the facet right of a side is left of the side before it
            uint32_t before = (side > q->ring_start[v] ? side : q->ring_start[v + 1]) - 1;
            if (many)
                pir_note_passed(tracked, arcs->edge[k], q->left[before], q->left[side]);
            else
                pir_note_met(tracked, arcs->edge[k], q->edge[side], q->left[before], q->left[side]);
        }
        v = q->target[side];
        by = many ? v != arcs->to[k] ? entered_by(q, v, from, side) : PIR_NO_SIDE : q->twin[side];
    }
    return true;
}

/* Lists the crossings of arc k, whose side has been measured; where it has none, `side` is as in walk_arc. */
static inline __attribute__((always_inline)) bool cross_arc(pir_tracked *tracked, const pir_arcs *arcs, uint32_t k,
                                                            uint32_t side, bool many, enum listing listing,
                                                            pir_walked *walked) {
    uint32_t last = PIR_NO_CROSSING;
    if (!crosses_once(tracked, arcs, k))
        return walk_arc(tracked, arcs, k, side, many, listing, walked);
    if (!list_crossing(tracked, arcs->edge[k], arcs->side[k], &last, listing, walked))
        return false;
    if (listing == NOTED && many)
        pir_note_passed(tracked, arcs->edge[k], arcs->right[k], arcs->left[k]);
    else if (listing == NOTED)
        pir_note_met(tracked, arcs->edge[k], tracked->pairing.q->edge[arcs->side[k]], arcs->right[k], arcs->left[k]);
    return true;
}

static bool cross_arcs(pir_tracked *tracked, const pir_arcs *arcs, enum listing listing, pir_walked *walked) {
    for (uint32_t k = 0; k < arcs->count; k++)
        if (!cross_arc(tracked, arcs, k, PIR_NO_SIDE, false, listing, walked))
            return false;
    return true;
}

/*
 * Crosses the chunk of a large body, and fetches between arcs the memory of the next two: one at a time, since a
 * processor that is to fetch many lines at once does nothing else meanwhile.
 */
static bool cross_and_fetch(pir_tracked *tracked, const struct chunk *chunk, const pir_arcs *found,
                            const pir_arcs *listed, const struct edges *next, enum listing listing,
                            pir_walked *walked) {
    for (uint32_t k = 0, i = 0; k < PIR_ARCS; k++) {
        fetch_edge(tracked->pairing.p, next, k);
        if (k < found->count)
            fetch_side(tracked, found, k);
        if (k < listed->count)
            fetch_cell(tracked->pairing.q, listed, k);
        bool leads = i < chunk->led && chunk->arc[i] == k;
        if (k < chunk->arcs.count &&
            !cross_arc(tracked, &chunk->arcs, k, leads ? chunk->side[i] : PIR_NO_SIDE, true, listing, walked))
            return false;
        i += leads;
    }
    return true;
}

static bool walk_edges(pir_tracked *tracked, const uint32_t *edge, uint32_t count, enum listing listing,
                       pir_walked *walked) {
    const pir_polytope *p = tracked->pairing.p, *q = tracked->pairing.q;
    const bool many = pir_is_large(q);
    const uint32_t turns = many ? TURNS : 3, chunks = count / PIR_ARCS + (count % PIR_ARCS != 0);
    struct chunk chunk[TURNS];
    for (uint32_t i = 0; i < turns; i++)
        chunk[i].led = chunk[i].arcs.count = 0;
    for (uint32_t c = 0; c < chunks + turns - 1; c++) {
        struct chunk *listed = &chunk[c % turns], *found = &chunk[(c + turns - 1) % turns],
                     *crossed = &chunk[(c + 1) % turns];
        uint32_t left = c < chunks ? count - c * PIR_ARCS : 0;
        list_arcs(tracked, edge, c * PIR_ARCS, left < PIR_ARCS ? left : PIR_ARCS, listing != ASIDE, &listed->arcs);
        tracked->kernels->find_sides(q, &found->arcs);
        tracked->kernels->measure_sides(&tracked->p_facets, p, q, &crossed->arcs);
        if (many) {
            list_led(q, found);
            leave_first_cells(tracked, &chunk[(c + turns - 2) % turns]);
            fetch_next_cells(q, &chunk[(c + turns - 3) % turns]);
        }
        const struct edges next = {edge, count, c * PIR_ARCS + FETCHED_BEFORE};
        if (!(many ? cross_and_fetch(tracked, crossed, &found->arcs, &listed->arcs, &next, listing, walked)
                   : cross_arcs(tracked, &crossed->arcs, listing, walked)))
            return false;
    }
    return true;
}

bool pir_walk_edges(pir_tracked *tracked, const uint32_t *edge, uint32_t count) {
    return walk_edges(tracked, edge, count, edge ? UNNOTED : NOTED, NULL);
}

bool pir_walk_aside(pir_tracked *tracked, const uint32_t *edge, uint32_t count, pir_walked *ret_walked) {
    ret_walked->count = 0;
    return walk_edges(tracked, edge, count, ASIDE, ret_walked);
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
