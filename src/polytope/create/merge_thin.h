/* SPDX-License-Identifier: MIT */
/*
 * Vertices of a hull that are vertices only by rounding, found by doubles, dropped with an exact bound.
 */
#ifndef PIR_POLYTOPE_CREATE_MERGE_THIN_H
#define PIR_POLYTOPE_CREATE_MERGE_THIN_H

#include "base/vec.h"
#include "polytope/polytope.h"

/*
 * The vertices as doubles relative to the first, into ret_at, in units of the least power of two of the hull's integers
 * that leaves all of them below 1. Returns `tolerance`, a length, in those units; 0 where it is below the doubles.
 */
double pir_merge_place(const pir_polytope *hull, double tolerance, pir_vec3 *ret_at);

/*
 * The hull of dimension 3 without the vertices that lie within half of `tolerance` of the hull of their neighbours: a
 * new polytope of fewer vertices with the same allocator and scale. Its merge bound says how far it is from `hull`, at
 * most half of the tolerance; its sources are those of `hull`. NULL where no vertex can go. PIR_ERR_MEMORY.
 */
pir_status pir_merge_thin(const pir_polytope *hull, double tolerance, pir_polytope **ret_thinned);

#endif
