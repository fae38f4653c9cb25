/* SPDX-License-Identifier: MIT */
/*
 * The text of the kernels' review, the same for every version; REVIEW_TARGET says for which processor. The file that includes this has
 *
 *     turn_facet(facets, f, turned)                               the normal of facet f turned, 0, and its motion, 0
 *     look_in(facets, moment, cell, turned, ret_look)             the look at it in a cell
 *
 * Facets are taken by chunks, and a chunk in three passes without branches that depend on what is seen: looking at all; filing
 * those that sleep on; looking at the others in the cell that each may have crossed into. So many looks are under way at a time.
 */

#define REVIEW_CHUNK 64

/* The one side of its cell that facet f has touched and is past, as a halfedge; or PIR_NO_SIDE. */
REVIEW_TARGET static inline uint32_t side_crossed(const pir_facets *facets, uint32_t f, const pir_look *look) {
    uint32_t cell = facets->cell[f], start = facets->ring_start[cell], sides = facets->ring_start[cell + 1] - start;
    uint64_t mask = pir_side_mask(sides), touched = look->touched & mask;
    bool one = (sides <= PIR_SIDE_BITS) & ((touched & (touched - 1)) == 0) & ((look->above & touched) != 0);
    return one ? start + (uint32_t)__builtin_ctzll(touched | (uint64_t)1 << 63) : PIR_NO_SIDE;
}

/* Whether a facet seen past side `half` is in the next cell, having touched no side of it but the same one; then it is filed there. */
REVIEW_TARGET static inline bool settle_across(const pir_facets *facets, const pir_moment *moment, pir_alarms *alarms,
                                               uint32_t f, uint32_t half, const float turned[8]) {
    uint32_t next = facets->target[half], start = facets->ring_start[next],
             sides = facets->ring_start[next + 1] - start;
    pir_look there;
    look_in(facets, moment, next, turned, &there);
    uint64_t mask = pir_side_mask(sides), back = (uint64_t)1 << (facets->twin[half] - start) % PIR_SIDE_BITS;
    if (sides > PIR_SIDE_BITS || (there.touched & mask) != back || (there.above & mask) != 0)
        return false;
    facets->cell[f] = next;
    pir_alarm_keep(alarms, facets->first_alarm + f, facets->twin[half]);
    pir_sleep_look(facets, moment, alarms, f, &there);
    return true;
}

REVIEW_TARGET static uint32_t review_chunk(const pir_facets *facets, const pir_moment *moment, pir_alarms *alarms,
                                           const uint32_t *woken, uint32_t count, pir_suspect *ret_suspects,
                                           uint64_t *sides) {
    pir_look look[REVIEW_CHUNK];
    float turned[REVIEW_CHUNK][8];
    uint8_t stirred[REVIEW_CHUNK], crossing[REVIEW_CHUNK];
    uint32_t stirred_count = 0, crossing_count = 0;
    uint64_t looked_at = 0, not_calm = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t f = woken[k] - facets->first_alarm, cell = facets->cell[f];
        looked_at += facets->ring_start[cell + 1] - facets->ring_start[cell];
        turn_facet(facets, f, turned[k]);
        look_in(facets, moment, cell, turned[k], &look[k]);
        not_calm |= (uint64_t)((look[k].touched | look[k].above) != 0) << k;
    }
    for (uint64_t left = ~not_calm & pir_side_mask(count); left; left &= left - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(left);
        pir_sleep_look(facets, moment, alarms, woken[k] - facets->first_alarm, &look[k]);
    }
    for (uint64_t left = not_calm; left; left &= left - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(left), f = woken[k] - facets->first_alarm;
        uint32_t half = side_crossed(facets, f, &look[k]);
        ret_suspects[stirred_count] = (pir_suspect){f, half};
        crossing[crossing_count] = (uint8_t)stirred_count;
        crossing_count += half != PIR_NO_SIDE;
        stirred[stirred_count++] = (uint8_t)k;
    }
    for (uint32_t i = 0; i < crossing_count; i++) {
        pir_suspect *suspect = &ret_suspects[crossing[i]];
        if (!settle_across(facets, moment, alarms, suspect->facet, suspect->crossed, turned[stirred[crossing[i]]]))
            suspect->crossed = PIR_NO_SIDE;
    }
    *sides += looked_at;
    return stirred_count;
}

REVIEW_TARGET static uint32_t review(const pir_facets *facets, const pir_moment *moment, pir_alarms *alarms,
                                     const uint32_t *woken, uint32_t count, pir_suspect *ret_suspects,
                                     uint64_t *sides) {
    uint32_t suspects = 0;
    for (uint32_t k = 0; k < count; k += REVIEW_CHUNK) {
        uint32_t n = count - k < REVIEW_CHUNK ? count - k : REVIEW_CHUNK;
        suspects += review_chunk(facets, moment, alarms, woken + k, n, ret_suspects + suspects, sides);
    }
    return suspects;
}

#undef REVIEW_CHUNK
