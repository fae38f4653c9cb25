/* SPDX-License-Identifier: MIT */
/* Sums as bytes, for tests and fuzz targets. */
#ifndef TESTS_SUPPORT_SUM_BYTES_H
#define TESTS_SUPPORT_SUM_BYTES_H

#include <stddef.h>
#include <stdint.h>

#include <pirouette/sum.h>

typedef struct test_bytes {
    uint8_t *data; /* for free(); NULL where there was no memory, or the sum would not be written */
    size_t size;
} test_bytes;

test_bytes test_bytes_of(const pir_sum *sum);

/* Sets the header's length and checksum right, so that what was changed is found by what reads it. */
void test_bytes_seal(uint8_t *data, size_t size);

#endif
