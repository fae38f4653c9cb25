/* SPDX-License-Identifier: MIT */
/*
 * The crossings of the slice before, and whether a reader foresees those of now.
 *
 * From the crossings of an edge of −P as they were a reader takes out and enters those that facets pass as they go to
 * neighbouring cells. It foresees the edge when that leaves the crossings of now: when each edge of Q is found an even
 * number of times among those before, those passed and those of now.
 */
#ifndef PIR_CSPACE_RECORD_HELD_CROSSINGS_H
#define PIR_CSPACE_RECORD_HELD_CROSSINGS_H

#include "dymsum/pairing/pairing.h"

/* An edge of Q that an edge of −P has passed, and the next one that the same edge has. */
typedef struct pir_passed_edge {
    uint32_t other, next;
} pir_passed_edge;

typedef struct pir_held_crossings {
    pir_allocator allocator;
    const pir_pairing *pairing; /* borrowed; its crossings are those of now */
    uint32_t *first;            /* per edge of −P: a slot, or PIR_NO_CROSSING */
    pir_crossing *slot;         /* as pir_crossings has them */
    uint32_t slot_room;
    uint32_t *first_passed; /* per edge of −P: an entry of `passed`, or PIR_NO_CROSSING */
    pir_passed_edge *passed;
    uint32_t passed_count;
    uint8_t *odd; /* per edge of Q: whether it has been found an odd number of times; 0 between calls */
} pir_held_crossings;

/* None held. False when out of memory; pir_held_crossings_finish releases what is there. */
bool pir_held_crossings_init(pir_held_crossings *held, const pir_pairing *pairing, const pir_allocator *allocator);
void pir_held_crossings_finish(pir_held_crossings *held);

/* Makes room to hold the crossings of now. False when out of memory. */
bool pir_held_crossings_reserve(pir_held_crossings *held);

/* Holds the crossings of now, in room that has been made. */
void pir_held_crossings_take(pir_held_crossings *held);

/* Edge e of −P and edge g of Q pass each other. A facet does so with each of its edges, once a slice at most. */
static inline void pir_held_crossings_pass(pir_held_crossings *held, uint32_t e, uint32_t g) {
    held->passed[held->passed_count] = (pir_passed_edge){g, held->first_passed[e]};
    held->first_passed[e] = held->passed_count++;
}

/* Whether a reader foresees the crossings of edge e of −P. What e has passed is forgotten. O(these). */
bool pir_is_foreseen(pir_held_crossings *held, uint32_t e);

#endif
