/* SPDX-License-Identifier: MIT */
/*
 * Locating facets. Those of P breadth first, each by descent from the cell of a facet beside it.
 *
 * Those of Q follow from the crossings without a sign. Along the arc of an edge of Q that has no crossing, both ends
 * are in one cell of P. Where it has one crossing, with edge e of P, its right end is in the cell of e's origin and
 * its left end in that of e's target: an arc of P separates the cells of its edge's vertices. Where it has several,
 * their order along the arc is not known, and the edge tells nothing. So cells spread from single crossings along
 * edges that have none. What they do not reach is located by descent.
 */
#include "dymsum/rebuild/facet_cells.h"

#include <string.h>

#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/descent.h"

uint32_t pir_locate_facet_of_p(pir_tracked *tracked, uint32_t f, uint32_t from) {
    uint32_t cell = from;
    pir_expiry unused;
    if (!tracked->kernels->descend(&tracked->p_facets, f, &cell, &tracked->pairing.signs.by_filter))
        cell = pir_descend_fv(tracked, f, pir_rotated_normal(&tracked->pairing, f), cell, &unused);
    return cell;
}

uint32_t pir_locate_facet_of_q(pir_tracked *tracked, uint32_t g, uint32_t from) {
    uint32_t cell = from;
    pir_expiry unused;
    if (!tracked->kernels->descend(&tracked->q_facets, g, &cell, &tracked->pairing.signs.by_filter))
        cell = pir_descend_vf(tracked, g, cell, &unused);
    return cell;
}

void pir_locate_facets_of_p(pir_tracked *tracked) {
    const pir_polytope *p = tracked->pairing.p;
    uint32_t *fv = tracked->pairing.fv, *queue = tracked->work->queue, head = 0, tail = 0;
    if (p->facet_count == 0)
        return;
    for (uint32_t f = 1; f < p->facet_count; f++)
        fv[f] = PIR_NO_PAIR;
    fv[0] = pir_locate_facet_of_p(tracked, 0, 0);
    queue[tail++] = 0;
    while (head < tail) {
        uint32_t f = queue[head++], cell = fv[f];
        const pir_across *side = p->across + p->loop_start[f], *end = p->across + p->loop_start[f + 1];
        for (; side < end; side++) {
            uint32_t beside = side->facet;
            if (fv[beside] != PIR_NO_PAIR)
                continue;
            fv[beside] = pir_locate_facet_of_p(tracked, beside, cell);
            queue[tail++] = beside;
        }
    }
}

/* Facet g of Q is in the cell of v: it is listed, once. */
static inline void set_cell(pir_tracked *tracked, uint32_t g, uint32_t v, uint32_t *tail) {
    if (tracked->pairing.vf[g] != PIR_NO_PAIR)
        return;
    tracked->pairing.vf[g] = v;
    tracked->work->queue[(*tail)++] = g;
}

/* Counts the crossings of each edge of Q whose mark is 0: afterwards 0, 1, or 2 for more. Other marks stay. */
static void count_crossings(pir_tracked *tracked) {
    const pir_polytope *q = tracked->pairing.q;
    const pir_crossings *c = &tracked->pairing.crossings;
    uint8_t *mark = tracked->work->mark;
    for (uint32_t i = 0; i < c->used; i++) {
        uint8_t *of_edge = &mark[q->edge[c->half[i]]];
        *of_edge += *of_edge < 2;
    }
}

/*
 * Cells spread from the facets listed from `head` on, along edges that have no crossing. Returns the end of the list.
 */
static uint32_t spread(pir_tracked *tracked, uint32_t head, uint32_t tail) {
    const pir_polytope *q = tracked->pairing.q;
    for (; head < tail; head++) {
        uint32_t g = tracked->work->queue[head];
        for (uint32_t i = q->loop_start[g]; i < q->loop_start[g + 1]; i++)
            if (tracked->work->mark[q->across[i].edge] == 0)
                set_cell(tracked, q->across[i].facet, tracked->pairing.vf[g], &tail);
    }
    return tail;
}

/* The cell of a facet beside g that has one, or any. */
static uint32_t cell_beside(const pir_tracked *tracked, uint32_t g) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t cell = PIR_NO_PAIR;
    for (uint32_t i = q->loop_start[g]; i < q->loop_start[g + 1] && cell == PIR_NO_PAIR; i++)
        cell = tracked->pairing.vf[q->across[i].facet];
    return cell != PIR_NO_PAIR ? cell : 0;
}

uint32_t pir_spread_cells_of_q(pir_tracked *tracked) {
    const pir_polytope *p = tracked->pairing.p, *q = tracked->pairing.q;
    const pir_crossings *c = &tracked->pairing.crossings;
    uint32_t tail = 0;
    count_crossings(tracked);
    for (uint32_t i = 0; i < c->used; i++) {
        uint32_t h = c->half[i], half = p->edge_half[c->edge[i]];
        if (tracked->work->mark[q->edge[h]] != 1)
            continue;
        set_cell(tracked, pir_right(q, h), p->origin[half], &tail);
        set_cell(tracked, q->left[h], p->target[half], &tail);
    }
    return spread(tracked, 0, tail);
}

void pir_locate_facets_of_q(pir_tracked *tracked) {
    const pir_polytope *q = tracked->pairing.q;
    uint32_t *vf = tracked->pairing.vf;
    memset(tracked->work->mark, 0, q->edge_count);
    for (uint32_t g = 0; g < q->facet_count; g++)
        vf[g] = PIR_NO_PAIR;
    uint32_t tail = pir_spread_cells_of_q(tracked);
    for (uint32_t g = 0; g < q->facet_count && tail < q->facet_count; g++) {
        uint32_t head = tail;
        if (vf[g] == PIR_NO_PAIR)
            set_cell(tracked, g, pir_locate_facet_of_q(tracked, g, cell_beside(tracked, g)), &tail);
        tail = spread(tracked, head, tail);
    }
}
