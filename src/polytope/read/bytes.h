/* SPDX-License-Identifier: MIT */
/* Numbers in binary files, the least significant byte first or, when `big`, the most significant. */
#ifndef PIR_POLYTOPE_READ_BYTES_H
#define PIR_POLYTOPE_READ_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* An integer of 1 to 8 bytes without a sign. */
static inline uint64_t pir_bytes_unsigned(const char *bytes, size_t size, bool big) {
    uint64_t value = 0;
    for (size_t k = 0; k < size; k++)
        value = value << 8 | (unsigned char)bytes[big ? k : size - 1 - k];
    return value;
}

/* An integer in two's complement, 1 to 4 bytes. */
static inline int64_t pir_bytes_signed(const char *bytes, size_t size, bool big) {
    const int64_t value = (int64_t)pir_bytes_unsigned(bytes, size, big), range = (int64_t)1 << (8 * size);
    return value >= range / 2 ? value - range : value;
}

static inline double pir_bytes_float(const char *bytes, bool big) {
    const uint32_t bits = (uint32_t)pir_bytes_unsigned(bytes, 4, big);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double pir_bytes_double(const char *bytes, bool big) {
    const uint64_t bits = pir_bytes_unsigned(bytes, 8, big);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
