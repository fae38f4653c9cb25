/* SPDX-License-Identifier: MIT */
/*
 * The life of a sum: making it, rotating it by one method or another, reading its pairing. The invariants stand in sum.h.
 */
#include "dymsum/sum.h"

#include <string.h>

#include "dymsum/region/sweep.h"
#include "dymsum/update/choose.h"

pir_sum_options pir_sum_options_default(void) {
    return (pir_sum_options){.allocator = NULL, .difference = 0};
}

static uint32_t most(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

static uint32_t queue_capacity(const pir_sum *sum) {
    return most(most(sum->pairing.p->facet_count, sum->pairing.q->facet_count), sum->pairing.p->edge_count);
}

/* The facets of p, in the cells `cell` of q. */
static void link_facets(pir_facets *facets, const pir_polytope *p, const pir_polytope *q, uint32_t *cell) {
    facets->count = p->facet_count;
    facets->normal = p->normal4;
    facets->ring_start = q->ring_start;
    facets->ring_block = q->ring_block;
    facets->target = q->target;
    facets->twin = q->twin;
    facets->ring = q->ring;
    facets->cell = cell;
}

void pir_sum_link_facets(pir_sum *sum) {
    link_facets(&sum->p_facets, sum->pairing.p, sum->pairing.q, sum->pairing.fv);
    link_facets(&sum->q_facets, sum->pairing.q, sum->pairing.p, sum->pairing.vf);
    sum->q_facets.first_certificate = sum->pairing.p->facet_count;
}

static bool allocate(pir_sum *sum) {
    const pir_allocator *a = &sum->pairing.allocator;
    const pir_polytope *p = sum->pairing.p, *q = sum->pairing.q;
    sum->pairing.fv = PIR_ZEROED(a, uint32_t, p->facet_count);
    sum->pairing.vf = PIR_ZEROED(a, uint32_t, q->facet_count);
    sum->pairing.crossings.first = PIR_NEW(a, uint32_t, p->edge_count);
    sum->queue = PIR_NEW(a, uint32_t, queue_capacity(sum));
    sum->mark = PIR_ZEROED(a, uint8_t, queue_capacity(sum));
    sum->rotated = PIR_NEW(a, pir_vec3, p->facet_count);
    sum->touched = PIR_ZEROED(a, uint32_t, p->edge_count);
    sum->suspects = PIR_NEW(a, pir_suspect, pir_certificate_count(sum));
    sum->passes = PIR_NEW(a, pir_suspect, q->facet_count);
    if (!sum->pairing.fv || !sum->pairing.vf || !sum->pairing.crossings.first || !sum->queue || !sum->mark ||
        !sum->rotated || !sum->touched || !sum->suspects || !sum->passes ||
        !pir_certificates_init(&sum->certificates, a, pir_certificate_count(sum)))
        return false;
    pir_sum_link_facets(sum);
    // room for what most rotations need, so that tracking seldom grows it
    return pir_crossings_reserve(sum, 3 * (p->edge_count + q->edge_count) + 64);
}

static void free_sum(pir_sum *sum) {
    const pir_allocator allocator = sum->pairing.allocator, *a = &allocator;
    const pir_polytope *p = sum->pairing.p, *q = sum->pairing.q;
    PIR_FREE(a, sum->pairing.fv, p->facet_count);
    PIR_FREE(a, sum->pairing.vf, q->facet_count);
    PIR_FREE(a, sum->pairing.crossings.first, p->edge_count);
    PIR_FREE(a, sum->queue, queue_capacity(sum));
    PIR_FREE(a, sum->mark, queue_capacity(sum));
    PIR_FREE(a, sum->rotated, p->facet_count);
    PIR_FREE(a, sum->touched, p->edge_count);
    PIR_FREE(a, sum->suspects, pir_certificate_count(sum));
    PIR_FREE(a, sum->passes, q->facet_count);
    pir_certificates_finish(&sum->certificates, a);
    pir_crossings_finish(sum);
    pir_sweep_finish(sum);
    pir_signs_finish(&sum->pairing.signs, a);
    pir_cgm_destroy(sum->cgm_q);
    pir_polytope_release(sum->pairing.p);
    pir_polytope_release(sum->pairing.q);
    pir_polytope_release(sum->made_of[PIR_OPERAND_P]);
    pir_polytope_release(sum->made_of[PIR_OPERAND_Q]);
    PIR_FREE(a, sum, 1);
}

void pir_sum_destroy(pir_sum *sum) {
    if (sum && atomic_fetch_sub_explicit(&sum->references, 1, memory_order_acq_rel) == 1)
        free_sum(sum);
}

pir_status pir_sum_new(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_allocator *allocator,
                       pir_sum **ret_sum) {
    pir_sum *sum = PIR_ZEROED(allocator, pir_sum, 1);
    if (!sum)
        return PIR_ERR_MEMORY;
    sum->pairing.allocator = *allocator;
    atomic_init(&sum->references, 1);
    sum->pairing.generation = 1;
    sum->kernels = pir_kernels_choose();
    // from here on destroy can take it apart
    sum->pairing.p = pir_polytope_retain(p);
    sum->pairing.q = pir_polytope_retain(q);
    sum->made_of[PIR_OPERAND_P] = pir_polytope_retain(p);
    sum->made_of[PIR_OPERAND_Q] = pir_polytope_retain(q);
    pir_status status =
        pir_signs_init(&sum->pairing.signs, allocator, most(p->exact_edge.stride, p->exact_normal.stride),
                       most(q->exact_edge.stride, q->exact_normal.stride));
    if (status == PIR_OK && !allocate(sum))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK)
        status = pir_rotation_set(&sum->pairing.signs.rotation, rotation);
    if (status != PIR_OK) {
        pir_sum_destroy(sum);
        return status;
    }
    *ret_sum = sum;
    return PIR_OK;
}

pir_status pir_sum_create(pir_polytope *p, pir_polytope *q, pir_quat rotation, const pir_sum_options *options,
                          pir_sum **ret_sum) {
    if (!p || !q || !ret_sum)
        return PIR_ERR_ARGUMENT;
    const pir_sum_options used = options ? *options : pir_sum_options_default();
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    pir_rotation checked;
    pir_status status = pir_rotation_set(&checked, rotation);
    if (status != PIR_OK)
        return status;
    pir_polytope *turning = NULL;
    pir_sum *sum = NULL;
    if (used.difference)
        status = pir_polytope_reflect(p, &turning);
    else
        turning = pir_polytope_retain(p);
    if (status == PIR_OK)
        status = pir_sum_new(turning, q, rotation, &allocator, &sum);
    pir_polytope_release(turning);
    if (status == PIR_OK)
        status = pir_walk_rebuild(sum);
    if (status != PIR_OK) {
        pir_sum_destroy(sum);
        return status;
    }
    sum->pairing.difference = used.difference != 0;
    sum->statistics.allocations = 0;
    *ret_sum = sum;
    return PIR_OK;
}

/* Moves the clock on to the rotation, and the alarms with it. */
static void advance_epoch(pir_sum *sum, pir_quat before) {
    double shift = 0;
    uint32_t used = pir_certificate_count(sum);
    bool many_expired = sum->expired > used;
    switch (pir_epoch_take_step(&sum->epoch, before, sum->pairing.signs.rotation.unit, many_expired, &shift)) {
    case PIR_EPOCH_CONTINUES:
        break;
    case PIR_EPOCH_REBASED:
        pir_certificates_shift(&sum->certificates, used, shift);
        break;
    case PIR_EPOCH_BEGINS:
        pir_certificates_set_now(&sum->certificates, sum->pairing.signs.rotation.unit);
        pir_certificates_new_epoch(&sum->certificates, used, sum->epoch.axial, sum->epoch.expected);
        sum->expired = 0;
        break;
    }
}

/* The pairing that was there at rotation `before`: it fitted the memory that is there. The clock begins an epoch at the next step. */
static pir_status restore(pir_sum *sum, pir_quat before, const pir_cover *cover, pir_status status) {
    pir_rotation_set(&sum->pairing.signs.rotation, before);
    sum->region.cover = *cover;
    pir_status again = pir_walk_rebuild(sum);
    PIR_ASSERT(again == PIR_OK);
    (void)again;
    return status;
}

pir_status pir_sum_rotate(pir_sum *sum, pir_quat rotation, pir_method method) {
    if (!sum || method < PIR_METHOD_AUTO || method > PIR_METHOD_CGM)
        return PIR_ERR_ARGUMENT;
    // with a tolerance, an update is put off while it is within that
    if (sum->lag.tolerance > 0 && method <= PIR_METHOD_UPDATE) {
        bool done;
        pir_status kept = pir_lag_behind(sum, rotation, &done);
        if (kept != PIR_OK || done)
            return kept;
    }
    pir_rotation *now = &sum->pairing.signs.rotation;
    pir_quat before = now->given, unit_before = now->unit;
    const pir_cover cover = sum->region.cover;
    pir_status status = pir_rotation_set(now, rotation);
    if (status != PIR_OK)
        return status;
    pir_sum_changes(sum);
    pir_region_step(sum, unit_before);
    advance_epoch(sum, unit_before);
    double angle = fabs(sum->epoch.stride);
    if (method == PIR_METHOD_AUTO)
        method = pir_choose_method(sum, angle);
    if (method == PIR_METHOD_CGM) {
        sum->statistics.rebuilds++;
        status = pir_cgm_rebuild(sum);
        pir_learn_walk(sum);
    } else if (method == PIR_METHOD_WALK) {
        sum->statistics.rebuilds++;
        pir_region_renew(sum);
        status = pir_walk_rebuild(sum);
        pir_learn_walk(sum);
    } else {
        uint64_t asked = pir_signs_asked(&sum->pairing.signs);
        sum->statistics.updates++;
        pir_region_follow(sum);
        status = pir_update_repair(sum);
        if (status == PIR_OK && !pir_region_admit(sum))
            status = PIR_ERR_MEMORY;
        pir_learn_update(sum, angle, pir_signs_asked(&sum->pairing.signs) - asked);
    }
    if (status != PIR_OK)
        return restore(sum, before, &cover, status);
    sum->lag.lagging = false;
    return PIR_OK;
}

pir_status pir_sum_rotate_brute_force(pir_sum *sum, pir_quat rotation) {
    if (!sum)
        return PIR_ERR_ARGUMENT;
    pir_quat before = sum->pairing.signs.rotation.given;
    const pir_cover cover = sum->region.cover;
    pir_status status = pir_rotation_set(&sum->pairing.signs.rotation, rotation);
    if (status != PIR_OK)
        return status;
    pir_sum_changes(sum);
    status = pir_brute_rebuild(sum);
    if (status != PIR_OK)
        return restore(sum, before, &cover, status);
    sum->lag.lagging = false;
    return PIR_OK;
}

/* --- reading --- */

pir_quat pir_sum_rotation(const pir_sum *sum) {
    return sum->lag.lagging ? sum->lag.now.given : sum->pairing.signs.rotation.given;
}

const pir_polytope *pir_sum_p(const pir_sum *sum) {
    return sum->pairing.p;
}

const pir_polytope *pir_sum_q(const pir_sum *sum) {
    return sum->pairing.q;
}

const uint32_t *pir_sum_fv(const pir_sum *sum) {
    return sum->pairing.fv;
}

const uint32_t *pir_sum_vf(const pir_sum *sum) {
    return sum->pairing.vf;
}

uint32_t pir_sum_ee_count(const pir_sum *sum) {
    return sum->pairing.crossings.count;
}

void pir_sum_ee(const pir_sum *sum, uint32_t (*ret_pairs)[2]) {
    const pir_crossings *c = &sum->pairing.crossings;
    const pir_polytope *p = sum->pairing.p, *q = sum->pairing.q;
    for (uint32_t e = 0; e < p->edge_count; e++)
        for (uint32_t slot = sum->pairing.crossings.first[e]; slot != PIR_NO_CROSSING; slot = c->next[slot]) {
            // a segment's two edges are one to callers
            (*ret_pairs)[0] = p->artificial ? 0 : e;
            (*ret_pairs)[1] = q->artificial ? 0 : q->edge[c->half[slot]];
            ret_pairs++;
        }
}

pir_sum_statistics pir_sum_get_statistics(const pir_sum *sum) {
    pir_sum_statistics statistics = sum->statistics;
    statistics.by_filter = sum->pairing.signs.by_filter;
    statistics.by_exact = sum->pairing.signs.by_exact;
    statistics.by_perturbation = sum->pairing.signs.by_perturbation;
    return statistics;
}
