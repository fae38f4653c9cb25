/* SPDX-License-Identifier: MIT */
/*
 * Convex pieces of bodies that are as wide as the bodies let them be.
 *
 * Convex pieces of a solid end where others begin, so each blocks little. A wide piece is the hull of the body less
 * what is beyond some of the facets of a piece: those that it needs for being within the union of all pieces. So wide
 * pieces overlap, and about a convex hole each facet of the hole has one that goes from end to end. Their corners are
 * rounded inwards, and that they are within the union is proven for the rounded ones.
 *
 * Where signs of coordinates map corners to others but for rounding, corners are moved so that they do it exactly, if
 * all pieces are then proven to be within the union. So a hole of corners on a circle has its symmetries.
 */
#ifndef PIR_PLAN_RIGID_WIDE_PIECES_H
#define PIR_PLAN_RIGID_WIDE_PIECES_H

#include "plan/plan_sums.h"

/* The wide pieces of all pieces, from malloc; there may be fewer. To be freed with pir_plan_pieces_over_free. */
pir_status pir_wide_pieces_make(const pir_plan_pieces *pieces, size_t memory, pir_plan_pieces *ret_wide);

#endif
