/* SPDX-License-Identifier: MIT */
/* Where a descent begins at a facet of D. */
#ifndef PIR_QUERY_LAST_FACET_SIMPLEX_H
#define PIR_QUERY_LAST_FACET_SIMPLEX_H

#include "query/decide/piece.h"
#include "query/frame/nearest_vertex.h"

/* Sets the count and the vertices of a simplex: three vertices of D at a piece, far apart. */
void pir_facet_simplex(const pir_frame *frame, pir_piece piece, pir_simplex *simplex);

#endif
