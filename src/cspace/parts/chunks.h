/* SPDX-License-Identifier: MIT */
/* The chunks that packed bytes are made of; see pack.h. */
#ifndef PIR_CSPACE_PARTS_CHUNKS_H
#define PIR_CSPACE_PARTS_CHUNKS_H

#include "cspace/parts/unit.h"

/* The most bytes of a chunk. */
#define PIR_CHUNK_MOST (1u << 16)

/* Elements of each section in a chunk: what a reader of one slice has to unpack. */
static const uint32_t pir_chunk_elements[PIR_UNIT_SECTION_COUNT] = {1u << 13, 1u << 11, 1u << 11};

/* Added to the size of a chunk that is stored. */
#define PIR_CHUNK_STORED (UINT32_C(1) << 31)

/* A chunk, as a data set holds it. */
typedef struct pir_chunk {
    const uint8_t *data;
    uint32_t size;
    bool stored; /* not deflated, which would have made it longer; shuffled all the same */
} pir_chunk;

/* The chunks of so many elements of a unit. */
static inline uint64_t pir_chunks_of(int section, uint64_t elements) {
    return (elements + pir_chunk_elements[section] - 1) / pir_chunk_elements[section];
}

/* The chunk at `*at`, which moves on to the next. False at the end, and where what stands there is no chunk. */
bool pir_next_chunk(const pir_bytes *packed, size_t *at, pir_chunk *ret_chunk);

/* Whether packed bytes are the chunks of so many elements. */
bool pir_packed_holds(const pir_bytes *packed, pir_unit_section section, uint64_t elements);

#endif
