/* SPDX-License-Identifier: MIT */
/*
 * A pairing that records are applied to. The bytes are not trusted: every number is checked, and crossings that are no
 * way from cell to cell are found when they are put in order.
 *
 * Invariant, after a whole record and any number of changes that were taken: fv and vf are vertices of the other
 * operand; the crossings of each edge of −P are different edges of Q, in any order.
 */
#ifndef PIR_CSPACE_RECORD_REPLAY_H
#define PIR_CSPACE_RECORD_REPLAY_H

#include "cspace/record/record_bytes.h"
#include "cspace/record/ring_ranks.h"
#include "polytope/polytope.h"

/* A crossing of an edge of −P with a halfedge of Q, which leaves the cell before it. */
typedef struct pir_record_replay_crossing {
    uint32_t edge, half;
} pir_record_replay_crossing;

/* The crossings of the edges of −P, each edge's a chain of slots. Free slots are chained too. */
typedef struct pir_record_replay_slots {
    uint32_t *first;        /* per edge of −P: a slot, or PIR_NO_EDGE */
    uint32_t *next, *other; /* per slot: the next one of its chain; the edge of Q */
    uint32_t used, room, free, count;
} pir_record_replay_slots;

typedef struct pir_record_replay {
    pir_allocator allocator;
    const pir_polytope *p, *q; /* −P and Q; borrowed */
    pir_ring_ranks ranks_p, ranks_q;
    uint32_t *fv, *vf;
    bool begun; /* a whole record has been applied */
    pir_record_replay_slots slots;
    pir_record_replay_crossing *ordered; /* room for all crossings */
    uint32_t ordered_room;
} pir_record_replay;

/* False when out of memory. pir_record_replay_finish releases whatever is there. */
bool pir_record_replay_init(pir_record_replay *replay, const pir_polytope *minus_p, const pir_polytope *q,
                            const pir_allocator *allocator);
void pir_record_replay_finish(pir_record_replay *replay);

/*
 * Applies the record. After an error the replay needs a whole record next. Errors: PIR_ERR_FORMAT, PIR_ERR_LIMIT,
 * PIR_ERR_MEMORY.
 */
pir_status pir_record_replay_record(pir_record_replay *replay, const uint8_t *bytes, size_t size);

/*
 * All crossings, by rising edge of −P and in order along its arc; valid until the next call. Errors: PIR_ERR_FORMAT
 * where they lead from no cell to the next, PIR_ERR_MEMORY.
 */
pir_status pir_record_replay_crossings(pir_record_replay *replay, const pir_record_replay_crossing **ret_crossings,
                                       uint32_t *ret_count);

#endif
