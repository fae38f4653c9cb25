/* SPDX-License-Identifier: MIT */
/* Numbers of binary files, the least significant byte first. */
#ifndef PIR_POLYTOPE_WRITE_WRITE_BYTES_H
#define PIR_POLYTOPE_WRITE_WRITE_BYTES_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* The `size` lower bytes of a number, at most 8. */
static inline void pir_write_bytes(FILE *file, uint64_t value, size_t size) {
    unsigned char bytes[8];
    for (size_t k = 0; k < size; k++)
        bytes[k] = (unsigned char)(value >> 8 * k);
    fwrite(bytes, 1, size, file);
}

static inline void pir_write_float(FILE *file, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    pir_write_bytes(file, bits, sizeof bits);
}

static inline void pir_write_double(FILE *file, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    pir_write_bytes(file, bits, sizeof bits);
}

#endif
