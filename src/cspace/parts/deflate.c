/* SPDX-License-Identifier: MIT */
/*
 * One block with a code of its own: runs are found and symbols counted, the code is made, and then the length is known
 * before a bit is written. A run is a match at distance 1, the only one.
 */
#include "cspace/parts/deflate.h"

#include <string.h>
#include <zlib.h>

#include "cspace/parts/huffman.h"

/* The alphabets: bytes, the end of the block, lengths of matches; lengths of words, and those that repeat. */
enum { END = 256, FIRST_LENGTH = 257, LAST_LENGTH = 285, SYMBOLS = 286 };
enum { REPEAT = 16, ZEROS = 17, MANY_ZEROS = 18, META_SYMBOLS = 19 };

#define MATCH_LEAST  3u
#define MATCH_MOST   258u
#define META_LONGEST 7

/* The order in which a block has the lengths of the words for lengths of words. */
static const uint8_t meta_order[META_SYMBOLS] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};

/* --- runs --- */

static uint32_t word_at(const uint8_t *data) {
    uint32_t word;
    memcpy(&word, data, sizeof word);
    return word;
}

static uint32_t find_runs(const uint8_t *data, uint32_t size, pir_byte_run *run) {
    uint32_t count = 0;
    for (uint32_t i = 1; i + PIR_RUN_LEAST <= size; i++) {
        if (word_at(data + i) != word_at(data + i - 1))
            continue;
        uint32_t end = i + PIR_RUN_LEAST;
        while (end < size && data[end] == data[i])
            end++;
        run[count++] = (pir_byte_run){i, end - i};
        i = end;
    }
    return count;
}

/* The length of the next match of a run that has so many bytes left: what remains can be a match too. */
static uint32_t match_of(uint32_t left) {
    if (left <= MATCH_MOST)
        return left;
    return left - MATCH_MOST < MATCH_LEAST ? MATCH_MOST - MATCH_LEAST : MATCH_MOST;
}

/* A symbol, and bits that come after its word. */
struct token {
    uint16_t symbol;
    uint8_t extra_bits, extra;
};

static struct token token_of_match(uint32_t length) {
    if (length == MATCH_MOST)
        return (struct token){LAST_LENGTH, 0, 0};
    const uint32_t over = length - MATCH_LEAST;
    if (over < 8)
        return (struct token){(uint16_t)(FIRST_LENGTH + over), 0, 0};
    const uint32_t bits = 29 - (uint32_t)__builtin_clz(over);
    return (struct token){(uint16_t)(FIRST_LENGTH + 4 * bits + (over >> bits)), (uint8_t)bits,
                          (uint8_t)(over & ((1u << bits) - 1))};
}

/* --- what the block has --- */

struct block {
    const uint8_t *data;
    uint32_t size;
    const pir_byte_run *run;
    uint32_t runs;
    pir_prefix_code code, meta;
    struct token length[SYMBOLS + 1]; /* of words, as the head has them */
    uint32_t lengths;
    uint32_t symbols, meta_lengths; /* how many lengths of words the head has, and of words for these */
};

/* Counts symbols; returns the bits that come after their words. */
static uint32_t count_symbols(const struct block *block, uint32_t *count) {
    uint32_t bits = 0, at = 0;
    for (uint32_t r = 0; r <= block->runs; r++) {
        const uint32_t end = r < block->runs ? block->run[r].start : block->size;
        for (; at < end; at++)
            count[block->data[at]]++;
        for (uint32_t left = r < block->runs ? block->run[r].length : 0, match; left > 0; left -= match, at += match) {
            match = match_of(left);
            const struct token token = token_of_match(match);
            count[token.symbol]++;
            // the distance has a word of one bit
            bits += token.extra_bits + 1u;
        }
    }
    count[END] = 1;
    return bits;
}

/* How often a length of a word comes again from `at` on, `most` times at most. */
static uint32_t times(const uint8_t *length, uint32_t at, uint32_t end, uint32_t most) {
    uint32_t n = 1;
    while (at + n < end && n < most && length[at + n] == length[at])
        n++;
    return n;
}

/* Lists the lengths of words, those of the one distance last; counts the symbols of the list. */
static void list_lengths(struct block *block, uint32_t *count) {
    uint8_t length[SYMBOLS + 1];
    block->symbols = SYMBOLS;
    while (block->code.length[block->symbols - 1] == 0)
        block->symbols--;
    memcpy(length, block->code.length, block->symbols);
    length[block->symbols] = 1;
    const uint32_t end = block->symbols + 1;
    block->lengths = 0;
    for (uint32_t at = 0, n; at < end; at += n) {
        struct token token = {length[at], 0, 0};
        n = 1;
        if (length[at] == 0 && (n = times(length, at, end, 138)) >= 3)
            token =
                n > 10 ? (struct token){MANY_ZEROS, 7, (uint8_t)(n - 11)} : (struct token){ZEROS, 3, (uint8_t)(n - 3)};
        else if (at > 0 && length[at] == length[at - 1] && (n = times(length, at, end, 6)) >= 3)
            token = (struct token){REPEAT, 2, (uint8_t)(n - 3)};
        else
            n = 1;
        block->length[block->lengths++] = token;
        count[token.symbol]++;
    }
}

/* Makes both codes; returns the bits of the whole block. */
static uint64_t make_codes(struct block *block) {
    uint32_t count[SYMBOLS] = {0}, meta_count[META_SYMBOLS] = {0};
    uint64_t bits = count_symbols(block, count);
    pir_prefix_code_make(count, SYMBOLS, PIR_WORD_MOST, &block->code);
    list_lengths(block, meta_count);
    pir_prefix_code_make(meta_count, META_SYMBOLS, META_LONGEST, &block->meta);
    block->meta_lengths = META_SYMBOLS;
    while (block->meta_lengths > 4 && block->meta.length[meta_order[block->meta_lengths - 1]] == 0)
        block->meta_lengths--;
    for (uint32_t s = 0; s < SYMBOLS; s++)
        bits += (uint64_t)count[s] * block->code.length[s];
    for (uint32_t i = 0; i < block->lengths; i++)
        bits += block->meta.length[block->length[i].symbol] + block->length[i].extra_bits;
    return bits + 3 + 5 + 5 + 4 + 3 * block->meta_lengths;
}

/* --- bits --- */

/* Writes bits, the least significant first. */
struct bits {
    uint8_t *at;
    uint64_t held;
    unsigned count; /* held; fewer than 8 after lay_down */
};

/* At most 56 bits between two calls of lay_down. */
static inline void put(struct bits *bits, uint64_t value, unsigned count) {
    bits->held |= value << bits->count;
    bits->count += count;
}

static inline void lay_down(struct bits *bits) {
    for (unsigned i = 0; i < 8; i++)
        bits->at[i] = (uint8_t)(bits->held >> 8 * i);
    bits->at += bits->count / 8;
    bits->held >>= bits->count / 8 * 8;
    bits->count %= 8;
}

static void put_token(struct bits *bits, const pir_prefix_code *code, struct token token) {
    put(bits, code->word[token.symbol], code->length[token.symbol]);
    put(bits, token.extra, token.extra_bits);
    lay_down(bits);
}

static void put_head(const struct block *block, struct bits *bits) {
    // the last block, with codes of its own; one distance
    put(bits, 1 | 2 << 1, 3);
    put(bits, block->symbols - FIRST_LENGTH, 5);
    put(bits, 0, 5);
    put(bits, block->meta_lengths - 4, 4);
    lay_down(bits);
    for (uint32_t i = 0; i < block->meta_lengths; i++) {
        put(bits, block->meta.length[meta_order[i]], 3);
        lay_down(bits);
    }
    for (uint32_t i = 0; i < block->lengths; i++)
        put_token(bits, &block->meta, block->length[i]);
}

static void put_bytes(const pir_prefix_code *code, const uint8_t *data, const uint8_t *end, struct bits *to) {
    struct bits bits = *to;
    for (; end - data >= 3; data += 3) {
        for (int i = 0; i < 3; i++)
            put(&bits, code->word[data[i]], code->length[data[i]]);
        lay_down(&bits);
    }
    for (; data < end; data++) {
        put(&bits, code->word[*data], code->length[*data]);
        lay_down(&bits);
    }
    *to = bits;
}

static void put_body(const struct block *block, struct bits *bits) {
    uint32_t at = 0;
    for (uint32_t r = 0; r <= block->runs; r++) {
        const uint32_t end = r < block->runs ? block->run[r].start : block->size;
        put_bytes(&block->code, block->data + at, block->data + end, bits);
        at = end;
        for (uint32_t left = r < block->runs ? block->run[r].length : 0, match; left > 0; left -= match, at += match) {
            match = match_of(left);
            put_token(bits, &block->code, token_of_match(match));
            put(bits, 0, 1);
        }
    }
    put_token(bits, &block->code, (struct token){END, 0, 0});
}

uint32_t pir_deflate_runs(const uint8_t *data, uint32_t size, pir_byte_run *run, uint8_t *ret_deflated) {
    struct block block = {.data = data, .size = size, .run = run, .runs = find_runs(data, size, run)};
    const uint64_t bytes = 2 + (make_codes(&block) + 7) / 8 + 4;
    if (bytes >= size)
        return 0;
    // a window of 32 KiB; the remainder makes the two bytes a multiple of 31
    struct bits bits = {ret_deflated, 0, 0};
    put(&bits, 0x0178, 16);
    put_head(&block, &bits);
    put_body(&block, &bits);
    lay_down(&bits);
    uint8_t *at = bits.at + (bits.count > 0);
    const uint32_t sum = (uint32_t)adler32(1, data, size);
    for (unsigned i = 0; i < 4; i++)
        at[i] = (uint8_t)(sum >> (24 - 8 * i));
    return (uint32_t)bytes;
}
