/* SPDX-License-Identifier: MIT */
/*
 * The text of the kernels' descent, the same for every version. DESCEND_TARGET says for which processor. The file that
 * includes this defines
 *
 *     turn_facet(facets, f, turned)                      the normal of facet f rotated, 0, and its motion, 0
 *     compare(ring, blocks, turned, s)                   whether some s over a ring is at least −PIR_FLOAT_BOUND; `s`
 *                                                        are those of the last block
 *     steepest(ring, blocks, turned, s, ret_which)       the greatest s over that ring, and the first direction of it
 *
 * Facets are taken by chunks. All of a chunk are compared where they are before those that rise take their next step,
 * without branches that depend on what is found: so a processor can fetch many rings at a time.
 */

#define DESCEND_CHUNK 32

/* Returns how many facets are listed in ret_open. */
DESCEND_TARGET static inline uint32_t descend_chunk(const pir_facets *facets, const uint32_t *facet,
                                                    const uint32_t *from, uint32_t count, uint32_t *ret_open,
                                                    uint64_t *sides) {
    float turned[DESCEND_CHUNK][8], s[DESCEND_CHUNK][PIR_LANES];
    uint32_t at[DESCEND_CHUNK], moving[DESCEND_CHUNK], left = count, open = 0;
    uint64_t compared = 0;
    for (uint32_t k = 0; k < count; k++) {
        turn_facet(facets, facet[k], turned[k]);
        at[k] = from[k];
        moving[k] = k;
    }
    // each step rises for certain, so the descent ends
    while (left > 0) {
        uint32_t past = 0;
        for (uint32_t i = 0; i < left; i++) {
            uint32_t k = moving[i], v = at[k], block = facets->ring_block[v];
            compared += facets->ring_start[v + 1] - facets->ring_start[v];
            __builtin_prefetch(facets->target + facets->ring_start[v]);
            moving[past] = k;
            past += compare(facets->ring + (size_t)block * 3 * PIR_LANES, facets->ring_block[v + 1] - block, turned[k],
                            s[k]);
        }
        left = 0;
        for (uint32_t i = 0; i < past; i++) {
            uint32_t k = moving[i], v = at[k], block = facets->ring_block[v], which = 0;
            bool rises = steepest(facets->ring + (size_t)block * 3 * PIR_LANES, facets->ring_block[v + 1] - block,
                                  turned[k], s[k], &which) > PIR_FLOAT_BOUND;
            uint32_t next = facets->target[facets->ring_start[v] + which];
            at[k] = rises ? next : v;
            ret_open[open] = facet[k];
            open += !rises;
            moving[left] = k;
            left += rises;
        }
    }
    for (uint32_t k = 0; k < count; k++)
        facets->cell[facet[k]] = at[k];
    *sides += compared;
    return open;
}

DESCEND_TARGET static uint32_t descend(const pir_facets *facets, const uint32_t *facet, const uint32_t *from,
                                       uint32_t count, uint32_t *ret_open, uint64_t *sides) {
    uint32_t open = 0;
    for (uint32_t k = 0; k < count; k += DESCEND_CHUNK) {
        uint32_t n = count - k < DESCEND_CHUNK ? count - k : DESCEND_CHUNK;
        open += descend_chunk(facets, facet + k, from + k, n, ret_open + open, sides);
    }
    return open;
}

#undef DESCEND_CHUNK
