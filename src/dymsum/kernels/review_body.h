/* SPDX-License-Identifier: MIT */
/*
 * The text of the kernels' review, the same for every version. REVIEW_TARGET says for which processor. The file that
 * includes this defines
 *
 *     turn_facet(facets, f, turned)                      the normal of facet f rotated, 0, and its motion, 0
 *     check_in(ring, blocks, step, turned, ret_check)    the check of it in a cell of that ring
 *
 * Facets are taken by chunks, and a chunk in three passes without branches that depend on what is found: checking all;
 * certifying those that have stayed; checking the others in the cell that each may have crossed into. So a processor
 * can have many checks under way at a time.
 */

#define REVIEW_CHUNK 64

/*
 * With so many facets, what is checked is not in a cache near the processor. It is fetched ahead: facets by two chunks,
 * their cells by one, each between two checks. A processor that is to fetch many lines at once does nothing else
 * meanwhile.
 */
#define REVIEW_FETCHES 16384

/* Fetches the ring of a cell. */
REVIEW_TARGET PIR_FETCHING void fetch_ring(const pir_facets *facets, uint32_t cell) {
    const pir_ring *ring = pir_ring_of(facets, cell);
    PIR_FETCH(ring->x);
    PIR_FETCH(ring->z);
    PIR_FETCH(facets->ring_start + cell);
}

/* Fetches what a facet is turned by, where it is, and what its certificate is filed in. */
REVIEW_TARGET PIR_FETCHING void fetch_facet(const pir_facets *facets, const pir_certificates *certificates,
                                            uint32_t i) {
    uint32_t f = i - facets->first_certificate;
    PIR_FETCH(facets->cell + f);
    PIR_FETCH(facets->normal + (size_t)4 * f);
    PIR_FETCH(certificates->at + i);
    PIR_FETCH(certificates->margin + i);
    PIR_FETCH(certificates->previous + i);
}

/* Fetches what it is compared with. */
REVIEW_TARGET PIR_FETCHING void fetch_cell(const pir_facets *facets, uint32_t i) {
    uint32_t cell = facets->cell[i - facets->first_certificate];
    fetch_ring(facets, cell);
}

/* The ring of a cell. Where there is no fetching, what it takes to know of single blocks is not worth it. */
REVIEW_TARGET static inline const pir_ring *ring_of(const pir_facets *facets, uint32_t cell, bool fetches,
                                                    uint32_t *ret_blocks) {
    if (fetches)
        return pir_rings_of(facets, cell, ret_blocks);
    uint32_t block = facets->ring_block[cell];
    *ret_blocks = facets->ring_block[cell + 1] - block;
    return facets->ring + block;
}

/* The one side of its cell that facet f has touched and is past, as a halfedge; or PIR_NO_SIDE. */
REVIEW_TARGET static inline uint32_t side_crossed(const pir_facets *facets, uint32_t f, const pir_check *check) {
    uint32_t cell = facets->cell[f], start = facets->ring_start[cell], sides = facets->ring_start[cell + 1] - start;
    uint64_t mask = pir_side_mask(sides), touched = check->touched & mask;
    bool one = (sides <= PIR_SIDE_BITS) & ((touched & (touched - 1)) == 0) & ((check->above & touched) != 0);
    return one ? start + (uint32_t)__builtin_ctzll(touched | (uint64_t)1 << 63) : PIR_NO_SIDE;
}

/* The cell beyond side `half` of one. Where there is fetching, the ring is what has been fetched. */
REVIEW_TARGET static inline uint32_t cell_beyond(const pir_facets *facets, uint32_t cell, uint32_t half, bool fetches) {
    uint32_t side = half - facets->ring_start[cell];
    return fetches ? pir_ring_of(facets, cell)[side / PIR_LANES].target[side % PIR_LANES] : facets->target[half];
}

/* The side of the cell beyond, of so many sides, that leads back. */
REVIEW_TARGET static inline uint32_t side_back(const pir_facets *facets, uint32_t cell, uint32_t half, uint32_t next,
                                               uint32_t sides, bool fetches) {
    uint32_t start = facets->ring_start[next], i = 0;
    // a segment has two edges between its corners
    if (!fetches || sides <= 2 || sides > PIR_LANES)
        return facets->twin[half] - start;
    const pir_ring *ring = pir_ring_of(facets, next);
    while (ring->target[i] != cell)
        i++;
    return i;
}

/*
 * Whether a facet that is past side `half` is in the next cell, having touched no side of it but the same one. Then it
 * is certified there.
 */
REVIEW_TARGET static inline bool settle_across(const pir_facets *facets, const pir_step *step,
                                               pir_certificates *certificates, uint32_t f, uint32_t half,
                                               const float turned[8], bool fetches) {
    uint32_t cell = facets->cell[f], next = cell_beyond(facets, cell, half, fetches);
    uint32_t start = facets->ring_start[next], sides = facets->ring_start[next + 1] - start;
    pir_check there;
    uint32_t blocks;
    const pir_ring *ring = ring_of(facets, next, fetches, &blocks);
    check_in(ring, blocks, step, turned, &there);
    uint32_t by = side_back(facets, cell, half, next, sides, fetches);
    uint64_t mask = pir_side_mask(sides);
    if (sides > PIR_SIDE_BITS || (there.touched & mask) != (uint64_t)1 << by % PIR_SIDE_BITS ||
        (there.above & mask) != 0)
        return false;
    facets->cell[f] = next;
    pir_certificate_keep_previous(certificates, facets->first_certificate + f, start + by);
    pir_certificate_file_check(facets, step, certificates, f, &there);
    return true;
}

/* Reviews a chunk, `count` facets. As many as are behind them in the list are fetched for. */
REVIEW_TARGET static inline __attribute__((always_inline)) uint32_t
review_chunk(const pir_facets *facets, const pir_step *step, pir_certificates *certificates, pir_due due,
             pir_suspect *ret_suspects, uint64_t *sides, const bool fetches) {
    const uint32_t *expired = due.expired;
    const uint32_t count = due.count, end = count + due.behind;
    pir_check check[REVIEW_CHUNK];
    float turned[REVIEW_CHUNK][8];
    uint8_t moved[REVIEW_CHUNK], crossing[REVIEW_CHUNK];
    uint32_t moved_count = 0, crossing_count = 0;
    uint64_t checked_sides = 0, not_calm = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t f = expired[k] - facets->first_certificate, cell = facets->cell[f];
        checked_sides += facets->ring_start[cell + 1] - facets->ring_start[cell];
        if (fetches) {
            if (k + 2 * REVIEW_CHUNK < end)
                fetch_facet(facets, certificates, expired[k + 2 * REVIEW_CHUNK]);
            if (k + REVIEW_CHUNK < end)
                fetch_cell(facets, expired[k + REVIEW_CHUNK]);
        }
        turn_facet(facets, f, turned[k]);
        uint32_t blocks;
        const pir_ring *ring = ring_of(facets, cell, fetches, &blocks);
        check_in(ring, blocks, step, turned[k], &check[k]);
        not_calm |= (uint64_t)((check[k].touched | check[k].above) != 0) << k;
    }
    for (uint64_t calm = ~not_calm & pir_side_mask(count); calm; calm &= calm - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(calm);
        pir_certificate_file_check(facets, step, certificates, expired[k] - facets->first_certificate, &check[k]);
    }
    for (; not_calm; not_calm &= not_calm - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(not_calm), f = expired[k] - facets->first_certificate;
        uint32_t half = side_crossed(facets, f, &check[k]);
        ret_suspects[moved_count] = (pir_suspect){f, half};
        crossing[crossing_count] = (uint8_t)moved_count;
        crossing_count += half != PIR_NO_SIDE;
        moved[moved_count++] = (uint8_t)k;
    }
    for (uint32_t i = 0; i < crossing_count && fetches; i++) {
        const pir_suspect *suspect = &ret_suspects[crossing[i]];
        fetch_ring(facets, cell_beyond(facets, facets->cell[suspect->facet], suspect->crossed, true));
    }
    for (uint32_t i = 0; i < crossing_count; i++) {
        pir_suspect *suspect = &ret_suspects[crossing[i]];
        if (!settle_across(facets, step, certificates, suspect->facet, suspect->crossed, turned[moved[crossing[i]]],
                           fetches))
            suspect->crossed = PIR_NO_SIDE;
    }
    *sides += checked_sides;
    return moved_count;
}

REVIEW_TARGET static uint32_t review(const pir_facets *facets, const pir_step *step, pir_certificates *certificates,
                                     const pir_due *due, pir_suspect *ret_suspects, uint64_t *sides) {
    uint32_t suspects = 0;
    const bool fetches = facets->count >= REVIEW_FETCHES;
    const uint32_t end = due->count + due->behind;
    for (uint32_t k = 0; fetches && !due->begun && k < end && k < 2 * REVIEW_CHUNK; k++)
        fetch_facet(facets, certificates, due->expired[k]);
    for (uint32_t k = 0; fetches && !due->begun && k < end && k < REVIEW_CHUNK; k++)
        fetch_cell(facets, due->expired[k]);
    for (uint32_t k = 0; k < due->count; k += REVIEW_CHUNK) {
        const uint32_t count = due->count - k < REVIEW_CHUNK ? due->count - k : REVIEW_CHUNK;
        const pir_due chunk = {due->expired + k, count, end - k - count, true};
        pir_suspect *to = ret_suspects + suspects;
        suspects += fetches ? review_chunk(facets, step, certificates, chunk, to, sides, true)
                            : review_chunk(facets, step, certificates, chunk, to, sides, false);
    }
    return suspects;
}

#undef REVIEW_FETCHES
#undef REVIEW_CHUNK
