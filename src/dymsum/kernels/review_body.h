/* SPDX-License-Identifier: MIT */
/*
 * The text of the kernels' review, the same for every version. REVIEW_TARGET says for which processor. The file that
 * includes this defines
 *
 *     turn_facet(facets, f, turned)                      the normal of facet f rotated, 0, and its motion, 0
 *     check_in(facets, step, cell, turned, ret_check)    the check of it in a cell
 *
 * Facets are taken by chunks, and a chunk in three passes without branches that depend on what is found: checking all;
 * certifying those that have stayed; checking the others in the cell that each may have crossed into. So a processor
 * can have many checks under way at a time.
 */

#define REVIEW_CHUNK 64

/* With so many facets, what is checked is not in a cache near the processor: it is fetched for a chunk at a time. */
#define REVIEW_FETCHES 16384

/* Fetches the ring of a cell. */
REVIEW_TARGET PIR_FETCHING void fetch_ring(const pir_facets *facets, uint32_t cell) {
    const float *ring = facets->ring + (size_t)facets->ring_block[cell] * 3 * PIR_LANES;
    __builtin_prefetch(ring);
    __builtin_prefetch(ring + 2 * PIR_LANES);
}

/* Fetches what facets are turned by, and what their certificates are filed in. */
REVIEW_TARGET PIR_FETCHING void fetch_facets(const pir_facets *facets, const pir_certificates *certificates,
                                             const uint32_t *expired, uint32_t count) {
    for (uint32_t k = 0; k < count; k++) {
        uint32_t i = expired[k], f = i - facets->first_certificate;
        __builtin_prefetch(facets->cell + f);
        __builtin_prefetch(facets->normal + (size_t)4 * f);
        __builtin_prefetch(certificates->at + i, 1);
        __builtin_prefetch(certificates->margin + i, 1);
        __builtin_prefetch(certificates->previous + i, 1);
    }
}

/* The one side of its cell that facet f has touched and is past, as a halfedge; or PIR_NO_SIDE. */
REVIEW_TARGET static inline uint32_t side_crossed(const pir_facets *facets, uint32_t f, const pir_check *check) {
    uint32_t cell = facets->cell[f], start = facets->ring_start[cell], sides = facets->ring_start[cell + 1] - start;
    uint64_t mask = pir_side_mask(sides), touched = check->touched & mask;
    bool one = (sides <= PIR_SIDE_BITS) & ((touched & (touched - 1)) == 0) & ((check->above & touched) != 0);
    return one ? start + (uint32_t)__builtin_ctzll(touched | (uint64_t)1 << 63) : PIR_NO_SIDE;
}

/*
 * Whether a facet that is past side `half` is in the next cell, having touched no side of it but the same one. Then it
 * is certified there.
 */
REVIEW_TARGET static inline bool settle_across(const pir_facets *facets, const pir_step *step,
                                               pir_certificates *certificates, uint32_t f, uint32_t half,
                                               const float turned[8]) {
    uint32_t next = facets->target[half], start = facets->ring_start[next],
             sides = facets->ring_start[next + 1] - start;
    pir_check there;
    check_in(facets, step, next, turned, &there);
    uint64_t mask = pir_side_mask(sides), back = (uint64_t)1 << (facets->twin[half] - start) % PIR_SIDE_BITS;
    if (sides > PIR_SIDE_BITS || (there.touched & mask) != back || (there.above & mask) != 0)
        return false;
    facets->cell[f] = next;
    pir_certificate_keep_previous(certificates, facets->first_certificate + f, facets->twin[half]);
    pir_certificate_file_check(facets, step, certificates, f, &there);
    return true;
}

REVIEW_TARGET static uint32_t review_chunk(const pir_facets *facets, const pir_step *step,
                                           pir_certificates *certificates, const uint32_t *expired, uint32_t count,
                                           pir_suspect *ret_suspects, uint64_t *sides) {
    pir_check check[REVIEW_CHUNK];
    float turned[REVIEW_CHUNK][8];
    uint8_t moved[REVIEW_CHUNK], crossing[REVIEW_CHUNK];
    uint32_t moved_count = 0, crossing_count = 0;
    uint64_t checked_sides = 0, not_calm = 0;
    const bool fetches = facets->count >= REVIEW_FETCHES;
    for (uint32_t k = 0; k < count && fetches; k++) {
        uint32_t cell = facets->cell[expired[k] - facets->first_certificate];
        fetch_ring(facets, cell);
        __builtin_prefetch(facets->target + facets->ring_start[cell]);
        __builtin_prefetch(facets->twin + facets->ring_start[cell]);
    }
    for (uint32_t k = 0; k < count; k++) {
        uint32_t f = expired[k] - facets->first_certificate, cell = facets->cell[f];
        checked_sides += facets->ring_start[cell + 1] - facets->ring_start[cell];
        turn_facet(facets, f, turned[k]);
        check_in(facets, step, cell, turned[k], &check[k]);
        not_calm |= (uint64_t)((check[k].touched | check[k].above) != 0) << k;
    }
    for (uint64_t left = ~not_calm & pir_side_mask(count); left; left &= left - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(left);
        pir_certificate_file_check(facets, step, certificates, expired[k] - facets->first_certificate, &check[k]);
    }
    for (uint64_t left = not_calm; left; left &= left - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(left), f = expired[k] - facets->first_certificate;
        uint32_t half = side_crossed(facets, f, &check[k]);
        ret_suspects[moved_count] = (pir_suspect){f, half};
        crossing[crossing_count] = (uint8_t)moved_count;
        crossing_count += half != PIR_NO_SIDE;
        moved[moved_count++] = (uint8_t)k;
    }
    for (uint32_t i = 0; i < crossing_count && fetches; i++)
        fetch_ring(facets, facets->target[ret_suspects[crossing[i]].crossed]);
    for (uint32_t i = 0; i < crossing_count; i++) {
        pir_suspect *suspect = &ret_suspects[crossing[i]];
        if (!settle_across(facets, step, certificates, suspect->facet, suspect->crossed, turned[moved[crossing[i]]]))
            suspect->crossed = PIR_NO_SIDE;
    }
    *sides += checked_sides;
    return moved_count;
}

REVIEW_TARGET static uint32_t review(const pir_facets *facets, const pir_step *step, pir_certificates *certificates,
                                     const uint32_t *expired, uint32_t count, pir_suspect *ret_suspects,
                                     uint64_t *sides) {
    uint32_t suspects = 0;
    for (uint32_t k = 0; k < count; k += REVIEW_CHUNK) {
        uint32_t n = count - k < REVIEW_CHUNK ? count - k : REVIEW_CHUNK, behind = count - k - n;
        if (facets->count >= REVIEW_FETCHES)
            fetch_facets(facets, certificates, expired + k + n, behind < REVIEW_CHUNK ? behind : REVIEW_CHUNK);
        suspects += review_chunk(facets, step, certificates, expired + k, n, ret_suspects + suspects, sides);
    }
    return suspects;
}

#undef REVIEW_FETCHES
#undef REVIEW_CHUNK
