/* SPDX-License-Identifier: MIT */
/*
 * The life of a sum: making it, rotating it by one method or another, reading its pairing. The invariants stand in sum.h.
 */
#include "dymsum/sum.h"

#include <string.h>

#include "dymsum/choose.h"

/* When the turn passes this, everything is counted from zero again, so that adding small angles stays accurate. */
#define REBASE_TURN 64.0

pir_sum_options pir_sum_options_default(void) {
    return (pir_sum_options){.allocator = NULL, .difference = 0};
}

static uint32_t most(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

static uint32_t queue_capacity(const pir_sum *sum) {
    return most(most(sum->p->facet_count, sum->q->facet_count), sum->p->edge_count);
}

static bool allocate(pir_sum *sum) {
    const pir_allocator *a = &sum->allocator;
    const pir_polytope *p = sum->p, *q = sum->q;
    sum->fv = PIR_ZEROED(a, uint32_t, p->facet_count);
    sum->vf = PIR_ZEROED(a, uint32_t, q->facet_count);
    sum->first = PIR_NEW(a, uint32_t, p->edge_count);
    sum->fv_until = PIR_NEW(a, double, p->facet_count);
    sum->vf_until = PIR_NEW(a, double, q->facet_count);
    sum->queue = PIR_NEW(a, uint32_t, queue_capacity(sum));
    sum->mark = PIR_ZEROED(a, uint8_t, queue_capacity(sum));
    sum->rotated = PIR_NEW(a, pir_vec3, p->facet_count);
    if (!sum->fv || !sum->vf || !sum->first || !sum->fv_until || !sum->vf_until || !sum->queue || !sum->mark ||
        !sum->rotated)
        return false;
    // room for what most rotations need, so that tracking seldom grows it
    return pir_crossings_reserve(sum, 3 * (p->edge_count + q->edge_count) + 64);
}

void pir_sum_destroy(pir_sum *sum) {
    if (!sum)
        return;
    const pir_allocator allocator = sum->allocator, *a = &allocator;
    const pir_polytope *p = sum->p, *q = sum->q;
    PIR_FREE(a, sum->fv, p->facet_count);
    PIR_FREE(a, sum->vf, q->facet_count);
    PIR_FREE(a, sum->first, p->edge_count);
    PIR_FREE(a, sum->fv_until, p->facet_count);
    PIR_FREE(a, sum->vf_until, q->facet_count);
    PIR_FREE(a, sum->queue, queue_capacity(sum));
    PIR_FREE(a, sum->mark, queue_capacity(sum));
    PIR_FREE(a, sum->rotated, p->facet_count);
    PIR_FREE(a, sum->crossings.half, sum->crossings.capacity);
    PIR_FREE(a, sum->crossings.edge, sum->crossings.capacity);
    PIR_FREE(a, sum->crossings.next, sum->crossings.capacity);
    PIR_FREE(a, sum->crossings.until, sum->crossings.capacity);
    pir_signs_finish(&sum->signs, a);
    pir_polytope_release(sum->p);
    pir_polytope_release(sum->q);
    PIR_FREE(a, sum, 1);
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
    pir_sum *sum = PIR_ZEROED(&allocator, pir_sum, 1);
    if (!sum)
        return PIR_ERR_MEMORY;
    sum->allocator = allocator;
    // from here on destroy can take it apart
    sum->q = pir_polytope_retain(q);
    if (!used.difference) {
        sum->p = pir_polytope_retain(p);
    } else if (pir_polytope_reflect(p, &sum->p) != PIR_OK) {
        pir_polytope_release(q);
        PIR_FREE(&allocator, sum, 1);
        return PIR_ERR_MEMORY;
    }
    status = pir_signs_init(&sum->signs, &allocator, most(sum->p->exact_edge.stride, sum->p->exact_normal.stride),
                            most(sum->q->exact_edge.stride, sum->q->exact_normal.stride));
    if (status == PIR_OK && !allocate(sum))
        status = PIR_ERR_MEMORY;
    if (status == PIR_OK) {
        pir_rotation_set(&sum->signs.rotation, rotation);
        status = pir_walk_rebuild(sum);
    }
    if (status != PIR_OK) {
        pir_sum_destroy(sum);
        return status;
    }
    sum->statistics.allocations = 0;
    *ret_sum = sum;
    return PIR_OK;
}

/* Counts the turn from zero again. Shrinking what is left by a hair keeps every rounding on the early side. */
static void rebase_turn(pir_sum *sum) {
    double less = sum->turn * (1 + 0x1p-51);
    for (uint32_t f = 0; f < sum->p->facet_count; f++)
        sum->fv_until[f] -= less;
    for (uint32_t g = 0; g < sum->q->facet_count; g++)
        sum->vf_until[g] -= less;
    for (uint32_t i = 0; i < sum->crossings.used; i++)
        sum->crossings.until[i] -= less;
    sum->turn = 0;
}

/* The pairing that was there at rotation `before`: it fitted the memory that is there. */
static pir_status restore(pir_sum *sum, pir_quat before, pir_status status) {
    pir_rotation_set(&sum->signs.rotation, before);
    pir_status again = pir_walk_rebuild(sum);
    PIR_ASSERT(again == PIR_OK);
    (void)again;
    return status;
}

pir_status pir_sum_rotate(pir_sum *sum, pir_quat rotation, pir_method method) {
    if (!sum || method < PIR_METHOD_AUTO || method > PIR_METHOD_WALK)
        return PIR_ERR_ARGUMENT;
    pir_rotation *now = &sum->signs.rotation;
    pir_quat before = now->given, unit_before = now->unit;
    pir_status status = pir_rotation_set(now, rotation);
    if (status != PIR_OK)
        return status;
    double angle = pir_rotation_angle_bound(unit_before, now->unit);
    if (method == PIR_METHOD_AUTO)
        method = pir_choose_method(sum, angle);
    if (method == PIR_METHOD_WALK) {
        sum->cost.walks_in_a_row++;
        sum->statistics.rebuilds++;
        status = pir_walk_rebuild(sum);
    } else {
        if (sum->turn > REBASE_TURN)
            rebase_turn(sum);
        sum->turn = (sum->turn + angle) * (1 + 0x1p-51);
        uint64_t asked = pir_signs_asked(&sum->signs);
        status = pir_update_repair(sum);
        sum->statistics.updates++;
        pir_learn_update(sum, angle, (double)(pir_signs_asked(&sum->signs) - asked));
    }
    return status == PIR_OK ? PIR_OK : restore(sum, before, status);
}

pir_status pir_sum_rotate_brute_force(pir_sum *sum, pir_quat rotation) {
    if (!sum)
        return PIR_ERR_ARGUMENT;
    pir_quat before = sum->signs.rotation.given;
    pir_status status = pir_rotation_set(&sum->signs.rotation, rotation);
    if (status != PIR_OK)
        return status;
    status = pir_brute_rebuild(sum);
    return status == PIR_OK ? PIR_OK : restore(sum, before, status);
}

/* --- reading --- */

pir_quat pir_sum_rotation(const pir_sum *sum) {
    return sum->signs.rotation.given;
}

const pir_polytope *pir_sum_p(const pir_sum *sum) {
    return sum->p;
}

const pir_polytope *pir_sum_q(const pir_sum *sum) {
    return sum->q;
}

const uint32_t *pir_sum_fv(const pir_sum *sum) {
    return sum->fv;
}

const uint32_t *pir_sum_vf(const pir_sum *sum) {
    return sum->vf;
}

uint32_t pir_sum_ee_count(const pir_sum *sum) {
    return sum->ee_count;
}

void pir_sum_ee(const pir_sum *sum, uint32_t (*ret_pairs)[2]) {
    const pir_crossings *c = &sum->crossings;
    for (uint32_t e = 0; e < sum->p->edge_count; e++)
        for (uint32_t slot = sum->first[e]; slot != PIR_NO_CROSSING; slot = c->next[slot]) {
            (*ret_pairs)[0] = e;
            (*ret_pairs)[1] = sum->q->edge[c->half[slot]];
            ret_pairs++;
        }
}

int pir_sum_same_pairing(const pir_sum *a, const pir_sum *b) {
    const pir_polytope *p = a->p, *q = a->q;
    if (p->facet_count != b->p->facet_count || q->facet_count != b->q->facet_count || p->edge_count != b->p->edge_count)
        return 0;
    if (a->ee_count != b->ee_count || memcmp(a->fv, b->fv, p->facet_count * sizeof *a->fv) != 0 ||
        memcmp(a->vf, b->vf, q->facet_count * sizeof *a->vf) != 0)
        return 0;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t i = a->first[e], j = b->first[e];
        while (i != PIR_NO_CROSSING && j != PIR_NO_CROSSING && a->crossings.half[i] == b->crossings.half[j]) {
            i = a->crossings.next[i];
            j = b->crossings.next[j];
        }
        if (i != PIR_NO_CROSSING || j != PIR_NO_CROSSING)
            return 0;
    }
    return 1;
}

pir_sum_statistics pir_sum_get_statistics(const pir_sum *sum) {
    pir_sum_statistics statistics = sum->statistics;
    statistics.by_filter = sum->signs.by_filter;
    statistics.by_exact = sum->signs.by_exact;
    statistics.by_perturbation = sum->signs.by_perturbation;
    return statistics;
}
