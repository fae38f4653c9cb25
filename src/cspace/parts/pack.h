/* SPDX-License-Identifier: MIT */
/*
 * Units as HDF5 keeps them. The elements of a section stand in chunks of fixed size, which HDF5 would shuffle and
 * deflate one by one as they are written, one thread at a time. Who makes a unit packs it instead: each unit begins a
 * chunk, so that its chunks are its own, and what is left to do for the file is to copy them.
 *
 * The last chunk of a unit is filled up with zeros. Packed bytes are chunk after chunk, each behind its size.
 */
#ifndef PIR_CSPACE_PARTS_PACK_H
#define PIR_CSPACE_PARTS_PACK_H

#include "cspace/parts/chunks.h"

/* How well deflate tries. Fast, and nearly as small as more: records are dense. */
#define PIR_DEFLATE_LEVEL 1

/* The form of chunks: their bytes, at most PIR_CHUNK_MOST, and those of a number in them; 1 where none is shuffled. */
typedef struct pir_chunk_form {
    uint32_t size, element;
    bool again; /* longer stretches come again in them, so that it is worth looking for these */
} pir_chunk_form;

/* Deflate looks for runs of a byte alone, or for longer stretches that come again. */
enum { PIR_PACK_RUNS, PIR_PACK_MATCHES, PIR_PACK_WAYS };

/* Memory to pack in, about 1 MB. A build without HDF5 packs nothing, and makes no compressors. */
typedef struct pir_packer {
    pir_allocator allocator;
    struct libdeflate_compressor *compressor[PIR_PACK_WAYS];
    uint8_t filled[PIR_CHUNK_MOST], shuffled[PIR_CHUNK_MOST], deflated[PIR_CHUNK_MOST];
} pir_packer;

/* NULL when out of memory. */
pir_packer *pir_packer_new(const pir_allocator *allocator);
/* NULL is accepted. */
void pir_packer_free(pir_packer *packer);

/* A chunk of data that fill it up to `used` bytes. It holds until the next call. */
pir_chunk pir_pack_chunk(pir_packer *packer, const pir_chunk_form *form, const void *data, uint32_t used);

/* Packs the sections of a unit. False when out of memory. */
bool pir_unit_pack(pir_unit *unit, pir_packer *packer, const pir_allocator *allocator);

#endif
