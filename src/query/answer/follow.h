/* SPDX-License-Identifier: MIT */
/* The inside of a query object, and what every call on one begins with. */
#ifndef PIR_QUERY_ANSWER_FOLLOW_H
#define PIR_QUERY_ANSWER_FOLLOW_H

#include <pirouette/query.h>

#include "base/scratch.h"
#include "query/contact/patch.h"
#include "query/depth/depth.h"
#include "query/depth/leaves.h"
#include "query/depth/regional.h"
#include "query/frame/body.h"
#include "query/walk/walker.h"

/*
 * The queries' room in a thread's scratch (base/scratch.h): planes, work space for groups, limbs for exact arithmetic,
 * patches. It grows to what the largest query needs.
 *
 * Planes and the integers of a placement stay from call to call, as long as the calls are on one query: the owner.
 * Another query that begins a call takes the room over, and both then make theirs again.
 */
typedef struct pir_query_room {
    const pir_query *owner; /* NULL where what was there is lost */
    pir_planes planes;
    pir_group_work work;
    pir_limbs limbs;
    pir_patch_room patches;
    pir_piece decided;        /* of the last answer, whosever it was: see pir_task */
    const pir_walker *walker; /* the version for this processor */
} pir_query_room;

/* The room in a scratch; NULL when out of memory. */
pir_query_room *pir_query_room_of(pir_scratch *scratch);

/* Makes room for the exact signs of two operands: PIR_ERR_MEMORY. */
pir_status pir_query_room_reserve_limbs(pir_query_room *room, const pir_scratch *scratch, const pir_polytope *p,
                                        const pir_polytope *q);

struct pir_query {
    pir_allocator allocator;
    /*
     * references to the sum, and to the operands that the parts below are filled in from; p is reflected, as the sum
     * holds it
     */
    pir_sum *sum;
    pir_polytope *p, *q;
    uint64_t generation; /* the generation of the sum that the parts below are for, 0 for none */

    pir_query_room *room; /* in the sum's scratch */

    pir_frame frame;
    pir_exact exact;
    pir_search search;
    pir_leaves *leaves;    /* made by the first batch */
    pir_regional regional; /* made when a region is first asked */
};

/* Begins a call: checks the input, follows the sum's changes, converts the translation. */
pir_status pir_query_place(pir_query *query, const pir_query_input *input, pir_placement *ret_placement);

/*
 * Begins an answer at a relative pose, the sum being there: the placement. `world` is borrowed until the next
 * call on the query.
 */
pir_status pir_query_place_relative(pir_query *query, const pir_world *world, pir_placement *ret_placement);

/* Makes what a search in a region needs: PIR_ERR_MEMORY. */
pir_status pir_query_need_regional(pir_query *query);

/* Begins a call that needs the whole sum: PIR_ERR_REGION where the sum has a region. */
pir_status pir_query_begin(pir_query *query, const pir_query_input *input, pir_placement *ret_placement);

/* --- answers.c --- */

/* Answers a call on a sum without a region, at a placement. `want`: see result.h. */
void pir_query_answer(pir_query *query, const pir_placement *placement, const pir_query_input *input, int want,
                      pir_query_cache *cache, pir_query_result *result);

#endif
