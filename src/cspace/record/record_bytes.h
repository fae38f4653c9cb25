/* SPDX-License-Identifier: MIT */
/*
 * A block of bytes that grows at its end, and unsigned numbers in it: 7 bits a byte, least significant first, 128 added
 * to all but the last byte.
 */
#ifndef PIR_CSPACE_RECORD_RECORD_BYTES_H
#define PIR_CSPACE_RECORD_RECORD_BYTES_H

#include "base/memory.h"

/* The most bytes that a number takes. */
#define PIR_NUMBER_BYTES 10

typedef struct pir_bytes {
    uint8_t *data;
    size_t used, room;
} pir_bytes;

/* Room for `more` bytes behind those in use. False when out of memory; nothing changes then. */
bool pir_bytes_reserve(pir_bytes *bytes, const pir_allocator *allocator, size_t more);
void pir_bytes_finish(pir_bytes *bytes, const pir_allocator *allocator);

/* Appends, where there is room for PIR_NUMBER_BYTES. */
static inline void pir_bytes_put(pir_bytes *bytes, uint64_t number) {
    for (; number >= 128; number >>= 7)
        bytes->data[bytes->used++] = (uint8_t)(number & 127) | 128;
    bytes->data[bytes->used++] = (uint8_t)number;
}

/* Bytes that are read; `broken` once a number did not end in them, or was greater than asked for. */
typedef struct pir_scan {
    const uint8_t *at, *end;
    bool broken;
} pir_scan;

/* The next number where it is at most `most`; else 0, and the scan is broken. */
static inline uint64_t pir_scan_number(pir_scan *scan, uint64_t most) {
    uint64_t number = 0;
    for (unsigned shift = 0; scan->at < scan->end && shift < 63; shift += 7) {
        uint8_t byte = *scan->at++;
        number |= (uint64_t)(byte & 127) << shift;
        if (byte < 128) {
            scan->broken |= number > most;
            return number > most ? 0 : number;
        }
    }
    scan->broken = true;
    return 0;
}

/* What a record begins with. */
enum { PIR_RECORD_CHANGES = 0, PIR_RECORD_WHOLE = 1 };

/* FNV-1a over more bytes; begin with PIR_HASH_START. */
#define PIR_HASH_START UINT64_C(0xcbf29ce484222325)

uint64_t pir_hash_bytes(uint64_t hash, const void *data, size_t size);

#endif
