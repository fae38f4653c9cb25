/* SPDX-License-Identifier: MIT */
/*
 * The facet of a piece by doubles alone, where the foot of x is inside of it.
 *
 * Most frames have the features of the frame before. Then doubles prove all that exact signs would: that the piece's
 * features are exposed by its normal, on which side x is, and that the foot of x is inside of the facet. Where any of
 * this is in doubt the ways that know integers go on.
 *
 * Numbers come from the operations of decide/facet.c and decide/touch.c in their order, so they have the same bits.
 */
#ifndef PIR_QUERY_LAST_SAME_FACET_H
#define PIR_QUERY_LAST_SAME_FACET_H

#include "query/decide/touch.h"

typedef struct pir_same_facet {
    pir_facet facet;
    double slack;
    double margin; /* the foot of x is at least this far from the rim, above 0 */
    pir_touch touch;
    uint32_t side; /* of two edges, where the rim is nearest: see below */
} pir_same_facet;

/* Whether the features at hand make a facet of D that holds the foot of x. */
typedef enum pir_same {
    PIR_SAME_NOT,      /* they make none */
    PIR_SAME_BESIDE,   /* they make one, and the foot is beside it */
    PIR_SAME_IN_DOUBT, /* doubles do not tell */
    PIR_SAME_NEAR,     /* they do, but its slack is next to nothing */
    PIR_SAME_PROVEN
} pir_same;

/*
 * `piece` may be one of D at some other placement. A vertex of it is moved to where its facet has it here; the edges of
 * one of two edges are not. Where the slack is next to nothing, facet and margin are proven, the slack is off and
 * there is no touch. Where the foot is beside the facet, that is known but for the slack; of two edges so is the side:
 * 0 and 1 are along Q's edge, at the origin and the target of P's halfedge, 2 and 3 along P's, at those of Q's.
 */
typedef pir_same pir_same_prover(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                                 pir_same_facet *ret_same);
pir_same_prover pir_same_facet_prove;

/*
 * A version of it, all of which give the same bits: the plain one first; NULL past those that this machine can run.
 */
pir_same_prover *pir_same_facet_version(unsigned index);

/* The last of them. */
pir_same_prover *pir_same_facet_best(void);

/* Sets the slack, as pir_facet_measure gives it, and the touch. */
void pir_same_facet_set_slack(const pir_frame *frame, const pir_placement *placement, double slack,
                              pir_same_facet *same);

#endif
