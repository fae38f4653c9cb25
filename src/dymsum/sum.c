/* SPDX-License-Identifier: MIT */
/* The life of a sum: making it, releasing it, reading its pairing. */
#include "dymsum/rotate.h"

#include "base/options.h"

bool pir_sum_reserve_lag(pir_sum *sum) {
    pir_pairing *pairing = &sum->tracked.pairing;
    // the room is there since the sum was made
    pir_sum_room *room = pir_sum_room_of(pairing->scratch, pairing->p, pairing->q);
    return room && pir_lag_reserve(&sum->lag, &pairing->allocator, &room->shown);
}

static void free_sum(pir_sum *sum) {
    const pir_allocator allocator = sum->tracked.pairing.allocator;
    pir_lag_finish(&sum->lag, &allocator);
    pir_region_finish(&sum->region, &allocator);
    pir_tracked_finish(&sum->tracked);
    pir_cgm_release(sum->cgm_q);
    pir_polytope_release(sum->made_of[PIR_OPERAND_P]);
    pir_polytope_release(sum->made_of[PIR_OPERAND_Q]);
    PIR_FREE(&allocator, sum, 1);
}

void pir_sum_destroy(pir_sum *sum) {
    if (sum && atomic_fetch_sub_explicit(&sum->references, 1, memory_order_acq_rel) == 1)
        free_sum(sum);
}

pir_status pir_sum_new(const pir_sum_parts *parts, pir_sum **ret_sum) {
    pir_sum *sum = PIR_ZEROED(parts->allocator, pir_sum, 1);
    if (!sum)
        return PIR_ERR_MEMORY;
    atomic_init(&sum->references, 1);
    sum->made_of[PIR_OPERAND_P] = pir_polytope_retain(parts->p);
    sum->made_of[PIR_OPERAND_Q] = pir_polytope_retain(parts->q);
    pir_status status = pir_tracked_init(&sum->tracked, parts);
    if (status != PIR_OK) {
        pir_sum_destroy(sum);
        return status;
    }
    *ret_sum = sum;
    return PIR_OK;
}

/* The scratch that a workspace begins with. */
static pir_scratch *scratch_of(pir_workspace *workspace) {
    return workspace ? ((const pir_workspace_head *)(const void *)workspace)->scratch : NULL;
}

pir_status pir_sum_create(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_sum_options *options,
                          pir_sum **ret_sum) {
    if (!p || !q || !ret_sum)
        return PIR_ERR_ARGUMENT;
    pir_sum_options used = pir_sum_options_default();
    pir_status status = pir_options_take("pir_sum_options", options, &used, NULL);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    pir_rotation checked;
    status = pir_rotation_set(&checked, rotation);
    if (status != PIR_OK)
        return status;
    pir_polytope *turning = NULL;
    pir_sum *sum = NULL;
    if (used.difference)
        status = pir_polytope_reflect(p, &turning);
    else
        turning = pir_polytope_retain(p);
    if (status == PIR_OK)
        status = pir_sum_new(&(pir_sum_parts){turning, q, rotation, &allocator, scratch_of(used.workspace)}, &sum);
    pir_polytope_release(turning);
    if (status == PIR_OK)
        status = pir_sum_walk(sum);
    if (status != PIR_OK) {
        pir_sum_destroy(sum);
        return status;
    }
    sum->tracked.pairing.difference = used.difference != 0;
    sum->tracked.statistics.allocations = 0;
    *ret_sum = sum;
    return PIR_OK;
}

const pir_polytope *pir_sum_p(const pir_sum *sum) {
    return sum->tracked.pairing.p;
}

const pir_polytope *pir_sum_q(const pir_sum *sum) {
    return sum->tracked.pairing.q;
}

const uint32_t *pir_sum_fv(const pir_sum *sum) {
    return sum->tracked.pairing.fv;
}

const uint32_t *pir_sum_vf(const pir_sum *sum) {
    return sum->tracked.pairing.vf;
}

uint32_t pir_sum_ee_count(const pir_sum *sum) {
    return sum->tracked.pairing.crossings.count;
}

void pir_sum_ee(const pir_sum *sum, uint32_t (*ret_pairs)[2]) {
    const pir_pairing *pairing = &sum->tracked.pairing;
    const pir_polytope *p = pairing->p, *q = pairing->q;
    for (uint32_t e = 0; e < p->edge_count; e++)
        for (uint32_t at = pir_crossing_first(pairing, e); at != PIR_NO_CROSSING; at = pir_crossing_next(pairing, at)) {
            // a segment's two edges are one to callers
            (*ret_pairs)[0] = p->artificial ? 0 : e;
            (*ret_pairs)[1] = q->artificial ? 0 : q->edge[pir_crossing_half(pairing, at)];
            ret_pairs++;
        }
}

pir_sum_statistics pir_sum_get_statistics(const pir_sum *sum) {
    pir_sum_statistics statistics = sum->tracked.statistics;
    statistics.by_filter = sum->tracked.pairing.signs.by_filter;
    statistics.by_exact = sum->tracked.pairing.signs.by_exact;
    statistics.by_perturbation = sum->tracked.pairing.signs.by_perturbation;
    return statistics;
}
