/* SPDX-License-Identifier: MIT */
/*
 * Merging nearly coplanar facets of an exact hull. merge_groups.c says by doubles which facets might become one and
 * near which plane; merge.c makes the planes exact, moves the vertices onto them, and proves how far they went.
 */
#ifndef PIR_POLYTOPE_CREATE_MERGE_H
#define PIR_POLYTOPE_CREATE_MERGE_H

#include "base/vec.h"
#include "polytope/polytope.h"

/* The hull with its facets merged within the tolerance, or itself where none are; takes the
   caller's reference of it. */
pir_status pir_polytope_merge_within(pir_polytope *hull, double tolerance, pir_polytope **ret_polytope);

/* The least double found that is not below the square root of a rational that is not negative. */
double pir_root_rounded_up(const mpq_t square);

#endif
