/* SPDX-License-Identifier: MIT */
/* Numbers to bytes of snapshots, least byte first; `at` moves on. */
#ifndef PIR_SCENE_FILE_PUT_BYTES_H
#define PIR_SCENE_FILE_PUT_BYTES_H

#include <stdint.h>
#include <string.h>

static inline void pir_put_bytes(uint8_t **at, uint64_t value, int bytes) {
    for (int k = 0; k < bytes; k++)
        *(*at)++ = (uint8_t)(value >> (8 * k));
}

static inline void pir_put_double(uint8_t **at, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    pir_put_bytes(at, bits, 8);
}

#endif
