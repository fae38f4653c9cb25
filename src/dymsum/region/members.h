/* SPDX-License-Identifier: MIT */
/* The active facets of one operand over the cells of the other: see members.c. */
#ifndef PIR_DYMSUM_REGION_MEMBERS_H
#define PIR_DYMSUM_REGION_MEMBERS_H

#include "dymsum/pairing/tracked.h"
#include "dymsum/region/sweep.h"

typedef struct pir_member_place {
    pir_tracked *tracked;
    pir_region_facets *facets;
    const pir_polytope *own;
    uint32_t *cell, first_certificate;
    uint32_t sweep; /* the number of the last sweep */
    bool of_p;
} pir_member_place;

/* The facets of P over the cells of Q, and the reverse. */
pir_member_place pir_members_of_p(pir_sweep *sweep, pir_tracked *tracked);
pir_member_place pir_members_of_q(pir_sweep *sweep, pir_tracked *tracked);

/* Takes its cell from facet f, which keeps it as a hint. */
static inline void pir_member_drop(const pir_member_place *place, uint32_t f) {
    if (place->cell[f] != PIR_NO_PAIR)
        place->facets->hint[f] = place->cell[f];
    place->cell[f] = PIR_NO_PAIR;
}

/* Locates the members without a cell. Each gets a certificate and is noted in the journal. */
void pir_members_admit(const pir_member_place *place);

/*
 * Locates them in a walk: the caller says afterwards that all certificates have expired, and that anything may have
 * changed. The first call leaves out those that no chain of members leads to from a facet with a cell.
 */
void pir_members_locate_beside(const pir_member_place *place);
void pir_members_locate(const pir_member_place *place);

#endif
