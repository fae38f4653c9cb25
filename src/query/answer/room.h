/* SPDX-License-Identifier: MIT */
/*
 * The queries' room in a thread's scratch (base/scratch.h): planes, work space for groups, limbs for exact arithmetic,
 * patches. It grows to what the largest query needs.
 *
 * Planes and the integers of a placement stay from call to call, as long as the calls are on one query: the owner.
 * Another query that begins a call takes the room over, and both then make theirs again.
 */
#ifndef PIR_QUERY_ANSWER_ROOM_H
#define PIR_QUERY_ANSWER_ROOM_H

#include "base/scratch.h"
#include "query/contact/patch.h"
#include "query/planes/groups.h"

typedef struct pir_query_room {
    const pir_query *owner; /* NULL where what was there is lost */
    pir_planes planes;
    pir_group_work work;
    pir_limbs limbs;
    pir_patch_room patches;
} pir_query_room;

/* The room in a scratch; NULL when out of memory. */
pir_query_room *pir_query_room_of(pir_scratch *scratch);

/* Makes room for the exact signs of two operands: PIR_ERR_MEMORY. */
pir_status pir_query_room_reserve_limbs(pir_query_room *room, const pir_scratch *scratch, const pir_polytope *p,
                                        const pir_polytope *q);

#endif
