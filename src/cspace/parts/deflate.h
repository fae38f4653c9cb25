/* SPDX-License-Identifier: MIT */
/*
 * Deflate in the form of zlib (RFC 1950, RFC 1951) that looks for runs of one byte and for nothing else. Records are
 * dense, and arrays of numbers are little else once shuffled: to look for more takes ten times as long and gains an
 * eighth. What it makes is a function of the data alone, whatever zlib there is.
 */
#ifndef PIR_CSPACE_PARTS_DEFLATE_H
#define PIR_CSPACE_PARTS_DEFLATE_H

#include <stdint.h>

/* The most bytes at a time, and by how much the room for what they become must exceed them. */
#define PIR_DEFLATE_MOST  (1u << 16)
#define PIR_DEFLATE_SLACK 16u

/* A run of bytes that equal the one before them. */
typedef struct pir_byte_run {
    uint32_t start, length;
} pir_byte_run;

/* Runs have at least this length. */
#define PIR_RUN_LEAST 4

/* Room for all runs. */
#define PIR_RUNS_MOST (PIR_DEFLATE_MOST / PIR_RUN_LEAST)

/*
 * Deflates `size` bytes, 1 to PIR_DEFLATE_MOST. Returns how many bytes that gives; 0 where it would be no fewer, and
 * nothing has been written then. ret_deflated has room for size + PIR_DEFLATE_SLACK; `run` is room to work in, for
 * PIR_RUNS_MOST.
 */
uint32_t pir_deflate_runs(const uint8_t *data, uint32_t size, pir_byte_run *run, uint8_t *ret_deflated);

#endif
