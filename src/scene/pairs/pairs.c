/* SPDX-License-Identifier: MIT */
/* Pairs of pieces: see pairs.h. */
#include "scene/pairs/pairs.h"

void pir_scene_pairs_init(pir_scene_pairs *pairs) {
    *pairs = (pir_scene_pairs){.unused = PIR_END_NONE};
}

void pir_scene_pairs_finish(pir_scene_pairs *pairs, const pir_allocator *allocator) {
    for (uint32_t i = 0; i < pairs->capacity; i++) {
        pir_pair_destroy(pairs->at[i].asked);
        pir_scene_pairs_forget(pairs, i);
    }
    pir_kept_pool_finish(&pairs->kept, allocator);
    for (uint32_t i = 0; i < pairs->pooled; i++)
        pir_pair_destroy(pairs->pool[i]);
    PIR_FREE(allocator, pairs->at, pairs->capacity);
    PIR_FREE(allocator, pairs->pool, pairs->capacity);
}

/* Room for more pairs, and in the pool for all of them. */
static bool grow(pir_scene_pairs *pairs, const pir_allocator *allocator) {
    uint32_t old = pairs->capacity, capacity = old > 0 ? old + old / 2 : 64;
    if (capacity > UINT32_MAX / 4)
        return false;
    pir_scene_pair *at = PIR_NEW(allocator, pir_scene_pair, capacity);
    pir_pair **pool = PIR_NEW(allocator, pir_pair *, capacity);
    if (!at || !pool) {
        PIR_FREE(allocator, at, capacity);
        PIR_FREE(allocator, pool, capacity);
        return false;
    }
    for (uint32_t i = 0; i < old; i++)
        at[i] = pairs->at[i];
    for (uint32_t i = 0; i < pairs->pooled; i++)
        pool[i] = pairs->pool[i];
    PIR_FREE(allocator, pairs->at, old);
    PIR_FREE(allocator, pairs->pool, old);
    pairs->at = at;
    pairs->pool = pool;
    pairs->capacity = capacity;
    for (uint32_t i = capacity; i-- > old;) {
        at[i] = (pir_scene_pair){.next = {pairs->unused}};
        pairs->unused = i;
    }
    return true;
}

/* Puts an end at the head of a list. */
static void link_end(pir_scene_pairs *pairs, uint32_t pair, uint32_t side, uint32_t *first) {
    pairs->at[pair].next[side] = *first;
    pairs->at[pair].previous[side] = PIR_END_NONE;
    if (*first != PIR_END_NONE)
        pairs->at[*first / 2].previous[*first % 2] = 2 * pair + side;
    *first = 2 * pair + side;
}

static void unlink_end(pir_scene_pairs *pairs, uint32_t pair, uint32_t side, uint32_t *first) {
    uint32_t next = pairs->at[pair].next[side], previous = pairs->at[pair].previous[side];
    if (next != PIR_END_NONE)
        pairs->at[next / 2].previous[next % 2] = previous;
    if (previous != PIR_END_NONE)
        pairs->at[previous / 2].next[previous % 2] = next;
    else
        *first = next;
}

uint32_t pir_scene_pairs_add(pir_scene_pairs *pairs, const pir_allocator *allocator, const uint32_t piece[2],
                             uint32_t *first_p, uint32_t *first_q) {
    if (pairs->unused == PIR_END_NONE && !grow(pairs, allocator))
        return PIR_END_NONE;
    uint32_t pair = pairs->unused;
    pairs->unused = pairs->at[pair].next[0];
    pairs->at[pair] = (pir_scene_pair){.piece = {piece[0], piece[1]}};
    pairs->count++;
    link_end(pairs, pair, 0, first_p);
    link_end(pairs, pair, 1, first_q);
    return pair;
}

void pir_scene_pairs_forget(pir_scene_pairs *pairs, uint32_t pair) {
    pir_kept_pool_give(&pairs->kept, pairs->at[pair].kept);
    pir_kept_pool_give(&pairs->kept, pairs->at[pair].united);
    pairs->at[pair].kept = pairs->at[pair].united = NULL;
}

void pir_scene_pairs_drop(pir_scene_pairs *pairs, uint32_t pair, uint32_t *first_p, uint32_t *first_q) {
    unlink_end(pairs, pair, 0, first_p);
    unlink_end(pairs, pair, 1, first_q);
    pir_scene_pairs_forget(pairs, pair);
    if (pairs->at[pair].asked)
        pairs->pool[pairs->pooled++] = pairs->at[pair].asked;
    pairs->at[pair] = (pir_scene_pair){.next = {pairs->unused}};
    pairs->unused = pair;
    pairs->count--;
}

static pir_status make(const pir_allocator *allocator, pir_polytope *p, pir_polytope *q, pir_pair **ret_pair) {
    pir_pair_options options = pir_pair_options_default();
    options.allocator = allocator;
    return pir_pair_create(p, q, &options, ret_pair);
}

pir_status pir_scene_pairs_ready(pir_scene_pairs *pairs, const pir_allocator *allocator, uint32_t pair, pir_polytope *p,
                                 pir_polytope *q) {
    pir_scene_pair *at = &pairs->at[pair];
    if (at->asked)
        return PIR_OK;
    if (pairs->pooled == 0)
        return make(allocator, p, q, &at->asked);
    pir_status status = pir_pair_reset(pairs->pool[pairs->pooled - 1], p, q);
    if (status == PIR_OK)
        at->asked = pairs->pool[--pairs->pooled];
    return status;
}
