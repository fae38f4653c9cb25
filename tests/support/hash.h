/* SPDX-License-Identifier: MIT */
/* The hash that tests compare long results by: FNV-1a of 64 bits. */
#ifndef PIR_TEST_HASH_H
#define PIR_TEST_HASH_H

#include <stddef.h>
#include <stdint.h>

#define TEST_HASH_START UINT64_C(0xcbf29ce484222325)

static inline uint64_t test_hash(uint64_t hash, const void *data, size_t size) {
    const uint8_t *byte = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ byte[i]) * 0x100000001b3u;
    return hash;
}

#endif
