/* SPDX-License-Identifier: MIT */
/*
 * Huffman's algorithm on sorted counts: nodes that join others come out in order too, so the two least are at the
 * front of one of two queues.
 *
 * Words that are too long are cut to the longest allowed. Then the sum of 2^(longest − length) over all words is too
 * great, by k. Each of k times a word of the greatest shorter length makes room: it and a longest one become two that
 * are one bit longer than it was, which takes 1 from the sum. Longest words do not run out: below each node at their
 * depth there were n ≥ 2 words, of which n − 1 are used so.
 */
#include "cspace/parts/huffman.h"

#include <string.h>

/* Counts are sorted by so many bits at a time. */
#define DIGIT  8
#define DIGITS (1u << DIGIT)

struct tree {
    uint32_t leaves;
    uint16_t symbol[PIR_SYMBOLS_MOST]; /* by rising count, and of the same count by rising number */
    uint32_t weight[2 * PIR_SYMBOLS_MOST];
    uint32_t parent[2 * PIR_SYMBOLS_MOST]; /* leaves first, then nodes in the order in which they are made */
};

/* Sorts the symbols by the digit of their counts that begins at bit `shift`. */
static void sort_by_digit(struct tree *tree, const uint32_t *count, unsigned shift) {
    uint32_t start[DIGITS + 1] = {0};
    uint16_t sorted[PIR_SYMBOLS_MOST];
    for (uint32_t i = 0; i < tree->leaves; i++)
        start[(count[tree->symbol[i]] >> shift & (DIGITS - 1)) + 1]++;
    for (uint32_t d = 0; d < DIGITS; d++)
        start[d + 1] += start[d];
    for (uint32_t i = 0; i < tree->leaves; i++)
        sorted[start[count[tree->symbol[i]] >> shift & (DIGITS - 1)]++] = tree->symbol[i];
    memcpy(tree->symbol, sorted, tree->leaves * sizeof *sorted);
}

static void list_leaves(struct tree *tree, const uint32_t *count, uint32_t symbols) {
    uint32_t all = 0;
    tree->leaves = 0;
    for (uint32_t s = 0; s < symbols; s++) {
        all |= count[s];
        tree->symbol[tree->leaves] = (uint16_t)s;
        tree->leaves += count[s] > 0;
    }
    for (unsigned shift = 0; shift < 32 && all >> shift; shift += DIGIT)
        sort_by_digit(tree, count, shift);
    for (uint32_t i = 0; i < tree->leaves; i++)
        tree->weight[i] = count[tree->symbol[i]];
}

/* The one of less weight of the first leaf and the first node that have no parent yet. */
static uint32_t take_least(const struct tree *tree, uint32_t *leaf, uint32_t *node, uint32_t nodes_end) {
    if (*leaf < tree->leaves && (*node == nodes_end || tree->weight[*leaf] <= tree->weight[*node]))
        return (*leaf)++;
    return (*node)++;
}

static void join(struct tree *tree) {
    uint32_t leaf = 0, node = tree->leaves;
    for (uint32_t made = tree->leaves; made < 2 * tree->leaves - 1; made++) {
        uint32_t a = take_least(tree, &leaf, &node, made), b = take_least(tree, &leaf, &node, made);
        tree->weight[made] = tree->weight[a] + tree->weight[b];
        tree->parent[a] = tree->parent[b] = made;
    }
}

/* How many words have each length, none longer than `longest`. */
static void count_lengths(const struct tree *tree, uint32_t longest, uint32_t *of_length) {
    uint32_t depth[2 * PIR_SYMBOLS_MOST], root = 2 * tree->leaves - 2;
    uint64_t sum = 0;
    depth[root] = 0;
    for (uint32_t i = root; i-- > 0;) {
        depth[i] = depth[tree->parent[i]] + 1;
        if (i >= tree->leaves)
            continue;
        uint32_t length = depth[i] < longest ? depth[i] : longest;
        of_length[length]++;
        sum += (uint64_t)1 << (longest - length);
    }
    for (uint64_t excess = sum - ((uint64_t)1 << longest); excess > 0; excess--) {
        uint32_t shorter = longest - 1;
        while (of_length[shorter] == 0)
            shorter--;
        of_length[shorter]--;
        of_length[shorter + 1] += 2;
        of_length[longest]--;
    }
}

static uint16_t reversed(uint32_t word, uint32_t length) {
    uint32_t back = 0;
    for (uint32_t i = 0; i < length; i++)
        back |= (word >> i & 1) << (length - 1 - i);
    return (uint16_t)back;
}

/* Words of each length are numbers in succession, by rising symbol. */
static void number_words(const uint32_t *of_length, uint32_t symbols, pir_prefix_code *code) {
    uint32_t next[PIR_WORD_MOST + 1] = {0};
    for (uint32_t length = 1, word = 0; length <= PIR_WORD_MOST; length++) {
        word = (word + of_length[length - 1]) << 1;
        next[length] = word;
    }
    for (uint32_t s = 0; s < symbols; s++)
        if (code->length[s] > 0)
            code->word[s] = reversed(next[code->length[s]]++, code->length[s]);
}

void pir_prefix_code_make(const uint32_t *count, uint32_t symbols, uint32_t longest, pir_prefix_code *ret_code) {
    struct tree tree;
    uint32_t of_length[PIR_WORD_MOST + 1] = {0}, at = 0;
    *ret_code = (pir_prefix_code){{0}, {0}};
    list_leaves(&tree, count, symbols);
    join(&tree);
    count_lengths(&tree, longest, of_length);
    // the least frequent symbols have the longest words
    for (uint32_t length = longest; length > 0; length--)
        for (uint32_t i = 0; i < of_length[length]; i++)
            ret_code->length[tree.symbol[at++]] = (uint8_t)length;
    number_words(of_length, symbols, ret_code);
}
