/* SPDX-License-Identifier: MIT */
/* A block of bytes that grows by doubling, and the hash of bytes. */
#include "cspace/record/record_bytes.h"

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

uint64_t pir_hash_bytes(uint64_t hash, const void *data, size_t size) {
    const uint8_t *at = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ at[i]) * UINT64_C(0x100000001b3);
    return hash;
}
