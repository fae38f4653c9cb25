/* SPDX-License-Identifier: MIT */
/* The active facets of one operand over the cells of the other: see members.c. */
#ifndef PIR_DYMSUM_REGION_MEMBERS_H
#define PIR_DYMSUM_REGION_MEMBERS_H

#include "dymsum/pairing/tracked.h"
#include "dymsum/region/sweep.h"

typedef struct pir_member_place {
    pir_tracked *tracked;
    pir_region_facets *facets;
    const pir_facets *located; /* those of the operand, as kernels know them */
    const pir_polytope *own;
    uint32_t *cell, first_certificate;
    uint32_t sweep; /* the number of the last sweep */
    bool of_p;
} pir_member_place;

/* The facets of P over the cells of Q, and the reverse. */
pir_member_place pir_members_of_p(pir_sweep *sweep, pir_tracked *tracked);
pir_member_place pir_members_of_q(pir_sweep *sweep, pir_tracked *tracked);

/* Locates the members without a cell. Each gets a certificate and is noted in the journal. */
void pir_members_admit(const pir_member_place *place);

/*
 * Locates all members in a walk: the caller says afterwards that all certificates have expired, and that anything may
 * have changed.
 */
void pir_members_locate(const pir_member_place *place);

#endif
