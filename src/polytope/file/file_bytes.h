/* SPDX-License-Identifier: MIT */
/* A whole file in memory. */
#ifndef PIR_POLYTOPE_FILE_FILE_BYTES_H
#define PIR_POLYTOPE_FILE_FILE_BYTES_H

#include <stddef.h>

#include <pirouette/base.h>

struct pir_read_bytes {
    char *data;
    size_t size, capacity;
};

/*
 * Reads what `path` names, of at most PIR_FILE_SIZE_MAX bytes, into `bytes`, which begins as zeros. The caller frees
 * `capacity` bytes of `data`, whatever the outcome. PIR_ERR_FILE, PIR_ERR_LIMIT, PIR_ERR_MEMORY.
 */
pir_status pir_file_read(const char *path, const pir_allocator *allocator, pir_report *report,
                         struct pir_read_bytes *bytes);

#endif
