/* SPDX-License-Identifier: MIT */
/*
 * A query and the sum that it stands on: making and releasing it, and following what the sum does.
 *
 * The query holds references to the sum and to both operands, so whatever it was made from stays in memory as long as
 * it does, in whatever order callers destroy things. Each call compares the sum's generation (dymsum/view.h) with the one that
 * the query is for. Where they differ:
 *
 *   - Operands. A sum's operand is only ever replaced by the same polytope on another scale. Its features keep their
 *     numbers and their normals to the bit, so all sizes and the groups stay. What depends on coordinates is filled
 *     anew, in the memory that is there; only the room for exact signs may have to grow, with the digits of the scale.
 *     Bounds begin as in a new query.
 *   - Rotation. The planes of the last one are forgotten. At one rotation the pairing of given operands is unique, so
 *     nothing is to be forgotten when that stays; a search in a region makes its planes anew each time (region.c).
 *   - The number of crossings. There is room for their planes before anything is asked.
 *
 * A call that fails on the way leaves the generation behind: the next one goes the same way again.
 */
#include "query/contact/patch.h"

void pir_query_destroy(pir_query *query) {
    if (!query)
        return;
    const pir_allocator allocator = query->allocator, *a = &allocator;
    PIR_FREE(a, query->scratch.base, query->scratch.capacity);
    pir_patch_room_free(a, query->patches, query->p, query->q);
    pir_leaves_finish(query);
    pir_bounds_finish(query);
    pir_planes_finish(query);
    pir_region_free(query);
    pir_frame_finish(query);
    pir_polytope_release(query->p);
    pir_polytope_release(query->q);
    pir_sum_destroy(query->sum);
    PIR_FREE(a, query, 1);
}

/* Room for exact signs at the operands' scales; what was in it is lost. */
static bool reserve_scratch(pir_query *query) {
    uint32_t need = pir_exact_limbs(query->p, query->q);
    if (query->scratch.base && need <= query->scratch.capacity)
        return true;
    const pir_allocator *a = &query->allocator;
    mp_limb_t *limbs = PIR_NEW(a, mp_limb_t, need);
    if (!limbs)
        return false;
    PIR_FREE(a, query->scratch.base, query->scratch.capacity);
    query->scratch = (pir_limbs){limbs, 0, need};
    return true;
}

/* Takes a reference to `polytope` in place of the one in *held. */
static void hold(pir_polytope **held, pir_polytope *polytope) {
    pir_polytope *before = *held;
    *held = pir_polytope_retain(polytope);
    pir_polytope_release(before);
}

/* Fills what depends on the operands' coordinates for those that the sum has now. */
static pir_status fit(pir_query *query) {
    query->fits = false;
    hold(&query->p, pir_sum_pairing(query->sum)->p);
    hold(&query->q, pir_sum_pairing(query->sum)->q);
    if (!reserve_scratch(query))
        return PIR_ERR_MEMORY;
    pir_status status = pir_frame_fill(query);
    if (status != PIR_OK)
        return status;
    pir_planes_fill(query);
    pir_bounds_fill(query);
    pir_region_forget(query);
    query->followed = false;
    query->fits = true;
    return PIR_OK;
}

pir_status pir_query_create(pir_sum *difference, pir_query **ret_query) {
    if (!difference || !ret_query || !pir_sum_pairing(difference)->difference)
        return PIR_ERR_ARGUMENT;
    const pir_pairing *pairing = pir_sum_pairing(difference);
    const pir_allocator *a = &pairing->allocator;
    pir_query *query = PIR_ZEROED(a, pir_query, 1);
    if (!query)
        return PIR_ERR_MEMORY;
    query->allocator = *a;
    // from here on destroy can take it apart
    query->sum = pir_sum_retain(difference);
    hold(&query->p, pairing->p);
    hold(&query->q, pairing->q);
    query->patches = pir_patch_room_new(a, query->p, query->q);
    bool done = query->patches && pir_frame_init(query) && pir_planes_init(query) && pir_bounds_init(query) &&
                pir_region_init(query);
    pir_status status = done ? fit(query) : PIR_ERR_MEMORY;
    if (status != PIR_OK) {
        pir_query_destroy(query);
        return status;
    }
    *ret_query = query;
    return PIR_OK;
}

/* Brings the query to what the sum is now. */
static pir_status follow(pir_query *query) {
    const pir_sum *sum = query->sum;
    if (query->generation == pir_sum_generation(sum))
        return PIR_OK;
    pir_status status = PIR_OK;
    // the query's own references keep these addresses from being given to others
    if (query->p != pir_sum_p(sum) || query->q != pir_sum_q(sum) || !query->fits)
        status = fit(query);
    if (status == PIR_OK) {
        pir_frame_follow(query);
        status = pir_planes_reserve(query);
    }
    query->generation = status == PIR_OK ? pir_sum_generation(sum) : 0;
    return status;
}

pir_status pir_query_place(pir_query *query, const pir_query_input *input, pir_placement *ret_placement) {
    if (!query || !input)
        return PIR_ERR_ARGUMENT;
    if (isnan(input->radius_p) || isnan(input->radius_q) || isnan(input->cutoff))
        return PIR_ERR_NOT_FINITE;
    if (!(input->radius_p >= 0 && input->radius_p < HUGE_VAL && input->radius_q >= 0 && input->radius_q < HUGE_VAL))
        return PIR_ERR_ARGUMENT;
    pir_status status = follow(query);
    return status == PIR_OK ? pir_frame_place(query, input->translation, ret_placement) : status;
}

pir_status pir_query_begin(pir_query *query, const pir_query_input *input, pir_placement *ret_placement) {
    if (query && pir_sum_cone(query->sum)->set)
        return PIR_ERR_UNSUPPORTED;
    return pir_query_place(query, input, ret_placement);
}
