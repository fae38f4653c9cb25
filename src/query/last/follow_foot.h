/* SPDX-License-Identifier: MIT */
/*
 * From a facet of D that no longer holds the foot of x to the one that does, by doubles.
 *
 * A facet is left across the side that the foot is farthest beyond. On the Gaussian map of D the facet is a corner, and
 * that side is an arc from there: a part of the arc of an edge of one body, in the cell of a vertex of the other. So
 * the facet across lies where the arc leaves the cell, at two edges that cross, or else where the arc ends. Two edges
 * that cross no more are left for a facet at the end of one of them.
 *
 * Where x is inside of D, each facet on the way has less slack than the one before: the foot is beyond the next one's
 * plane. So none comes twice. From outside the nearest point may lie on an edge of D, and the way leads to and fro
 * across that, or about a vertex: then it is given up. Rounding may lead astray; but what is given is proven.
 */
#ifndef PIR_QUERY_LAST_FOLLOW_FOOT_H
#define PIR_QUERY_LAST_FOLLOW_FOOT_H

#include "query/last/same_facet.h"

/*
 * Goes on from what a prover has left in `same`, the answer being `is`. Where that is neither PIR_SAME_NOT nor
 * PIR_SAME_BESIDE nothing happens, nor where a body has no inside. Returns what the prover says of the last facet on
 * the way, which `same` is then.
 */
typedef pir_same pir_foot_follower(const pir_frame *frame, const pir_placement *placement, pir_same is,
                                   pir_same_facet *same);
pir_foot_follower pir_follow_foot;

/*
 * A version of it, all of which give the same bits: the plain one first; NULL past those that this machine can run.
 */
pir_foot_follower *pir_follow_foot_version(unsigned index);

/* The last of them. */
pir_foot_follower *pir_follow_foot_best(void);

#endif
