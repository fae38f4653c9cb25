/* SPDX-License-Identifier: MIT */
/* The pieces that the boundary of D consists of. */
#ifndef PIR_QUERY_DECIDE_PIECE_H
#define PIR_QUERY_DECIDE_PIECE_H

#include <pirouette/mesh.h>

#include "query/frame/frame.h"

/*
 * A pair of features whose sum is a facet of D, or a part of one:
 *
 *     PIR_FACET_FV    first: a facet of P      second: the vertex of Q farthest along its normal
 *     PIR_FACET_VF    first: the vertex of P farthest along the facet's normal      second: a facet of Q
 *     PIR_FACET_EE    first: an edge of P      second: a halfedge of Q; their arcs cross
 *
 * A true facet of D consists of several pieces where features are parallel: see facet.h.
 */
typedef struct pir_piece {
    uint32_t kind, first, second;
} pir_piece;

static inline bool pir_piece_same(pir_piece a, pir_piece b) {
    return a.kind == b.kind && a.first == b.first && a.second == b.second;
}

/* In place of a kind: there is no piece. */
#define PIR_NO_PIECE UINT32_MAX

/* A corner of a piece: a vertex of P and one of Q. */
static inline void pir_piece_corner(const pir_frame *frame, pir_piece piece, uint32_t *ret_a, uint32_t *ret_b) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    if (piece.kind == PIR_FACET_FV) {
        *ret_a = p->origin[p->loop[p->loop_start[piece.first]]];
        *ret_b = piece.second;
    } else if (piece.kind == PIR_FACET_VF) {
        *ret_a = piece.first;
        *ret_b = q->origin[q->loop[q->loop_start[piece.second]]];
    } else {
        *ret_a = p->origin[p->edge_half[piece.first]];
        *ret_b = q->origin[piece.second];
    }
}

#endif
