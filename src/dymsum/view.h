/* SPDX-License-Identifier: MIT */
/*
 * The read-only view of a sum: its pairing, its rotations, its region, and a number that changes with it.
 *
 * Queries, meshes, live meshes and files include this header and not the sum's own. Nothing here changes a sum, but for
 * the integers that exact signs make on demand. What is borrowed here stays valid until the sum changes or is freed.
 */
#ifndef PIR_DYMSUM_VIEW_H
#define PIR_DYMSUM_VIEW_H

#include "dymsum/pairing/journal.h"
#include "dymsum/pairing/pairing.h"
#include "dymsum/region/cover.h"

/* The pairing, with the operands. It is the first member of a sum. */
static inline const pir_pairing *pir_sum_pairing(const pir_sum *sum) {
    return (const pir_pairing *)(const void *)sum;
}

/* Signs at the rotation that the pairing is exact at, with their rotation and scratch memory. */
static inline pir_signs *pir_sum_signs(pir_sum *sum) {
    return &((pir_pairing *)(void *)sum)->signs;
}

/* The scratch that the sum and what stands on it work in. */
static inline pir_scratch *pir_sum_scratch(const pir_sum *sum) {
    return pir_sum_pairing(sum)->scratch;
}

/* The rotation that the pairing is exact at. */
static inline pir_rotation *pir_sum_exact_rotation(pir_sum *sum) {
    return &pir_sum_signs(sum)->rotation;
}

/*
 * A number that changes with every call that may have changed anything that is read of the sum: operands, rotation,
 * pairing, tolerance, region. Whoever derives something from a sum keeps the number beside it, and derives again when
 * the two differ. Never 0.
 */
static inline uint64_t pir_sum_generation(const pir_sum *sum) {
    return pir_sum_pairing(sum)->generation;
}

/*
 * Takes a reference, which pir_sum_destroy gives back. The last one to go frees the sum. Returns the sum. Taking one
 * changes nothing that is read of the sum.
 */
pir_sum *pir_sum_retain(const pir_sum *sum);

/* The rotation that was asked for. It differs from the exact one while a tolerance lets the pairing stay behind. */
pir_rotation *pir_sum_shown_rotation(const pir_sum *sum);

/* The operand at scale 1, as it was given; with PIR_OPERAND_P of a difference, reflected. */
const pir_polytope *pir_sum_made_of(const pir_sum *sum, pir_operand operand);

/* The region's cone, which is not `set` where the sum is whole, and the cover that its features were chosen by. */
const pir_cone *pir_sum_cone(const pir_sum *sum);
const pir_cover *pir_sum_cover(const pir_sum *sum);

/* Numbers of features of one kind. */
typedef struct pir_features {
    const uint32_t *at;
    uint32_t count;
} pir_features;

/* The features that a region keeps. Only for sums that have or had a region. */
typedef struct pir_kept {
    pir_features facets_p, facets_q, edges_p;
} pir_kept;

pir_kept pir_sum_kept(const pir_sum *sum);

/* The slots that have changed lately, from the time on that pir_sum_keep_journal has made room: PIR_ERR_MEMORY. */
const pir_journal *pir_sum_journal(const pir_sum *sum);
pir_status pir_sum_keep_journal(const pir_sum *sum);

#endif
