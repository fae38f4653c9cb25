/* SPDX-License-Identifier: MIT */
/*
 * Cells of active facets, found by descent. In a walk each starts where the grid says (starts.c). In an update one
 * starts from the cell of a neighbour where one has a cell, and those that are new around it follow breadth first.
 */
#include "dymsum/region/members.h"

#include "dymsum/pairing/predicates.h"
#include "dymsum/rebuild/descent.h"
#include "dymsum/rebuild/facet_cells.h"

pir_member_place pir_members_of_p(pir_sweep *sweep, pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    return (pir_member_place){tracked, &sweep->p, &tracked->p_facets, pairing->p, pairing->fv, 0, sweep->number, true};
}

pir_member_place pir_members_of_q(pir_sweep *sweep, pir_tracked *tracked) {
    pir_pairing *pairing = &tracked->pairing;
    uint32_t first = tracked->q_facets.first_certificate;
    return (pir_member_place){tracked,     &sweep->q, &tracked->q_facets, pairing->q,
                              pairing->vf, first,     sweep->number,      false};
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
        if (beside == PIR_NO_PAIR)
            place->tracked->kernels->find_starts(place->located, &place->facets->starts, &f, 1, &beside);
        locate(place, f, beside);
        locate_around(place, f);
    }
}

void pir_members_locate(const pir_member_place *place) {
    const pir_members *members = &place->facets->members;
    for (uint32_t i = 0; i < members->count; i += PIR_DESCENT_MOST) {
        uint32_t left = members->count - i, count = left < PIR_DESCENT_MOST ? left : PIR_DESCENT_MOST;
        uint32_t from[PIR_DESCENT_MOST];
        place->tracked->kernels->find_starts(place->located, &place->facets->starts, members->at + i, count, from);
        pir_settle_facets(place->tracked, place->of_p, members->at + i, from, count);
    }
}
