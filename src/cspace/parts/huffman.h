/* SPDX-License-Identifier: MIT */
/*
 * Prefix codes of limited length, as deflate has them (RFC 1951, 3.2.2): a code is given by the lengths of its words,
 * and words are written with the bits of each reversed.
 */
#ifndef PIR_CSPACE_PARTS_HUFFMAN_H
#define PIR_CSPACE_PARTS_HUFFMAN_H

#include <stdint.h>

/* The most symbols of an alphabet, and the longest word. */
#define PIR_SYMBOLS_MOST 286
#define PIR_WORD_MOST    15

typedef struct pir_prefix_code {
    uint16_t word[PIR_SYMBOLS_MOST];  /* bits reversed */
    uint8_t length[PIR_SYMBOLS_MOST]; /* 0 for a symbol that has no word */
} pir_prefix_code;

/*
 * A complete code for the symbols whose count is not 0: the best one, where that has no words longer than `longest`.
 * There are two such symbols at least and 2^longest at most, and all counts together are less than 2^32. A function of
 * the counts. O(symbols · log symbols).
 */
void pir_prefix_code_make(const uint32_t *count, uint32_t symbols, uint32_t longest, pir_prefix_code *ret_code);

#endif
