/* SPDX-License-Identifier: MIT */
/* A body in convex pieces, each a polytope, with a tree over their boxes in the frame of the body. */
#ifndef PIR_SOLID_PIECES_COMPOUND_H
#define PIR_SOLID_PIECES_COMPOUND_H

#include <pirouette/solid.h>

#include "solid/space/boxes.h"

/* A face of a piece, in the frame of the body: outward normal, and the height of its plane. */
typedef struct pir_compound_face {
    double normal[3], offset;
} pir_compound_face;

/* A box as it is seen from the other body's frame in a visit: its middle, and half of the box round it. */
typedef struct pir_turned_box {
    uint64_t visit;
    double middle[3], half[3];
} pir_turned_box;

typedef struct pir_compound {
    uint32_t count;
    pir_polytope **piece;
    pir_boxes boxes;
    double reach;                        /* no point of the body is farther from the origin of its frame */
    uint32_t *vertex_start, *face_start; /* per piece, and the end of the last */
    double (*vertex)[3];
    pir_compound_face *face;
    double (*middle)[3];    /* of each piece: the mean of its vertices */
    pir_turned_box *turned; /* of the nodes of `boxes`, then of its boxes: what a visit has turned */
} pir_compound;

/* The polytopes of all pieces. Errors as of pir_pieces_polytope; what was made is then freed. */
pir_status pir_compound_init(pir_compound *compound, const pir_pieces *pieces, const pir_allocator *allocator);
void pir_compound_finish(pir_compound *compound, const pir_allocator *allocator);

#endif
