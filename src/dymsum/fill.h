/* SPDX-License-Identifier: MIT */
/*
 * Making a sum from a pairing that is known: for those who restore one.
 *
 * A sum is begun, filled, and read only after pir_fill_end. Nothing checks that the pairing is right: pir_sum_is_valid
 * does. One that cannot be filled is released by pir_sum_destroy.
 */
#ifndef PIR_DYMSUM_FILL_H
#define PIR_DYMSUM_FILL_H

#include "dymsum/pairing/pairing.h"
#include "dymsum/region/cover.h"

/* The operands of a sum: at scale 1, and at the scale that was last set. */
typedef struct pir_fill_operands {
    pir_polytope *made_of[2], *now[2]; /* by pir_operand */
    bool difference;
} pir_fill_operands;

/* A sum with all its memory and no pairing. Takes references to the operands. Errors as pir_sum_create. */
pir_status pir_fill_begin(const pir_fill_operands *operands, pir_quat rotation, const pir_allocator *allocator,
                          pir_sum **ret_sum);

/* Room for fv, or vf: as many cells as P has facets, or Q. */
uint32_t *pir_fill_cells(pir_sum *sum, pir_operand facets_of);

/* Begins the crossings, of which there are `count` in all; false when out of memory. */
bool pir_fill_crossings(pir_sum *sum, uint32_t count);

/*
 * One more crossing of edge e with halfedge h, behind *last, which is PIR_NO_CROSSING before the first crossing of an
 * edge, and becomes the new one. False when out of memory.
 */
bool pir_fill_crossing(pir_sum *sum, uint32_t e, uint32_t h, uint32_t *last);

/* Ends the pairing: its certificates are expired. */
void pir_fill_end(pir_sum *sum);

/*
 * Limits the pairing to a region. *ret_fits: whether it has pairs for exactly the features that the cover asks for, and
 * the cover holds at the rotation. False when out of memory.
 */
bool pir_fill_region(pir_sum *sum, const pir_cone *cone, const pir_cover *cover, bool *ret_fits);

/*
 * Lets the pairing stay behind the rotation `shown`, where the tolerance, which is set, allows that: *ret_done. Errors
 * as pir_sum_rotate.
 */
pir_status pir_fill_shown(pir_sum *sum, pir_quat shown, bool *ret_done);

#endif
