/* SPDX-License-Identifier: MIT */
/* The inside of a query of two bodies in pieces. */
#ifndef PIR_SOLID_QUERY_SOLID_QUERY_H
#define PIR_SOLID_QUERY_SOLID_QUERY_H

#include <pirouette/solid_query.h>

#include "base/memory.h"
#include "solid/depth/depth_search.h"
#include "solid/query/piece_pairs.h"

struct pir_solid_query {
    pir_allocator allocator;
    pir_compound p, q;
    pir_piece_pairs pairs;
    uint32_t last[2]; /* the pieces of the last answer */
    uint64_t visits;
    pir_depth_search *depth; /* made when a depth is first asked for */
};

#endif
