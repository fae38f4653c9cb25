/* SPDX-License-Identifier: MIT */
/*
 * The pairs of pieces whose boxes in the tree meet. A pair is known by its number; each piece has a list of those that
 * it is in.
 *
 * An end of a pair is 2 · pair + side: the pieces on side 0 and 1 are P and Q. Lists are of ends.
 *
 * A pair has a pir_pair from the first time that something had to be asked of it. When the pair is dropped its
 * pir_pair goes to a pool, from which the next one takes it.
 *
 * A pair that is in contact may have records of what was found, its own and that of a union that it is in. They go with
 * the contact.
 */
#ifndef PIR_SCENE_PAIRS_PAIRS_H
#define PIR_SCENE_PAIRS_PAIRS_H

#include <pirouette/pair.h>

#include "base/memory.h"
#include "scene/pairs/kept_record.h"

#define PIR_END_NONE UINT32_MAX

typedef struct pir_scene_pair {
    uint32_t piece[2];
    uint32_t next[2], previous[2]; /* ends in the lists of the two pieces; next[0] of an unused pair: the next one */
    bool touching;                 /* after the last update */
    pir_pair *asked;               /* or NULL */
    pir_kept_record *kept;         /* of an answer and contacts of the pair alone, or NULL */
    pir_kept_record *united;       /* of contacts of a union, or NULL */
    double apart, travelled;       /* distance that was proven, 0 for none, when both had moved this far together */
} pir_scene_pair;

typedef struct pir_scene_pairs {
    pir_scene_pair *at;
    uint32_t capacity, unused, count;
    pir_pair **pool; /* room for as many as there are pairs */
    uint32_t pooled;
    pir_kept_pool kept; /* records that no pair has */
} pir_scene_pairs;

void pir_scene_pairs_init(pir_scene_pairs *pairs);
void pir_scene_pairs_finish(pir_scene_pairs *pairs, const pir_allocator *allocator);

/* A pair of two pieces, whose lists begin at the ends *first_p and *first_q. PIR_END_NONE when out of memory. */
uint32_t pir_scene_pairs_add(pir_scene_pairs *pairs, const pir_allocator *allocator, const uint32_t piece[2],
                             uint32_t *first_p, uint32_t *first_q);

/* Gives back what a pair keeps of its contact. */
void pir_scene_pairs_forget(pir_scene_pairs *pairs, uint32_t pair);

/* Takes a pair out of both lists. */
void pir_scene_pairs_drop(pir_scene_pairs *pairs, uint32_t pair, uint32_t *first_p, uint32_t *first_q);

/* Gives a pair its pir_pair, where it has none. Errors as pir_pair_create. */
pir_status pir_scene_pairs_ready(pir_scene_pairs *pairs, const pir_allocator *allocator, uint32_t pair, pir_polytope *p,
                                 pir_polytope *q);

#endif
