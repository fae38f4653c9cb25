/* SPDX-License-Identifier: MIT */
/* The pieces of a solid as they are kept: their vertices as rationals, in units of the model. */
#ifndef PIR_SOLID_PIECES_PIECE_LIST_H
#define PIR_SOLID_PIECES_PIECE_LIST_H

#include <gmp.h>

#include <pirouette/solid.h>

#include "base/memory.h"

struct pir_pieces {
    pir_allocator allocator;
    uint32_t count, vertex_count;
    uint32_t *start; /* count + 1: the first vertex of each */
    mpq_t *vertex;   /* three a vertex, initialised */
};

/* Room for pieces and their vertices, all 0; NULL without memory. The allocator is copied. */
pir_pieces *pir_pieces_new(const pir_allocator *allocator, uint32_t count, uint32_t vertex_count);

#endif
