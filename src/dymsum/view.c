/* SPDX-License-Identifier: MIT */
/* Reads of a sum from outside that need more than the pairing. */
#include "dymsum/view.h"

#include <stddef.h>

#include "dymsum/sum.h"

_Static_assert(offsetof(struct pir_sum, tracked) == 0 && offsetof(pir_tracked, pairing) == 0,
               "pir_sum_pairing takes a sum's address for its pairing's");

pir_sum *pir_sum_retain(const pir_sum *sum) {
    pir_sum *held = (pir_sum *)sum;
    atomic_fetch_add_explicit(&held->references, 1, memory_order_relaxed);
    return held;
}

pir_rotation *pir_sum_shown_rotation(const pir_sum *sum) {
    pir_sum *at = (pir_sum *)sum;
    return sum->lag.lagging ? &at->lag.knots->now : &at->tracked.pairing.signs.rotation;
}

const pir_polytope *pir_sum_made_of(const pir_sum *sum, pir_operand operand) {
    return sum->made_of[operand];
}

const pir_cone *pir_sum_cone(const pir_sum *sum) {
    return &sum->region.cone;
}

const pir_cover *pir_sum_cover(const pir_sum *sum) {
    return &sum->region.cover;
}

static pir_features features_of(const pir_members *members) {
    return (pir_features){members->at, members->count};
}

pir_kept pir_sum_kept(const pir_sum *sum) {
    const pir_region *region = &sum->region;
    return (pir_kept){features_of(&region->sweep->p.members), features_of(&region->sweep->q.members),
                      features_of(&region->sweep->edges)};
}

const pir_journal *pir_sum_journal(const pir_sum *sum) {
    return &sum->tracked.journal;
}

pir_status pir_sum_keep_journal(const pir_sum *sum) {
    // what is noted is no part of what the sum says
    pir_tracked *tracked = &((pir_sum *)sum)->tracked;
    return pir_journal_keep(&tracked->journal, &tracked->pairing.allocator) ? PIR_OK : PIR_ERR_MEMORY;
}
