/* SPDX-License-Identifier: MIT */
/*
 * A second sum with the pairing of a first. Pairs are copied edge by edge, so the copy's crossings stand in a row; its certificates
 * are not copied but all expired, as after a rebuild: its first update looks at every pair.
 */
#include "dymsum/sum.h"

#include <string.h>

bool pir_crossing_append(pir_sum *sum, uint32_t e, uint32_t h, uint32_t *last) {
    uint32_t slot = pir_crossing_new(sum, e, h);
    if (slot == PIR_NO_CROSSING)
        return false;
    if (*last == PIR_NO_CROSSING)
        sum->pairing.crossings.first[e] = slot;
    else
        sum->pairing.crossings.next[*last] = slot;
    *last = slot;
    return true;
}

static bool copy_pairing(pir_sum *to, const pir_sum *from) {
    const pir_pairing *pairing = &from->pairing;
    if (!pir_crossings_reserve(to, from->pairing.crossings.count))
        return false;
    memcpy(to->pairing.fv, from->pairing.fv, from->pairing.p->facet_count * sizeof *to->pairing.fv);
    memcpy(to->pairing.vf, from->pairing.vf, from->pairing.q->facet_count * sizeof *to->pairing.vf);
    pir_crossings_clear(to);
    for (uint32_t e = 0; e < from->pairing.p->edge_count; e++) {
        uint32_t last = PIR_NO_CROSSING;
        for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at))
            if (!pir_crossing_append(to, e, pir_crossing_half(pairing, at), &last))
                return false;
    }
    pir_expire_all(to);
    return true;
}

pir_status pir_sum_clone(const pir_sum *sum, const pir_allocator *allocator, pir_sum **ret_sum) {
    if (!sum || !ret_sum)
        return PIR_ERR_ARGUMENT;
    const pir_allocator used = allocator ? *allocator : sum->pairing.allocator;
    pir_sum *copy = NULL;
    pir_status status = pir_sum_new(sum->pairing.p, sum->pairing.q, sum->pairing.signs.rotation.given, &used, &copy);
    if (status != PIR_OK)
        return status;
    for (int i = 0; i < 2; i++) {
        pir_polytope_release(copy->made_of[i]);
        copy->made_of[i] = pir_polytope_retain(sum->made_of[i]);
    }
    bool done = copy_pairing(copy, sum), fits = true;
    if (done && sum->region.cone.set)
        done = pir_region_adopt(copy, &sum->region.cone, &sum->region.cover, &fits);
    PIR_ASSERT(fits);
    if (!done) {
        pir_sum_destroy(copy);
        return PIR_ERR_MEMORY;
    }
    copy->pairing.difference = sum->pairing.difference;
    copy->cost = sum->cost;
    copy->lag = sum->lag;
    if (sum->lag.lagging)
        pir_rotation_set(&copy->lag.now, sum->lag.now.given); // its integers point into itself
    copy->statistics = (pir_sum_statistics){0};
    *ret_sum = copy;
    return PIR_OK;
}
