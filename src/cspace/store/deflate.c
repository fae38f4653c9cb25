/* SPDX-License-Identifier: MIT */
/*
 * One block with codes of its own: first the tokens, literals and runs; then how often each comes, a code for them, and
 * the bits.
 *
 * A token below 256 is a literal; END ends the block; END + l repeats the byte before l times, which RFC 1951 says as a
 * match of length l at distance 1.
 */
#include "cspace/store/deflate.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define END         256u
#define RUN_LEAST   3u
#define RUN_MOST    258u
#define SYMBOLS     286u
#define LENGTHS     19u /* symbols that lengths of codes are written in */
#define BITS_MOST   15u
#define LENGTH_MOST 7u

/* --- tokens --- */

static size_t tokenise(const uint8_t *data, size_t size, uint16_t *token) {
    size_t count = 0;
    for (size_t i = 0; i < size;) {
        token[count++] = data[i++];
        if (i + RUN_LEAST > size || data[i] != data[i - 1] || data[i + 1] != data[i] || data[i + 2] != data[i])
            continue;
        size_t run = RUN_LEAST;
        while (run < RUN_MOST && i + run < size && data[i + run] == data[i])
            run++;
        token[count++] = (uint16_t)(END + run);
        i += run;
    }
    token[count++] = END;
    return count;
}

/* The symbol of a run's length, and the bits that follow it. */
static unsigned run_symbol(unsigned length, unsigned *ret_bits, unsigned *ret_value) {
    *ret_bits = *ret_value = 0;
    if (length == RUN_MOST)
        return SYMBOLS - 1;
    unsigned rest = length - RUN_LEAST;
    if (rest < 8)
        return END + 1 + rest;
    while (rest >> (*ret_bits + 3) != 0)
        ++*ret_bits;
    // four symbols for each number of bits
    *ret_value = rest & ((1u << *ret_bits) - 1);
    return END + 1 + 4 * *ret_bits + (rest >> *ret_bits);
}

/* --- codes --- */

/* A symbol, or a node over two others, as a code is made. */
struct node {
    uint32_t weight;
    uint16_t symbol, parent;
};

static int by_weight(const void *left, const void *right) {
    const struct node *a = left, *b = right;
    if (a->weight != b->weight)
        return a->weight < b->weight ? -1 : 1;
    return (a->symbol > b->symbol) - (a->symbol < b->symbol);
}

/* Huffman's lengths for `used` symbols that stand first in `node`, by weight. Returns the greatest. */
static unsigned join_nodes(struct node *node, size_t used, uint8_t *length) {
    size_t leaf = 0, inner = used, made = used;
    for (; made < 2 * used - 1; made++) {
        node[made].weight = 0;
        for (int half = 0; half < 2; half++) {
            bool take_leaf = leaf < used && (inner == made || node[leaf].weight <= node[inner].weight);
            size_t taken = take_leaf ? leaf++ : inner++;
            node[made].weight += node[taken].weight;
            node[taken].parent = (uint16_t)made;
        }
    }
    unsigned most = 0;
    for (size_t i = 0; i < used; i++) {
        unsigned depth = 0;
        for (size_t at = i; at != made - 1; at = node[at].parent)
            depth++;
        length[node[i].symbol] = (uint8_t)depth;
        most = depth > most ? depth : most;
    }
    return most;
}

/* Lengths of codes of at most `most` bits, 0 for symbols that do not come; at least two symbols come. */
static void find_lengths(const uint32_t *weight, size_t symbols, unsigned most, uint8_t *length) {
    struct node node[2 * SYMBOLS];
    size_t used = 0;
    memset(length, 0, symbols);
    for (size_t s = 0; s < symbols; s++)
        if (weight[s] > 0)
            node[used++] = (struct node){weight[s], (uint16_t)s, 0};
    do {
        qsort(node, used, sizeof *node, by_weight);
        if (join_nodes(node, used, length) <= most)
            return;
        // rare symbols weigh more, until the code is short enough
        for (size_t i = 0; i < used; i++)
            node[i].weight = node[i].weight / 2 + 1;
    } while (true);
}

/* The codes of lengths, each with its first bit lowest. */
static void find_codes(const uint8_t *length, size_t symbols, uint16_t *code) {
    unsigned count[BITS_MOST + 1] = {0}, next[BITS_MOST + 1], first = 0;
    for (size_t s = 0; s < symbols; s++)
        count[length[s]]++;
    count[0] = 0;
    for (unsigned bits = 1; bits <= BITS_MOST; bits++)
        next[bits] = first = (first + count[bits - 1]) << 1;
    for (size_t s = 0; s < symbols; s++) {
        unsigned straight = length[s] ? next[length[s]]++ : 0, reversed = 0;
        for (unsigned bit = 0; bit < length[s]; bit++)
            reversed |= (straight >> bit & 1) << (length[s] - 1 - bit);
        code[s] = (uint16_t)reversed;
    }
}

/* --- bits --- */

struct bits {
    uint8_t *data;
    size_t used, room; /* bytes */
    uint64_t held;
    unsigned count;
    bool full;
};

/* Appends at most 24 bits. */
static inline void put_bits(struct bits *bits, unsigned value, unsigned count) {
    bits->held |= (uint64_t)value << bits->count;
    bits->count += count;
    if (bits->count < 32)
        return;
    if (bits->room - bits->used < 4) {
        bits->full = true;
    } else {
        for (int byte = 0; byte < 4; byte++)
            bits->data[bits->used + (size_t)byte] = (uint8_t)(bits->held >> 8 * byte);
        bits->used += 4;
    }
    bits->held >>= 32;
    bits->count -= 32;
}

static void put_byte(struct bits *bits, uint8_t byte) {
    if (bits->used < bits->room)
        bits->data[bits->used++] = byte;
    else
        bits->full = true;
}

/* Ends the last byte. */
static void end_bits(struct bits *bits) {
    for (; bits->count > 0; bits->held >>= 8) {
        put_byte(bits, (uint8_t)bits->held);
        bits->count = bits->count > 8 ? bits->count - 8 : 0;
    }
}

/* --- the block --- */

/* Calls `put` for the symbols that lengths are written in: a length, or 17 and 18 for runs of zeros. */
static void each_length(const uint8_t *length, size_t count, void *context,
                        void (*put)(void *context, unsigned symbol, unsigned value, unsigned bits)) {
    for (size_t i = 0; i < count;) {
        size_t zeros = 0;
        while (i + zeros < count && zeros < 138 && length[i + zeros] == 0)
            zeros++;
        if (zeros >= 3) {
            put(context, zeros >= 11 ? 18 : 17, (unsigned)zeros - (zeros >= 11 ? 11 : 3), zeros >= 11 ? 7 : 3);
            i += zeros;
        } else {
            put(context, length[i++], 0, 0);
        }
    }
}

static void count_length(void *context, unsigned symbol, unsigned value, unsigned bits) {
    (void)value;
    (void)bits;
    ((uint32_t *)context)[symbol]++;
}

/* How lengths are written. */
struct lengths {
    struct bits *bits;
    uint8_t length[LENGTHS];
    uint16_t code[LENGTHS];
};

static void put_length(void *context, unsigned symbol, unsigned value, unsigned bits) {
    const struct lengths *lengths = context;
    put_bits(lengths->bits, lengths->code[symbol], lengths->length[symbol]);
    put_bits(lengths->bits, value, bits);
}

/* The head of the block: the lengths of all codes. `length` ends with that of the one distance. */
static void put_head(struct bits *bits, const uint8_t length[SYMBOLS + 1]) {
    static const uint8_t order[LENGTHS] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    uint32_t weight[LENGTHS] = {0};
    struct lengths lengths = {.bits = bits};
    each_length(length, SYMBOLS + 1, weight, count_length);
    find_lengths(weight, LENGTHS, LENGTH_MOST, lengths.length);
    find_codes(lengths.length, LENGTHS, lengths.code);
    put_bits(bits, 1 | 2 << 1, 3); // the last block, with codes of its own
    put_bits(bits, SYMBOLS - 257, 5);
    put_bits(bits, 0, 5);
    put_bits(bits, LENGTHS - 4, 4);
    for (unsigned i = 0; i < LENGTHS; i++)
        put_bits(bits, lengths.length[order[i]], 3);
    each_length(length, SYMBOLS + 1, &lengths, put_length);
}

static void put_tokens(struct bits *bits, const uint16_t *token, size_t count, const uint8_t *length) {
    uint16_t code[SYMBOLS];
    find_codes(length, SYMBOLS, code);
    for (size_t i = 0; i < count && !bits->full; i++) {
        unsigned symbol = token[i], more = 0, value = 0;
        if (symbol > END)
            symbol = run_symbol(symbol - END, &more, &value);
        put_bits(bits, code[symbol], length[symbol]);
        // the one distance is a zero bit
        if (symbol > END)
            put_bits(bits, value, more + 1);
    }
}

static uint32_t adler_of(const uint8_t *data, size_t size) {
    uint32_t a = 1, b = 0;
    for (size_t i = 0; i < size;) {
        // as many as cannot overflow
        for (size_t end = size - i < 5552 ? size : i + 5552; i < end; i++) {
            a += data[i];
            b += a;
        }
        a %= 65521;
        b %= 65521;
    }
    return b << 16 | a;
}

size_t pir_deflate(const uint8_t *data, size_t size, pir_deflate_work *work, uint8_t *ret_stream, size_t room) {
    struct bits bits = {.data = ret_stream, .room = room};
    uint32_t weight[SYMBOLS] = {0}, adler = adler_of(data, size);
    uint8_t length[SYMBOLS + 1];
    size_t count = tokenise(data, size, work->token);
    for (size_t i = 0; i < count; i++) {
        unsigned more, value, token = work->token[i];
        weight[token > END ? run_symbol(token - END, &more, &value) : token]++;
    }
    find_lengths(weight, SYMBOLS, BITS_MOST, length);
    length[SYMBOLS] = 1;
    put_byte(&bits, 0x78);
    put_byte(&bits, 0x01);
    put_head(&bits, length);
    put_tokens(&bits, work->token, count, length);
    end_bits(&bits);
    for (int byte = 3; byte >= 0; byte--)
        put_byte(&bits, (uint8_t)(adler >> 8 * byte));
    return bits.full || bits.used >= room ? 0 : bits.used;
}
