/* SPDX-License-Identifier: MIT */
/* The cell of one facet, found by descent on the other operand's Gaussian map. */
#ifndef PIR_DYMSUM_REBUILD_DESCENT_H
#define PIR_DYMSUM_REBUILD_DESCENT_H

#include "dymsum/pairing/tracked.h"

/*
 * The vertex of Q farthest along facet f of P, whose normal is rotated to `rotated`. The descent starts at vertex
 * `from`. *ret_expiry: how long f stays in that cell.
 */
uint32_t pir_descend_fv(pir_tracked *tracked, uint32_t f, pir_vec3 rotated, uint32_t from, pir_expiry *ret_expiry);

/* The vertex of P farthest along facet g of Q. */
uint32_t pir_descend_vf(pir_tracked *tracked, uint32_t g, uint32_t from, pir_expiry *ret_expiry);

#endif
