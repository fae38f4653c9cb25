/* SPDX-License-Identifier: MIT */
/*
 * Cells of active facets, found by descent: from the cell of a neighbour where one has a cell, otherwise from the cell
 * in which the facet was last; and from there breadth first.
 */
#include "dymsum/region/members.h"

#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/descent.h"
#include "dymsum/rebuild/facet_cells.h"

pir_member_place pir_members_of_p(pir_sweep *sweep, pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    return (pir_member_place){tracked, &sweep->p, pairing->p, pairing->fv, 0, sweep->number, true};
}

pir_member_place pir_members_of_q(pir_sweep *sweep, pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    uint32_t first = tracked->q_facets.first_certificate;
    return (pir_member_place){tracked, &sweep->q, pairing->q, pairing->vf, first, sweep->number, false};
}

static void locate(const pir_member_place *place, uint32_t f, uint32_t from) {
    pir_tracked *tracked = place->tracked;
    pir_expiry expiry;
    place->cell[f] = place->of_p ? pir_descend_fv(tracked, f, pir_rotated_normal(&tracked->pairing, f), from, &expiry)
                                 : pir_descend_vf(tracked, f, from, &expiry);
    pir_tracked_certify(tracked, place->first_certificate + f, &expiry);
    pir_journal_note(&tracked->journal, place->first_certificate + f);
}

/* Locates members without a cell from facet `from`, which has one: breadth first. */
static void locate_around(const pir_member_place *place, uint32_t from) {
    const pir_polytope *own = place->own;
    const uint32_t *seen = place->facets->members.seen;
    uint32_t *queue = place->tracked->work->queue, head = 0, tail = 0;
    queue[tail++] = from;
    while (head < tail) {
        uint32_t f = queue[head++], cell = place->cell[f];
        for (uint32_t i = own->loop_start[f]; i < own->loop_start[f + 1]; i++) {
            uint32_t to = own->across[i].facet;
            if (seen[to] != place->sweep || place->cell[to] != PIR_NO_PAIR)
                continue;
            locate(place, to, cell);
            queue[tail++] = to;
        }
    }
}

void pir_members_admit(const pir_member_place *place) {
    const pir_members *members = &place->facets->members;
    for (uint32_t i = 0; i < members->count; i++) {
        uint32_t f = members->at[i];
        if (place->cell[f] != PIR_NO_PAIR)
            continue;
        uint32_t beside = pir_cell_beside(place->own, place->cell, f);
        locate(place, f, beside != PIR_NO_PAIR ? beside : place->facets->hint[f]);
        locate_around(place, f);
    }
}

/*
 * As locate_around, many at a time, in a walk: from the `tail` facets listed in work.queue. That has room for one more
 * than either operand has facets: P has inside, so it has more edges than facets, and so has Q or it has two facets.
 */
static void settle_around(const pir_member_place *place, uint32_t tail) {
    const pir_polytope *own = place->own;
    const uint32_t *seen = place->facets->members.seen;
    uint32_t *queue = place->tracked->work->queue, settled = tail, count = 0;
    uint32_t facet[PIR_DESCENT_MOST], start[PIR_DESCENT_MOST];
    for (uint32_t head = 0; head < tail;) {
        uint32_t f = queue[head++], cell = place->cell[f];
        for (uint32_t i = own->loop_start[f]; i < own->loop_start[f + 1]; i++) {
            // by masks: that it is a member without a cell is not foreseen
            uint32_t to = own->across[i].facet, beside = place->cell[to];
            uint32_t is_new = (uint32_t)(seen[to] == place->sweep) & (uint32_t)(beside == PIR_NO_PAIR);
            place->cell[to] = beside ^ ((beside ^ cell) & -is_new);
            facet[count] = queue[tail] = to;
            start[count] = cell;
            tail += is_new;
            count += is_new;
            if (count == PIR_DESCENT_MOST) {
                pir_settle_facets(place->tracked, place->of_p, facet, start, count);
                settled = tail;
                count = 0;
            }
        }
        // those that follow have no cells of their own yet
        if (head == settled) {
            pir_settle_facets(place->tracked, place->of_p, facet, start, count);
            settled = tail;
            count = 0;
        }
    }
}

/* Locates the members without a cell that are beside a facet with one; lists them in work.queue. Returns how many. */
static uint32_t settle_beside(const pir_member_place *place) {
    const pir_members *members = &place->facets->members;
    uint32_t *queue = place->tracked->work->queue, from[PIR_DESCENT_MOST], open = 0, settled = 0, tail = 0;
    // those without a cell are listed first, without branches, and those that are located stay listed
    for (uint32_t i = 0; i < members->count; i++) {
        queue[open] = members->at[i];
        open += place->cell[members->at[i]] == PIR_NO_PAIR;
    }
    for (uint32_t i = 0; i < open; i++) {
        uint32_t f = queue[i];
        queue[tail] = f;
        from[tail - settled] = pir_cell_beside(place->own, place->cell, f);
        tail += from[tail - settled] != PIR_NO_PAIR;
        if (tail - settled == PIR_DESCENT_MOST) {
            pir_settle_facets(place->tracked, place->of_p, queue + settled, from, PIR_DESCENT_MOST);
            settled = tail;
        }
    }
    pir_settle_facets(place->tracked, place->of_p, queue + settled, from, tail - settled);
    return tail;
}

void pir_members_locate_beside(const pir_member_place *place) {
    settle_around(place, settle_beside(place));
}

void pir_members_locate(const pir_member_place *place) {
    const pir_members *members = &place->facets->members;
    uint32_t *queue = place->tracked->work->queue;
    for (uint32_t i = 0; i < members->count; i++) {
        uint32_t f = members->at[i];
        if (place->cell[f] != PIR_NO_PAIR)
            continue;
        uint32_t from = pir_cell_beside(place->own, place->cell, f);
        from = from != PIR_NO_PAIR ? from : place->facets->hint[f];
        pir_settle_facets(place->tracked, place->of_p, &f, &from, 1);
        queue[0] = f;
        settle_around(place, 1);
    }
}
