/* SPDX-License-Identifier: MIT */
/*
 * The text of the kernels' descent, the same for every version. DESCEND_TARGET says for which processor. The file that
 * includes this defines
 *
 *     turn_facet(facets, f, turned)                       the normal of facet f rotated, 0, and its motion, 0
 *     steepest(ring, blocks, turned, ret_which)           the greatest s over a ring, and the first direction with it;
 *                                                         or, where all are below −PIR_FLOAT_BOUND, a number below
 *                                                         that
 */

DESCEND_TARGET static bool descend(const pir_facets *facets, uint32_t f, uint32_t *cell, uint64_t *sides) {
    float turned[8];
    turn_facet(facets, f, turned);
    uint32_t at = *cell;
    uint64_t compared = 0;
    for (;;) {
        uint32_t block = facets->ring_block[at], start = facets->ring_start[at], which = 0;
        float highest =
            steepest(facets->ring + (size_t)block * 3 * PIR_LANES, facets->ring_block[at + 1] - block, turned, &which);
        compared += facets->ring_start[at + 1] - start;
        // each step rises for certain, so the descent ends
        if (!(highest > PIR_FLOAT_BOUND)) {
            *cell = at;
            *sides += compared;
            return highest < -PIR_FLOAT_BOUND;
        }
        at = facets->target[start + which];
    }
}
