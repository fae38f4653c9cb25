/* SPDX-License-Identifier: MIT */
/*
 * The facet of a piece by doubles alone, where the foot of x is inside of it.
 *
 * Most frames have the features of the frame before. Then doubles prove all that exact signs would: that the piece's
 * features are exposed by its normal, on which side x is, and that the foot of x is inside of the facet. Where any of
 * this is in doubt the ways that know integers go on.
 *
 * Numbers come from the operations of decide/facet.c and decide/touch.c in their order, so they have the same bits.
 *
 * From a facet of D that no longer holds the foot of x a walk goes to the one that does.
 *
 * A facet is left across the side that the foot is farthest beyond. On the Gaussian map of D the facet is a corner, and
 * that side is an arc from there: a part of the arc of an edge of one body, in the cell of a vertex of the other. So
 * the facet across lies where the arc leaves the cell, at two edges that cross, or else where the arc ends. Two edges
 * that cross no more are left for a facet at the end of one of them.
 *
 * Where x is inside of D, each facet on the way has less slack than the one before: the foot is beyond the next one's
 * plane. So none comes twice. From outside the nearest point may lie on an edge of D, and the way leads to and fro
 * across that, or about a vertex: then it is given up. Rounding may lead astray; but what is given is proven.
 *
 * Where the foot is far beyond the rim, as after a jump of the poses, the way goes on from a facet at the vertex of D
 * that is farthest towards x. Once is enough: from there few steps lead to the foot.
 */
#ifndef PIR_QUERY_WALK_WALKER_H
#define PIR_QUERY_WALK_WALKER_H

#include "query/decide/touch.h"

typedef struct pir_same_facet {
    pir_facet facet;
    double slack;
    double margin; /* the foot of x is at least this far from the rim, above 0 */
    pir_touch touch;
    uint32_t side; /* of two edges, where the rim is nearest: see below */
    bool is_far;   /* a way to it began at a facet towards x */
} pir_same_facet;

/* Whether the features at hand make a facet of D that holds the foot of x. */
typedef enum pir_same {
    PIR_SAME_NOT,      /* they make none */
    PIR_SAME_BESIDE,   /* they make one, and the foot is beside it */
    PIR_SAME_IN_DOUBT, /* doubles do not tell */
    PIR_SAME_NEAR,     /* they do, but its slack is next to nothing */
    PIR_SAME_PROVEN
} pir_same;

/* The loops around vertices and facets, in versions for processors that give the same bits. */
typedef struct pir_walker {
    /*
     * `piece` may be one of D at some other placement. A vertex of it is moved to where its facet has it here; the
     * edges of one of two edges are not. Where the slack is next to nothing, facet and margin are proven, the slack is
     * off and there is no touch. Where the foot is beside the facet, that is known but for the slack; of two edges so
     * is the side: 0 and 1 are along Q's edge, at the origin and the target of P's halfedge, 2 and 3 along P's, at
     * those of Q's.
     */
    pir_same (*prove)(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                      pir_same_facet *ret_same);

    /*
     * Goes on from what a prover has left in `same`, the answer being `is`. Where that is neither PIR_SAME_NOT nor
     * PIR_SAME_BESIDE nothing happens, nor where a body has no inside. Returns what the prover says of the last facet
     * on the way, which `same` is then.
     */
    pir_same (*follow)(const pir_frame *frame, const pir_placement *placement, pir_same is, pir_same_facet *same);

    /*
     * Moves *a and *b to the vertices of P and Q that pir_climb along the unit vector n ends at, and sets n as P has
     * it.
     */
    void (*supports)(const pir_frame *frame, pir_vec3 n, uint32_t *a, uint32_t *b, pir_vec3 *ret_back);

    /* The vertex of one body that such a climb from `from` ends at, along n as that body has it. */
    uint32_t (*support)(const pir_body *body, pir_vec3 n, uint32_t from);
} pir_walker;

/* Sets the slack, as pir_facet_measure gives it, and the touch. */
void pir_same_facet_set_slack(const pir_frame *frame, const pir_placement *placement, double slack,
                              pir_same_facet *same);

extern const pir_walker pir_walker_plain, pir_walker_avx2;

#endif
