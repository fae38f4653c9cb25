/* SPDX-License-Identifier: MIT */
/*
 * Writes the records of a sum that turns.
 *
 * A recorder holds the pairing of the slice before: the cells of facets, and the crossings. Of edges of −P it looks
 * at those that the sum's journal names; where the journal does not reach back, at all.
 *
 * A record depends on the pairings before and after alone, not on the way between them or on slots.
 */
#ifndef PIR_CSPACE_RECORD_RECORDER_H
#define PIR_CSPACE_RECORD_RECORDER_H

#include "cspace/record/held_crossings.h"
#include "cspace/record/record_bytes.h"
#include "cspace/record/ring_ranks.h"
#include "dymsum/view.h"

/* A facet that is in another cell than before. */
typedef struct pir_cell_change {
    uint32_t facet, before, now;
} pir_cell_change;

typedef struct pir_recorder {
    pir_allocator allocator;
    const pir_sum *sum; /* borrowed */
    const pir_pairing *pairing;
    uint64_t edges_seen, steps; /* of the journal: what has been read */
    pir_ring_ranks p, q;
    uint32_t *fv, *vf;       /* of the slice before */
    pir_cell_change *change; /* room for all facets: those of −P, then those of Q */
    uint32_t change_count[2];
    uint64_t *doubtful; /* a bit for each edge of −P for which the reader may be wrong */
    pir_held_crossings held;
    uint32_t *unforeseen; /* edges of −P: room for all */
} pir_recorder;

/* False when out of memory. pir_recorder_finish releases whatever is there. */
bool pir_recorder_init(pir_recorder *recorder, const pir_sum *sum, const pir_allocator *allocator);
void pir_recorder_finish(pir_recorder *recorder);

/* Appends the record of the sum as it is now: whole where `key` or where much has changed. False when out of memory. */
bool pir_recorder_write(pir_recorder *recorder, bool key, pir_bytes *bytes);

#endif
