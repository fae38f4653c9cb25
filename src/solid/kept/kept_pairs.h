/* SPDX-License-Identifier: MIT */
/*
 * The sums of all pairs of pieces, kept while P turns: each a list of planes of the space, which have the same numbers
 * as long as the features that they are of support each other.
 *
 * Invariants between updates:
 * - A pair's sum is what is below all of its planes, each that of a facet of it. Planes stand by what they are of.
 * - What an update takes out of a pair is `dropped`, and its number is not used again before pir_kept_pairs_settle.
 */
#ifndef PIR_SOLID_KEPT_PAIRS_H
#define PIR_SOLID_KEPT_PAIRS_H

#include "solid/kept/sign_table.h"

/* The features of a plane. Of a face of P's piece (kind 0) or of Q's (1): its number there, the vertex of the other
 * that is farthest along it. Of two edges (2): their numbers in the pieces, and whether it is along e × g or against
 * it. */
typedef struct pir_sum_facet_key {
    uint32_t kind, a, b;
    bool turned;
} pir_sum_facet_key;

typedef struct pir_kept_pair_sum {
    pir_sum_facet_key *key;
    uint32_t *plane;
    uint32_t count, room, plane_room;
    uint32_t renewed;              /* the frame in which all planes had their doubles made */
    uint64_t met;                  /* the number of the facet's look round that came to it last */
    uint32_t first_new, new_count; /* of that frame, in `added` */
    uint32_t noted, noted_count;   /* while signs are being looked through: the last one in `note` + 1, or 0 */
} pir_kept_pair_sum;

/* A sign of a pair that has changed, and the one noted before it + 1, or 0. */
typedef struct pir_pair_note {
    uint32_t change, before;
} pir_pair_note;

typedef struct pir_kept_pairs {
    pir_sign_table *table;
    pir_kept_pair_sum *pair; /* k·l by P's piece, then Q's */
    uint32_t count;
    uint32_t *changed, changed_count, changed_room; /* pairs of this frame */
    uint32_t *added, added_count, added_room;       /* planes of this frame */
    uint32_t *dropped, dropped_count, dropped_room; /* likewise */
    uint8_t *has_changed;                           /* per pair: whether planes came or went in this frame */
    uint8_t *is_dropped;                            /* per plane of the space */
    uint32_t is_dropped_room;
    pir_sum_facet_key *key, *touched; /* scratch, as are the next */
    uint32_t *plane, key_room, touched_room, plane_room;
    pir_pair_note *note;
    uint32_t note_count, note_room;
    uint32_t (*edge_at[2])[2]; /* per edge of the pieces of a body: the places of its ends among the piece's vertices */
    uint64_t looks;            /* of facets round themselves */
    uint8_t *below;            /* per vertex of a piece: whether an edge leads farther */
    uint32_t below_room;
} pir_kept_pairs;

/* Makes the sums of all pairs from a table of signs. The status is the space's. */
void pir_kept_pairs_init(pir_kept_pairs *pairs, pir_sign_table *table);
void pir_kept_pairs_finish(pir_kept_pairs *pairs);

/* Brings the pairs to the table's signs, which have changed. */
void pir_kept_pairs_update(pir_kept_pairs *pairs);

/* Makes the numbers of planes that were dropped spare: nothing refers to them. */
void pir_kept_pairs_settle(pir_kept_pairs *pairs);

static inline bool pir_plane_is_dropped(const pir_kept_pairs *pairs, uint32_t plane) {
    return plane < pairs->is_dropped_room && pairs->is_dropped[plane];
}

/* The box of a pair's sum, at the rotation at hand. */
pir_space_box pir_kept_pair_box(const pir_kept_pairs *pairs, uint32_t pair);

#endif
