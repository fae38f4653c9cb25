/* SPDX-License-Identifier: MIT */
/*
 * Units as HDF5 keeps them. The elements of a section stand in chunks of fixed size, which HDF5 would shuffle and
 * deflate one by one as they are written, one thread at a time. Who makes a unit packs it instead: each unit begins a
 * chunk, so that its chunks are its own, and what is left to do for the file is to copy them.
 *
 * The last chunk of a unit is filled up with zeros. Packed bytes are chunk after chunk, each behind its size.
 */
#ifndef PIR_CSPACE_STORE_PACK_H
#define PIR_CSPACE_STORE_PACK_H

#include "cspace/store/unit.h"

/* How well deflate tries. Fast, and nearly as small as more: records are dense. */
#define PIR_DEFLATE_LEVEL 1

/* Elements of each section in a chunk: what a reader of one slice has to unpack. */
static const uint32_t pir_chunk_elements[PIR_SECTION_COUNT] = {1u << 15, 1u << 11, 1u << 11};

/* Added to the size of a chunk that is stored. */
#define PIR_CHUNK_STORED (UINT32_C(1) << 31)

/* Packs the sections of a unit. False when out of memory. */
bool pir_unit_pack(pir_unit *unit, const pir_allocator *allocator);

/* A chunk, as a data set holds it. */
typedef struct pir_chunk {
    const uint8_t *data;
    uint32_t size;
    bool stored; /* not deflated, which would have made it longer; shuffled all the same */
} pir_chunk;

/* The chunk at `*at`, which moves on to the next. False at the end, and where what stands there is no chunk. */
bool pir_next_chunk(const pir_bytes *packed, size_t *at, pir_chunk *ret_chunk);

/* Whether packed bytes are the chunks of so many elements. */
bool pir_packed_holds(const pir_bytes *packed, pir_section section, uint64_t elements);

#endif
