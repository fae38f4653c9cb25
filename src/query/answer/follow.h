/* SPDX-License-Identifier: MIT */
/* The inside of a query object, and what every call on one begins with. */
#ifndef PIR_QUERY_ANSWER_FOLLOW_H
#define PIR_QUERY_ANSWER_FOLLOW_H

#include <pirouette/query.h>

#include "query/contact/patch.h"
#include "query/planes/leaves.h"
#include "query/search/regional.h"
#include "query/search/search.h"

struct pir_query {
    pir_allocator allocator;
    /*
     * references: to the sum, and to its operands as all below was made from them; p is reflected, as the sum holds
     * it
     */
    pir_sum *sum;
    pir_polytope *p, *q;
    bool fits;           /* whether what depends on their coordinates is filled in */
    uint64_t generation; /* of the sum, that all below is for; 0 where it is for none */

    pir_frame frame;
    pir_exact exact;
    pir_search search;
    pir_leaves leaves;
    pir_regional regional;
    pir_patch_room patches;
};

/* What every call begins with: checks, what has changed in the sum, the placement. */
pir_status pir_query_place(pir_query *query, const pir_query_input *input, pir_placement *ret_placement);

/* The same for calls that need the whole sum: PIR_ERR_UNSUPPORTED where it has a region. */
pir_status pir_query_begin(pir_query *query, const pir_query_input *input, pir_placement *ret_placement);

#endif
