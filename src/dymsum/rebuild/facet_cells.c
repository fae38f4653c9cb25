/* SPDX-License-Identifier: MIT */
/*
 * Locating facets.
 *
 * Those of P by descent from the cell of a facet beside each, in the order of visits (polytope/facet_order.c), many at
 * a time, so that memory is fetched for all of them at once.
 *
 * Those of Q follow from the crossings without a sign. Along the arc of an edge of Q that has no crossing, both ends
 * are in one cell of P. Where it has one crossing, with edge e of P, its right end is in the cell of e's origin and
 * its left end in that of e's target: an arc of P separates the cells of its edge's vertices. Where it has several,
 * their order along the arc is not known, and the edge tells nothing. So cells spread from single crossings along
 * edges that have none. What they do not reach is located by descent.
 *
 * Where Q is large, all crossings tell: each leads from one cell of P to the next, so the difference of the cells'
 * numbers at the two ends of an arc is the sum over its crossings, in whatever order they come. One facet is located by
 * descent, and the others follow in the order of visits. That reads far less memory, and what it does next does not
 * depend on what it finds. Signs are asked for that one facet alone.
 */
#include "dymsum/rebuild/facet_cells.h"

#include <string.h>

#include "base/fetching.h"
#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/descent.h"

void pir_settle_facets(pir_tracked *tracked, bool of_p, const uint32_t *facet, const uint32_t *from, uint32_t count) {
    const pir_facets *facets = of_p ? &tracked->p_facets : &tracked->q_facets;
    uint32_t open[PIR_DESCENT_MOST];
    if (count == 0)
        return;
    uint32_t remaining = tracked->kernels->descend(facets, facet, from, count, open, &tracked->pairing.signs.by_filter);
    pir_expiry unused;
    for (uint32_t i = 0; i < remaining; i++) {
        uint32_t f = open[i], *cell = &facets->cell[f];
        *cell = of_p ? pir_descend_fv(tracked, f, pir_rotated_normal(&tracked->pairing, f), *cell, &unused)
                     : pir_descend_vf(tracked, f, *cell, &unused);
    }
}

/* --- facets of P --- */

/* Facets are fetched so many visits before theirs. */
#define FETCHED_BEFORE 160

/*
 * Fetches the cells that are likely to come after those of some facets: by what the number of a facet's cell differs
 * from that of the one before it, the next one often does again.
 */
PIR_FETCHING void fetch_onward(const pir_tracked *tracked, const uint32_t *facet, const uint32_t *from,
                               uint32_t count) {
    const pir_polytope *q = tracked->pairing.q;
    const uint32_t *fv = tracked->pairing.fv;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t onward = 2 * fv[facet[k]] - from[k];
        const pir_ring *ring = q->ring + q->ring_block[onward < q->vertex_count ? onward : 0];
        PIR_FETCH(ring->x);
        PIR_FETCH(ring->z);
    }
}

/* Fetches the facets of so many visits. */
PIR_FETCHING void fetch_visits(const pir_tracked *tracked, uint32_t first, uint32_t count) {
    const pir_polytope *p = tracked->pairing.p;
    for (uint32_t i = first; i < first + count && i < p->facet_count; i++) {
        PIR_FETCH(p->normal4 + 4 * (size_t)p->visit[i].facet);
        PIR_FETCH(&tracked->pairing.fv[p->visit[i].facet]);
    }
}

void pir_locate_facets_of_p(pir_tracked *tracked) {
    const pir_polytope *p = tracked->pairing.p;
    const bool many = pir_is_large(tracked->pairing.q);
    uint32_t *fv = tracked->pairing.fv;
    for (uint32_t f = 0; f < p->facet_count; f++)
        fv[f] = PIR_NO_PAIR;
    for (uint32_t i = 0; i < p->facet_count;) {
        uint32_t facet[PIR_DESCENT_MOST], from[PIR_DESCENT_MOST], count = 0;
        // facet by facet, until a neighbour has no cell yet
        for (; i < p->facet_count && count < PIR_DESCENT_MOST; i++) {
            const pir_visit visit = p->visit[i];
            if (fv[visit.beside] == PIR_NO_PAIR && i > 0)
                break;
            facet[count] = visit.facet;
            from[count++] = i > 0 ? fv[visit.beside] : 0;
        }
        pir_settle_facets(tracked, true, facet, from, count);
        if (many) {
            fetch_onward(tracked, facet, from, count);
            fetch_visits(tracked, i + FETCHED_BEFORE, count);
        }
    }
}

/* --- facets of Q --- */

void pir_forget_met(pir_tracked *tracked) {
    const pir_polytope *q = tracked->pairing.q;
    pir_arc_cells *met = tracked->work->met;
    if (pir_is_large(q))
        memset(tracked->pairing.vf, 0, q->facet_count * sizeof *tracked->pairing.vf);
    else
        for (uint32_t e = 0; e < q->edge_count; e++)
            met[e] = (pir_arc_cells){{PIR_ONE_CELL, PIR_ONE_CELL}};
}

/* The cell of facet g of Q that its sides tell, or PIR_NO_PAIR. Those that tell one tell the same, less than that. */
static inline uint32_t noted_cell(const pir_tracked *tracked, uint32_t g) {
    const pir_polytope *q = tracked->pairing.q;
    const pir_arc_cells *met = tracked->work->met;
    const uint32_t *vf = tracked->pairing.vf;
    uint32_t cell = PIR_NO_PAIR;
    for (const pir_across *side = q->across + q->loop_start[g], *end = q->across + q->loop_start[g + 1]; side < end;
         side++) {
        uint32_t beside = vf[side->facet];
        uint32_t told = met[side->edge].of[g > side->facet];
        told = told == PIR_ONE_CELL ? beside : told;
        cell = told < cell ? told : cell;
    }
    return cell;
}

/* Facets beside g along arcs without a crossing are in its cell, and those beside them. */
static void spread(pir_tracked *tracked, uint32_t g) {
    const pir_polytope *q = tracked->pairing.q;
    pir_suspect *list = tracked->work->passes;
    uint32_t *vf = tracked->pairing.vf, remaining = 0;
    list[remaining++].facet = g;
    while (remaining > 0) {
        uint32_t from = list[--remaining].facet;
        for (uint32_t i = q->loop_start[from]; i < q->loop_start[from + 1]; i++) {
            const pir_across side = q->across[i];
            if (tracked->work->met[side.edge].of[0] != PIR_ONE_CELL || vf[side.facet] != PIR_NO_PAIR)
                continue;
            vf[side.facet] = vf[g];
            list[remaining++].facet = side.facet;
        }
    }
}

/*
 * Gives facets the cells that noted crossings tell; they have none before. The numbers of those that get none are the
 * first of work.suspects; returns how many these are.
 */
static uint32_t take_noted_cells(pir_tracked *tracked) {
    uint32_t *vf = tracked->pairing.vf, open = 0, remaining = 0;
    pir_suspect *list = tracked->work->suspects;
    for (uint32_t g = 0; g < tracked->pairing.q->facet_count; g++) {
        vf[g] = noted_cell(tracked, g);
        list[open].facet = g;
        open += vf[g] == PIR_NO_PAIR;
    }
    // what a facet is told by one that comes later
    for (uint32_t i = 0; i < open; i++) {
        uint32_t g = list[i].facet;
        if (vf[g] == PIR_NO_PAIR && (vf[g] = noted_cell(tracked, g)) != PIR_NO_PAIR)
            spread(tracked, g);
    }
    for (uint32_t i = 0; i < open; i++) {
        list[remaining].facet = list[i].facet;
        remaining += vf[list[i].facet] == PIR_NO_PAIR;
    }
    return remaining;
}

/* Adds up what arcs have passed, from facet to facet. */
static void sum_passed(pir_tracked *tracked) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t *vf = tracked->pairing.vf, first = q->visit[0].facet, from = 0;
    pir_settle_facets(tracked, false, &first, &from, 1);
    for (uint32_t i = 1; i < q->facet_count; i++)
        vf[q->visit[i].facet] += vf[q->visit[i].beside];
}

void pir_locate_facets_of_q(pir_tracked *tracked) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t *vf = tracked->pairing.vf;
    if (pir_is_large(q)) {
        sum_passed(tracked);
        return;
    }
    for (uint32_t g = 0; g < q->facet_count; g++)
        vf[g] = PIR_NO_PAIR;
    uint32_t open = take_noted_cells(tracked);
    for (uint32_t i = 0; i < open; i++) {
        uint32_t g = tracked->work->suspects[i].facet, cell = vf[g];
        if (cell != PIR_NO_PAIR)
            continue;
        cell = pir_cell_beside(q, vf, g);
        cell = cell != PIR_NO_PAIR ? cell : 0;
        pir_settle_facets(tracked, false, &g, &cell, 1);
        spread(tracked, g);
    }
}
