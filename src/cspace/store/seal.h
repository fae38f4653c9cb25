/* SPDX-License-Identifier: MIT */
/*
 * The seal of a file of slices: hashes of all its bytes, which stand behind them. HDF5 trusts what it reads, and some
 * files that were damaged crash it; so it is given no byte that has not been checked.
 *
 * The sealed bytes are divided into blocks of PIR_SEAL_BLOCK bytes, the last one shorter. Behind it stand
 *
 *     the hashes of the blocks, 16 bytes each;
 *     the hashes of these, taken in blocks of the same size;
 *     64 bytes: magic, the size of what is sealed (eight bytes, least significant first), 16 zeros, the hash of the
 *     hashes of hashes, the hash of the 48 bytes before.
 *
 * Hashes are XXH3, 128 bits, in canonical order. To open a file takes its last 64 bytes and 16 of each 16 MiB; a block
 * is read and checked when one of its bytes is asked for.
 */
#ifndef PIR_CSPACE_STORE_SEAL_H
#define PIR_CSPACE_STORE_SEAL_H

#include <pirouette/base.h>

#include "base/memory.h"

#define PIR_SEAL_BLOCK ((size_t)1 << 14)
#define PIR_SEAL_HASH  16

/* Blocks that are kept, by their number modulo this. */
#define PIR_SEAL_KEPT 4

/* A block that has been checked. */
typedef struct pir_sealed_block {
    uint64_t number; /* or UINT64_MAX */
    uint8_t bytes[PIR_SEAL_BLOCK];
} pir_sealed_block;

/* A sealed file that is read. */
typedef struct pir_sealed {
    pir_allocator allocator;
    int descriptor;         /* or -1 */
    uint64_t size;          /* of what is sealed */
    uint8_t *upper;         /* the hashes of hashes */
    size_t upper_size;      /* in bytes */
    pir_sealed_block *kept; /* PIR_SEAL_KEPT of them, and behind these one of hashes */
    uint64_t damaged;       /* 1 + the number of the block that was found to be so; 0: none */
    int error;              /* of the system, where it could not read */
} pir_sealed;

/*
 * Opens a file and checks its seal. pir_sealed_close releases whatever is there, whatever the outcome. Errors:
 * PIR_ERR_FILE, PIR_ERR_FORMAT (no HDF5, no seal), PIR_ERR_MEMORY.
 */
pir_status pir_sealed_open(pir_sealed *sealed, const char *path, const pir_allocator *allocator, pir_report *report);
void pir_sealed_close(pir_sealed *sealed);

/* Reads bytes that are as they were when they were sealed; zeros beyond the end. False: `damaged` or `error` is set. */
bool pir_sealed_read(pir_sealed *sealed, uint64_t at, size_t size, uint8_t *data);

/* Tells what pir_sealed_read met, and returns its status; PIR_OK where it met nothing. */
pir_status pir_sealed_tell(const pir_sealed *sealed, const char *path, pir_report *report);

/* Seals the file, in place of its seal where it has one. PIR_ERR_FILE, PIR_ERR_MEMORY. */
pir_status pir_seal(const char *path, const pir_allocator *allocator, pir_report *report);

/* At most what a seal takes, of so many bytes. */
static inline uint64_t pir_seal_size(uint64_t size) {
    return size / (PIR_SEAL_BLOCK / PIR_SEAL_HASH) * 2 + 256;
}

#endif
