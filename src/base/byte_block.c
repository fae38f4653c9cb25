/* SPDX-License-Identifier: MIT */
/* A block of bytes that grows by doubling, and the hash of bytes. */
#include "base/byte_block.h"

/* Of FNV-1a. */
#define PRIME UINT64_C(0x100000001b3)

bool pir_bytes_reserve(pir_bytes *bytes, const pir_allocator *a, size_t more) {
    if (more <= bytes->room - bytes->used)
        return true;
    size_t room = bytes->room ? 2 * bytes->room : 256;
    if (room - bytes->used < more)
        room = bytes->used + more;
    uint8_t *grown = PIR_RESIZE(a, bytes->data, bytes->room, room);
    if (!grown)
        return false;
    bytes->data = grown;
    bytes->room = room;
    return true;
}

void pir_bytes_finish(pir_bytes *bytes, const pir_allocator *a) {
    PIR_FREE(a, bytes->data, bytes->room);
    *bytes = (pir_bytes){0};
}

/* So many bytes as a number, the least significant first. */
static inline uint64_t word_at(const uint8_t *at, size_t size) {
    uint64_t word = 0;
    for (size_t k = 0; k < size; k++)
        word |= (uint64_t)at[k] << 8 * k;
    return word;
}

uint64_t pir_hash_words(uint64_t hash, const void *data, size_t size) {
    const uint8_t *at = data;
    size_t i = 0;
    for (; i + 8 <= size; i += 8)
        hash = (hash ^ word_at(at + i, 8)) * PRIME;
    return i < size ? (hash ^ word_at(at + i, size - i)) * PRIME : hash;
}

uint64_t pir_hash_bytes(uint64_t hash, const void *data, size_t size) {
    const uint8_t *at = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ at[i]) * PRIME;
    return hash;
}
