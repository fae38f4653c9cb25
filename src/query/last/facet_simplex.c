/* SPDX-License-Identifier: MIT */
/* Three vertices of D at a facet: see facet_simplex.h. */
#include "query/last/facet_simplex.h"

/* Three vertices of a facet, far apart. */
static void spread(const pir_polytope *p, uint32_t facet, uint32_t v[3]) {
    uint32_t start = p->loop_start[facet], count = p->loop_start[facet + 1] - start;
    for (uint32_t i = 0; i < 3; i++)
        v[i] = p->origin[p->loop[start + i * count / 3]];
}

void pir_facet_simplex(const pir_frame *frame, pir_piece piece, pir_simplex *simplex) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    simplex->count = 3;
    if (piece.kind == PIR_FACET_FV) {
        spread(p, piece.first, simplex->a);
        simplex->b[0] = simplex->b[1] = simplex->b[2] = piece.second;
    } else if (piece.kind == PIR_FACET_VF) {
        simplex->a[0] = simplex->a[1] = simplex->a[2] = piece.first;
        spread(q, piece.second, simplex->b);
    } else {
        uint32_t half = p->edge_half[piece.first];
        simplex->a[0] = simplex->a[1] = p->origin[half];
        simplex->a[2] = p->target[half];
        simplex->b[0] = q->origin[piece.second];
        simplex->b[1] = simplex->b[2] = q->target[piece.second];
    }
}
