/* SPDX-License-Identifier: MIT */
/*
 * Unsigned numbers in bytes: 3 bits a half byte, least significant first, 8 added to all but the last half byte. The
 * lower half of a byte comes first. Most numbers of a record are below 8.
 */
#ifndef PIR_CSPACE_RECORD_RECORD_BYTES_H
#define PIR_CSPACE_RECORD_RECORD_BYTES_H

#include "base/byte_block.h"

/* The most bytes that a number of 32 bits takes. */
#define PIR_NUMBER_BYTES 6

/* Writes numbers, sixteen half bytes at a time. */
typedef struct pir_pen {
    uint8_t *at;   /* room for eight bytes more than the numbers that are still to come take */
    uint64_t held; /* half bytes that are still to be written */
    unsigned bits; /* of these, fewer than 64 */
} pir_pen;

/* Bytes that a pen writes beyond those of its numbers. */
#define PIR_PEN_SLACK 8

/* Writes what is held, in eight bytes, the least significant first. */
static inline void pir_pen_write(const pir_pen *pen) {
    for (unsigned i = 0; i < 8; i++)
        pen->at[i] = (uint8_t)(pen->held >> 8 * i);
}

static inline void pir_pen_put_half(pir_pen *pen, uint64_t half) {
    pen->held |= half << pen->bits;
    pen->bits += 4;
    if (pen->bits == 64) {
        pir_pen_write(pen);
        *pen = (pir_pen){pen->at + 8, 0, 0};
    }
}

static inline void pir_pen_put(pir_pen *pen, uint32_t number) {
    for (; number >= 8; number >>= 3)
        pir_pen_put_half(pen, (number & 7) | 8);
    pir_pen_put_half(pen, number);
}

/* Writes what is held; half a byte that is left over is 0. Returns the end of what has been written. */
static inline uint8_t *pir_pen_end(const pir_pen *pen) {
    pir_pen_write(pen);
    return pen->at + (pen->bits + 4) / 8;
}

/* Bytes that are read; `broken` once a number did not end in them, or was greater than asked for. */
typedef struct pir_record_scan {
    const uint8_t *at, *end;
    bool odd, broken;
} pir_record_scan;

/* The next number where it is at most `most`; else 0, and the scan is broken. */
static inline uint32_t pir_record_scan_number(pir_record_scan *scan, uint32_t most) {
    uint64_t number = 0;
    for (unsigned shift = 0; scan->at < scan->end && shift < 33; shift += 3) {
        uint32_t half = scan->odd ? *scan->at >> 4 : *scan->at & 15;
        scan->at += scan->odd;
        scan->odd = !scan->odd;
        number |= (uint64_t)(half & 7) << shift;
        if (half < 8) {
            scan->broken |= number > most;
            return number > most ? 0 : (uint32_t)number;
        }
    }
    scan->broken = true;
    return 0;
}

/* Whether everything has been read: at most half a byte is left over, of zeros. */
static inline bool pir_record_scan_ended(const pir_record_scan *scan) {
    return !scan->broken && (scan->odd ? scan->at + 1 == scan->end && *scan->at >> 4 == 0 : scan->at == scan->end);
}

/* The first number of a record: how it holds its slice. */
enum { PIR_RECORD_CHANGES = 0, PIR_RECORD_WHOLE = 1 };

#endif
