/* SPDX-License-Identifier: MIT */
/* A block of bytes that grows at its end, and the hash of bytes. */
#ifndef PIR_BASE_BYTE_BLOCK_H
#define PIR_BASE_BYTE_BLOCK_H

#include "base/memory.h"

typedef struct pir_bytes {
    uint8_t *data;
    size_t used, room;
} pir_bytes;

/* Room for `more` bytes behind those in use. False when out of memory; nothing changes then. */
bool pir_bytes_reserve(pir_bytes *bytes, const pir_allocator *allocator, size_t more);
void pir_bytes_finish(pir_bytes *bytes, const pir_allocator *allocator);

/* FNV-1a over more bytes; begin with PIR_HASH_START. */
#define PIR_HASH_START UINT64_C(0xcbf29ce484222325)

uint64_t pir_hash_bytes(uint64_t hash, const void *data, size_t size);

/* Hashes numbers of eight bytes, the least significant first; zeros fill the last one up. */
uint64_t pir_hash_words(uint64_t hash, const void *data, size_t size);

#endif
