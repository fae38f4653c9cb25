/* SPDX-License-Identifier: MIT */
/*
 * The text of the kernels' descent, the same for every version. DESCEND_TARGET says for which processor. The file that
 * includes this defines
 *
 *     turn_facet(facets, f, turned)                 the normal of facet f rotated, 0, and its motion, 0
 *     steepest(ring, blocks, turned, ret_which)     the greatest s over a ring, and the first direction of it
 *
 * All facets are compared where they are before those that rise take their next step, without branches that depend on
 * what is found: so a processor can fetch many rings at a time.
 */

/* With so many facets, what is compared is not in a cache near the processor. */
#define DESCENT_FETCHES 4096

/* Fetches the rings of these cells. */
DESCEND_TARGET PIR_FETCHING void fetch_cells(const pir_facets *facets, const uint32_t *at, uint64_t which) {
    for (; which; which &= which - 1) {
        uint32_t v = at[__builtin_ctzll(which)];
        const pir_ring *ring = facets->ring + facets->ring_block[v];
        PIR_FETCH(ring->x);
        PIR_FETCH(ring->z);
    }
}

DESCEND_TARGET static inline __attribute__((always_inline)) uint32_t
descend_all(const pir_facets *facets, const uint32_t *facet, const uint32_t *from, uint32_t count, bool fetches,
            uint32_t *ret_open, uint64_t *sides) {
    float turned[PIR_DESCENT_MOST][8];
    uint32_t at[PIR_DESCENT_MOST], open = 0;
    uint64_t unsure = 0, compared = 0;
    for (uint32_t k = 0; k < count; k++) {
        turn_facet(facets, facet[k], turned[k]);
        at[k] = from[k];
    }
    // each step rises for certain, so the descent ends
    for (uint64_t moving = UINT64_MAX >> (PIR_DESCENT_MOST - count), rising; moving; moving = rising) {
        rising = 0;
        if (fetches)
            fetch_cells(facets, at, moving);
        for (; moving; moving &= moving - 1) {
            uint32_t k = (uint32_t)__builtin_ctzll(moving), v = at[k], which = 0;
            uint32_t block = facets->ring_block[v], start = facets->ring_start[v];
            float highest = steepest(facets->ring + block, facets->ring_block[v + 1] - block, turned[k], &which);
            uint64_t rises = highest > PIR_FLOAT_BOUND;
            uint32_t next = fetches ? facets->ring[block + which / PIR_LANES].target[which % PIR_LANES]
                                    : facets->target[start + which];
            compared += facets->ring_start[v + 1] - start;
            // by masks: neither is foreseen
            at[k] = v ^ ((v ^ next) & -(uint32_t)rises);
            rising |= rises << k;
            unsure |= ((uint64_t)(highest >= -PIR_FLOAT_BOUND) ^ rises) << k;
        }
    }
    for (uint32_t k = 0; k < count; k++)
        facets->cell[facet[k]] = at[k];
    for (; unsure; unsure &= unsure - 1)
        ret_open[open++] = facet[(uint32_t)__builtin_ctzll(unsure)];
    *sides += compared;
    return open;
}

DESCEND_TARGET static uint32_t descend(const pir_facets *facets, const uint32_t *facet, const uint32_t *from,
                                       uint32_t count, uint32_t *ret_open, uint64_t *sides) {
    return facets->count >= DESCENT_FETCHES ? descend_all(facets, facet, from, count, true, ret_open, sides)
                                            : descend_all(facets, facet, from, count, false, ret_open, sides);
}

#undef DESCENT_FETCHES
