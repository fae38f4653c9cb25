/* SPDX-License-Identifier: MIT */
/*
 * Bytes into a zlib stream (RFC 1950, 1951) with Huffman codes and runs of one byte alone. Records are dense: to look
 * for longer matches takes ten times as long and gains an eighth.
 */
#ifndef PIR_CSPACE_STORE_DEFLATE_H
#define PIR_CSPACE_STORE_DEFLATE_H

#include <stddef.h>
#include <stdint.h>

/* The most bytes that are deflated at once. */
#define PIR_DEFLATE_MOST (1u << 16)

/* Room for the work. */
typedef struct pir_deflate_work {
    uint16_t token[PIR_DEFLATE_MOST + 1];
} pir_deflate_work;

/*
 * Writes the stream of 1 to PIR_DEFLATE_MOST bytes. Returns its length, or 0 where it would be `room` bytes or longer.
 * The same bytes everywhere.
 */
size_t pir_deflate(const uint8_t *data, size_t size, pir_deflate_work *work, uint8_t *ret_stream, size_t room);

#endif
